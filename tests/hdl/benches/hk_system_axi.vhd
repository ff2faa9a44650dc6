-- hk_system with an AXI4-Lite bus, on the bus of a simulated sensor.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

entity hk_system_axi is
  generic (
    COUNTS_FILE  : string;
    CLOCK_HZ     : positive;
    BAUD         : positive;
    TIME_DIVISOR : positive
  );
  port (
    clk           : in  std_logic;
    rst           : in  std_logic;
    uart_rx       : in  std_logic;
    uart_tx       : out std_logic;
    interrupt     : out std_logic;
    s_axi_awaddr  : in  std_logic_vector(7 downto 0);
    s_axi_awvalid : in  std_logic;
    s_axi_awready : out std_logic;
    s_axi_wdata   : in  std_logic_vector(31 downto 0);
    s_axi_wvalid  : in  std_logic;
    s_axi_wready  : out std_logic;
    s_axi_bresp   : out std_logic_vector(1 downto 0);
    s_axi_bvalid  : out std_logic;
    s_axi_araddr  : in  std_logic_vector(7 downto 0);
    s_axi_arvalid : in  std_logic;
    s_axi_arready : out std_logic;
    s_axi_rdata   : out std_logic_vector(31 downto 0);
    s_axi_rresp   : out std_logic_vector(1 downto 0);
    s_axi_rvalid  : out std_logic
  );
end entity hk_system_axi;

architecture bench of hk_system_axi is

  signal scl     : std_logic;
  signal sda     : std_logic;
  signal scl_in  : std_logic;
  signal sda_in  : std_logic;
  signal scl_low : std_logic;
  signal sda_low : std_logic;
  signal int_pin : std_logic;

begin

  scl    <= 'H';
  sda    <= 'H';
  scl    <= '0' when scl_low = '1' else 'Z';
  sda    <= '0' when sda_low = '1' else 'Z';
  scl_in <= to_x01(scl);
  sda_in <= to_x01(sda);

  system : entity work.hk_system
    generic map (
      CLOCK_HZ     => CLOCK_HZ,
      BAUD         => BAUD,
      TIME_DIVISOR => TIME_DIVISOR
    )
    port map (
      clk           => clk,
      rst           => rst,
      scl_in        => scl_in,
      sda_in        => sda_in,
      scl_low       => scl_low,
      sda_low       => sda_low,
      int_pin       => int_pin,
      uart_rx       => uart_rx,
      uart_tx       => uart_tx,
      s_axi_awaddr  => s_axi_awaddr,
      s_axi_awvalid => s_axi_awvalid,
      s_axi_awready => s_axi_awready,
      s_axi_wdata   => s_axi_wdata,
      s_axi_wstrb   => "1111",
      s_axi_wvalid  => s_axi_wvalid,
      s_axi_wready  => s_axi_wready,
      s_axi_bresp   => s_axi_bresp,
      s_axi_bvalid  => s_axi_bvalid,
      s_axi_bready  => '1',
      s_axi_araddr  => s_axi_araddr,
      s_axi_arvalid => s_axi_arvalid,
      s_axi_arready => s_axi_arready,
      s_axi_rdata   => s_axi_rdata,
      s_axi_rresp   => s_axi_rresp,
      s_axi_rvalid  => s_axi_rvalid,
      s_axi_rready  => '1',
      interrupt     => interrupt,
      running       => open,
      failed        => open
    );

  sensor : entity work.hk_mpu6050_model
    generic map (
      COUNTS_FILE  => COUNTS_FILE,
      TIME_DIVISOR => TIME_DIVISOR
    )
    port map (
      scl     => scl,
      sda     => sda,
      int_pin => int_pin,
      rows    => open
    );

end architecture bench;
