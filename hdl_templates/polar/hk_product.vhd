-- One product of 18 x 18 bits, one DSP48A: operands and product are registered, so a product is there
-- two clocks after its operands, and there is a new one every clock.
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

  signal factor_r      : signed(17 downto 0);
  signal coefficient_r : signed(17 downto 0);

begin

  process (clk)
  begin
    if rising_edge(clk) then
      factor_r      <= factor;
      coefficient_r <= coefficient;
      product       <= factor_r * coefficient_r;
    end if;
  end process;

end architecture rtl;
