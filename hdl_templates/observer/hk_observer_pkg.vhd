-- What may change in the observer while it runs: words of 32 bits in the formats of the design.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.hk_observer_design_pkg.all;

package hk_observer_pkg is

  -- The gains, and where the bias of each axis of the sensor starts.
  type hk_settings_t is record
    kt          : signed(31 downto 0);
    kv          : signed(31 downto 0);
    kb          : signed(31 downto 0);
    gyro_bias_x : signed(31 downto 0);
    gyro_bias_y : signed(31 downto 0);
    gyro_bias_z : signed(31 downto 0);
  end record;

  -- Those of the design.
  constant design_settings_c : hk_settings_t := (
    kt          => kt_c,
    kv          => kv_c,
    kb          => kb_c,
    gyro_bias_x => gyro_bias_x_c,
    gyro_bias_y => gyro_bias_y_c,
    gyro_bias_z => gyro_bias_z_c
  );

end package hk_observer_pkg;
