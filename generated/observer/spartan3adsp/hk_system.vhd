-- made by hostkit 0.1.0 from design f27a2d565bf0; do not edit; template system/hk_system.vhd.j2
-- The whole without its board: sensor, filter, telemetry, heartbeat.
--
-- A sample is kept here, and its angles in the filter, until the frame that tells of both has been
-- handed over; the next one waits in the sensor's core meanwhile. One that finds it full as well is
-- lost and counted, and seen as a gap of the sequence.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.hk_common_pkg.all;
use work.hk_observer_pkg.all;
use work.hk_system_pkg.all;

entity hk_system is
  generic (
    CLOCK_HZ     : positive := clock_hz_c;
    BAUD         : positive := baud_c;
    BUS_HZ       : positive := 400000;  -- of the sensor
    TIME_DIVISOR : positive := 1        -- shortens the waits of sensor and heartbeat in simulation
  );
  port (
    clk     : in  std_logic;
    rst     : in  std_logic;  -- synchronous, active high
    scl_in  : in  std_logic;  -- the lines as they are
    sda_in  : in  std_logic;
    scl_low : out std_logic;  -- 1 pulls the line low, 0 lets it go
    sda_low : out std_logic;
    int_pin : in  std_logic;  -- data ready, active high, asynchronous
    uart_rx : in  std_logic := '1';  -- asynchronous; unused without a bus
    uart_tx : out std_logic;
    running : out std_logic;  -- the sensor is configured and sampling
    failed  : out std_logic   -- no sensor, or one that is refused
  );
end entity hk_system;

architecture rtl of hk_system is

  -- States of MAVLink's heartbeat.
  constant boot_c     : unsigned(7 downto 0) := to_unsigned(1, 8);
  constant active_c   : unsigned(7 downto 0) := to_unsigned(4, 8);
  constant critical_c : unsigned(7 downto 0) := to_unsigned(5, 8);

  -- The heartbeat counts changes of the bit of the time that changes every 64 us: 15625 a second.
  constant beat_bit_c : natural  := 6;
  constant beats_c    : positive := 15625 / TIME_DIVISOR;

  signal time_us : unsigned(63 downto 0);

  signal sensor_valid       : std_logic;
  signal sensor_time_us     : unsigned(63 downto 0);
  signal sensor_sequence    : unsigned(31 downto 0);
  signal sensor_accel_x     : signed(15 downto 0);
  signal sensor_accel_y     : signed(15 downto 0);
  signal sensor_accel_z     : signed(15 downto 0);
  signal sensor_temperature : signed(15 downto 0);
  signal sensor_gyro_x      : signed(15 downto 0);
  signal sensor_gyro_y      : signed(15 downto 0);
  signal sensor_gyro_z      : signed(15 downto 0);
  signal free               : std_logic;  -- no sample is kept

  signal identity        : std_logic_vector(7 downto 0);
  signal sensor_running  : std_logic;
  signal sensor_failed   : std_logic;
  signal errors          : unsigned(15 downto 0);
  signal nacks           : unsigned(15 downto 0);
  signal timeouts        : unsigned(15 downto 0);
  signal stuck_buses     : unsigned(15 downto 0);
  signal restarts        : unsigned(15 downto 0);
  signal lost_samples    : unsigned(15 downto 0);

  signal settings         : hk_settings_t;
  signal filter_rst       : std_logic;
  signal filter_busy      : std_logic;
  signal filter_in_valid  : std_logic;
  signal filter_in_ready  : std_logic;
  signal filter_out_valid : std_logic;
  signal filter_out_ready : std_logic;
  signal in_channel       : unsigned(0 downto 0);
  signal angle_roll       : signed(31 downto 0);
  signal angle_pitch      : signed(31 downto 0);
  signal state_index      : unsigned(4 downto 0);
  signal state_word       : signed(31 downto 0);
  signal restarted        : std_logic;
  signal saturated        : std_logic;

  signal sampling   : std_logic;
  signal sampling_r : std_logic;
  signal kept_r     : std_logic;  -- a sample is kept
  signal filtered_r : std_logic;  -- the filter has it
  signal restart_r  : std_logic;  -- the filter is to begin anew before the next sample

  -- The sample that is kept.
  signal sample_time_us_r  : unsigned(63 downto 0);
  signal sample_sequence_r : unsigned(31 downto 0);
  signal accel_x_r         : signed(15 downto 0);
  signal accel_y_r         : signed(15 downto 0);
  signal accel_z_r         : signed(15 downto 0);
  signal temperature_r     : signed(15 downto 0);
  signal gyro_x_r          : signed(15 downto 0);
  signal gyro_y_r          : signed(15 downto 0);
  signal gyro_z_r          : signed(15 downto 0);
  signal errors_then_r     : unsigned(15 downto 0);

  signal frame_ready     : std_logic;
  signal heartbeat_ready : std_logic;
  signal heartbeat_due_r : std_logic;
  signal state_ready     : std_logic;
  signal state_due_r     : std_logic;  -- the state of the next sample is to be told
  signal status_r        : unsigned(7 downto 0);
  signal beat_r          : std_logic;
  signal beats_r         : unsigned(hk_index_bits(beats_c) - 1 downto 0);  -- since the last one
  signal byte_valid      : std_logic;
  signal byte_ready      : std_logic;
  signal byte_data       : std_logic_vector(7 downto 0);

  signal enable  : std_logic;
  signal clear   : std_logic;
  signal retuned : std_logic;

