-- Angle and magnitude of a vector, or the arc sine of y / x, one at a time, a digit a clock, with
-- one multiplier.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.hk_design_pkg.all;
use work.hk_polar_pkg.all;

entity hk_polar_iterative is
  generic (
    ID_BITS : positive
  );
  port (
    clk       : in  std_logic;
    rst       : in  std_logic;  -- synchronous, active high
    in_valid  : in  std_logic;
    in_ready  : out std_logic;
    in_id     : in  unsigned(ID_BITS - 1 downto 0);
    arcsine   : in  std_logic;
    x         : in  signed(16 downto 0);
    y         : in  signed(16 downto 0);
    out_valid : out std_logic;
    out_ready : in  std_logic;
    out_id    : out unsigned(ID_BITS - 1 downto 0);
    angle     : out signed(31 downto 0);
    magnitude : out unsigned(29 downto 0)
  );
end entity hk_polar_iterative;

architecture rtl of hk_polar_iterative is

  type state_t is (
    idle,
    limiting,
    clamping,   -- from here to rooting: arc sine only
    squaring,   -- two operands, then two squares
    rooting,
    turning,    -- the arc tangent
    shrinking,  -- the stretch is taken off the length
    finished
  );
  signal state_r : state_t;
  signal step_r  : unsigned(1 downto 0);

  signal id_r       : unsigned(ID_BITS - 1 downto 0);
  signal arcsine_r  : std_logic;
  signal behind_r   : std_logic;
  signal below_r    : std_logic;
  signal x_r        : unsigned(16 downto 0);  -- sizes
  signal y_r        : unsigned(16 downto 0);
  signal square_r   : unsigned(2 * polar_root_integers_c - 1 downto 0);

  signal root_start_r : std_logic;
  signal root_done    : std_logic;
  signal root_taken   : std_logic;
  signal root         : unsigned(polar_root_bits_c - 1 downto 0);

  signal arctan_start : std_logic;
  signal arctan_done  : std_logic;
  signal started_r    : std_logic;
  signal arctan_x     : unsigned(29 downto 0);
  signal no_turn      : signed(31 downto 0);
  signal no_count     : unsigned(15 downto 0);
  signal length       : unsigned(29 downto 0);
  signal turn         : unsigned(turn_digits_c - 1 downto 0);

  signal arctan_multiply    : std_logic;
  signal arctan_factor      : signed(30 downto 0);
  signal arctan_coefficient : signed(17 downto 0);
  signal multiply_r         : std_logic;
  signal factor_r           : signed(31 downto 0);
  signal coefficient_r      : signed(17 downto 0);
  signal product            : signed(49 downto 0);

begin

  in_ready  <= '1' when state_r = idle else '0';
  out_valid <= '1' when state_r = finished else '0';
  out_id    <= id_r;

  main : process (clk)
  begin
    if rising_edge(clk) then
      factor_r      <= resize(arctan_factor, 32);
      coefficient_r <= arctan_coefficient;
      multiply_r    <= arctan_multiply;

      if state_r = idle then
        step_r    <= (others => '0');
        started_r <= '0';
        id_r      <= in_id;
        arcsine_r <= arcsine;
        behind_r  <= x(16) and not arcsine;
        below_r   <= y(16);
        x_r       <= polar_size(x);
        y_r       <= polar_size(y);
        if in_valid = '1' then
          state_r <= limiting;
        end if;

      elsif state_r = limiting then
        x_r     <= '0' & polar_limited(x_r, arcsine_r);
        y_r     <= '0' & polar_limited(y_r, arcsine_r);
        state_r <= turning;
        if arcsine_r = '1' then
          state_r <= clamping;
        end if;

      elsif state_r = clamping then
        if y_r > x_r then
          y_r <= x_r;
        end if;
        state_r <= squaring;

      elsif state_r = squaring then
        if step_r = 0 then
          factor_r      <= signed(resize(x_r, 32));
          coefficient_r <= signed(resize(x_r, 18));
          multiply_r    <= '1';
        elsif step_r = 1 then
          factor_r      <= signed(resize(y_r, 32));
          coefficient_r <= signed(resize(y_r, 18));
          multiply_r    <= '1';
        elsif step_r = 2 then
          square_r <= unsigned(product(2 * polar_root_integers_c - 1 downto 0));
        else
          square_r     <= square_r - unsigned(product(2 * polar_root_integers_c - 1 downto 0));
          root_start_r <= '1';
          state_r      <= rooting;
        end if;
        step_r <= step_r + 1;

      elsif state_r = rooting then
        root_start_r <= '0';
        if root_done = '1' then
          state_r <= turning;
        end if;

      elsif state_r = turning then
        started_r <= '1';
        if arctan_done = '1' then
          factor_r      <= signed(resize(length, 32));
          coefficient_r <= to_signed(shrinks_c(to_integer(turn)), 18);
          multiply_r    <= '1';
          state_r       <= shrinking;
        end if;

      elsif state_r = shrinking then
        step_r  <= "01";
        if step_r = 1 then
          magnitude <= length - unsigned(product(stretch_fraction_bits_c + 29
                                                 downto stretch_fraction_bits_c));
          state_r   <= finished;
        end if;

      else
        if out_ready = '1' then
          state_r <= idle;
        end if;
      end if;

      if rst = '1' then
        root_start_r <= '0';
        multiply_r   <= '0';
        state_r      <= idle;
      end if;
    end if;
  end process main;

  multiplier : entity work.hk_multiplier
    port map (
      clk         => clk,
      enable      => multiply_r,
      factor      => factor_r,
      coefficient => coefficient_r,
      product     => product
    );

  -- The root holds until the next one is asked for.
  root_taken <= '1' when state_r = rooting else '0';

  square_root : entity work.hk_root
    generic map (
      INTEGER_BITS  => polar_root_integers_c,
      FRACTION_BITS => root_fraction_bits_c
    )
    port map (
      clk       => clk,
      rst       => rst,
      in_valid  => root_start_r,
      in_ready  => open,
      radicand  => square_r,
      out_valid => root_done,
      out_ready => root_taken,
      root      => root
    );

  arctan_start <= not started_r when state_r = turning else '0';
  arctan_x     <= shift_left(resize(root, 30), guard_bits_c - root_fraction_bits_c)
                  when arcsine_r = '1'
                  else shift_left(resize(x_r, 30), guard_bits_c);
  no_turn      <= (others => '0');
  no_count     <= (others => '0');

  angles : entity work.hk_arctan
    port map (
      clk             => clk,
      rst             => rst,
      in_valid        => arctan_start,
      in_ready        => open,
      x               => arctan_x,
      y               => y_r(15 downto 0),
      x_negative      => behind_r,
      y_negative      => below_r,
      second          => '0',
      y_second        => no_count,
      second_negative => '0',
      zero            => no_turn,
      out_valid       => arctan_done,
      angle           => angle,
      length          => length,
      stretch         => open,
      turn            => turn,
      multiply        => arctan_multiply,
      factor          => arctan_factor,
      coefficient     => arctan_coefficient,
      product         => product
    );

end architecture rtl;
