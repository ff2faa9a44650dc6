-- Serial transmitter, 8 data bits, no parity, 1 stop bit. A byte that is offered within the stop
-- bit of the one before follows it without a gap.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

entity hk_uart_tx is
  generic (
    CLOCK_HZ : positive;
    BAUD     : positive  -- a quarter of the clock at most, so that the receiver can follow
  );
  port (
    clk      : in  std_logic;
    rst      : in  std_logic;  -- synchronous, active high
    in_valid : in  std_logic;
    in_ready : out std_logic;
    in_data  : in  std_logic_vector(7 downto 0);
    tx       : out std_logic
  );
end entity hk_uart_tx;

architecture rtl of hk_uart_tx is

  signal tick : std_logic;

  -- Bits to come, the next one lowest, and behind them a mark that is the stop bit as well.
  signal bits_r : std_logic_vector(9 downto 0);
  signal busy_r : std_logic;
  signal tx_r   : std_logic;

begin

  assert BAUD <= CLOCK_HZ / 4
    report "hk_uart_tx: BAUD must be a quarter of CLOCK_HZ at most"
    severity failure;

  in_ready <= not busy_r;
  tx       <= tx_r;

  ticks : entity work.hk_ticks
    generic map (
      CLOCK_HZ => CLOCK_HZ,
      TICKS_HZ => BAUD
    )
    port map (
      clk     => clk,
      restart => rst,
      tick    => tick
    );

  process (clk)
  begin
    if rising_edge(clk) then
      if busy_r = '0' then
        if in_valid = '1' then
          bits_r <= '1' & in_data & '0';
          busy_r <= '1';
        end if;
      elsif tick = '1' then
        tx_r   <= bits_r(0);
        bits_r <= '0' & bits_r(9 downto 1);
        if unsigned(bits_r(9 downto 1)) = 0 then
          busy_r <= '0';
        end if;
      end if;
      if rst = '1' then
        busy_r <= '0';
        tx_r   <= '1';
      end if;
    end if;
  end process;

end architecture rtl;
