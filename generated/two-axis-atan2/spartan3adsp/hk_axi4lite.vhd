-- AXI4-Lite slave before the registers. Addresses and data are taken independently, one of each at
-- a time; of a read and a write that both wait the read goes first. Protection bits are ignored.
-- What the registers refuse is answered SLVERR, all else OKAY.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

entity hk_axi4lite is
  port (
    clk           : in  std_logic;
    rst           : in  std_logic;  -- synchronous, active high
    s_axi_awaddr  : in  std_logic_vector(7 downto 0);
    s_axi_awprot  : in  std_logic_vector(2 downto 0);
    s_axi_awvalid : in  std_logic;
    s_axi_awready : out std_logic;
    s_axi_wdata   : in  std_logic_vector(31 downto 0);
    s_axi_wstrb   : in  std_logic_vector(3 downto 0);
    s_axi_wvalid  : in  std_logic;
    s_axi_wready  : out std_logic;
    s_axi_bresp   : out std_logic_vector(1 downto 0);
    s_axi_bvalid  : out std_logic;
    s_axi_bready  : in  std_logic;
    s_axi_araddr  : in  std_logic_vector(7 downto 0);
    s_axi_arprot  : in  std_logic_vector(2 downto 0);
    s_axi_arvalid : in  std_logic;
    s_axi_arready : out std_logic;
    s_axi_rdata   : out std_logic_vector(31 downto 0);
    s_axi_rresp   : out std_logic_vector(1 downto 0);
    s_axi_rvalid  : out std_logic;
    s_axi_rready  : in  std_logic;
    address       : out unsigned(7 downto 0);  -- from here on: ports of hk_regs
    write         : out std_logic;
    read          : out std_logic;
    write_data    : out std_logic_vector(31 downto 0);
    write_strobes : out std_logic_vector(3 downto 0);
    read_data     : in  std_logic_vector(31 downto 0);
    acknowledge   : in  std_logic;
    error         : in  std_logic
  );
end entity hk_axi4lite;

architecture rtl of hk_axi4lite is

  -- Each side: an address waits until its response has been taken.
  signal has_write_address_r : std_logic;
  signal has_write_data_r    : std_logic;
  signal has_read_address_r  : std_logic;
  signal write_address_r     : unsigned(7 downto 0);
  signal read_address_r      : unsigned(7 downto 0);
  signal write_data_r        : std_logic_vector(31 downto 0);
  signal write_strobes_r     : std_logic_vector(3 downto 0);

  signal can_write : std_logic;
  signal can_read  : std_logic;
  signal to_write  : std_logic;
  signal to_read   : std_logic;

  signal writing_r   : std_logic;  -- requested, not acknowledged
  signal reading_r   : std_logic;
  signal written_r   : std_logic;  -- a response waits
  signal have_read_r : std_logic;
  signal write_bad_r : std_logic;
  signal read_bad_r  : std_logic;

begin

  s_axi_awready <= not has_write_address_r;
  s_axi_wready  <= not has_write_data_r;
  s_axi_arready <= not has_read_address_r;
  s_axi_bvalid  <= written_r;
  s_axi_bresp   <= write_bad_r & '0';
  s_axi_rvalid  <= have_read_r;
  s_axi_rresp   <= read_bad_r & '0';
  s_axi_rdata   <= read_data;  -- holds: the next read waits until this one was taken

  can_write <= has_write_address_r and has_write_data_r and not written_r
               and not writing_r and not reading_r;
  can_read  <= has_read_address_r and not have_read_r and not writing_r and not reading_r;
  -- A read cannot ask again the clock after its acknowledge: no write waits longer than one read.
  to_read  <= can_read;
  to_write <= can_write and not can_read;

  address       <= read_address_r when to_read = '1' else write_address_r;
  write         <= to_write;
  read          <= to_read;
  write_data    <= write_data_r;
  write_strobes <= write_strobes_r;

  process (clk)
  begin
    if rising_edge(clk) then
      if s_axi_awvalid = '1' and has_write_address_r = '0' then
        has_write_address_r <= '1';
        write_address_r     <= unsigned(s_axi_awaddr);
      end if;
      if s_axi_wvalid = '1' and has_write_data_r = '0' then
        has_write_data_r <= '1';
        write_data_r     <= s_axi_wdata;
        write_strobes_r  <= s_axi_wstrb;
      end if;
      if s_axi_arvalid = '1' and has_read_address_r = '0' then
        has_read_address_r <= '1';
        read_address_r     <= unsigned(s_axi_araddr);
      end if;

      if to_write = '1' then
        writing_r <= '1';
      end if;
      if to_read = '1' then
        reading_r <= '1';
      end if;

      if acknowledge = '1' then
        if writing_r = '1' then
          written_r   <= '1';
          write_bad_r <= error;
        end if;
        if reading_r = '1' then
          have_read_r <= '1';
          read_bad_r  <= error;
        end if;
        writing_r <= '0';
        reading_r <= '0';
      end if;

      if written_r = '1' and s_axi_bready = '1' then
        written_r           <= '0';
        has_write_address_r <= '0';
        has_write_data_r    <= '0';
      end if;
      if have_read_r = '1' and s_axi_rready = '1' then
        have_read_r        <= '0';
        has_read_address_r <= '0';
      end if;

      if rst = '1' then
        has_write_address_r <= '0';
        has_write_data_r    <= '0';
        has_read_address_r  <= '0';
        writing_r           <= '0';
        reading_r           <= '0';
        written_r           <= '0';
        have_read_r         <= '0';
        write_bad_r         <= '0';
        read_bad_r          <= '0';
        write_address_r     <= (others => '0');  -- only for a quiet simulation
        read_address_r      <= (others => '0');
      end if;
    end if;
  end process;

end architecture rtl;
