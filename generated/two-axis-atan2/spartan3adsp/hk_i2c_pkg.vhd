-- Commands of hk_i2c_master.
library ieee;
use ieee.std_logic_1164.all;

package hk_i2c_pkg is

  subtype hk_i2c_command_t is std_logic_vector(2 downto 0);

  constant i2c_start_c   : hk_i2c_command_t := "000";  -- start, or repeated start
  constant i2c_stop_c    : hk_i2c_command_t := "001";
  constant i2c_write_c   : hk_i2c_command_t := "010";
  constant i2c_recover_c : hk_i2c_command_t := "011";  -- stop, up to nine times, until SDA is high
  constant i2c_read_c    : hk_i2c_command_t := "100";  -- and acknowledge: more bytes follow
  constant i2c_last_c    : hk_i2c_command_t := "101";  -- read and do not acknowledge

end package hk_i2c_pkg;
