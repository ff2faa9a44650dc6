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
    kt          => to_signed(kt_c, 32),
    kv          => to_signed(kv_c, 32),
    kb          => to_signed(kb_c, 32),
    gyro_bias_x => to_signed(bias_x_c, 32),
    gyro_bias_y => to_signed(bias_y_c, 32),
    gyro_bias_z => to_signed(bias_z_c, 32)
  );

end package hk_observer_pkg;
