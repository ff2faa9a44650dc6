-- made by hostkit 0.1.0 from design f27a2d565bf0; do not edit; template registers/hk_regs_pkg.vhd.j2
-- Registers of the system: word addresses, and what goes between decoder and core.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.hk_observer_pkg.all;

package hk_regs_pkg is

  subtype hk_regs_word_t is unsigned(5 downto 0);  -- address without its low two bits

  constant identity_word_c : hk_regs_word_t := to_unsigned(0, 6);
  constant version_word_c : hk_regs_word_t := to_unsigned(1, 6);
  constant digest_high_word_c : hk_regs_word_t := to_unsigned(2, 6);
  constant digest_low_word_c : hk_regs_word_t := to_unsigned(3, 6);
  constant features_word_c : hk_regs_word_t := to_unsigned(4, 6);
  constant sensor_word_c : hk_regs_word_t := to_unsigned(5, 6);
  constant rate_word_c : hk_regs_word_t := to_unsigned(6, 6);
  constant formats_word_c : hk_regs_word_t := to_unsigned(7, 6);
  constant scales_word_c : hk_regs_word_t := to_unsigned(8, 6);
  constant control_word_c : hk_regs_word_t := to_unsigned(9, 6);
  constant status_word_c : hk_regs_word_t := to_unsigned(10, 6);
  constant events_word_c : hk_regs_word_t := to_unsigned(11, 6);
  constant interrupts_word_c : hk_regs_word_t := to_unsigned(12, 6);
  constant uart_rx_word_c : hk_regs_word_t := to_unsigned(13, 6);
  constant kt_word_c : hk_regs_word_t := to_unsigned(16, 6);
  constant kv_word_c : hk_regs_word_t := to_unsigned(17, 6);
  constant kb_word_c : hk_regs_word_t := to_unsigned(18, 6);
  constant gyro_bias_x_word_c : hk_regs_word_t := to_unsigned(19, 6);
  constant gyro_bias_y_word_c : hk_regs_word_t := to_unsigned(20, 6);
  constant gyro_bias_z_word_c : hk_regs_word_t := to_unsigned(21, 6);
  constant sample_number_word_c : hk_regs_word_t := to_unsigned(32, 6);
  constant time_low_word_c : hk_regs_word_t := to_unsigned(33, 6);
  constant time_high_word_c : hk_regs_word_t := to_unsigned(34, 6);
  constant angle_roll_word_c : hk_regs_word_t := to_unsigned(35, 6);
  constant angle_pitch_word_c : hk_regs_word_t := to_unsigned(36, 6);
  constant accel_xy_word_c : hk_regs_word_t := to_unsigned(39, 6);
  constant accel_z_temperature_word_c : hk_regs_word_t := to_unsigned(40, 6);
  constant gyro_xy_word_c : hk_regs_word_t := to_unsigned(41, 6);
  constant gyro_z_word_c : hk_regs_word_t := to_unsigned(42, 6);
  constant bus_counts_word_c : hk_regs_word_t := to_unsigned(48, 6);
  constant stuck_counts_word_c : hk_regs_word_t := to_unsigned(49, 6);
  constant loss_counts_word_c : hk_regs_word_t := to_unsigned(50, 6);
  constant link_counts_word_c : hk_regs_word_t := to_unsigned(51, 6);

  -- Values as they are; of the events, one clock of 1 each time.
  type hk_regs_in_t is record
    running : std_logic;
    failed : std_logic;
    core_busy : std_logic;
    identity : std_logic_vector(7 downto 0);
    new_sample : std_logic;
    restarted : std_logic;
    saturated : std_logic;
    overrun : std_logic;
    bus_error : std_logic;
    uart_overrun : std_logic;
    uart_framing : std_logic;
    uart_data : std_logic_vector(7 downto 0);
    uart_valid : std_logic;
    sequence : unsigned(31 downto 0);
    time_us : unsigned(63 downto 0);
    angle_roll : signed(31 downto 0);
    angle_pitch : signed(31 downto 0);
    accel_x : signed(15 downto 0);
    accel_y : signed(15 downto 0);
    accel_z : signed(15 downto 0);
    temperature : signed(15 downto 0);
    gyro_x : signed(15 downto 0);
    gyro_y : signed(15 downto 0);
    gyro_z : signed(15 downto 0);
    errors : unsigned(15 downto 0);
    nacks : unsigned(15 downto 0);
    timeouts : unsigned(15 downto 0);
    stuck_buses : unsigned(15 downto 0);
    restarts : unsigned(15 downto 0);
    lost_samples : unsigned(15 downto 0);
    link_lost : unsigned(15 downto 0);
  end record;

  type hk_regs_out_t is record
    settings  : hk_settings_t;  -- change together, on an edge where core_busy was 0
    enable    : std_logic;      -- samples are taken
    clear     : std_logic;      -- for one clock: restart the filter
    retuned   : std_logic;      -- the settings are not the design's
    uart_read : std_logic;      -- for one clock: the received byte is taken
    interrupt : std_logic;      -- while an event is set that may interrupt
  end record;

end package hk_regs_pkg;
