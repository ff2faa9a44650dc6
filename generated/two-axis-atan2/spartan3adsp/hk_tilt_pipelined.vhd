-- Roll and pitch from specific force, new ones every clock, tilt_clocks after the counts. Both
-- methods; an axis that the design lacks gives 0.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.hk_common_pkg.all;
use work.hk_complementary_design_pkg.all;
use work.hk_complementary_pkg.all;
use work.hk_design_pkg.all;
use work.hk_polar_pkg.all;

entity hk_tilt_pipelined is
  port (
    clk         : in  std_logic;
    rst         : in  std_logic;  -- synchronous, active high
    accel_x     : in  signed(15 downto 0);
    accel_y     : in  signed(15 downto 0);
    accel_z     : in  signed(15 downto 0);
    force_roll  : out signed(31 downto 0);  -- half turns
    force_pitch : out signed(31 downto 0)
  );
end entity hk_tilt_pipelined;

architecture rtl of hk_tilt_pipelined is

  -- Components of specific force; the angles rise with side and back.
  signal side_r : signed(16 downto 0);
  signal back_r : signed(16 downto 0);
  signal up_r   : signed(16 downto 0);

  signal roll_size_r      : unsigned(15 downto 0);
  signal roll_negative_r  : std_logic;
  signal pitch_size_r     : unsigned(15 downto 0);
  signal pitch_negative_r : std_logic;
  signal z_size_r         : unsigned(15 downto 0);
  signal z_negative_r     : std_logic;

begin

  counts : process (clk)
  begin
    if rising_edge(clk) then
      side_r <= body_count(body_y_c, accel_x, accel_y, accel_z);
      back_r <= -body_count(body_x_c, accel_x, accel_y, accel_z);
      up_r   <= body_count(body_z_c, accel_x, accel_y, accel_z);

      roll_size_r      <= tilt_size(side_r);
      roll_negative_r  <= side_r(16);
      pitch_size_r     <= tilt_size(back_r);
      pitch_negative_r <= back_r(16);
      z_size_r         <= size_of(up_r);
      z_negative_r     <= up_r(16);
    end if;
  end process counts;

  from_two : if not uses_arcsin_c generate

    signal x     : unsigned(29 downto 0);
    signal y     : unsigned(29 downto 0);
    signal angle : signed(31 downto 0);

    signal stretch : unsigned(16 downto 0);
    signal length  : unsigned(29 downto 0);

  begin

    x <= shift_left(resize(z_size_r, 30), guard_bits_c);
    y <= shift_left(resize(roll_size_r, 30), guard_bits_c);

    first : entity work.hk_arctan_pipelined
      port map (
        clk        => clk,
        x          => x,
        y          => y,
        x_negative => z_negative_r,
        y_negative => roll_negative_r,
        stretch    => stretch,
        turn       => open,
        length     => length,
        angle      => angle
      );

    without_pitch : if not has_pitch_c generate
      force_roll  <= angle;
      force_pitch <= (others => '0');
    end generate without_pitch;

    with_pitch : if has_pitch_c generate

      -- Clocks from where its operands are.
      constant stretched_c : positive := product_clocks_c + 1;
      constant waits_c     : positive := length_clocks_c - stretch_clocks_c - stretched_c;

      signal sized          : std_logic_vector(16 downto 0);
      signal at_stretch     : std_logic_vector(16 downto 0);
      signal at_product     : std_logic_vector(16 downto 0);
      signal size_factor    : signed(17 downto 0);
      signal stretch_factor : signed(17 downto 0);
      signal product        : signed(35 downto 0);
      signal stretched_r    : std_logic_vector(30 downto 0);
      signal at_length      : std_logic_vector(30 downto 0);
      signal pitch_y        : unsigned(29 downto 0);
      signal late_roll      : std_logic_vector(31 downto 0);

    begin

      sized <= pitch_negative_r & std_logic_vector(pitch_size_r);

      beside_turn : entity work.hk_delay
        generic map (
          BITS   => 17,
          CLOCKS => stretch_clocks_c
        )
        port map (
          clk      => clk,
          rst      => rst,
          in_data  => sized,
          out_data => at_stretch
        );

      size_factor    <= signed(resize(unsigned(at_stretch(15 downto 0)), 18));
      stretch_factor <= signed(resize(stretch, 18));

      stretching : entity work.hk_product
        port map (
          clk         => clk,
          factor      => size_factor,
          coefficient => stretch_factor,
          product     => product
        );

      beside_product : entity work.hk_delay
        generic map (
          BITS   => 17,
          CLOCKS => product_clocks_c
        )
        port map (
          clk      => clk,
          rst      => rst,
          in_data  => at_stretch,
          out_data => at_product
        );

      process (clk)
        variable wide_v : signed(49 downto 0);
      begin
        if rising_edge(clk) then
          wide_v                   := resize(product, 50);
          stretched_r(30)          <= at_product(16);
          stretched_r(29 downto 0) <= std_logic_vector(
            shift_left(resize(unsigned(at_product(15 downto 0)), 30), guard_bits_c)
            + unsigned(wide_v(stretch_fraction_bits_c - guard_bits_c + 29
                              downto stretch_fraction_bits_c - guard_bits_c)));
        end if;
      end process;

      beside_length : entity work.hk_delay
        generic map (
          BITS   => 31,
          CLOCKS => waits_c
        )
        port map (
          clk      => clk,
          rst      => rst,
          in_data  => stretched_r,
          out_data => at_length
        );

      pitch_y <= unsigned(at_length(29 downto 0));

      second : entity work.hk_arctan_pipelined
        port map (
          clk        => clk,
          x          => length,
          y          => pitch_y,
          x_negative => '0',
          y_negative => at_length(30),
          stretch    => open,
          turn       => open,
          length     => open,
          angle      => force_pitch
        );

      with_roll : if has_roll_c generate

        beside_second : entity work.hk_delay
          generic map (
            BITS   => 32,
            CLOCKS => length_clocks_c
          )
          port map (
            clk      => clk,
            rst      => rst,
            in_data  => std_logic_vector(angle),
            out_data => late_roll
          );

        force_roll <= signed(late_roll);

      end generate with_roll;

      without_roll : if not has_roll_c generate
        force_roll <= (others => '0');
      end generate without_roll;

    end generate with_pitch;

  end generate from_two;

  roll_from_one : if uses_arcsin_c and has_roll_c generate
    roll_sine : entity work.hk_arcsine_pipelined
      port map (
        clk      => clk,
        rst      => rst,
        size     => roll_size_r,
        negative => roll_negative_r,
        angle    => force_roll
      );
  end generate roll_from_one;

  pitch_from_one : if uses_arcsin_c and has_pitch_c generate
    pitch_sine : entity work.hk_arcsine_pipelined
      port map (
        clk      => clk,
        rst      => rst,
        size     => pitch_size_r,
        negative => pitch_negative_r,
        angle    => force_pitch
      );
  end generate pitch_from_one;

  lacks_roll : if uses_arcsin_c and not has_roll_c generate
    force_roll <= (others => '0');
  end generate lacks_roll;

  lacks_pitch : if uses_arcsin_c and not has_pitch_c generate
    force_pitch <= (others => '0');
  end generate lacks_pitch;

end architecture rtl;
