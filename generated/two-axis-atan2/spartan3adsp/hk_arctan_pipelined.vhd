-- Arc tangent and length of a vector, a new one every clock; the same integers as hk_arctan. Each
-- digit of its two divisions has a stage. A rest below zero is not put back but added to in the
-- next stage, which gives the same digits. No reset: what comes out belongs to what went in so many
-- clocks before, see hk_polar_pkg.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.hk_common_pkg.all;
use work.hk_design_pkg.all;
use work.hk_polar_pkg.all;

entity hk_arctan_pipelined is
  port (
    clk        : in  std_logic;
    x          : in  unsigned(29 downto 0);  -- sizes, with guard bits
    y          : in  unsigned(29 downto 0);
    x_negative : in  std_logic;
    y_negative : in  std_logic;
    stretch    : out unsigned(16 downto 0);  -- after stretch_clocks_c
    turn       : out unsigned(turn_digits_c - 1 downto 0);  -- on the same clock
    length     : out unsigned(29 downto 0);  -- after length_clocks_c
    angle      : out signed(31 downto 0)     -- after arctan_clocks_c; half turns
  );
end entity hk_arctan_pipelined;

architecture rtl of hk_arctan_pipelined is

  -- Stages: 1 and 2 order the components, then come the digits of the turn, two stages that turn
  -- the larger component, and the digits of the ratio.
  constant swapped_c : positive := 2;
  constant counted_c : positive := swapped_c + turn_digits_c;
  constant summed_c  : positive := counted_c + 1;
  constant turned_c  : positive := turned_clocks_c;
  constant divided_c : positive := turned_c + ratio_digits_c;
  constant fine_c    : positive := turned_c + 8;  -- so many digits correct the length
  constant scaled_c  : positive := divided_c + product_clocks_c;

  subtype rest_t is signed(32 downto 0);
  subtype part_t is unsigned(21 downto 0);
  subtype more_t is unsigned(27 downto 0);
  subtype turn_t is unsigned(turn_digits_c - 1 downto 0);
  subtype ratio_t is unsigned(ratio_digits_c - 1 downto 0);
  subtype along_t is unsigned(30 downto 0);

  type rests_t is array (natural range <>) of rest_t;
  type parts_t is array (natural range <>) of part_t;
  type mores_t is array (natural range <>) of more_t;
  type turns_t is array (natural range <>) of turn_t;
  type ratios_t is array (natural range <>) of ratio_t;
  type alongs_t is array (natural range <>) of along_t;

  -- What folds the octant back; the last stage uses it.
  signal steep_r   : std_logic_vector(swapped_c to scaled_c + 1);
  signal behind_r  : std_logic_vector(1 to scaled_c + 1);
  signal below_r   : std_logic_vector(1 to scaled_c + 1);
  signal nothing_r : std_logic_vector(1 to scaled_c + 1);

  signal x_r      : unsigned(29 downto 0);
  signal y_r      : unsigned(29 downto 0);
  signal higher_r : std_logic;

  signal rest_r  : rests_t(swapped_c to divided_c);
  signal along_r : alongs_t(swapped_c to length_clocks_c - 1);
  signal part_r  : parts_t(swapped_c to counted_c);
  signal more_r  : mores_t(swapped_c to summed_c);
  signal turn_r  : turns_t(swapped_c to scaled_c - 1);
  signal ratio_r : ratios_t(turned_c to divided_c);

  signal fine          : signed(17 downto 0);
  signal fine_next     : signed(17 downto 0);
  signal fine_square   : signed(35 downto 0);
  signal coarse_along  : signed(17 downto 0);
  signal coarse_square : signed(17 downto 0);
  signal growth        : signed(35 downto 0);
  signal ratio         : signed(17 downto 0);
  signal product       : signed(35 downto 0);
  signal table_r       : signed(31 downto 0);
  signal octant_r      : signed(31 downto 0);

  -- Rest of the next digit: a rest below zero was not put back, so the divisor is added now.
  function next_rest (rest : rest_t; divisor : along_t) return rest_t is
  begin
    if rest(32) = '1' then
      return (rest(31 downto 0) & '0') + signed("00" & std_logic_vector(divisor));
    end if;
    return (rest(31 downto 0) & '0') - signed("00" & std_logic_vector(divisor));
  end function next_rest;

