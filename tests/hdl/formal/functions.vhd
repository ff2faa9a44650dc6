-- The functions of the filter behind ports, so that a tool can prove things about them.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.hk_common_pkg.all;
use work.hk_complementary_design_pkg.all;
use work.hk_complementary_pkg.all;
use work.hk_design_pkg.all;

entity functions is
  generic (
    BITS            : positive := 17;  -- dropped by the rounding
    LIMIT           : positive := 16384;
    DIFFERENCE_BITS : positive := 12;
    BLEND_BITS      : positive := 8  -- fraction bits of the blend, which is 0 .. 1
  );
  port (
    product    : in  signed(49 downto 0);
    rounded    : out signed(31 downto 0);
    count      : in  signed(16 downto 0);
    inside     : out signed(16 downto 0);
    size       : out unsigned(15 downto 0);
    bias       : in  signed(31 downto 0);
    kept       : out signed(31 downto 0);
    highest    : out signed(31 downto 0);
    difference : in  signed(DIFFERENCE_BITS - 1 downto 0);
    blend      : in  signed(BLEND_BITS + 1 downto 0);
    correction : out signed(31 downto 0)
  );
end entity functions;

architecture rtl of functions is
  signal step : signed(DIFFERENCE_BITS + BLEND_BITS + 1 downto 0);
begin

  rounded    <= shift_rounded(product, BITS);
  inside     <= clamped(count, LIMIT);
  size       <= size_of(count);
  kept       <= limited(bias);
  highest    <= bias_limit_c;
  step       <= difference * blend;
  correction <= shift_rounded(resize(step, 50), BLEND_BITS);

end architecture rtl;
