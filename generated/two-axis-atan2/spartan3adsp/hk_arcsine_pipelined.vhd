-- Arc sine of a count over 1 g, a new one every clock: the count is squared, what is left of 1 g
-- has its root taken, and both have an angle.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.hk_complementary_pkg.all;
use work.hk_design_pkg.all;
use work.hk_polar_pkg.all;

entity hk_arcsine_pipelined is
  port (
    clk      : in  std_logic;
    rst      : in  std_logic;  -- synchronous, active high
    size     : in  unsigned(15 downto 0);  -- at most 1 g
    negative : in  std_logic;
    angle    : out signed(31 downto 0)  -- half turns
  );
end entity hk_arcsine_pipelined;

architecture rtl of hk_arcsine_pipelined is

  constant radicand_clocks_c : positive := product_clocks_c + 1;

  signal sized      : std_logic_vector(16 downto 0);  -- sign and size
  signal factor     : signed(17 downto 0);
  signal square     : signed(35 downto 0);
  signal radicand_r : unsigned(2 * root_integers_c - 1 downto 0);
  signal root       : unsigned(root_integers_c + root_fraction_bits_c - 1 downto 0);
  signal late       : std_logic_vector(16 downto 0);
  signal x          : unsigned(29 downto 0);
  signal y          : unsigned(29 downto 0);

begin

  process (clk)
  begin
    if rising_edge(clk) then
      radicand_r <= rest_of_square(resize(square, 50));
    end if;
  end process;

  sized  <= negative & std_logic_vector(size);
  factor <= signed(resize(size, 18));

  squaring : entity work.hk_product
    port map (
      clk         => clk,
      factor      => factor,
      coefficient => factor,
      product     => square
    );

  square_root : entity work.hk_root_pipelined
    generic map (
      INTEGER_BITS  => root_integers_c,
      FRACTION_BITS => root_fraction_bits_c
    )
    port map (
      clk      => clk,
      radicand => radicand_r,
      root     => root
    );

  beside_root : entity work.hk_delay
    generic map (
      BITS   => 17,
      CLOCKS => radicand_clocks_c + root_integers_c + root_fraction_bits_c
    )
    port map (
      clk      => clk,
      rst      => rst,
      in_data  => sized,
      out_data => late
    );

  x <= shift_left(resize(root, 30), guard_bits_c - root_fraction_bits_c);
  y <= shift_left(resize(unsigned(late(15 downto 0)), 30), guard_bits_c);

  arctan : entity work.hk_arctan_pipelined
    port map (
      clk        => clk,
      x          => x,
      y          => y,
      x_negative => '0',
      y_negative => late(16),
      stretch    => open,
      turn       => open,
      length     => open,
      angle      => angle
    );

end architecture rtl;
