-- One product of 18 x 18 bits, one DSP48A, a new one every clock. Operands and product have two
-- registers each, as many as a DSP48A holds: where a device has them in its fabric, the outer ones
-- give the way to the multiplier and from it a clock of its own.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

entity hk_product is
  port (
    clk         : in  std_logic;
    factor      : in  signed(17 downto 0);
    coefficient : in  signed(17 downto 0);
    product     : out signed(35 downto 0)
  );
end entity hk_product;

architecture rtl of hk_product is

  signal factor_1_r      : signed(17 downto 0);
  signal factor_2_r      : signed(17 downto 0);
  signal coefficient_1_r : signed(17 downto 0);
  signal coefficient_2_r : signed(17 downto 0);
  signal product_r       : signed(35 downto 0);

begin

  process (clk)
  begin
    if rising_edge(clk) then
      factor_1_r      <= factor;
      factor_2_r      <= factor_1_r;
      coefficient_1_r <= coefficient;
      coefficient_2_r <= coefficient_1_r;
      product_r       <= factor_2_r * coefficient_2_r;
      product         <= product_r;
    end if;
  end process;

end architecture rtl;
