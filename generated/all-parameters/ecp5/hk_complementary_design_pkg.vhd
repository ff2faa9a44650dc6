-- made by hostkit 0.1.0 from design 0099cab74159; do not edit; template complementary/hk_complementary_design_pkg.vhd.j2
-- What the complementary filter knows of its design. Angles are half turns: one unit is
-- pi / 2**31 rad.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

package hk_complementary_design_pkg is

  -- Whether the core takes a sample a clock.
  constant pipelined_c : boolean := false;

  -- Tilt method (arc sine of one component, or arc tangent of two).
  constant uses_arcsin_c : boolean := false;

  -- Coefficients: raw / 2**fraction_bits.
  constant rate_gain_roll_c : signed(17 downto 0) :=
    to_signed(117674, 18);  -- 1838.6488888888891 half turns / 2^31 per count, s11.6
  constant rate_gain_roll_fraction_bits_c : positive := 6;
  constant rate_gain_pitch_c : signed(17 downto 0) :=
    to_signed(114178, 18);  -- 1784.0355555555557 half turns / 2^31 per count, s11.6
  constant rate_gain_pitch_fraction_bits_c : positive := 6;
  constant blend_c : signed(17 downto 0) :=
    to_signed(117441, 18);  -- 0.0034999999999999476 1, s-8.25
  constant blend_fraction_bits_c : positive := 25;
  constant integral_gain_c : signed(17 downto 0) :=
    to_signed(85899, 18);  -- 0.01024 1, s-6.23
  constant integral_gain_fraction_bits_c : positive := 23;

  -- Taken off the measured tilt, half turns.
  constant tilt_offset_roll_c : signed(31 downto 0) := to_signed(23860929, 32);
  constant tilt_offset_pitch_c : signed(31 downto 0) := to_signed(-41756626, 32);

  -- Bias of the gyroscope, half turns per sample. With an integral this is where it starts, it has
  -- fraction bits, and it follows the correction up to a limit.
  constant has_integral_c : boolean := true;
  constant gyro_bias_roll_c : signed(31 downto 0) := to_signed(91625969, 32);
  constant gyro_bias_pitch_c : signed(31 downto 0) := to_signed(-45812984, 32);
  constant bias_fraction_bits_c : positive := 9;
  constant bias_limit_c : signed(31 downto 0) := to_signed(1221679586, 32);

  -- Gate: the specific force corrects if the sum of its squared counts lies within these, included.
  constant uses_gate_c    : boolean := true;
  constant gate_lowest_c  : unsigned(31 downto 0) := to_unsigned(217432720, 32);
  constant gate_highest_c : unsigned(31 downto 0) := to_unsigned(324806901, 32);

end package hk_complementary_design_pkg;
