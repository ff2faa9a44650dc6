-- Types and fixed-point primitives that the blocks of the core share.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

package hk_common_pkg is

  -- Arc tangents of the CORDIC, padded with zeros so that no 5-bit step number leaves the table.
  type hk_angle_table_t is array (0 to 31) of signed(31 downto 0);

  -- One body axis: the sensor axis it is (0, 1, 2 are x, y, z) and whether it points the other way.
  type hk_body_axis_t is record
    source   : natural range 0 to 2;
    negative : boolean;
  end record;

  -- Count along a body axis. One bit wider than the counts, because -(-32768) needs it.
  function body_count (
    axis    : hk_body_axis_t;
    x, y, z : signed(15 downto 0)
  ) return signed;

  -- Nearest count in -limit .. limit.
  function clamped (count : signed(16 downto 0); limit : natural) return signed;

  -- Divide by 2**bits, rounding halves upwards, and keep the low 32 bits.
  function shift_rounded (product : signed(49 downto 0); bits : positive) return signed;

  -- Arithmetic shift by a variable distance, written out in powers of two.
  function shifted_right (
    value    : signed(31 downto 0);
    distance : unsigned(4 downto 0)
  ) return signed;

end package hk_common_pkg;

package body hk_common_pkg is

  function body_count (
    axis    : hk_body_axis_t;
    x, y, z : signed(15 downto 0)
  ) return signed is
    variable count_v : signed(16 downto 0);
  begin
    if axis.source = 0 then
      count_v := resize(x, 17);
    elsif axis.source = 1 then
      count_v := resize(y, 17);
    else
      count_v := resize(z, 17);
    end if;
    if axis.negative then
      count_v := -count_v;
    end if;
    return count_v;
  end function body_count;

  function clamped (count : signed(16 downto 0); limit : natural) return signed is
  begin
    if count > limit then
      return to_signed(limit, 17);
    elsif count < -limit then
      return to_signed(-limit, 17);
    end if;
    return count;
  end function clamped;

  function shift_rounded (product : signed(49 downto 0); bits : positive) return signed is
    variable wide_v   : signed(81 downto 0);
    variable result_v : signed(31 downto 0);
  begin
    -- floor((p + half) / 2**bits) is floor(p / 2**bits) plus the first bit that is dropped.
    wide_v   := resize(product, 82);
    result_v := wide_v(bits + 31 downto bits);
    if product(bits - 1) = '1' then
      result_v := result_v + 1;
    end if;
    return result_v;
  end function shift_rounded;

  function shifted_right (
    value    : signed(31 downto 0);
    distance : unsigned(4 downto 0)
  ) return signed is
    variable sign_v   : signed(15 downto 0);
    variable result_v : signed(31 downto 0);
  begin
    sign_v   := (others => value(31));
    result_v := value;
    if distance(4) = '1' then
      result_v := sign_v & result_v(31 downto 16);
    end if;
    if distance(3) = '1' then
      result_v := sign_v(7 downto 0) & result_v(31 downto 8);
    end if;
    if distance(2) = '1' then
      result_v := sign_v(3 downto 0) & result_v(31 downto 4);
    end if;
    if distance(1) = '1' then
      result_v := sign_v(1 downto 0) & result_v(31 downto 2);
    end if;
    if distance(0) = '1' then
      result_v := sign_v(0 downto 0) & result_v(31 downto 1);
    end if;
    return result_v;
  end function shifted_right;

end package body hk_common_pkg;
