-- The registers behind one of their front ends, every element of their records as a port of its own.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.hk_regs_pkg.all;

entity hk_regs_bench is
  generic (
    WISHBONE : boolean := false
  );
  port (
    clk : in std_logic;
    rst : in std_logic;
    s_axi_awaddr : in std_logic_vector(7 downto 0) := (others => '0');
    s_axi_awprot : in std_logic_vector(2 downto 0) := (others => '0');
    s_axi_awvalid : in std_logic := '0';
    s_axi_awready : out std_logic;
    s_axi_wdata : in std_logic_vector(31 downto 0) := (others => '0');
    s_axi_wstrb : in std_logic_vector(3 downto 0) := (others => '0');
    s_axi_wvalid : in std_logic := '0';
    s_axi_wready : out std_logic;
    s_axi_bresp : out std_logic_vector(1 downto 0);
    s_axi_bvalid : out std_logic;
    s_axi_bready : in std_logic := '0';
    s_axi_araddr : in std_logic_vector(7 downto 0) := (others => '0');
    s_axi_arprot : in std_logic_vector(2 downto 0) := (others => '0');
    s_axi_arvalid : in std_logic := '0';
    s_axi_arready : out std_logic;
    s_axi_rdata : out std_logic_vector(31 downto 0);
    s_axi_rresp : out std_logic_vector(1 downto 0);
    s_axi_rvalid : out std_logic;
    s_axi_rready : in std_logic := '0';
    wb_cyc : in std_logic := '0';
    wb_stb : in std_logic := '0';
    wb_we : in std_logic := '0';
    wb_adr : in std_logic_vector(7 downto 0) := (others => '0');
    wb_sel : in std_logic_vector(3 downto 0) := (others => '0');
    wb_dat_w : in std_logic_vector(31 downto 0) := (others => '0');
    wb_dat_r : out std_logic_vector(31 downto 0);
    wb_ack : out std_logic;
    wb_err : out std_logic;
    write_request : out std_logic;
    read_request : out std_logic;
    running : in std_logic;
    failed : in std_logic;
    core_busy : in std_logic;
    identity : in std_logic_vector(7 downto 0);
    new_sample : in std_logic;
    restarted : in std_logic;
    saturated : in std_logic;
    overrun : in std_logic;
    bus_error : in std_logic;
    uart_overrun : in std_logic;
    uart_framing : in std_logic;
    uart_data : in std_logic_vector(7 downto 0);
    uart_valid : in std_logic;
    sample_sequence : in unsigned(31 downto 0);
    time_us : in unsigned(63 downto 0);
    angle_roll : in signed(31 downto 0);
    angle_pitch : in signed(31 downto 0);
    bias_roll : in signed(31 downto 0);
    bias_pitch : in signed(31 downto 0);
    accel_x : in signed(15 downto 0);
    accel_y : in signed(15 downto 0);
    accel_z : in signed(15 downto 0);
    temperature : in signed(15 downto 0);
    gyro_x : in signed(15 downto 0);
    gyro_y : in signed(15 downto 0);
    gyro_z : in signed(15 downto 0);
    errors : in unsigned(15 downto 0);
    nacks : in unsigned(15 downto 0);
    timeouts : in unsigned(15 downto 0);
    stuck_buses : in unsigned(15 downto 0);
    restarts : in unsigned(15 downto 0);
    lost_samples : in unsigned(15 downto 0);
    link_lost : in unsigned(15 downto 0);
    enable : out std_logic;
    clear : out std_logic;
    retuned : out std_logic;
    uart_read : out std_logic;
    interrupt : out std_logic;
    settings_blend : out signed(17 downto 0);
    settings_rate_gain_roll : out signed(17 downto 0);
    settings_rate_gain_pitch : out signed(17 downto 0);
    settings_integral_gain : out signed(17 downto 0);
    settings_tilt_offset_roll : out signed(31 downto 0);
    settings_tilt_offset_pitch : out signed(31 downto 0);
    settings_gyro_bias_roll : out signed(31 downto 0);
    settings_gyro_bias_pitch : out signed(31 downto 0);
    settings_gate_lowest : out unsigned(31 downto 0);
    settings_gate_highest : out unsigned(31 downto 0)
  );
end entity hk_regs_bench;

architecture sim of hk_regs_bench is

  signal from_core     : hk_regs_in_t;
  signal to_core       : hk_regs_out_t;
  signal address       : unsigned(7 downto 0);
  signal write         : std_logic;
  signal read          : std_logic;
  signal write_data    : std_logic_vector(31 downto 0);
  signal write_strobes : std_logic_vector(3 downto 0);
  signal read_data     : std_logic_vector(31 downto 0);
  signal acknowledge   : std_logic;
  signal error         : std_logic;

