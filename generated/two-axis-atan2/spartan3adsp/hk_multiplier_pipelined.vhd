-- 32 x 18 bits, a new product every clock, each multiplier_clocks_c clocks after its operands: the
-- operands, the products of the two parts of the factor, and their sum are registered.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

entity hk_multiplier_pipelined is
  port (
    clk         : in  std_logic;
    factor      : in  signed(31 downto 0);
    coefficient : in  signed(17 downto 0);
    product     : out signed(49 downto 0)
  );
end entity hk_multiplier_pipelined;

architecture rtl of hk_multiplier_pipelined is

  signal low_factor   : signed(17 downto 0);
  signal high_factor  : signed(17 downto 0);
  signal low_product  : signed(35 downto 0);
  signal high_product : signed(35 downto 0);

begin

  low_factor  <= signed('0' & std_logic_vector(factor(16 downto 0)));
  high_factor <= resize(factor(31 downto 17), 18);

  low_part : entity work.hk_product
    port map (
      clk         => clk,
      factor      => low_factor,
      coefficient => coefficient,
      product     => low_product
    );

  high_part : entity work.hk_product
    port map (
      clk         => clk,
      factor      => high_factor,
      coefficient => coefficient,
      product     => high_product
    );

  process (clk)
  begin
    if rising_edge(clk) then
      product(16 downto 0)  <= low_product(16 downto 0);
      product(49 downto 17) <= high_product(32 downto 0) + low_product(35 downto 17);
    end if;
  end process;

end architecture rtl;
