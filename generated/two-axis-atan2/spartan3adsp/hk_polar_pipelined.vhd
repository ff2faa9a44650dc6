-- Angle and magnitude of a vector, or the arc sine of y / x, a new one every clock. Nothing stops
-- the pipeline; results wait in a queue, and a vector is taken only if there is room for its
-- result.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.hk_design_pkg.all;
use work.hk_polar_pkg.all;

entity hk_polar_pipelined is
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
end entity hk_polar_pipelined;

architecture rtl of hk_polar_pipelined is

  -- Clocks after which something is there.
  constant sized_c      : positive := 3;
  constant radicand_c   : positive := sized_c + product_clocks_c + 1;
  constant rooted_c     : positive := radicand_c + polar_root_bits_c;
  constant chosen_c     : positive := rooted_c + 1;
  constant stretched_c  : positive := chosen_c + stretch_clocks_c;
  constant lengthened_c : positive := chosen_c + length_clocks_c;
  constant folded_c     : positive := chosen_c + arctan_clocks_c;
  constant finished_c   : positive := lengthened_c + multiplier_clocks_c + 1;

  constant result_bits_c : positive := ID_BITS + 62;

  signal taken    : std_logic;
  signal room     : std_logic;
  signal valid_r  : std_logic_vector(1 to finished_c);
  signal late_id  : std_logic_vector(ID_BITS - 1 downto 0);

  -- After one, two and three clocks.
  signal x_size_1_r  : unsigned(16 downto 0);
  signal y_size_1_r  : unsigned(16 downto 0);
  signal x_size_2_r  : unsigned(15 downto 0);
  signal y_size_2_r  : unsigned(15 downto 0);
  signal x_size_3_r  : unsigned(15 downto 0);
  signal y_size_3_r  : unsigned(15 downto 0);
  signal arcsine_r   : std_logic_vector(1 to sized_c);
  signal x_below_r   : std_logic_vector(1 to sized_c);
  signal y_below_r   : std_logic_vector(1 to sized_c);

  signal x_factor   : signed(17 downto 0);
  signal y_factor   : signed(17 downto 0);
  signal x_square   : signed(35 downto 0);
  signal y_square   : signed(35 downto 0);
  signal radicand_r : unsigned(2 * polar_root_integers_c - 1 downto 0);
  signal root       : unsigned(polar_root_bits_c - 1 downto 0);

  signal sized : std_logic_vector(34 downto 0);  -- arc sine, signs and sizes of x and y
  signal late  : std_logic_vector(34 downto 0);

  signal x_r       : unsigned(29 downto 0);
  signal y_r       : unsigned(29 downto 0);
  signal behind_r  : std_logic;
  signal below_r   : std_logic;
  signal turn      : unsigned(turn_digits_c - 1 downto 0);
  signal late_turn : std_logic_vector(turn_digits_c - 1 downto 0);
  signal length    : unsigned(29 downto 0);

  signal shrink_r      : signed(17 downto 0);
  signal length_factor : signed(31 downto 0);
  signal shrunk        : signed(49 downto 0);
  signal long          : std_logic_vector(29 downto 0);
  signal late_length   : std_logic_vector(29 downto 0);
  signal magnitude_r   : unsigned(29 downto 0);
  signal folded        : signed(31 downto 0);
  signal late_folded   : std_logic_vector(31 downto 0);

  signal result   : std_logic_vector(result_bits_c - 1 downto 0);
  signal out_data : std_logic_vector(result_bits_c - 1 downto 0);

