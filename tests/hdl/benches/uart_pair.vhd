-- A transmitter and a receiver of one rate, side by side.
library ieee;
use ieee.std_logic_1164.all;

entity uart_pair is
  generic (
    CLOCK_HZ : positive;
    BAUD     : positive
  );
  port (
    clk           : in  std_logic;
    rst           : in  std_logic;
    in_valid      : in  std_logic;
    in_ready      : out std_logic;
    in_data       : in  std_logic_vector(7 downto 0);
    tx            : out std_logic;
    rx            : in  std_logic;
    out_valid     : out std_logic;
    out_ready     : in  std_logic;
    out_data      : out std_logic_vector(7 downto 0);
    framing_error : out std_logic;
    overrun       : out std_logic
  );
end entity uart_pair;

architecture bench of uart_pair is
begin

  transmitter : entity work.hk_uart_tx
    generic map (CLOCK_HZ => CLOCK_HZ, BAUD => BAUD)
    port map (
      clk => clk, rst => rst, in_valid => in_valid, in_ready => in_ready, in_data => in_data,
      tx => tx
    );

  receiver : entity work.hk_uart_rx
    generic map (CLOCK_HZ => CLOCK_HZ, BAUD => BAUD)
    port map (
      clk => clk, rst => rst, rx => rx, out_valid => out_valid, out_ready => out_ready,
      out_data => out_data, framing_error => framing_error, overrun => overrun
    );

end architecture bench;
