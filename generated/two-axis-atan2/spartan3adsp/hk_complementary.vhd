-- The complementary tilt filter. Takes raw counts in sensor axes; per axis it measures the tilt
-- from specific force, predicts with the angular rate, and corrects the prediction with the wrapped
-- difference, and the bias of the gyroscope with it. The first sample after reset loads the measured
-- tilt. One sample at a time. What a design does not use is switched off by constants.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.hk_common_pkg.all;
use work.hk_complementary_pkg.all;
use work.hk_design_pkg.all;

entity hk_complementary is
  port (
    clk           : in  std_logic;
    rst           : in  std_logic;  -- synchronous, active high
    in_valid      : in  std_logic;
    in_ready      : out std_logic;
    accel_x       : in  signed(15 downto 0);  -- counts, sensor axes
    accel_y       : in  signed(15 downto 0);
    accel_z       : in  signed(15 downto 0);
    gyro_x        : in  signed(15 downto 0);
    gyro_y        : in  signed(15 downto 0);
    gyro_z        : in  signed(15 downto 0);
    out_valid     : out std_logic;
    out_ready     : in  std_logic;
    angle_roll    : out signed(31 downto 0);  -- half turns, wraps at +-pi; 0 if not in the design
    angle_pitch   : out signed(31 downto 0);
    bias_roll     : out signed(31 downto 0);  -- of the gyroscope, half turns per sample with
    bias_pitch    : out signed(31 downto 0);  -- bias_fraction_bits_c; 0 without an integral
    restarted     : out std_logic;            -- this sample loaded the measured tilt
    design_digest : out std_logic_vector(47 downto 0)  -- constant: which design this core is
  );
end entity hk_complementary;

architecture rtl of hk_complementary is

  constant root_shift_c    : natural  := guard_bits_c - root_fraction_bits_c;
  constant stretch_shift_c : positive := stretch_fraction_bits_c - guard_bits_c;

  -- In order, one clock each but for idle, the waits and finished.
  type state_t is (
    idle,
    force_roll,     -- roll: start the arc tangent, or square the component
    force_pitch,    -- pitch: square the component, for the arc sine
    rate_roll,      -- multiply the roll rate by its gain
    rate_pitch,
    predict_roll,
    predict_pitch,
    squares,        -- with a gate only: five clocks for the square of the specific force
    wait_root,      -- arc sine only
    wait_angle,     -- then multiply the innovation
    correct,
    learn,          -- with an integral only: change the bias, which update limits
    update,
    finished
  );
  signal state_r : state_t;

  signal angle_r     : angle_array_t;
  signal bias_r      : angle_array_t;
  signal restart_r   : std_logic;
  signal restarted_r : std_logic;

  signal multiply_r    : std_logic;
  signal factor_r      : signed(31 downto 0);
  signal coefficient_r : signed(17 downto 0);
  signal product       : signed(49 downto 0);

  signal root_start_r : std_logic;
  signal root_free    : std_logic;
  signal root_done    : std_logic;
  signal root_taken   : std_logic;
  signal radicand_r   : unsigned(2 * root_integers_c - 1 downto 0);
  signal root         : unsigned(root_integers_c + root_fraction_bits_c - 1 downto 0);

  signal arctan_start_r : std_logic;
  signal arctan_free    : std_logic;
  signal arctan_done    : std_logic;
  signal arctan_taken   : std_logic;
  signal x_r            : unsigned(29 downto 0);
  signal y_r            : unsigned(29 downto 0);
  signal x_negative_r   : std_logic;
  signal y_negative_r   : std_logic;
  signal force_angle    : signed(31 downto 0);
  signal length         : unsigned(29 downto 0);
  signal stretch        : signed(17 downto 0);

  function first_wait return state_t is
  begin
    if uses_arcsin_c then
      return wait_root;
    end if;
    return wait_angle;
  end function first_wait;