begin

  order : process (clk)
  begin
    if rising_edge(clk) then
      x_r          <= x;
      y_r          <= y;
      behind_r(1)  <= x_negative;
      below_r(1)   <= y_negative;
      nothing_r(1) <= '0';
      if x = 0 and y = 0 then
        nothing_r(1) <= '1';
      end if;
      higher_r <= '0';
      if y > x then
        higher_r <= '1';
      end if;

      steep_r(swapped_c) <= higher_r;
      if higher_r = '1' then
        along_r(swapped_c) <= resize(y_r, 31);
        rest_r(swapped_c)  <= signed(resize(x_r, 33));
        part_r(swapped_c)  <= x_r(29 downto 8);
      else
        along_r(swapped_c) <= resize(x_r, 31);
        rest_r(swapped_c)  <= signed(resize(y_r, 33));
        part_r(swapped_c)  <= y_r(29 downto 8);
      end if;
      more_r(swapped_c) <= (others => '0');
      turn_r(swapped_c) <= (others => '0');
    end if;
  end process order;

  -- The products of the digits with a part of the smaller component follow a stage behind.
  turning : for stage in swapped_c + 1 to counted_c generate

    process (clk)
      variable rest_v : rest_t;
    begin
      if rising_edge(clk) then
        rest_v         := next_rest(rest_r(stage - 1), along_r(stage - 1));
        rest_r(stage)  <= rest_v;
        turn_r(stage)  <= turn_r(stage - 1)(turn_digits_c - 2 downto 0) & not rest_v(32);
        along_r(stage) <= along_r(stage - 1);
        part_r(stage)  <= part_r(stage - 1);
        more_r(stage)  <= more_r(stage - 1)(26 downto 0) & '0';
        if turn_r(stage - 1)(0) = '1' then
          more_r(stage) <= (more_r(stage - 1)(26 downto 0) & '0') + part_r(stage - 1);
        end if;
      end if;
    end process;

  end generate turning;

  widening : process (clk)
    variable back_v : rest_t;
  begin
    if rising_edge(clk) then
      more_r(summed_c) <= more_r(counted_c)(26 downto 0) & '0';
      if turn_r(counted_c)(0) = '1' then
        more_r(summed_c) <= (more_r(counted_c)(26 downto 0) & '0') + part_r(counted_c);
      end if;
      rest_r(summed_c)  <= rest_r(counted_c);
      along_r(summed_c) <= along_r(counted_c);
      stretch           <= to_unsigned(stretches_c(to_integer(turn_r(counted_c))), 17);
      turn              <= turn_r(counted_c);

      along_r(turned_c) <= along_r(summed_c) + (more_r(summed_c) & "00");
      back_v            := (others => '0');
      if rest_r(summed_c)(32) = '1' then
        back_v := signed("00" & std_logic_vector(along_r(summed_c)));
      end if;
      rest_r(turned_c)  <= rest_r(summed_c) + back_v;
      ratio_r(turned_c) <= (others => '0');
    end if;
  end process widening;

  dividing : for stage in turned_c + 1 to divided_c generate

    process (clk)
      variable rest_v : rest_t;
    begin
      if rising_edge(clk) then
        rest_v         := next_rest(rest_r(stage - 1), along_r(stage - 1));
        rest_r(stage)  <= rest_v;
        ratio_r(stage) <= ratio_r(stage - 1)(ratio_digits_c - 2 downto 0) & not rest_v(32);
      end if;
    end process;

  end generate dividing;

  carry : process (clk)
  begin
    if rising_edge(clk) then
      along_r(turned_c + 1 to length_clocks_c - 1)
        <= along_r(turned_c to length_clocks_c - 2);
      turn_r(summed_c to scaled_c - 1)       <= turn_r(counted_c to scaled_c - 2);
      steep_r(swapped_c + 1 to scaled_c + 1) <= steep_r(swapped_c to scaled_c);
      behind_r(2 to scaled_c + 1)            <= behind_r(1 to scaled_c);
      below_r(2 to scaled_c + 1)             <= below_r(1 to scaled_c);
      nothing_r(2 to scaled_c + 1)           <= nothing_r(1 to scaled_c);
    end if;
  end process carry;

  -- The first eight digits, squared, correct the length.
  fine      <= signed(resize(ratio_r(fine_c)(7 downto 0), 18));
  fine_next <= fine + 1;

  square : entity work.hk_product
    port map (
      clk         => clk,
      factor      => fine,
      coefficient => fine_next,
      product     => fine_square
    );

  coarse_along  <= signed(resize(along_r(fine_c + product_clocks_c)(30 downto 16), 18));
  coarse_square <= signed(resize(unsigned(fine_square(15 downto 0)), 18));

  grow : entity work.hk_product
    port map (
      clk         => clk,
      factor      => coarse_along,
      coefficient => coarse_square,
      product     => growth
    );

  -- The line that stands for the arc tangent of the ratio.
  ratio <= signed(shift_left(resize(ratio_r(divided_c), 18), 16 - ratio_digits_c));

  straight : entity work.hk_product
    port map (
      clk         => clk,
      factor      => ratio,
      coefficient => slope_c,
      product     => product
    );

  finish : process (clk)
    variable wide_v     : signed(67 downto 0);
    variable quarters_v : signed(31 downto 0);  -- whole quarter turns
    variable turns_v    : std_logic;            -- against the angle in the octant
  begin
    if rising_edge(clk) then
      length <= along_r(length_clocks_c - 1)(29 downto 0)
                + (unsigned(growth(30 downto 16)) & "000");
      if nothing_r(length_clocks_c - 1) = '1' then
        length <= (others => '0');
      end if;

      table_r  <= to_signed(angles_c(to_integer(turn_r(scaled_c - 1))), 32);
      wide_v   := resize(product, 68);
      octant_r <= table_r + wide_v(slope_fraction_bits_c + 31 downto slope_fraction_bits_c);

      quarters_v     := (others => '0');
      quarters_v(30) := steep_r(scaled_c + 1);
      quarters_v(31) := (steep_r(scaled_c + 1) and below_r(scaled_c + 1))
                        or (behind_r(scaled_c + 1) and not steep_r(scaled_c + 1));
      turns_v        := steep_r(scaled_c + 1) xor behind_r(scaled_c + 1)
                        xor below_r(scaled_c + 1);
      if turns_v = '1' then
        angle <= quarters_v - octant_r;
      else
        angle <= quarters_v + octant_r;
      end if;
      if nothing_r(scaled_c + 1) = '1' then
        angle <= (others => '0');
      end if;
    end if;
  end process finish;

end architecture rtl;
