-- made by hostkit 0.1.0 from design 0099cab74159; do not edit; template complementary/hk_design_pkg.vhd.j2
-- Everything the core knows of its design. Angles are half turns: one unit is pi / 2**31 rad.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.hk_common_pkg.all;

package hk_design_pkg is

  -- Which design, and the sample rate its coefficients hold for: 100.0 Hz.
  constant design_digest_c : std_logic_vector(47 downto 0) := x"0099cab74159";

  -- Axes and tilt method (arc sine of one component, or arc tangent of two).
  constant has_roll_c    : boolean := true;
  constant has_pitch_c   : boolean := true;
  constant uses_arcsin_c : boolean := false;

  -- Mounting: which sensor axis is which body axis.
  constant body_x_c : hk_body_axis_t :=
    (source => 0, negative => false);  -- +x
  constant body_y_c : hk_body_axis_t :=
    (source => 1, negative => false);  -- +y
  constant body_z_c : hk_body_axis_t :=
    (source => 2, negative => false);  -- +z

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

  -- Accelerometer count of 1 g.
  constant gravity_count_c : positive := 16384;

  -- CORDIC: counts are shifted left by the guard bits; the magnitude carries the gain.
  constant cordic_steps_c              : positive range 1 to 31 := 20;
  constant cordic_guard_bits_c         : positive := 12;
  constant cordic_gain_c               : signed(17 downto 0) :=
    to_signed(53961, 18);  -- 1.646760258120067, s1.15
  constant cordic_gain_fraction_bits_c : positive := 15;
  constant root_fraction_bits_c        : positive := 8;

  -- round(atan(2**-i) / pi * 2**31) for step i, then zeros.
  constant cordic_angles_c : hk_angle_table_t := (
    to_signed(536870912, 32),
    to_signed(316933406, 32),
    to_signed(167458907, 32),
    to_signed(85004756, 32),
    to_signed(42667331, 32),
    to_signed(21354465, 32),
    to_signed(10679838, 32),
    to_signed(5340245, 32),
    to_signed(2670163, 32),
    to_signed(1335087, 32),
    to_signed(667544, 32),
    to_signed(333772, 32),
    to_signed(166886, 32),
    to_signed(83443, 32),
    to_signed(41722, 32),
    to_signed(20861, 32),
    to_signed(10430, 32),
    to_signed(5215, 32),
    to_signed(2608, 32),
    to_signed(1304, 32),
    to_signed(0, 32),
    to_signed(0, 32),
    to_signed(0, 32),
    to_signed(0, 32),
    to_signed(0, 32),
    to_signed(0, 32),
    to_signed(0, 32),
    to_signed(0, 32),
    to_signed(0, 32),
    to_signed(0, 32),
    to_signed(0, 32),
    to_signed(0, 32)
  );

end package hk_design_pkg;
