-- made by hostkit 0.1.0 from design f27a2d565bf0; do not edit; template sensor/hk_mpu6050_pkg.vhd.j2
-- The MPU-6050 as this design uses it: parts that are taken, and what is done to them.
library ieee;
use ieee.std_logic_1164.all;

package hk_mpu6050_pkg is

  constant sensor_address_c : std_logic_vector(6 downto 0) := "1101000";
  constant period_us_c      : positive := 10000;
  constant settle_samples_c : positive := 2;  -- dropped
  constant frozen_samples_c : positive := 50;  -- equal: frozen

  -- What a step does with its register and its value.
  subtype hk_operation_t is std_logic_vector(2 downto 0);
  constant identify_c : hk_operation_t := "000";  -- read the identity
  constant write_c    : hk_operation_t := "001";  -- while the sensor runs: read back
  constant wait_c     : hk_operation_t := "010";  -- so many units, or less by a part of one
  constant poll_c     : hk_operation_t := "011";  -- read until it has the value
  constant set_c      : hk_operation_t := "100";  -- write; later read back
  constant variant_c  : hk_operation_t := "101";  -- the same, on parts that have the register
  constant drop_c     : hk_operation_t := "110";  -- read, whatever it is
  constant sample_c   : hk_operation_t := "111";  -- read a sample; behind it nothing follows

  -- A step: operation, register, value.
  subtype hk_step_t is std_logic_vector(18 downto 0);
  type hk_program_t is array (0 to 31) of hk_step_t;
  constant program_c : hk_program_t := (
    0 => identify_c & x"75" & x"00",  -- WHO_AM_I
    1 => write_c & x"6B" & x"80",  -- PWR_MGMT_1
    2 => wait_c & x"00" & x"1A",  -- 100 ms
    3 => poll_c & x"6B" & x"40",  -- PWR_MGMT_1
    4 => write_c & x"6B" & x"01",  -- PWR_MGMT_1
    5 => write_c & x"68" & x"07",  -- SIGNAL_PATH_RESET
    6 => wait_c & x"00" & x"1A",  -- 100 ms
    7 => write_c & x"38" & x"00",  -- INT_ENABLE
    8 => drop_c & x"3A" & x"00",  -- INT_STATUS
    9 => set_c & x"6A" & x"00",  -- USER_CTRL
    10 => set_c & x"23" & x"00",  -- FIFO_EN
    11 => set_c & x"6C" & x"00",  -- PWR_MGMT_2
    12 => set_c & x"37" & x"20",  -- INT_PIN_CFG
    13 => set_c & x"19" & x"09",  -- SMPLRT_DIV
    14 => set_c & x"1A" & x"02",  -- CONFIG
    15 => set_c & x"1B" & x"08",  -- GYRO_CONFIG
    16 => set_c & x"1C" & x"08",  -- ACCEL_CONFIG
    17 => variant_c & x"1D" & x"02",  -- ACCEL_CONFIG_2
    18 => set_c & x"6B" & x"01",  -- PWR_MGMT_1
    19 => write_c & x"38" & x"01",  -- INT_ENABLE
    20 => sample_c & x"3A" & x"00",  -- INT_STATUS
    27 => wait_c & x"00" & x"02",  -- until the next look
    28 => wait_c & x"00" & x"0F",  -- 1.5 periods
    29 => wait_c & x"00" & x"08",  -- 7/8 of a period
    30 => wait_c & x"00" & x"F5",  -- 1 s
    31 => wait_c & x"00" & x"04",  -- 10 ms
    others => drop_c & x"00" & x"00"
  );

  -- While the sensor runs a wait is counted in units of 2**period_unit_c us, which is between a
  -- sixteenth and an eighth of a period; before that in units of 4.096 ms.
  constant period_unit_c : natural := 10;

  -- Places in the program. The registers from first_scale_c on say what a count means.
  subtype hk_place_t is natural range 0 to 31;
  constant poll_step_c     : hk_place_t := 3;
  constant first_set_c     : hk_place_t := 9;
  constant first_scale_c   : hk_place_t := 13;
  constant last_scale_c    : hk_place_t := 16;
  constant last_set_c      : hk_place_t := 18;
  constant sample_step_c   : hk_place_t := 20;
  constant gap_step_c      : hk_place_t := 27;
  constant overdue_step_c  : hk_place_t := 28;
  constant unlooked_step_c : hk_place_t := 29;
  constant refused_step_c  : hk_place_t := 30;
  constant begin_step_c    : hk_place_t := 31;  -- the first follows

  function is_accepted (identity : std_logic_vector(7 downto 0)) return std_logic;

  -- Whether the part has a low-pass register for its accelerometer.
  function is_variant (identity : std_logic_vector(7 downto 0)) return std_logic;

end package hk_mpu6050_pkg;

package body hk_mpu6050_pkg is

  function is_accepted (identity : std_logic_vector(7 downto 0)) return std_logic is
  begin
    if identity = x"68" then  -- MPU-6050
      return '1';
    end if;
    if identity = x"70" then  -- MPU-6500
      return '1';
    end if;
    if identity = x"71" then  -- MPU-9250
      return '1';
    end if;
    if identity = x"73" then  -- MPU-9255
      return '1';
    end if;
    if identity = x"98" then  -- ICM-20689
      return '1';
    end if;
    if identity = x"72" then  -- unknown clone
      return '1';
    end if;
    if identity = x"74" then  -- MPU-6515
      return '1';
    end if;
    if identity = x"75" then  -- unknown clone
      return '1';
    end if;
    return '0';
  end function is_accepted;

  function is_variant (identity : std_logic_vector(7 downto 0)) return std_logic is
  begin
    if identity = x"70" then
      return '1';
    end if;
    if identity = x"71" then
      return '1';
    end if;
    if identity = x"73" then
      return '1';
    end if;
    if identity = x"98" then
      return '1';
    end if;
    if identity = x"74" then
      return '1';
    end if;
    return '0';
  end function is_variant;

end package body hk_mpu6050_pkg;
