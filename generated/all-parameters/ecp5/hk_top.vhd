-- made by hostkit 0.1.0 from design 0099cab74159; do not edit; template ecp5/top.vhd.j2
-- The system on a ULX3S: clock, reset and pads. The PLL is in hk_ecp5_pll.v; here it is a component
-- without a body, so that this file can be analysed without it.
library ieee;
use ieee.std_logic_1164.all;

entity hk_top is
  port (
    clk_in       : in    std_logic;  -- 25.000000 MHz
    reset_button : in    std_logic;  -- high when pressed
    scl          : inout std_logic;  -- open drain, pulled up outside
    sda          : inout std_logic;
    int_pin      : in    std_logic;  -- data ready of the sensor
    uart_rx      : in    std_logic;
    uart_tx      : out   std_logic;
    led_running  : out   std_logic;  -- the sensor is configured and sampling
    led_failed   : out   std_logic;  -- no sensor, or one that is refused
    wifi_gpio0   : out   std_logic   -- high, so that the ESP32 of the board does not take over
  );
end entity hk_top;

architecture board of hk_top is

  component hk_ecp5_pll is
    port (
      clk_in : in  std_logic;
      clk    : out std_logic;
      locked : out std_logic
    );
  end component hk_ecp5_pll;

  signal clk    : std_logic;
  signal locked : std_logic;

  -- The value after configuration holds the system in reset: nothing else resets the reset.
  signal ready_r : std_logic_vector(3 downto 0) := (others => '0');
  signal rst     : std_logic;

  signal scl_in  : std_logic;
  signal sda_in  : std_logic;
  signal scl_low : std_logic;
  signal sda_low : std_logic;

begin

  clock : hk_ecp5_pll
    port map (
      clk_in => clk_in,
      clk    => clk,
      locked => locked
    );

  rst <= not ready_r(3);

  reset : process (clk)
  begin
    if rising_edge(clk) then
      ready_r <= ready_r(2 downto 0) & (locked and not reset_button);
    end if;
  end process reset;

  -- A line is pulled low or let go, never driven high.
  scl    <= '0' when scl_low = '1' else 'Z';
  sda    <= '0' when sda_low = '1' else 'Z';
  scl_in <= scl;
  sda_in <= sda;

  wifi_gpio0 <= '1';

  system : entity work.hk_system
    port map (
      clk     => clk,
      rst     => rst,
      scl_in  => scl_in,
      sda_in  => sda_in,
      scl_low => scl_low,
      sda_low => sda_low,
      int_pin => int_pin,
      uart_rx => uart_rx,
      uart_tx => uart_tx,
      running => led_running,
      failed  => led_failed
    );

end architecture board;