begin

  in_ready    <= '1' when state_r = idle else '0';
  out_valid   <= '1' when state_r = finished else '0';
  angle_roll  <= angle_r(roll);
  angle_pitch <= angle_r(pitch);
  bias_roll   <= bias_r(roll) when has_integral_c else (others => '0');
  bias_pitch  <= bias_r(pitch) when has_integral_c else (others => '0');
  restarted   <= restarted_r;

  -- In halves, because GHDL 2.0 converts a constant of more than 32 bits wrongly.
  design_digest(47 downto 24) <= design_digest_c(47 downto 24);
  design_digest(23 downto 0)  <= design_digest_c(23 downto 0);

  root_taken   <= '1' when state_r = wait_root else '0';
  arctan_taken <= '1' when state_r = wait_angle else '0';

  main : process (clk)
    variable axis_v      : axis_t;
    variable component_v : count_array_t;  -- of specific force, rises with the angle
    variable force_z_v   : signed(16 downto 0);
    variable force_v     : force_t;        -- sensor axes; the next to be squared is the first
    variable rate_v      : count_array_t;
    variable predicted_v : angle_array_t;
    variable radicand_v  : unsigned(2 * root_integers_c - 1 downto 0);
    variable clocks_v    : unsigned(2 downto 0);   -- in the state of the squares
    variable square_v    : unsigned(31 downto 0);  -- of the specific force: at most 3 * 2**30
    variable corrects_v  : boolean;
    variable tilt_v      : signed(31 downto 0);
  begin
    if rising_edge(clk) then
      multiply_r <= '0';
      if root_free = '1' then
        root_start_r <= '0';
      end if;
      if arctan_free = '1' then
        arctan_start_r <= '0';
      end if;

      if state_r = idle then
        if in_valid = '1' then
          component_v(roll)  := body_count(body_y_c, accel_x, accel_y, accel_z);
          component_v(pitch) := -body_count(body_x_c, accel_x, accel_y, accel_z);
          force_z_v          := body_count(body_z_c, accel_x, accel_y, accel_z);
          rate_v(roll)       := body_count(body_x_c, gyro_x, gyro_y, gyro_z);
          rate_v(pitch)      := body_count(body_y_c, gyro_x, gyro_y, gyro_z);
          force_v            := (accel_x, accel_y, accel_z);
          axis_v             := first_axis;
          state_r            <= force_roll;
        end if;

      elsif state_r = force_roll then
        if uses_arcsin_c then
          component_v(roll)  := clamped(component_v(roll), gravity_count_c);
          component_v(pitch) := clamped(component_v(pitch), gravity_count_c);
          factor_r           <= resize(component_v(roll), 32);
          coefficient_r      <= resize(component_v(roll), 18);
          multiply_r         <= '1';
        else
          x_r            <= with_guard_bits(force_z_v);
          y_r            <= with_guard_bits(component_v(roll));
          x_negative_r   <= force_z_v(16);
          y_negative_r   <= component_v(roll)(16);
          arctan_start_r <= '1';
        end if;
        if has_integral_c then
          predicted_v(roll)  := without_bias(angle_r(roll), bias_r(roll));
          predicted_v(pitch) := without_bias(angle_r(pitch), bias_r(pitch));
        end if;
        state_r <= force_pitch;

      elsif state_r = force_pitch then
        factor_r      <= resize(component_v(pitch), 32);
        coefficient_r <= resize(component_v(pitch), 18);
        multiply_r    <= '1';
        state_r       <= rate_roll;

      elsif state_r = rate_roll then
        if uses_arcsin_c and has_roll_c then
          radicand_r   <= rest_of_square(product);
          root_start_r <= '1';
        end if;
        factor_r      <= resize(rate_v(roll), 32);
        coefficient_r <= rate_gain_roll_c;
        multiply_r    <= '1';
        state_r       <= rate_pitch;

      elsif state_r = rate_pitch then
        radicand_v := rest_of_square(product);
        if uses_arcsin_c and not has_roll_c then
          radicand_r   <= radicand_v;
          root_start_r <= '1';
        end if;
        factor_r      <= resize(rate_v(pitch), 32);
        coefficient_r <= rate_gain_pitch_c;
        multiply_r    <= '1';
        state_r       <= predict_roll;

      elsif state_r = predict_roll then
        predicted_v(roll) := before_turn(roll, angle_r(roll), predicted_v(roll))
                             + shift_rounded(product, rate_gain_roll_fraction_bits_c);
        state_r           <= predict_pitch;

      elsif state_r = predict_pitch then
        predicted_v(pitch) := before_turn(pitch, angle_r(pitch), predicted_v(pitch))
                              + shift_rounded(product, rate_gain_pitch_fraction_bits_c);
        clocks_v           := (others => '0');
        square_v           := (others => '0');
        if uses_gate_c then
          state_r <= squares;
        else
          state_r <= first_wait;
        end if;

      elsif state_r = squares then
        -- A factor a clock; its square is there two clocks later.
        if clocks_v < 3 then
          factor_r      <= resize(force_v(0), 32);
          coefficient_r <= resize(force_v(0), 18);
          multiply_r    <= '1';
          force_v       := (force_v(1), force_v(2), force_v(2));
        end if;
        if clocks_v >= 2 then
          square_v := square_v + unsigned(product(31 downto 0));
        end if;
        if clocks_v = 4 then
          corrects_v := square_v >= gate_lowest_c and square_v <= gate_highest_c;
          state_r    <= first_wait;
        end if;
        clocks_v := clocks_v + 1;

      elsif state_r = wait_root then
        if root_done = '1' then
          x_r            <= shift_left(resize(root, 30), root_shift_c);
          y_r            <= with_guard_bits(component_v(axis_v));
          x_negative_r   <= '0';
          y_negative_r   <= component_v(axis_v)(16);
          arctan_start_r <= '1';
          if axis_v = roll and has_pitch_c then
            radicand_r   <= radicand_v;
            root_start_r <= '1';
          end if;
          state_r <= wait_angle;
        end if;

      elsif state_r = wait_angle then
        -- The stretch is there many clocks before the angle: its product is, too.
        if axis_v = roll and has_pitch_c and not uses_arcsin_c then
          factor_r      <= signed(resize(size_of(component_v(pitch)), 32));
          coefficient_r <= stretch;
          multiply_r    <= '1';
        end if;
        if arctan_done = '1' then
          if axis_v = roll and has_pitch_c and not uses_arcsin_c then
            x_r            <= length;
            y_r            <= with_guard_bits(component_v(pitch))
                              + unsigned(product(stretch_shift_c + 29 downto stretch_shift_c));
            x_negative_r   <= '0';
            y_negative_r   <= component_v(pitch)(16);
            arctan_start_r <= '1';
          end if;
          tilt_v     := force_angle - tilt_offset_c(axis_v);
          factor_r   <= tilt_v - predicted_v(axis_v);
          if uses_gate_c and not corrects_v then
            factor_r <= (others => '0');
          end if;
          coefficient_r <= blend_c;
          if has_integral_c then
            coefficient_r <= integral_gain_c;
          end if;
          multiply_r <= '1';
          state_r    <= correct;
        end if;

      elsif state_r = correct then
        if has_integral_c then
          coefficient_r <= blend_c;
          multiply_r    <= '1';
          state_r       <= learn;
        else
          state_r <= update;
        end if;

      elsif state_r = learn then
        if restart_r = '0' and (axis_v = pitch or has_roll_c) then
          bias_r(axis_v) <= bias_r(axis_v)
                            - shift_rounded(product, integral_gain_fraction_bits_c);
        end if;
        state_r <= update;

      elsif state_r = update then
        if axis_v = pitch or has_roll_c then
          if has_integral_c then
            bias_r(axis_v) <= limited(bias_r(axis_v));
          end if;
          if restart_r = '1' then
            angle_r(axis_v) <= tilt_v;
          else
            angle_r(axis_v) <= predicted_v(axis_v) + shift_rounded(product, blend_fraction_bits_c);
          end if;
        end if;
        if axis_v = roll and has_pitch_c then
          axis_v  := pitch;
          state_r <= first_wait;
        else
          restarted_r <= restart_r;
          restart_r   <= '0';
          state_r     <= finished;
        end if;

      else
        if out_ready = '1' then
          state_r <= idle;
        end if;
      end if;

      if rst = '1' then
        angle_r        <= (others => (others => '0'));
        if has_integral_c then
          bias_r(roll)  <= gyro_bias_roll_c;
          bias_r(pitch) <= gyro_bias_pitch_c;
        end if;
        restart_r      <= '1';
        restarted_r    <= '0';
        multiply_r     <= '0';
        root_start_r   <= '0';
        arctan_start_r <= '0';
        state_r        <= idle;
      end if;
    end if;
  end process main;

  multiplier : entity work.hk_multiplier
    port map (
      clk         => clk,
      enable      => multiply_r,
      factor      => factor_r,
      coefficient => coefficient_r,
      product     => product
    );

  arctan : entity work.hk_arctan
    port map (
      clk        => clk,
      rst        => rst,
      in_valid   => arctan_start_r,
      in_ready   => arctan_free,
      x          => x_r,
      y          => y_r,
      x_negative => x_negative_r,
      y_negative => y_negative_r,
      out_valid  => arctan_done,
      out_ready  => arctan_taken,
      angle      => force_angle,
      length     => length,
      stretch    => stretch
    );

  with_root : if uses_arcsin_c generate
    square_root : entity work.hk_root
      generic map (
        INTEGER_BITS  => root_integers_c,
        FRACTION_BITS => root_fraction_bits_c
      )
      port map (
        clk       => clk,
        rst       => rst,
        in_valid  => root_start_r,
        in_ready  => root_free,
        radicand  => radicand_r,
        out_valid => root_done,
        out_ready => root_taken,
        root      => root
      );
  end generate with_root;

  without_root : if not uses_arcsin_c generate
    root_free <= '1';
    root_done <= '0';
    root      <= (others => '0');
  end generate without_root;

end architecture rtl;
