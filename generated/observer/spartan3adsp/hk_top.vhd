-- made by hostkit 0.1.0 from design f27a2d565bf0; do not edit; template spartan3adsp/top.vhd.j2
-- The system on a board with a Spartan-3A DSP: clock, reset and pads. Primitives of the vendor are
-- in this file only; they are declared here, so that it can be analysed without their library.
library ieee;
use ieee.std_logic_1164.all;

entity hk_top is
  port (
    clk_in       : in    std_logic;  -- 125.000000 MHz
    reset_button : in    std_logic;  -- high when pressed
    scl          : inout std_logic;  -- open drain, pulled up outside
    sda          : inout std_logic;
    int_pin      : in    std_logic;  -- data ready of the sensor
    uart_rx      : in    std_logic;
    uart_tx      : out   std_logic;
    led_running  : out   std_logic;  -- the sensor is configured and sampling
    led_failed   : out   std_logic   -- no sensor, or one that is refused
  );
end entity hk_top;

architecture board of hk_top is

  component IBUFG is
    port (
      I : in  std_logic;
      O : out std_logic
    );
  end component IBUFG;

  component BUFG is
    port (
      I : in  std_logic;
      O : out std_logic
    );
  end component BUFG;

  component IOBUF is
    port (
      I  : in    std_logic;
      T  : in    std_logic;
      O  : out   std_logic;
      IO : inout std_logic
    );
  end component IOBUF;

  component DCM_SP is
    generic (
      CLK_FEEDBACK   : string  := "1X";
      CLKFX_MULTIPLY : integer := 4;
      CLKFX_DIVIDE   : integer := 1;
      CLKIN_PERIOD   : real    := 0.0
    );
    port (
      CLKIN    : in  std_logic;
      CLKFB    : in  std_logic;
      RST      : in  std_logic;
      DSSEN    : in  std_logic;
      PSCLK    : in  std_logic;
      PSEN     : in  std_logic;
      PSINCDEC : in  std_logic;
      CLKFX    : out std_logic;
      LOCKED   : out std_logic
    );
  end component DCM_SP;

  attribute box_type : string;
  attribute box_type of IBUFG  : component is "primitive";
  attribute box_type of BUFG   : component is "primitive";
  attribute box_type of IOBUF  : component is "primitive";
  attribute box_type of DCM_SP : component is "primitive";

  signal oscillator : std_logic;
  signal clk_fx     : std_logic;
  signal clk        : std_logic;
  signal locked     : std_logic;

  -- The value after configuration holds the system in reset: nothing else resets the reset.
  signal ready_r : std_logic_vector(3 downto 0) := (others => '0');
  signal rst     : std_logic;

  signal scl_in      : std_logic;
  signal sda_in      : std_logic;
  signal scl_low     : std_logic;
  signal sda_low     : std_logic;
  signal scl_release : std_logic;
  signal sda_release : std_logic;

begin

  clock_pad : IBUFG
    port map (
      I => clk_in,
      O => oscillator
    );

  -- 125.000000 MHz * 2 / 5 = 50.000000 MHz; the synthesiser alone needs no feedback.
  clock_manager : DCM_SP
    generic map (
      CLK_FEEDBACK   => "NONE",
      CLKFX_MULTIPLY => 2,
      CLKFX_DIVIDE   => 5,
      CLKIN_PERIOD   => 8.000
    )
    port map (
      CLKIN    => oscillator,
      CLKFB    => '0',
      RST      => '0',
      DSSEN    => '0',
      PSCLK    => '0',
      PSEN     => '0',
      PSINCDEC => '0',
      CLKFX    => clk_fx,
      LOCKED   => locked
    );

  clock_net : BUFG
    port map (
      I => clk_fx,
      O => clk
    );

  rst <= not ready_r(3);

  reset : process (clk)
  begin
    if rising_edge(clk) then
      ready_r <= ready_r(2 downto 0) & (locked and not reset_button);
    end if;
  end process reset;

  -- A line is pulled low or let go, never driven high.
  scl_release <= not scl_low;
  sda_release <= not sda_low;

  scl_pad : IOBUF
    port map (
      I  => '0',
      T  => scl_release,
      O  => scl_in,
      IO => scl
    );

  sda_pad : IOBUF
    port map (
      I  => '0',
      T  => sda_release,
      O  => sda_in,
      IO => sda
    );

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
