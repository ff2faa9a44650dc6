-- The sender of frames, its transmitter, and a receiver at the other end of the line.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

entity link_loop is
  generic (
    CLOCK_HZ : positive;
    BAUD     : positive
  );
  port (
    clk             : in  std_logic;
    rst             : in  std_logic;
    sample_valid    : in  std_logic;
    sample_ready    : out std_logic;
    time_us         : in  unsigned(63 downto 0);
    sequence        : in  unsigned(31 downto 0);
    angle_roll      : in  signed(31 downto 0);
    angle_pitch     : in  signed(31 downto 0);
    bias_roll       : in  signed(31 downto 0);
    bias_pitch      : in  signed(31 downto 0);
    accel_x         : in  signed(15 downto 0);
    accel_y         : in  signed(15 downto 0);
    accel_z         : in  signed(15 downto 0);
    temperature     : in  signed(15 downto 0);
    gyro_x          : in  signed(15 downto 0);
    gyro_y          : in  signed(15 downto 0);
    gyro_z          : in  signed(15 downto 0);
    i2c_errors      : in  unsigned(15 downto 0);
    restarted       : in  std_logic;
    saturated       : in  std_logic;
    retuned         : in  std_logic;
    heartbeat_valid : in  std_logic;
    heartbeat_ready : out std_logic;
    system_status   : in  unsigned(7 downto 0);
    out_valid       : out std_logic;
    out_data        : out std_logic_vector(7 downto 0);
    framing_error   : out std_logic
  );
end entity link_loop;

architecture bench of link_loop is

  signal byte_valid : std_logic;
  signal byte_ready : std_logic;
  signal byte_data  : std_logic_vector(7 downto 0);
  signal line       : std_logic;

begin

  sender : entity work.hk_mavlink_tx
    port map (
      clk => clk, rst => rst, sample_valid => sample_valid, sample_ready => sample_ready,
      time_us => time_us, sequence => sequence, angle_roll => angle_roll,
      angle_pitch => angle_pitch, bias_roll => bias_roll, bias_pitch => bias_pitch,
      accel_x => accel_x, accel_y => accel_y, accel_z => accel_z, temperature => temperature,
      gyro_x => gyro_x, gyro_y => gyro_y, gyro_z => gyro_z, i2c_errors => i2c_errors,
      restarted => restarted, saturated => saturated, retuned => retuned,
      heartbeat_valid => heartbeat_valid, heartbeat_ready => heartbeat_ready,
      system_status => system_status, byte_valid => byte_valid, byte_ready => byte_ready,
      byte_data => byte_data
    );

  transmitter : entity work.hk_uart_tx
    generic map (CLOCK_HZ => CLOCK_HZ, BAUD => BAUD)
    port map (
      clk => clk, rst => rst, in_valid => byte_valid, in_ready => byte_ready,
      in_data => byte_data, tx => line
    );

  receiver : entity work.hk_uart_rx
    generic map (CLOCK_HZ => CLOCK_HZ, BAUD => BAUD)
    port map (
      clk => clk, rst => rst, rx => line, out_valid => out_valid, out_ready => '1',
      out_data => out_data, framing_error => framing_error, overrun => open
    );

end architecture bench;