begin

  running <= sensor_running;
  failed  <= sensor_failed;

  stopwatch : entity work.hk_stopwatch
    generic map (
      CLOCK_HZ => CLOCK_HZ
    )
    port map (
      clk     => clk,
      rst     => rst,
      time_us => time_us
    );

  sensor : entity work.hk_mpu6050
    generic map (
      CLOCK_HZ     => CLOCK_HZ,
      BUS_HZ       => BUS_HZ,
      TIME_DIVISOR => TIME_DIVISOR
    )
    port map (
      clk          => clk,
      rst          => rst,
      time_us      => time_us,
      int_pin      => int_pin,
      scl_in       => scl_in,
      sda_in       => sda_in,
      scl_low      => scl_low,
      sda_low      => sda_low,
      out_valid    => sensor_valid,
      out_ready    => free,
      out_time_us  => sensor_time_us,
      out_sequence => sensor_sequence,
      accel_x      => sensor_accel_x,
      accel_y      => sensor_accel_y,
      accel_z      => sensor_accel_z,
      temperature  => sensor_temperature,
      gyro_x       => sensor_gyro_x,
      gyro_y       => sensor_gyro_y,
      gyro_z       => sensor_gyro_z,
      identity     => identity,
      running      => sensor_running,
      failed       => sensor_failed,
      errors       => errors,
      nacks        => nacks,
      timeouts     => timeouts,
      stuck_buses  => stuck_buses,
      restarts     => restarts,
      lost_samples => lost_samples
    );

  in_channel       <= (others => '0');
  sampling         <= sensor_running and enable;
  free             <= not kept_r;
  filter_in_valid  <= kept_r and not filtered_r and not restart_r;
  filter_out_ready <= frame_ready;
  filter_rst       <= rst or (restart_r and not filtered_r);

  filter : entity work.hk_observer
    generic map (
      CHANNELS => 1
    )
    port map (
      clk           => clk,
      rst           => filter_rst,
      settings      => settings,
      busy          => filter_busy,
      in_valid      => filter_in_valid,
      in_ready      => filter_in_ready,
      in_channel    => in_channel,
      accel_x       => accel_x_r,
      accel_y       => accel_y_r,
      accel_z       => accel_z_r,
      gyro_x        => gyro_x_r,
      gyro_y        => gyro_y_r,
      gyro_z        => gyro_z_r,
      out_valid     => filter_out_valid,
      out_ready     => filter_out_ready,
      out_channel   => open,
      angle_roll    => angle_roll,
      angle_pitch   => angle_pitch,
      state_index   => state_index,
      state_word    => state_word,
      restarted     => restarted,
      saturated     => saturated,
      design_digest => open
    );

  keep : process (clk)
  begin
    if rising_edge(clk) then
      if kept_r = '0' and sensor_valid = '1' then
        sample_time_us_r  <= sensor_time_us;
        sample_sequence_r <= sensor_sequence;
        accel_x_r         <= sensor_accel_x;
        accel_y_r         <= sensor_accel_y;
        accel_z_r         <= sensor_accel_z;
        temperature_r     <= sensor_temperature;
        gyro_x_r          <= sensor_gyro_x;
        gyro_y_r          <= sensor_gyro_y;
        gyro_z_r          <= sensor_gyro_z;
        errors_then_r     <= errors;
        kept_r            <= enable;
      end if;
      if filter_in_valid = '1' and filter_in_ready = '1' then
        filtered_r <= '1';
      end if;
      if filter_out_valid = '1' and frame_ready = '1' then
        kept_r     <= '0';
        filtered_r <= '0';
      end if;

      -- What comes after a restart of the sensor does not go on from what was before.
      sampling_r <= sampling;
      if filtered_r = '0' then
        restart_r <= '0';
      end if;
      if clear = '1' or (sampling = '1' and sampling_r = '0') then
        restart_r <= '1';
      end if;

      if rst = '1' then
        accel_x_r  <= (others => '0');
        accel_y_r  <= (others => '0');
        accel_z_r  <= (others => '0');
        gyro_x_r   <= (others => '0');
        gyro_y_r   <= (others => '0');
        gyro_z_r   <= (others => '0');
        sampling_r <= '0';
        kept_r     <= '0';
        filtered_r <= '0';
        restart_r  <= '0';
      end if;
    end if;
  end process keep;

  heartbeat : process (clk)
    variable status_v : unsigned(7 downto 0);
  begin
    if rising_edge(clk) then
      beat_r <= time_us(beat_bit_c);
      if heartbeat_ready = '1' then
        heartbeat_due_r <= '0';
      end if;
      if state_ready = '1' then
        state_due_r <= '0';
      end if;
      if beat_r /= time_us(beat_bit_c) then
        beats_r <= beats_r + 1;
        if beats_r = beats_c - 1 then
          beats_r         <= (others => '0');
          heartbeat_due_r <= '1';
        end if;
        -- Half a second away from the heartbeat, so that no sample waits for both.
        if beats_r = beats_c / 2 then
          state_due_r <= '1';
        end if;
      end if;

      -- The state holds until it has been told, and a change is told at once.
      status_v := status_r;
      if sensor_failed = '1' then
        status_v := critical_c;
      elsif sensor_running = '0' then
        if status_r = active_c then
          status_v := critical_c;  -- until samples come again
        end if;
      elsif sensor_valid = '1' then
        status_v := active_c;
      end if;
      if heartbeat_due_r = '0' and status_v /= status_r then
        status_r        <= status_v;
        heartbeat_due_r <= '1';
      end if;

      if rst = '1' then
        status_r        <= boot_c;
        heartbeat_due_r <= '1';
        state_due_r     <= '0';
        beats_r         <= (others => '0');
        beat_r          <= '0';
      end if;
    end if;
  end process heartbeat;

  frames : entity work.hk_mavlink_tx
    port map (
      clk             => clk,
      rst             => rst,
      sample_valid    => filter_out_valid,
      sample_ready    => frame_ready,
      time_us         => sample_time_us_r,
      sequence        => sample_sequence_r,
      angle_roll      => angle_roll,
      angle_pitch     => angle_pitch,
      accel_x         => accel_x_r,
      accel_y         => accel_y_r,
      accel_z         => accel_z_r,
      temperature     => temperature_r,
      gyro_x          => gyro_x_r,
      gyro_y          => gyro_y_r,
      gyro_z          => gyro_z_r,
      i2c_errors      => errors_then_r,
      restarted       => restarted,
      saturated       => saturated,
      retuned         => retuned,
      state_valid     => state_due_r,
      state_ready     => state_ready,
      state_index     => state_index,
      state_word      => state_word,
      heartbeat_valid => heartbeat_due_r,
      heartbeat_ready => heartbeat_ready,
      system_status   => status_r,
      byte_valid      => byte_valid,
      byte_ready      => byte_ready,
      byte_data       => byte_data
    );

  transmitter : entity work.hk_uart_tx
    generic map (
      CLOCK_HZ => CLOCK_HZ,
      BAUD     => BAUD
    )
    port map (
      clk      => clk,
      rst      => rst,
      in_valid => byte_valid,
      in_ready => byte_ready,
      in_data  => byte_data,
      tx       => uart_tx
    );

  -- One by one, because GHDL 2.0 converts a constant of more than 32 bits wrongly.
  settings.kt                <= design_settings_c.kt;
  settings.kv                <= design_settings_c.kv;
  settings.kb                <= design_settings_c.kb;
  settings.gyro_bias_x       <= design_settings_c.gyro_bias_x;
  settings.gyro_bias_y       <= design_settings_c.gyro_bias_y;
  settings.gyro_bias_z       <= design_settings_c.gyro_bias_z;
  enable   <= '1';
  clear    <= '0';
  retuned  <= '0';

end architecture rtl;
