-- made by hostkit 0.1.0 from design 0099cab74159; do not edit; template polar/hk_polar_pkg.vhd.j2
-- Clocks of the pipelined blocks, and what a length loses when its stretch is taken off.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.hk_common_pkg.all;
use work.hk_design_pkg.all;

package hk_polar_pkg is

  -- From operands to result, in clocks.
  constant product_clocks_c    : positive := 4;
  constant multiplier_clocks_c : positive := product_clocks_c + 1;

  -- From a vector to the stretch of its turn, to its length and to its angle.
  constant turned_clocks_c  : positive := turn_digits_c + 4;
  constant stretch_clocks_c : positive := turn_digits_c + 3;
  constant length_clocks_c  : positive := turned_clocks_c + 2 * product_clocks_c + 9;
  constant arctan_clocks_c  : positive := turned_clocks_c + ratio_digits_c + product_clocks_c + 2;

  -- Largest size of a component.
  constant polar_limit_c : positive := 32768;

  -- Bits of a root in the arc sine, and its clocks.
  constant polar_root_integers_c : positive := 15;
  constant polar_root_bits_c     : positive := polar_root_integers_c + root_fraction_bits_c;

  -- round((1 - 1 / sqrt(1 + (turn / 64)**2)) * 2**stretch_fraction_bits_c)
  constant shrinks_c : hk_turn_table_t := (
    0, 32, 128, 288, 511, 796, 1144, 1554,
    2024, 2554, 3143, 3788, 4490, 5246, 6056, 6916,
    7827, 8786, 9791, 10840, 11933, 13066, 14238, 15447,
    16691, 17968, 19276, 20614, 21979, 23369, 24783, 26219,
    27675, 29150, 30641, 32146, 33666, 35197, 36738, 38289,
    39846, 41410, 42979, 44551, 46126, 47703, 49279, 50855,
    52429, 54000, 55568, 57132, 58690, 60243, 61790, 63329,
    64861, 66384, 67899, 69404, 70900, 72386, 73862, 75326
  );

  -- Size of a component, up to 2**16.
  function polar_size (count : signed(16 downto 0)) return unsigned;

  -- That within the limit, or one less where it will be squared: squares have 30 bits.
  function polar_limited (size : unsigned(16 downto 0); squared : std_logic) return unsigned;

end package hk_polar_pkg;

package body hk_polar_pkg is

  function polar_size (count : signed(16 downto 0)) return unsigned is
  begin
    if count(16) = '1' then
      return unsigned(-count);
    end if;
    return unsigned(count);
  end function polar_size;

  function polar_limited (size : unsigned(16 downto 0); squared : std_logic) return unsigned is
  begin
    if squared = '1' and (size(16) = '1' or size(15) = '1') then
      return to_unsigned(polar_limit_c - 1, 16);
    elsif size(16) = '1' or size(15) = '1' then
      return to_unsigned(polar_limit_c, 16);
    end if;
    return size(15 downto 0);
  end function polar_limited;

end package body hk_polar_pkg;
