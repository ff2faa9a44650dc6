-- Types and functions of the complementary filter.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.hk_common_pkg.all;
use work.hk_design_pkg.all;

package hk_complementary_pkg is

  type axis_t is (roll, pitch);
  type count_array_t is array (axis_t) of signed(16 downto 0);
  type angle_array_t is array (axis_t) of signed(31 downto 0);
  type force_t is array (0 to 2) of signed(15 downto 0);

  constant root_integers_c : positive := 15;  -- 1 g is at most 2**14 counts

  constant tilt_offset_c : angle_array_t := (tilt_offset_roll_c, tilt_offset_pitch_c);

  -- The axis whose tilt is measured first.
  function first_axis return axis_t;

  -- The size of a count as the arc tangent takes it.
  function with_guard_bits (count : signed(16 downto 0)) return unsigned;

  -- What is left of 1 g beside a component, from the square of the component.
  function rest_of_square (square : signed(49 downto 0)) return unsigned;

  -- Angle without the turn that the bias of an integral makes in one sample.
  function without_bias (angle, bias : signed(31 downto 0)) return signed;

  -- What the turn of one sample is added to: prepared with the bias of an integral, or made here.
  function before_turn (axis : axis_t; angle, prepared : signed(31 downto 0)) return signed;

  -- Nearest bias in -bias_limit_c .. bias_limit_c.
  function limited (bias : signed(31 downto 0)) return signed;

end package hk_complementary_pkg;

package body hk_complementary_pkg is

  function first_axis return axis_t is
  begin
    -- The arc tangent of pitch needs the length that the one of roll leaves.
    if uses_arcsin_c and not has_roll_c then
      return pitch;
    end if;
    return roll;
  end function first_axis;

  function with_guard_bits (count : signed(16 downto 0)) return unsigned is
  begin
    return shift_left(resize(size_of(count), 30), guard_bits_c);
  end function with_guard_bits;

  function rest_of_square (square : signed(49 downto 0)) return unsigned is
  begin
    return to_unsigned(gravity_count_c * gravity_count_c, 2 * root_integers_c)
           - unsigned(square(2 * root_integers_c - 1 downto 0));
  end function rest_of_square;

  function without_bias (angle, bias : signed(31 downto 0)) return signed is
  begin
    return angle - shift_rounded(resize(bias, 50), bias_fraction_bits_c);
  end function without_bias;

  function before_turn (axis : axis_t; angle, prepared : signed(31 downto 0)) return signed is
  begin
    if has_integral_c then
      return prepared;
    end if;
    if axis = roll then
      return angle - gyro_bias_roll_c;
    end if;
    return angle - gyro_bias_pitch_c;
  end function before_turn;

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
