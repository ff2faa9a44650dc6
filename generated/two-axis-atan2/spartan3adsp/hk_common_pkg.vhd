-- Types and fixed-point primitives that the blocks of the core share.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

package hk_common_pkg is

  -- A number for each turn of the arc tangent; no 6-bit turn leaves the table.
  type hk_turn_table_t is array (0 to 63) of natural;

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

  -- Size of a count, up to 2**15.
  function size_of (count : signed(16 downto 0)) return unsigned;

  -- Whether a count stands at the end of its range.
  function at_end_of_range (count : signed(15 downto 0)) return boolean;

  -- Nearest count in -limit .. limit.
  function clamped (count : signed(16 downto 0); limit : natural) return signed;

  -- Divide by 2**bits, rounding halves upwards, and keep the low 32 bits.
  function shift_rounded (product : signed(49 downto 0); bits : positive) return signed;

  -- The same, rounding down: the bit below, product(bits - 1), is to be added as a carry.
  function shift_floored (product : signed(49 downto 0); bits : positive) return signed;

  -- Sum of two words and a carry in one adder; wraps.
  function hk_sum (a, b : signed(31 downto 0); carry : std_logic) return signed;

  -- Bits of an index 0 .. entries - 1, at least 1.
  function hk_index_bits (entries : positive) return positive;

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

  function size_of (count : signed(16 downto 0)) return unsigned is
    variable size_v : signed(16 downto 0);
  begin
    size_v := count;
    if count(16) = '1' then
      size_v := -count;
    end if;
    return unsigned(size_v(15 downto 0));
  end function size_of;

  function at_end_of_range (count : signed(15 downto 0)) return boolean is
  begin
    -- 32767, -32767 or -32768.
    if count(15) = '0' then
      return unsigned(count(14 downto 0)) = 32767;
    end if;
    return unsigned(count(14 downto 1)) = 0;
  end function at_end_of_range;

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
    variable result_v : signed(31 downto 0);
  begin
    -- floor((p + half) / 2**bits) is floor(p / 2**bits) plus the first bit that is dropped.
    result_v := shift_floored(product, bits);
    if product(bits - 1) = '1' then
      result_v := result_v + 1;
    end if;
    return result_v;
  end function shift_rounded;

  function shift_floored (product : signed(49 downto 0); bits : positive) return signed is
    variable wide_v : signed(81 downto 0);
  begin
    wide_v := resize(product, 82);
    return wide_v(bits + 31 downto bits);
  end function shift_floored;

  function hk_sum (a, b : signed(31 downto 0); carry : std_logic) return signed is
    variable sum_v : signed(32 downto 0);
  begin
    -- A one and the carry below the words, so that it is one sum of two.
    sum_v := (a & '1') + (b & carry);
    return sum_v(32 downto 1);
  end function hk_sum;

  function hk_index_bits (entries : positive) return positive is
    variable bits_v : positive;
  begin
    bits_v := 1;
    while 2 ** bits_v < entries loop
      bits_v := bits_v + 1;
    end loop;
    return bits_v;
  end function hk_index_bits;

end package body hk_common_pkg;
