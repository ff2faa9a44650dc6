-- Arc tangent and length of a vector. The first digits of the smaller component over the larger one
-- choose a turn from a table, and what they leave lies across the vector that is turned by it; the
-- digits of that give the rest of the angle. One digit a clock. A zero vector gives zero and zero.
--
-- With `second` a second angle follows: that of (length of the first vector, y_second). Its digits
-- begin while the first angle is still being finished.
--
-- The multiplier is the caller's. Where `multiply` is 1 it takes the operands into registers on the
-- next edge, the product is there one edge later and holds until the next multiplication. From a
-- vector taken to its angle nobody else may multiply but in the turn_digits_c clocks after it.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.hk_common_pkg.all;
use work.hk_design_pkg.all;

entity hk_arctan is
  generic (
    SIZE_BITS : positive range 16 to 30 := 16  -- of y; x and the length have 30
  );
  port (
    clk             : in  std_logic;
    rst             : in  std_logic;  -- synchronous, active high
    in_valid        : in  std_logic;
    in_ready        : out std_logic;
    x               : in  unsigned(29 downto 0);  -- size, with guard bits
    y               : in  unsigned(SIZE_BITS - 1 downto 0);  -- size, without
    x_negative      : in  std_logic;
    y_negative      : in  std_logic;
    second          : in  std_logic;              -- the last three hold until out_valid
    y_second        : in  unsigned(SIZE_BITS - 1 downto 0);
    second_negative : in  std_logic;
    zero            : in  signed(31 downto 0);    -- taken off the angle; holds until out_valid
    out_valid       : out std_logic;              -- for one clock: there is an angle
    angle           : out signed(31 downto 0);    -- half turns, wraps at +-pi; holds until the next
    length          : out unsigned(29 downto 0);  -- times 1 + stretch / 2**stretch_fraction_bits_c,
    stretch         : out signed(17 downto 0);    -- there with the angle, until a vector is taken
    turn            : out unsigned(turn_digits_c - 1 downto 0);  -- with it
    multiply        : out std_logic;
    factor          : out signed(30 downto 0);
    coefficient     : out signed(17 downto 0);
    product         : in  signed(49 downto 0)
  );
end entity hk_arctan;

architecture rtl of hk_arctan is

  constant guard_c         : natural  := 30 - SIZE_BITS;  -- guard bits
  constant stretch_shift_c : positive := stretch_fraction_bits_c - guard_c;

  type state_t is (
    idle,
    loading,   -- the second vector
    sorting,   -- which component is the larger one
    turning,   -- the digits of the turn
    widening,  -- turn the larger component: a clock for the product, then the sum
    dividing   -- the digits of the ratio
  );
  signal state_r : state_t;
  signal count_r : std_logic_vector(0 to ratio_digits_c - 1);  -- digits made: one is 1

  signal along_r  : unsigned(30 downto 0);  -- the larger component, then turned
  signal rest_r   : unsigned(31 downto 0);  -- of the smaller component, times two
  signal part_r   : unsigned(21 downto 0);  -- of the smaller component
  signal digits_r : unsigned(ratio_digits_c - 1 downto 0);
  signal turn_r   : unsigned(turn_digits_c - 1 downto 0);
  signal turned   : unsigned(30 downto 0);  -- the larger component with a product added to it
  signal trial    : unsigned(32 downto 0);  -- rest less the larger component, and its sign
  signal digits   : unsigned(ratio_digits_c - 1 downto 0);

  signal steep_r     : std_logic;
  signal behind_r    : std_logic;
  signal below_r     : std_logic;
  signal following_r : std_logic;  -- this is the second vector

  -- What the end of an angle needs while the next vector is in work.
  signal ending_r   : std_logic_vector(0 to 3);  -- a clock each: product, octant, fold, valid
  signal quarters_r : std_logic_vector(1 downto 0);
  signal negate_r   : std_logic;
  signal nothing_r  : std_logic;
  signal octant_r   : signed(31 downto 0);
  signal base_r     : signed(31 downto 0);

