-- made by hostkit 0.1.0 from design 0099cab74159; do not edit; template link/hk_mavlink_pkg.vhd.j2
-- The MAVLink messages that hk_mavlink_tx sends: layouts of the payloads, identities, sender.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

package hk_mavlink_pkg is

  subtype hk_byte_t is std_logic_vector(7 downto 0);

  constant magic_c : hk_byte_t := x"FD";

  -- The sender.
  constant system_id_c       : hk_byte_t := x"01";
  constant component_id_c    : hk_byte_t := x"01";
  constant vehicle_type_c    : hk_byte_t := x"00";
  constant autopilot_c       : hk_byte_t := x"00";
  constant mavlink_version_c : hk_byte_t := x"03";

  -- TILT_SAMPLE: bytes that can be other than zero, identity, first byte of each field.
  constant sample_bytes_c     : positive := 51;
  constant sample_id_0_c      : hk_byte_t := x"52";
  constant sample_id_1_c      : hk_byte_t := x"CB";
  constant sample_id_2_c      : hk_byte_t := x"00";
  constant sample_crc_extra_c : hk_byte_t := x"89";
  constant sample_time_usec_at_c : natural := 0;
  constant sample_sequence_at_c : natural := 8;
  constant sample_roll_at_c : natural := 12;
  constant sample_pitch_at_c : natural := 16;
  constant sample_accel_at_c : natural := 20;
  constant sample_gyro_at_c : natural := 26;
  constant sample_temperature_at_c : natural := 32;
  constant sample_i2c_errors_at_c : natural := 34;
  constant sample_digest_at_c : natural := 36;
  constant sample_flags_at_c : natural := 42;
  constant sample_hidden_at_c : natural := 43;

  -- HEARTBEAT: bytes that can be other than zero, identity, first byte of each field.
  constant heartbeat_bytes_c     : positive := 9;
  constant heartbeat_id_0_c      : hk_byte_t := x"00";
  constant heartbeat_id_1_c      : hk_byte_t := x"00";
  constant heartbeat_id_2_c      : hk_byte_t := x"00";
  constant heartbeat_crc_extra_c : hk_byte_t := x"32";
  constant heartbeat_custom_mode_at_c : natural := 0;
  constant heartbeat_type_at_c : natural := 4;
  constant heartbeat_autopilot_at_c : natural := 5;
  constant heartbeat_base_mode_at_c : natural := 6;
  constant heartbeat_system_status_at_c : natural := 7;
  constant heartbeat_mavlink_version_at_c : natural := 8;

  -- Bits of the flags.
  constant flag_restarted_c : natural range 0 to 7 := 0;
  constant flag_saturated_c : natural range 0 to 7 := 1;
  constant flag_retuned_c : natural range 0 to 7 := 2;

  -- Enough to number the bytes of the longest frame.
  constant place_bits_c : positive := 6;

end package hk_mavlink_pkg;
