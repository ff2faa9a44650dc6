-- Types and functions of the complementary filter.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.hk_common_pkg.all;
use work.hk_complementary_design_pkg.all;
use work.hk_design_pkg.all;

package hk_complementary_pkg is

  type axis_t is (roll, pitch);
  type force_t is array (0 to 2) of signed(15 downto 0);

  -- What may change at run time: coefficients in the formats of the design, angles in half turns,
  -- biases in half turns per sample (with an integral: where they start, with its fraction bits),
  -- bounds of the gate in squared counts. What the design does not use is ignored.
  type hk_settings_t is record
    blend             : signed(17 downto 0);
    rate_gain_roll    : signed(17 downto 0);
    rate_gain_pitch   : signed(17 downto 0);
    integral_gain     : signed(17 downto 0);
    tilt_offset_roll  : signed(31 downto 0);
    tilt_offset_pitch : signed(31 downto 0);
    gyro_bias_roll    : signed(31 downto 0);
    gyro_bias_pitch   : signed(31 downto 0);
    gate_lowest       : unsigned(31 downto 0);
    gate_highest      : unsigned(31 downto 0);
  end record;

  -- Those of the design.
  constant design_settings_c : hk_settings_t := (
    blend             => blend_c,
    rate_gain_roll    => rate_gain_roll_c,
    rate_gain_pitch   => rate_gain_pitch_c,
    integral_gain     => integral_gain_c,
    tilt_offset_roll  => tilt_offset_roll_c,
    tilt_offset_pitch => tilt_offset_pitch_c,
    gyro_bias_roll    => gyro_bias_roll_c,
    gyro_bias_pitch   => gyro_bias_pitch_c,
    gate_lowest       => gate_lowest_c,
    gate_highest      => gate_highest_c
  );

  constant has_both_c      : boolean  := has_roll_c and has_pitch_c;
  constant root_integers_c : positive := 15;  -- 1 g is at most 2**14 counts

  -- The size of a component as the tilt takes it: with the arc sine at most 1 g.
  function tilt_size (count : signed(16 downto 0)) return unsigned;

  -- What is left of 1 g beside a component, from the square of the component.
  function rest_of_square (square : signed(49 downto 0)) return unsigned;

  -- Nearest bias in -bias_limit_c .. bias_limit_c.
  function limited (bias : signed(31 downto 0)) return signed;

end package hk_complementary_pkg;

package body hk_complementary_pkg is

  function tilt_size (count : signed(16 downto 0)) return unsigned is
  begin
    if uses_arcsin_c and (count > gravity_count_c or count < -gravity_count_c) then
      return to_unsigned(gravity_count_c, 16);
    end if;
    return size_of(count);
  end function tilt_size;

  function rest_of_square (square : signed(49 downto 0)) return unsigned is
  begin
    return to_unsigned(gravity_count_c * gravity_count_c, 2 * root_integers_c)
           - unsigned(square(2 * root_integers_c - 1 downto 0));
  end function rest_of_square;

  function limited (bias : signed(31 downto 0)) return signed is
  begin
    if bias > bias_limit_c then
      return bias_limit_c;
    elsif bias < -bias_limit_c then
      return -bias_limit_c;
    end if;
    return bias;
  end function limited;

end package body hk_complementary_pkg;