begin

  from_core.running <= running;
  from_core.failed <= failed;
  from_core.core_busy <= core_busy;
  from_core.identity <= identity;
  from_core.new_sample <= new_sample;
  from_core.restarted <= restarted;
  from_core.saturated <= saturated;
  from_core.overrun <= overrun;
  from_core.bus_error <= bus_error;
  from_core.uart_overrun <= uart_overrun;
  from_core.uart_framing <= uart_framing;
  from_core.uart_data <= uart_data;
  from_core.uart_valid <= uart_valid;
  from_core.sequence <= sample_sequence;
  from_core.time_us <= time_us;
  from_core.angle_roll <= angle_roll;
  from_core.angle_pitch <= angle_pitch;
  from_core.bias_roll <= bias_roll;
  from_core.bias_pitch <= bias_pitch;
  from_core.accel_x <= accel_x;
  from_core.accel_y <= accel_y;
  from_core.accel_z <= accel_z;
  from_core.temperature <= temperature;
  from_core.gyro_x <= gyro_x;
  from_core.gyro_y <= gyro_y;
  from_core.gyro_z <= gyro_z;
  from_core.errors <= errors;
  from_core.nacks <= nacks;
  from_core.timeouts <= timeouts;
  from_core.stuck_buses <= stuck_buses;
  from_core.restarts <= restarts;
  from_core.lost_samples <= lost_samples;
  from_core.link_lost <= link_lost;
  settings_blend <= to_core.settings.blend;
  settings_rate_gain_roll <= to_core.settings.rate_gain_roll;
  settings_rate_gain_pitch <= to_core.settings.rate_gain_pitch;
  settings_integral_gain <= to_core.settings.integral_gain;
  settings_tilt_offset_roll <= to_core.settings.tilt_offset_roll;
  settings_tilt_offset_pitch <= to_core.settings.tilt_offset_pitch;
  settings_gyro_bias_roll <= to_core.settings.gyro_bias_roll;
  settings_gyro_bias_pitch <= to_core.settings.gyro_bias_pitch;
  settings_gate_lowest <= to_core.settings.gate_lowest;
  settings_gate_highest <= to_core.settings.gate_highest;
  enable <= to_core.enable;
  clear <= to_core.clear;
  retuned <= to_core.retuned;
  uart_read <= to_core.uart_read;
  interrupt <= to_core.interrupt;
  write_request <= write;
  read_request  <= read;

  registers : entity work.hk_regs
    port map (
      clk           => clk,
      rst           => rst,
      address       => address,
      write         => write,
      read          => read,
      write_data    => write_data,
      write_strobes => write_strobes,
      read_data     => read_data,
      acknowledge   => acknowledge,
      error         => error,
      from_core     => from_core,
      to_core       => to_core
    );

  with_axi : if not WISHBONE generate
    front : entity work.hk_axi4lite
      port map (
        clk           => clk,
        rst           => rst,
        s_axi_awaddr => s_axi_awaddr,
        s_axi_awprot => s_axi_awprot,
        s_axi_awvalid => s_axi_awvalid,
        s_axi_awready => s_axi_awready,
        s_axi_wdata => s_axi_wdata,
        s_axi_wstrb => s_axi_wstrb,
        s_axi_wvalid => s_axi_wvalid,
        s_axi_wready => s_axi_wready,
        s_axi_bresp => s_axi_bresp,
        s_axi_bvalid => s_axi_bvalid,
        s_axi_bready => s_axi_bready,
        s_axi_araddr => s_axi_araddr,
        s_axi_arprot => s_axi_arprot,
        s_axi_arvalid => s_axi_arvalid,
        s_axi_arready => s_axi_arready,
        s_axi_rdata => s_axi_rdata,
        s_axi_rresp => s_axi_rresp,
        s_axi_rvalid => s_axi_rvalid,
        s_axi_rready => s_axi_rready,
        address       => address,
        write         => write,
        read          => read,
        write_data    => write_data,
        write_strobes => write_strobes,
        read_data     => read_data,
        acknowledge   => acknowledge,
        error         => error
      );
  end generate with_axi;

  with_wishbone : if WISHBONE generate
    front : entity work.hk_wishbone
      port map (
        clk           => clk,
        rst           => rst,
        wb_cyc => wb_cyc,
        wb_stb => wb_stb,
        wb_we => wb_we,
        wb_adr => wb_adr,
        wb_sel => wb_sel,
        wb_dat_w => wb_dat_w,
        wb_dat_r => wb_dat_r,
        wb_ack => wb_ack,
        wb_err => wb_err,
        address       => address,
        write         => write,
        read          => read,
        write_data    => write_data,
        write_strobes => write_strobes,
        read_data     => read_data,
        acknowledge   => acknowledge,
        error         => error
      );
  end generate with_wishbone;

end architecture sim;
