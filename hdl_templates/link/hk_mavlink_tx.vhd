-- MAVLink 2 frames of samples and heartbeats, byte by byte. A frame is made of the inputs as they
-- stand, so they must hold until ready says that they are sent.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.hk_design_pkg.all;
use work.hk_mavlink_pkg.all;

entity hk_mavlink_tx is
  port (
    clk             : in  std_logic;
    rst             : in  std_logic;  -- synchronous, active high
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
    system_status   : in  unsigned(7 downto 0);  -- MAV_STATE
    byte_valid      : out std_logic;
    byte_ready      : in  std_logic;
    byte_data       : out std_logic_vector(7 downto 0)
  );
end entity hk_mavlink_tx;

architecture rtl of hk_mavlink_tx is

  -- Addresses of the bytes of a frame: its payload from 0, the rest at the end.
  constant header_c   : natural := 51;
  constant length_c   : natural := header_c + 1;
  constant sequence_c : natural := header_c + 4;
  constant id_c       : natural := header_c + 7;
  constant extra_c    : natural := 61;  -- only in the checksum; its two bytes have 62 and 63

  constant sample_last_c    : unsigned(5 downto 0) := to_unsigned(sample_bytes_c - 1, 6);
  constant heartbeat_last_c : unsigned(5 downto 0) := to_unsigned(heartbeat_bytes_c - 1, 6);

  type bytes_t is array (0 to 63) of hk_byte_t;

  procedure place (
    bytes : inout bytes_t;
    at    : in    natural;
    value : in    std_logic_vector
  ) is
    alias value_a : std_logic_vector(value'length - 1 downto 0) is value;
  begin
    for i in 0 to value'length / 8 - 1 loop
      bytes(at + i) := value_a(8 * i + 7 downto 8 * i);
    end loop;
  end procedure place;

begin

end architecture rtl;
