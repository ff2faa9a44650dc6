-- made by hostkit 0.1.0 from design 975f50245cf2; do not edit; template complementary/hk_complementary_design_pkg.vhd.j2
-- What the complementary filter knows of its design. Angles are half turns: one unit is
-- pi / 2**31 rad.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

package hk_complementary_design_pkg is

  -- Whether the core takes a sample a clock.
  constant pipelined_c : boolean := false;

  -- Tilt method (arc sine of one component, or arc tangent of two).
  constant uses_arcsin_c : boolean := true;

  -- Coefficients: raw / 2**fraction_bits.
  constant rate_gain_roll_c : signed(17 downto 0) :=
    to_signed(72818, 18);  -- 36408.88888888889 half turns / 2^31 per count, s16.1
  constant rate_gain_roll_fraction_bits_c : positive := 1;
  constant rate_gain_pitch_c : signed(17 downto 0) :=
    to_signed(72818, 18);  -- 36408.88888888889 half turns / 2^31 per count, s16.1
  constant rate_gain_pitch_fraction_bits_c : positive := 1;
  constant blend_c : signed(17 downto 0) :=
    to_signed(77070, 18);  -- 0.5880000000000001 1, s0.17
  constant blend_fraction_bits_c : positive := 17;
  constant integral_gain_c : signed(17 downto 0) :=
    to_signed(0, 18);  -- 0.0 1, s0.17
  constant integral_gain_fraction_bits_c : positive := 17;

  -- Taken off the measured tilt, half turns.
  constant tilt_offset_roll_c : signed(31 downto 0) := to_signed(0, 32);
  constant tilt_offset_pitch_c : signed(31 downto 0) := to_signed(0, 32);

  -- Bias of the gyroscope, half turns per sample. With an integral this is where it starts, it has
  -- fraction bits, and it follows the correction up to a limit.
  constant has_integral_c : boolean := false;
  constant gyro_bias_roll_c : signed(31 downto 0) := to_signed(0, 32);
  constant gyro_bias_pitch_c : signed(31 downto 0) := to_signed(0, 32);
  constant bias_fraction_bits_c : positive := 1;
  constant bias_limit_c : signed(31 downto 0) := to_signed(0, 32);

  -- Gate: the specific force corrects if the sum of its squared counts lies within these, included.
  constant uses_gate_c    : boolean := false;
  constant gate_lowest_c  : unsigned(31 downto 0) := to_unsigned(0, 32);
  constant gate_highest_c : unsigned(31 downto 0) := to_unsigned(0, 32);

end package hk_complementary_design_pkg;
