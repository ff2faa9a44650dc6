-- The one multiplier of the core: 32 x 18 bits, two DSP48A. The operands come from registers of the
-- caller; the product is registered here and holds until the next multiplication.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

entity hk_multiplier is
  port (
    clk         : in  std_logic;
    enable      : in  std_logic;
    factor      : in  signed(31 downto 0);
    coefficient : in  signed(17 downto 0);
    product     : out signed(49 downto 0)
  );
end entity hk_multiplier;

architecture rtl of hk_multiplier is
begin

  process (clk)
  begin
    if rising_edge(clk) then
      if enable = '1' then
        product <= factor * coefficient;
      end if;
    end if;
  end process;

end architecture rtl;