begin

  in_ready <= room;
  taken    <= in_valid and room;

  valid : process (clk)
  begin
    if rising_edge(clk) then
      valid_r <= taken & valid_r(1 to finished_c - 1);
      if rst = '1' then
        valid_r <= (others => '0');
      end if;
    end if;
  end process valid;

  sizes : process (clk)
  begin
    if rising_edge(clk) then
      x_size_1_r   <= polar_size(x);
      y_size_1_r   <= polar_size(y);
      x_below_r    <= x(16) & x_below_r(1 to sized_c - 1);
      y_below_r    <= y(16) & y_below_r(1 to sized_c - 1);
      arcsine_r    <= arcsine & arcsine_r(1 to sized_c - 1);

      x_size_2_r <= polar_limited(x_size_1_r, arcsine_r(1));
      y_size_2_r <= polar_limited(y_size_1_r, arcsine_r(1));

      x_size_3_r <= x_size_2_r;
      y_size_3_r <= y_size_2_r;
      if arcsine_r(2) = '1' and y_size_2_r > x_size_2_r then
        y_size_3_r <= x_size_2_r;
      end if;

      radicand_r <= unsigned(x_square(2 * polar_root_integers_c - 1 downto 0))
                    - unsigned(y_square(2 * polar_root_integers_c - 1 downto 0));
    end if;
  end process sizes;

  x_factor <= signed(resize(x_size_3_r, 18));
  y_factor <= signed(resize(y_size_3_r, 18));

  x_squared : entity work.hk_product
    port map (
      clk         => clk,
      factor      => x_factor,
      coefficient => x_factor,
      product     => x_square
    );

  y_squared : entity work.hk_product
    port map (
      clk         => clk,
      factor      => y_factor,
      coefficient => y_factor,
      product     => y_square
    );

  square_root : entity work.hk_root_pipelined
    generic map (
      INTEGER_BITS  => polar_root_integers_c,
      FRACTION_BITS => root_fraction_bits_c
    )
    port map (
      clk      => clk,
      radicand => radicand_r,
      root     => root
    );

  sized <= arcsine_r(sized_c) & x_below_r(sized_c) & y_below_r(sized_c)
           & std_logic_vector(x_size_3_r) & std_logic_vector(y_size_3_r);

  beside_the_root : entity work.hk_delay
    generic map (
      BITS   => 35,
      CLOCKS => rooted_c - sized_c
    )
    port map (
      clk      => clk,
      rst      => rst,
      in_data  => sized,
      out_data => late
    );

  choose : process (clk)
  begin
    if rising_edge(clk) then
      y_r      <= shift_left(resize(unsigned(late(15 downto 0)), 30), guard_bits_c);
      below_r  <= late(32);
      x_r      <= shift_left(resize(unsigned(late(31 downto 16)), 30), guard_bits_c);
      behind_r <= late(33);
      if late(34) = '1' then
        x_r      <= shift_left(resize(root, 30), guard_bits_c - root_fraction_bits_c);
        behind_r <= '0';
      end if;
    end if;
  end process choose;

  arctan : entity work.hk_arctan_pipelined
    port map (
      clk        => clk,
      x          => x_r,
      y          => y_r,
      x_negative => behind_r,
      y_negative => below_r,
      stretch    => open,
      turn       => turn,
      length     => length,
      angle      => folded
    );

  beside_the_length : entity work.hk_delay
    generic map (
      BITS   => turn_digits_c,
      CLOCKS => lengthened_c - 1 - stretched_c
    )
    port map (
      clk      => clk,
      rst      => rst,
      in_data  => std_logic_vector(turn),
      out_data => late_turn
    );

  length_factor <= signed(resize(length, 32));
  long          <= std_logic_vector(length);

  shrinking : entity work.hk_multiplier_pipelined
    port map (
      clk         => clk,
      factor      => length_factor,
      coefficient => shrink_r,
      product     => shrunk
    );

  beside_the_product : entity work.hk_delay
    generic map (
      BITS   => 30,
      CLOCKS => multiplier_clocks_c
    )
    port map (
      clk      => clk,
      rst      => rst,
      in_data  => long,
      out_data => late_length
    );

  shrink : process (clk)
  begin
    if rising_edge(clk) then
      shrink_r    <= to_signed(shrinks_c(to_integer(unsigned(late_turn))), 18);
      magnitude_r <= unsigned(late_length)
                     - unsigned(shrunk(stretch_fraction_bits_c + 29
                                       downto stretch_fraction_bits_c));
    end if;
  end process shrink;

  beside_magnitude : entity work.hk_delay
    generic map (
      BITS   => 32,
      CLOCKS => finished_c - folded_c
    )
    port map (
      clk      => clk,
      rst      => rst,
      in_data  => std_logic_vector(folded),
      out_data => late_folded
    );

  beside_all : entity work.hk_delay
    generic map (
      BITS   => ID_BITS,
      CLOCKS => finished_c
    )
    port map (
      clk      => clk,
      rst      => rst,
      in_data  => std_logic_vector(in_id),
      out_data => late_id
    );

  result <= late_id & std_logic_vector(magnitude_r) & late_folded;

  queue : entity work.hk_result_queue
    generic map (
      BITS         => result_bits_c,
      ADDRESS_BITS => 7
    )
    port map (
      clk       => clk,
      rst       => rst,
      taken     => taken,
      room      => room,
      busy      => open,
      in_valid  => valid_r(finished_c),
      in_data   => result,
      out_valid => out_valid,
      out_ready => out_ready,
      out_data  => out_data
    );

  angle     <= signed(out_data(31 downto 0));
  magnitude <= unsigned(out_data(61 downto 32));
  out_id    <= unsigned(out_data(result_bits_c - 1 downto 62));

end architecture rtl;
