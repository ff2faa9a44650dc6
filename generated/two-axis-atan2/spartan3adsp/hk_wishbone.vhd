-- Wishbone B4 slave before the registers: classic cycles, 32-bit data, byte addresses. A write
-- takes two clocks and a read three; acknowledge and error last one clock.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

entity hk_wishbone is
  port (
    clk           : in  std_logic;
    rst           : in  std_logic;  -- synchronous, active high
    wb_cyc        : in  std_logic;
    wb_stb        : in  std_logic;
    wb_we         : in  std_logic;
    wb_adr        : in  std_logic_vector(7 downto 0);  -- bytes; the low two bits are ignored
    wb_sel        : in  std_logic_vector(3 downto 0);  -- of a write; a read gives the whole word
    wb_dat_w      : in  std_logic_vector(31 downto 0);
    wb_dat_r      : out std_logic_vector(31 downto 0);
    wb_ack        : out std_logic;
    wb_err        : out std_logic;
    address       : out unsigned(7 downto 0);  -- from here on: ports of hk_regs
    write         : out std_logic;
    read          : out std_logic;
    write_data    : out std_logic_vector(31 downto 0);
    write_strobes : out std_logic_vector(3 downto 0);
    read_data     : in  std_logic_vector(31 downto 0);
    acknowledge   : in  std_logic;
    error         : in  std_logic
  );
end entity hk_wishbone;

architecture rtl of hk_wishbone is

  signal asked     : std_logic;
  signal answered  : std_logic;
  signal waiting_r : std_logic;  -- for the acknowledge of a request
  signal gone_r    : std_logic;  -- the master gave that request up

begin

  asked         <= wb_cyc and wb_stb;
  address       <= unsigned(wb_adr);
  write         <= asked and wb_we and not waiting_r;
  read          <= asked and not wb_we and not waiting_r;
  write_data    <= wb_dat_w;
  write_strobes <= wb_sel;

  answered <= asked and acknowledge and not gone_r;
  wb_dat_r <= read_data;
  wb_ack   <= answered and not error;
  wb_err   <= answered and error;

  process (clk)
  begin
    if rising_edge(clk) then
      if asked = '1' then
        waiting_r <= '1';
      elsif waiting_r = '1' then
        gone_r <= '1';
      end if;
      if acknowledge = '1' or rst = '1' then
        waiting_r <= '0';
        gone_r    <= '0';
      end if;
    end if;
  end process;

end architecture rtl;
