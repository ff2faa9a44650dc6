-- Vectoring CORDIC: rotates (x, y) onto the positive x axis, one step a clock. The result is there
-- cordic_steps_c clocks after the vector was taken. A zero vector gives zero and zero.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.hk_common_pkg.all;
use work.hk_design_pkg.all;

entity hk_cordic is
  port (
    clk       : in  std_logic;
    rst       : in  std_logic;  -- synchronous, active high
    in_valid  : in  std_logic;
    in_ready  : out std_logic;
    x         : in  signed(31 downto 0);  -- with guard bits
    y         : in  signed(31 downto 0);
    out_valid : out std_logic;
    out_ready : in  std_logic;
    angle     : out signed(31 downto 0);  -- half turns, wraps at +-pi
    magnitude : out signed(31 downto 0)   -- length times the gain of the CORDIC
  );
end entity hk_cordic;

architecture rtl of hk_cordic is

  constant half_turn_c : signed(31 downto 0) := x"80000000";

  type state_t is (idle, rotating, finished);
  signal state_r : state_t;

begin

  in_ready  <= '1' when state_r = idle else '0';
  out_valid <= '1' when state_r = finished else '0';

  process (clk)
    variable x_v, y_v           : signed(31 downto 0);
    variable x_part_v, y_part_v : signed(31 downto 0);
    variable angle_v, turn_v    : signed(31 downto 0);
    variable step_v             : unsigned(4 downto 0);
    variable nothing_v          : boolean;
  begin
    if rising_edge(clk) then
      if state_r = idle then
        if in_valid = '1' then
          nothing_v := x = 0 and y = 0;
          x_v       := x;
          y_v       := y;
          angle_v   := (others => '0');
          if x(31) = '1' then
            x_v     := -x;
            y_v     := -y;
            angle_v := half_turn_c;
          end if;
          step_v  := (others => '0');
          state_r <= rotating;
        end if;
      elsif state_r = rotating then
        x_part_v := shifted_right(x_v, step_v);
        y_part_v := shifted_right(y_v, step_v);
        turn_v   := cordic_angles_c(to_integer(step_v));
        if y_v(31) = '0' then
          x_v     := x_v + y_part_v;
          y_v     := y_v - x_part_v;
          angle_v := angle_v + turn_v;
        else
          x_v     := x_v - y_part_v;
          y_v     := y_v + x_part_v;
          angle_v := angle_v - turn_v;
        end if;
        if step_v = cordic_steps_c - 1 then
          angle <= angle_v;
          if nothing_v then
            angle <= (others => '0');
          end if;
          magnitude <= x_v;
          state_r   <= finished;
        end if;
        step_v := step_v + 1;
      else
        if out_ready = '1' then
          state_r <= idle;
        end if;
      end if;
      if rst = '1' then
        state_r <= idle;
      end if;
    end if;
  end process;

end architecture rtl;
