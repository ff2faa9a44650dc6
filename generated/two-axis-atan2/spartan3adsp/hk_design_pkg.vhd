-- made by hostkit 0.1.0 from design 00e52f7c2b01; do not edit; template common/hk_design_pkg.vhd.j2
-- What every core knows of its design. Angles are half turns: one unit is pi / 2**31 rad.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.hk_common_pkg.all;

package hk_design_pkg is

  -- Which design, and the sample rate its coefficients hold for: 100.0 Hz.
  constant design_digest_c : std_logic_vector(47 downto 0) := x"00e52f7c2b01";

  -- Sensors that the core serves.
  constant channels_c : positive := 1;

  -- Axes.
  constant has_roll_c  : boolean := true;
  constant has_pitch_c : boolean := true;

  -- Mounting: which sensor axis is which body axis.
  constant body_x_c : hk_body_axis_t :=
    (source => 0, negative => false);  -- +x
  constant body_y_c : hk_body_axis_t :=
    (source => 1, negative => false);  -- +y
  constant body_z_c : hk_body_axis_t :=
    (source => 2, negative => false);  -- +z

  -- Accelerometer count of 1 g.
  constant gravity_count_c : positive := 16384;

  -- Arc tangent: sizes of counts are shifted left by the guard bits; the digits of one division
  -- choose a turn, atan(turn / 64), and those of another are the ratio that is left, unit 2**-22.
  constant guard_bits_c            : positive := 14;
  constant turn_digits_c           : positive := 6;
  constant ratio_digits_c          : positive range 13 to 15 := 14;
  constant stretch_fraction_bits_c : positive := 18;
  constant root_fraction_bits_c    : positive := 8;
  constant slope_c                 : signed(17 downto 0) :=
    to_signed(41719, 18);  -- 162.9647145421576 half turns / 2^31 per 2^-22, s8.8
  constant slope_fraction_bits_c   : positive := 8;

  -- round(atan(turn / 64) / pi * 2**31)
  constant angles_c : hk_turn_table_t := (
    0, 10679838, 21354465, 32018685, 42667331, 53295284, 63897482, 74468939,
    85004756, 95500135, 105950391, 116350962, 126697423, 136985493, 147211045, 157370116,
    167458907, 177473799, 187411349, 197268300, 207041579, 216728303, 226325781, 235831508,
    245243172, 254558647, 263775993, 272893455, 281909457, 290822599, 299631651, 308335554,
    316933406, 325424463, 333808132, 342083962, 350251643, 358310992, 366261957, 374104599,
    381839095, 389465727, 396984877, 404397019, 411702716, 418902610, 425997422, 432987938,
    439875013, 446659557, 453342536, 459924966, 466407904, 472792449, 479079736, 485270931,
    491367227, 497369841, 503280012, 509098996, 514828063, 520468494, 526021581, 531488619
  );

  -- round((sqrt(1 + (turn / 64)**2) - 1) * 2**stretch_fraction_bits_c)
  constant stretches_c : hk_turn_table_t := (
    0, 32, 128, 288, 512, 799, 1149, 1563,
    2040, 2579, 3181, 3844, 4568, 5353, 6199, 7104,
    8068, 9090, 10171, 11308, 12502, 13751, 15056, 16414,
    17826, 19290, 20806, 22373, 23990, 25656, 27371, 29133,
    30942, 32796, 34696, 36639, 38626, 40655, 42726, 44837,
    46989, 49179, 51407, 53673, 55976, 58314, 60687, 63095,
    65536, 68010, 70516, 73053, 75621, 78219, 80846, 83501,
    86185, 88895, 91633, 94396, 97185, 99999, 102837, 105699
  );

end package hk_design_pkg;
