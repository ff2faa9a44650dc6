-- Whether the specific force corrects: the sum of its squared counts lies within two bounds,
-- included. A new answer every clock, gate_clocks_c after the counts.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

entity hk_gate_pipelined is
  port (
    clk      : in  std_logic;
    lowest   : in  unsigned(31 downto 0);
    highest  : in  unsigned(31 downto 0);
    accel_x  : in  signed(15 downto 0);
    accel_y  : in  signed(15 downto 0);
    accel_z  : in  signed(15 downto 0);
    corrects : out std_logic
  );
end entity hk_gate_pipelined;

architecture rtl of hk_gate_pipelined is

  signal x_factor : signed(17 downto 0);
  signal y_factor : signed(17 downto 0);
  signal z_factor : signed(17 downto 0);
  signal x_square : signed(35 downto 0);
  signal y_square : signed(35 downto 0);
  signal z_square : signed(35 downto 0);

  signal two_r    : unsigned(31 downto 0);
  signal third_r  : unsigned(31 downto 0);
  signal square_r : unsigned(31 downto 0);  -- at most 3 * 2**30
  signal above_r  : std_logic;
  signal below_r  : std_logic;

begin

  x_factor <= resize(accel_x, 18);
  y_factor <= resize(accel_y, 18);
  z_factor <= resize(accel_z, 18);

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

  z_squared : entity work.hk_product
    port map (
      clk         => clk,
      factor      => z_factor,
      coefficient => z_factor,
      product     => z_square
    );

  process (clk)
  begin
    if rising_edge(clk) then
      two_r    <= unsigned(x_square(31 downto 0)) + unsigned(y_square(31 downto 0));
      third_r  <= unsigned(z_square(31 downto 0));
      square_r <= two_r + third_r;
      above_r  <= '0';
      if square_r >= lowest then
        above_r <= '1';
      end if;
      below_r <= '0';
      if square_r <= highest then
        below_r <= '1';
      end if;
      corrects <= above_r and below_r;
    end if;
  end process;

end architecture rtl;
