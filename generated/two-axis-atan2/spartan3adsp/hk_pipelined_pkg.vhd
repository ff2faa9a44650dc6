-- Timing of the pipelined filter, in clocks after a sample has entered the pipeline.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.hk_complementary_design_pkg.all;
use work.hk_design_pkg.all;
use work.hk_polar_pkg.all;

package hk_pipelined_pkg is

  -- The measured tilt of both axes is there.
  function tilt_clocks return positive;

  -- The sum of the gate has been compared.
  constant gate_clocks_c : positive := product_clocks_c + 4;

  -- What the feedback adds: the result is there, and after how many clocks a sample of the same
  -- channel may follow.
  function loop_clocks return positive;
  function channel_clocks return positive;

end package hk_pipelined_pkg;

package body hk_pipelined_pkg is

  function tilt_clocks return positive is
  begin
    if uses_arcsin_c then
      -- Counts, sizes, the square, what is left of 1 g, its root, the arc tangent.
      return 2 + product_clocks_c + 1 + polar_root_bits_c + arctan_clocks_c;
    elsif has_pitch_c then
      return 2 + length_clocks_c + arctan_clocks_c;
    end if;
    return 2 + arctan_clocks_c;
  end function tilt_clocks;

  function loop_clocks return positive is
  begin
    if has_integral_c then
      return multiplier_clocks_c + 5;
    end if;
    return multiplier_clocks_c + 3;
  end function loop_clocks;

  function channel_clocks return positive is
  begin
    -- The state is read after one clock, and a write of it is seen a clock later.
    return loop_clocks + 1;
  end function channel_clocks;

end package body hk_pipelined_pkg;
