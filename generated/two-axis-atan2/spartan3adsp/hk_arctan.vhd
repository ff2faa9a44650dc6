-- Arc tangent and length of a vector. The first digits of the smaller component over the larger one
-- choose a turn from a table, and what they leave lies across the vector that is turned by it; the
-- digits of that give the rest of the angle. One digit a clock; the result is there turn_digits_c +
-- ratio_digits_c + 3 clocks after the vector was taken. A zero vector gives zero and zero.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.hk_design_pkg.all;

entity hk_arctan is
  port (
    clk        : in  std_logic;
    rst        : in  std_logic;  -- synchronous, active high
    in_valid   : in  std_logic;
    in_ready   : out std_logic;
    x          : in  unsigned(29 downto 0);  -- sizes, with guard bits
    y          : in  unsigned(29 downto 0);
    x_negative : in  std_logic;
    y_negative : in  std_logic;
    out_valid  : out std_logic;
    out_ready  : in  std_logic;
    angle      : out signed(31 downto 0);    -- half turns, wraps at +-pi
    length     : out unsigned(29 downto 0);  -- times 1 + stretch / 2**stretch_fraction_bits_c
    stretch    : out signed(17 downto 0)     -- there when the first digits are
  );
end entity hk_arctan;

architecture rtl of hk_arctan is

  type state_t is (
    idle,
    turning,   -- the digits of the turn
    widening,  -- turn the larger component
    dividing,  -- the digits of the ratio
    scaling,   -- multiply the ratio by the slope
    folding,   -- out of the first octant
    finished
  );
  signal state_r : state_t;

  signal multiply_r    : std_logic;
  signal factor_r      : signed(31 downto 0);
  signal coefficient_r : signed(17 downto 0);
  signal product       : signed(49 downto 0);

begin

  in_ready  <= '1' when state_r = idle else '0';
  out_valid <= '1' when state_r = finished else '0';

  process (clk)
    variable along_v    : unsigned(30 downto 0);  -- the larger component, then turned
    variable part_v     : unsigned(21 downto 0);  -- of the smaller component
    variable more_v     : unsigned(27 downto 0);  -- turn times that part
    variable rest_v     : unsigned(31 downto 0);
    variable trial_v    : unsigned(32 downto 0);
    variable digits_v   : unsigned(ratio_digits_c - 1 downto 0);
    variable count_v    : unsigned(3 downto 0);
    variable turn_v     : unsigned(turn_digits_c - 1 downto 0);
    variable steep_v    : std_logic;
    variable behind_v   : std_logic;
    variable below_v    : std_logic;
    variable nothing_v  : boolean;
    variable octant_v   : signed(31 downto 0);
    variable quarters_v : signed(31 downto 0);  -- whole quarter turns
  begin
    if rising_edge(clk) then
      multiply_r <= '0';

      if state_r = idle then
        if in_valid = '1' then
          nothing_v := x = 0 and y = 0;
          behind_v  := x_negative;
          below_v   := y_negative;
          steep_v   := '0';
          along_v   := resize(x, 31);
          rest_v    := resize(y, 32);
          if y > x then
            steep_v := '1';
            along_v := resize(y, 31);
            rest_v  := resize(x, 32);
          end if;
          part_v  := rest_v(29 downto 8);
          more_v  := (others => '0');
          count_v := (others => '0');
          state_r <= turning;
        end if;

      elsif state_r = turning or state_r = dividing then
        rest_v   := rest_v(30 downto 0) & '0';
        trial_v  := ('0' & rest_v) - ("00" & along_v);
        digits_v := digits_v(ratio_digits_c - 2 downto 0) & not trial_v(32);
        count_v  := count_v + 1;
        if trial_v(32) = '0' then
          rest_v := trial_v(31 downto 0);
        end if;
        if state_r = turning then
          more_v := more_v(26 downto 0) & '0';
          if trial_v(32) = '0' then
            more_v := more_v + part_v;
          end if;
          if count_v = turn_digits_c then
            state_r <= widening;
          end if;
        else
          -- The first eight digits, squared, correct the length while the others are made.
          if count_v = 8 then
            factor_r      <= signed(resize(digits_v(7 downto 0), 32));
            coefficient_r <= signed(resize(digits_v(7 downto 0), 18)) + 1;
            multiply_r    <= '1';
          end if;
          if count_v = 10 then
            factor_r      <= signed(resize(along_v(30 downto 16), 32));
            coefficient_r <= signed(resize(unsigned(product(15 downto 0)), 18));
            multiply_r    <= '1';
          end if;
          if count_v = ratio_digits_c then
            length <= along_v(29 downto 0)
                      + (unsigned(product(30 downto 16)) & "000");
            if nothing_v then
              length <= (others => '0');
            end if;
            factor_r      <= signed(shift_left(resize(digits_v, 32), 16 - ratio_digits_c));
            coefficient_r <= slope_c;
            multiply_r    <= '1';
            state_r       <= scaling;
          end if;
        end if;

      elsif state_r = widening then
        turn_v  := digits_v(turn_digits_c - 1 downto 0);
        along_v := along_v + (more_v & "00");
        stretch <= to_signed(stretches_c(to_integer(turn_v)), 18);
        count_v := (others => '0');
        state_r <= dividing;

      elsif state_r = scaling then
        state_r <= folding;

      elsif state_r = folding then
        octant_v := to_signed(angles_c(to_integer(turn_v)), 32)
                    + product(slope_fraction_bits_c + 31 downto slope_fraction_bits_c);
        quarters_v     := (others => '0');
        quarters_v(30) := steep_v;
        quarters_v(31) := (steep_v and below_v) or (behind_v and not steep_v);
        if (steep_v xor behind_v xor below_v) = '1' then
          angle <= quarters_v - octant_v;
        else
          angle <= quarters_v + octant_v;
        end if;
        if nothing_v then
          angle <= (others => '0');
        end if;
        state_r <= finished;

      else
        if out_ready = '1' then
          state_r <= idle;
        end if;
      end if;

      if rst = '1' then
        multiply_r <= '0';
        state_r    <= idle;
      end if;
    end if;
  end process;

  multiplier : entity work.hk_multiplier
    port map (
      clk         => clk,
      enable      => multiply_r,
      factor      => factor_r,
      coefficient => coefficient_r,
      product     => product
    );

end architecture rtl;