begin

  in_ready  <= '1' when state_r = idle else '0';
  out_valid <= ending_r(3);
  length    <= along_r(29 downto 0);
  stretch   <= to_signed(stretches_c(to_integer(turn_r)), 18);
  turn      <= turn_r;

  trial  <= ('0' & rest_r) - ("00" & along_r);
  digits <= digits_r(ratio_digits_c - 2 downto 0) & not trial(32);

  turned <= along_r + (unsigned(product(27 downto 0)) & "00") when state_r = widening
            else along_r + (unsigned(product(30 downto 16)) & "000");

  -- The turn widens the larger component. The first eight digits, squared, correct the length while
  -- the others are made. The stretch of the second vector comes before the last digit, and the slope
  -- with it.
  operands : process (state_r, count_r, digits_r, digits, along_r, part_r, y_second, turn_r,
                      product)
  begin
    multiply    <= '0';
    factor      <= signed(shift_left(resize(digits, 31), 16 - ratio_digits_c));
    coefficient <= slope_c;
    if state_r = dividing then
      if count_r(ratio_digits_c - 1) = '1' then
        multiply <= '1';
      elsif count_r(ratio_digits_c - 2) = '1' then
        factor      <= signed(resize(y_second, 31));
        coefficient <= to_signed(stretches_c(to_integer(turn_r)), 18);
        multiply    <= '1';
      elsif count_r(10) = '1' then
        factor      <= signed(resize(along_r(30 downto 16), 31));
        coefficient <= signed(resize(unsigned(product(15 downto 0)), 18));
        multiply    <= '1';
      elsif count_r(8) = '1' then
        factor      <= signed(resize(digits_r(7 downto 0), 31));
        coefficient <= signed(resize(digits_r(7 downto 0), 18)) + 1;
        multiply    <= '1';
      end if;
    elsif state_r = turning and count_r(turn_digits_c - 1) = '1' then
      factor      <= signed(resize(part_r, 31));
      coefficient <= signed(resize(digits(turn_digits_c - 1 downto 0), 18));
      multiply    <= '1';
    end if;
  end process operands;

  division : process (clk)
    variable digit_v : std_logic;
  begin
    if rising_edge(clk) then
      digit_v     := not trial(32);
      ending_r(0) <= '0';

      if state_r = idle then
        if in_valid = '1' then
          along_r     <= shift_left(resize(y, 31), guard_c);
          rest_r      <= resize(x, 32);
          behind_r    <= x_negative;
          below_r     <= y_negative;
          following_r <= '0';
          state_r     <= sorting;
        end if;

      elsif state_r = loading then
        along_r     <= shift_left(resize(y_second, 31), guard_c)
                       + unsigned(product(stretch_shift_c + 29 downto stretch_shift_c));
        rest_r      <= resize(along_r, 32);
        behind_r    <= '0';
        below_r     <= second_negative;
        following_r <= '1';
        state_r     <= sorting;

      elsif state_r = sorting then
        -- So far y stands in along_r and x in rest_r.
        steep_r <= trial(32);
        rest_r  <= rest_r(30 downto 0) & '0';
        if digit_v = '1' then
          along_r <= rest_r(30 downto 0);
          rest_r  <= along_r & '0';
        end if;
        count_r <= (0 => '1', others => '0');
        state_r <= turning;

      elsif state_r = widening then
        turn_r  <= digits_r(turn_digits_c - 1 downto 0);
        count_r <= '0' & count_r(0 to ratio_digits_c - 2);
        if count_r(turn_digits_c + 1) = '1' then
          along_r <= turned;
          count_r <= (0 => '1', others => '0');
          state_r <= dividing;
        end if;

      else
        if state_r = turning and count_r(0) = '1' then
          part_r <= rest_r(30 downto 9);
        end if;
        rest_r <= rest_r(30 downto 0) & '0';
        if digit_v = '1' then
          rest_r <= trial(30 downto 0) & '0';
        end if;
        digits_r <= digits;
        count_r  <= '0' & count_r(0 to ratio_digits_c - 2);
        if state_r = turning then
          if count_r(turn_digits_c - 1) = '1' then
            state_r <= widening;
          end if;
        elsif count_r(ratio_digits_c - 1) = '1' then
          along_r       <= turned;
          ending_r(0)   <= '1';
          quarters_r(0) <= steep_r;
          quarters_r(1) <= (steep_r and below_r) or (behind_r and not steep_r);
          negate_r      <= steep_r xor behind_r xor below_r;
          nothing_r     <= '0';
          if along_r(30 downto guard_c) = 0 then
            nothing_r <= '1';
          end if;
          state_r <= idle;
          if second = '1' and following_r = '0' then
            state_r <= loading;
          end if;
        end if;
      end if;

      if rst = '1' then
        ending_r(0) <= '0';
        state_r     <= idle;
      end if;
    end if;
  end process division;

  -- The product of the slope, then out of the first octant.
  finish : process (clk)
    variable quarters_v : signed(31 downto 0);
    variable negate_v   : signed(31 downto 0);
  begin
    if rising_edge(clk) then
      ending_r(1 to 3) <= ending_r(0 to 2);
      if ending_r(1) = '1' then
        octant_r <= to_signed(angles_c(to_integer(turn_r)), 32)
                    + product(slope_fraction_bits_c + 31 downto slope_fraction_bits_c);
        if nothing_r = '1' then
          octant_r <= (others => '0');
        end if;
        quarters_v               := (others => '0');
        quarters_v(31 downto 30) := signed(quarters_r);
        base_r                   <= quarters_v - zero;
      end if;
      if ending_r(2) = '1' then
        negate_v := (others => negate_r);
        angle <= hk_sum(base_r, octant_r xor negate_v, negate_r);
      end if;
      if rst = '1' then
        ending_r(1 to 3) <= (others => '0');
      end if;
    end if;
  end process finish;

end architecture rtl;
