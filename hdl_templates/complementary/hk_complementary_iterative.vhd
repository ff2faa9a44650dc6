-- The small core of the complementary filter: one sample at a time, one multiplier, one adder for
-- the angles. The axis in work stands in angle_now_r; every sum passes it on to angle_next_r, and
-- the other axis comes up, so that each is back in its place when a sample is done.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.hk_common_pkg.all;
use work.hk_complementary_design_pkg.all;
use work.hk_complementary_pkg.all;
use work.hk_design_pkg.all;

entity hk_complementary_iterative is
  generic (
    CHANNELS : positive
  );
  port (
    clk           : in  std_logic;
    rst           : in  std_logic;  -- synchronous, active high
    settings      : in  hk_settings_t;  -- may change only while busy = '0'
    busy          : out std_logic;      -- a sample is in work, or channels are being cleared
    in_valid      : in  std_logic;
    in_ready      : out std_logic;
    in_channel    : in  unsigned(hk_index_bits(CHANNELS) - 1 downto 0);
    accel_x       : in  signed(15 downto 0);  -- counts, sensor axes
    accel_y       : in  signed(15 downto 0);
    accel_z       : in  signed(15 downto 0);
    gyro_x        : in  signed(15 downto 0);
    gyro_y        : in  signed(15 downto 0);
    gyro_z        : in  signed(15 downto 0);
    out_valid     : out std_logic;
    out_ready     : in  std_logic;
    out_channel   : out unsigned(hk_index_bits(CHANNELS) - 1 downto 0);
    angle_roll    : out signed(31 downto 0);  -- half turns, wraps at +-pi; 0 if not in the design
    angle_pitch   : out signed(31 downto 0);
    bias_roll     : out signed(31 downto 0);  -- of the gyroscope, half turns per sample with
    bias_pitch    : out signed(31 downto 0);  -- bias_fraction_bits_c; 0 without an integral
    restarted     : out std_logic;            -- first of its channel: loaded the measured tilt
    saturated     : out std_logic;            -- a count stands at the end of its range
    design_digest : out std_logic_vector(47 downto 0)  -- constant: which design this core is
  );
end entity hk_complementary_iterative;

architecture rtl of hk_complementary_iterative is

  constant channel_bits_c : positive := hk_index_bits(CHANNELS);
  constant root_shift_c   : natural  := guard_bits_c - root_fraction_bits_c;

  type state_t is (
    idle,
    clearing,   -- with several channels: forget them all
    preparing,  -- the steps below
    waiting,    -- for a measured tilt; then multiply the innovation
    multiplying,
    learning,   -- with an integral only: change the bias, which correcting limits
    correcting,
    finished
  );
  signal state_r : state_t;

  -- With the arc sine the squares of the components come first.
  function squares return natural is
  begin
    if uses_arcsin_c then
      return 2;
    end if;
    return 0;
  end function squares;

  -- Steps of preparing. A product is there two steps after its operands. The arc tangent of two
  -- components multiplies from step turn_digits_c on, so the last operands come before.
  signal step_r : std_logic_vector(0 to 9);  -- one of them is 1
  constant square_roll_c  : natural := 0;  -- operands
  constant square_pitch_c : natural := 1;
  constant rate_roll_c    : natural := squares;
  constant rate_pitch_c   : natural := squares + 1;
  constant first_force_c  : natural := squares + 2;
  constant last_force_c   : natural := squares + 4;
  constant turn_roll_c    : natural := rate_roll_c + 2;  -- sums
  constant turn_pitch_c   : natural := rate_pitch_c + 2;
  constant bias_roll_c    : natural := turn_pitch_c + 1;
  constant bias_pitch_c   : natural := turn_pitch_c + 2;
  constant judge_c        : natural := last_force_c + 3;  -- the gate

  signal axis_r       : axis_t;
  signal channel_r    : unsigned(channel_bits_c - 1 downto 0);
  signal size_roll_r  : unsigned(15 downto 0);  -- of the specific force that rises with the angle
  signal size_pitch_r : unsigned(15 downto 0);
  signal down_roll_r  : std_logic;              -- its sign
  signal down_pitch_r : std_logic;
  signal rate_roll_r  : signed(16 downto 0);
  signal rate_pitch_r : signed(16 downto 0);
  signal force_r      : force_t;                -- sensor axes; the next to be squared is the first
  signal square_r     : unsigned(31 downto 0);  -- of the specific force: at most 3 * 2**30
  signal corrects_r   : std_logic;

  signal angle_now_r  : signed(31 downto 0);
  signal angle_next_r : signed(31 downto 0);
  signal bias_now_r   : signed(31 downto 0);
  signal bias_next_r  : signed(31 downto 0);
  signal started_r    : std_logic;  -- with one channel: it has had its first sample
  signal restarted_r  : std_logic;
  signal saturated_r  : std_logic;

  signal multiply_r    : std_logic;
  signal factor_r      : signed(31 downto 0);
  signal coefficient_r : signed(17 downto 0);
  signal product       : signed(49 downto 0);

  signal force_side   : signed(16 downto 0);  -- of the inputs, body axes
  signal force_up     : signed(16 downto 0);
  signal force_back   : signed(16 downto 0);
  signal offset       : signed(31 downto 0);
  signal second       : std_logic;
  signal arctan_start : std_logic;
  signal arctan_free  : std_logic;
  signal arctan_done  : std_logic;
  signal x            : unsigned(29 downto 0);
  signal y            : unsigned(15 downto 0);
  signal x_negative   : std_logic;
  signal y_negative   : std_logic;
  signal tilt         : signed(31 downto 0);

  signal arctan_multiply    : std_logic;
  signal arctan_factor      : signed(30 downto 0);
  signal arctan_coefficient : signed(17 downto 0);

  -- A stored channel: angles, with an integral the biases, and whether it has had a sample.
  signal stored_started    : std_logic;
  signal stored_angle_now  : signed(31 downto 0);
  signal stored_angle_next : signed(31 downto 0);
  signal stored_bias_now   : signed(31 downto 0);
  signal stored_bias_next  : signed(31 downto 0);

  function first_state return state_t is
  begin
    if CHANNELS > 1 then
      return clearing;
    end if;
    return idle;
  end function first_state;

  function first_axis return axis_t is
  begin
    -- The arc tangent of pitch needs the length that the one of roll leaves.
    if uses_arcsin_c and not has_roll_c then
      return pitch;
    end if;
    return roll;
  end function first_axis;

begin

  in_ready    <= '1' when state_r = idle else '0';
  busy        <= '0' when state_r = idle else '1';
  out_valid   <= '1' when state_r = finished else '0';
  restarted   <= restarted_r;
  saturated   <= saturated_r;
  out_channel <= channel_r when CHANNELS > 1 else (others => '0');

  angle_roll  <= angle_now_r when has_roll_c else (others => '0');
  angle_pitch <= angle_next_r when has_both_c
                 else angle_now_r when has_pitch_c
                 else (others => '0');
  bias_roll   <= bias_now_r when has_integral_c and has_roll_c else (others => '0');
  bias_pitch  <= bias_next_r when has_integral_c and has_both_c
                 else bias_now_r when has_integral_c and has_pitch_c
                 else (others => '0');

  -- In halves, because GHDL 2.0 converts a constant of more than 32 bits wrongly.
  design_digest(47 downto 24) <= design_digest_c(47 downto 24);
  design_digest(23 downto 0)  <= design_digest_c(23 downto 0);

  force_side <= body_count(body_y_c, accel_x, accel_y, accel_z);
  force_up   <= body_count(body_z_c, accel_x, accel_y, accel_z);
  force_back <= -body_count(body_x_c, accel_x, accel_y, accel_z);

  main : process (clk)
    variable add_v    : boolean;  -- to the angle in work
    variable addend_v : signed(31 downto 0);
    variable carry_v  : std_logic;
    variable sum_v    : signed(31 downto 0);
  begin
    if rising_edge(clk) then
      factor_r      <= resize(arctan_factor, 32);
      coefficient_r <= arctan_coefficient;
      multiply_r    <= arctan_multiply;
      add_v         := state_r = correcting;
      addend_v      := shift_floored(product, blend_fraction_bits_c);
      carry_v       := product(blend_fraction_bits_c - 1);

      if state_r = clearing then
        channel_r <= channel_r + 1;
        if channel_r = 2 ** channel_bits_c - 1 then
          state_r <= idle;
        end if;

      elsif state_r = idle then
        if in_valid = '1' then
          axis_r       <= first_axis;
          step_r <= (0 => '1', others => '0');
          channel_r    <= in_channel;
          size_roll_r  <= tilt_size(force_side);
          down_roll_r  <= force_side(16);
          size_pitch_r <= tilt_size(force_back);
          down_pitch_r <= force_back(16);
          rate_roll_r  <= body_count(body_x_c, gyro_x, gyro_y, gyro_z);
          rate_pitch_r <= body_count(body_y_c, gyro_x, gyro_y, gyro_z);
          force_r      <= (accel_x, accel_y, accel_z);
          saturated_r  <= '0';
          if at_end_of_range(accel_x) or at_end_of_range(accel_y) or at_end_of_range(accel_z)
            or at_end_of_range(gyro_x) or at_end_of_range(gyro_y) or at_end_of_range(gyro_z) then
            saturated_r <= '1';
          end if;
          state_r <= preparing;
        end if;

      elsif state_r = preparing then
        if step_r(0) = '1' then
          restarted_r <= not stored_started;
          if CHANNELS > 1 then
            angle_now_r  <= stored_angle_now;
            angle_next_r <= stored_angle_next;
            bias_now_r   <= stored_bias_now;
            bias_next_r  <= stored_bias_next;
          end if;
          square_r <= (others => '0');
        end if;

        if uses_arcsin_c and step_r(square_roll_c) = '1' then
          factor_r      <= signed(resize(size_roll_r, 32));
          coefficient_r <= signed(resize(size_roll_r, 18));
          multiply_r    <= '1';
        end if;
        if uses_arcsin_c and step_r(square_pitch_c) = '1' then
          factor_r      <= signed(resize(size_pitch_r, 32));
          coefficient_r <= signed(resize(size_pitch_r, 18));
          multiply_r    <= '1';
        end if;
        if step_r(rate_roll_c) = '1' then
          factor_r      <= resize(rate_roll_r, 32);
          coefficient_r <= settings.rate_gain_roll;
          multiply_r    <= '1';
        end if;
        if step_r(rate_pitch_c) = '1' then
          factor_r      <= resize(rate_pitch_r, 32);
          coefficient_r <= settings.rate_gain_pitch;
          multiply_r    <= '1';
        end if;
        if uses_gate_c and (step_r(first_force_c) or step_r(first_force_c + 1)
                            or step_r(last_force_c)) = '1' then
          factor_r      <= resize(force_r(0), 32);
          coefficient_r <= resize(force_r(0), 18);
          multiply_r    <= '1';
          force_r       <= (force_r(1), force_r(2), force_r(2));
        end if;
        if uses_gate_c and (step_r(first_force_c + 2) or step_r(first_force_c + 3)
                            or step_r(last_force_c + 2)) = '1' then
          square_r <= square_r + unsigned(product(31 downto 0));
        end if;

        if step_r(turn_roll_c) = '1' then
          add_v    := has_roll_c;
          addend_v := shift_floored(product, rate_gain_roll_fraction_bits_c);
          carry_v  := product(rate_gain_roll_fraction_bits_c - 1);
        end if;
        if step_r(turn_pitch_c) = '1' then
          add_v    := has_pitch_c;
          addend_v := shift_floored(product, rate_gain_pitch_fraction_bits_c);
          carry_v  := product(rate_gain_pitch_fraction_bits_c - 1);
        end if;
        if step_r(bias_roll_c) = '1' then
          add_v    := has_roll_c;
          addend_v := not settings.gyro_bias_roll;
          carry_v  := '1';
        end if;
        if step_r(bias_pitch_c) = '1' then
          add_v    := has_pitch_c;
          addend_v := not settings.gyro_bias_pitch;
          carry_v  := '1';
        end if;
        if has_integral_c and (step_r(bias_roll_c) or step_r(bias_pitch_c)) = '1' then
          addend_v := not shift_floored(resize(bias_now_r, 50), bias_fraction_bits_c);
          carry_v  := not bias_now_r(bias_fraction_bits_c - 1);
        end if;

        step_r <= '0' & step_r(0 to 8);
        if step_r(bias_pitch_c) = '1' and not uses_gate_c then
          state_r <= waiting;
        end if;
        if uses_gate_c and step_r(judge_c) = '1' then
          corrects_r <= '0';
          if square_r >= settings.gate_lowest and square_r <= settings.gate_highest then
            corrects_r <= '1';
          end if;
          state_r <= waiting;
        end if;

      elsif state_r = waiting then
        if arctan_done = '1' then
          if axis_r = roll and not has_roll_c then
            axis_r <= pitch;
          else
            factor_r      <= tilt - angle_now_r;
            coefficient_r <= settings.blend;
            if has_integral_c then
              coefficient_r <= settings.integral_gain;
            end if;
            multiply_r <= '1';
            if restarted_r = '1' then
              factor_r    <= (others => '0');
              angle_now_r <= tilt;
            elsif uses_gate_c and corrects_r = '0' then
              factor_r <= (others => '0');
            end if;
            state_r <= multiplying;
          end if;
        end if;

      elsif state_r = multiplying then
        state_r <= correcting;
        if has_integral_c then
          -- The same factor again.
          factor_r      <= factor_r;
          coefficient_r <= settings.blend;
          multiply_r    <= '1';
          state_r       <= learning;
        end if;

      elsif state_r = learning then
        bias_now_r <= hk_sum(bias_now_r,
                             not shift_floored(product, integral_gain_fraction_bits_c),
                             not product(integral_gain_fraction_bits_c - 1));
        state_r    <= correcting;

      elsif state_r = correcting then
        if has_both_c and axis_r = roll then
          axis_r  <= pitch;
          state_r <= waiting;
        else
          started_r <= '1';
          state_r   <= finished;
        end if;

      else
        if out_ready = '1' then
          state_r <= idle;
        end if;
      end if;

      sum_v := hk_sum(angle_now_r, addend_v, carry_v);
      if add_v then
        angle_now_r <= sum_v;
        if has_both_c then
          angle_now_r  <= angle_next_r;
          angle_next_r <= sum_v;
        end if;
        if has_integral_c then
          bias_now_r <= limited(bias_now_r);
          if has_both_c then
            bias_now_r  <= bias_next_r;
            bias_next_r <= limited(bias_now_r);
          end if;
        end if;
      end if;

      if has_integral_c and state_r = preparing and step_r(0) = '1' and stored_started = '0' then
        bias_now_r  <= settings.gyro_bias_roll;
        bias_next_r <= settings.gyro_bias_pitch;
        if not has_roll_c then
          bias_now_r <= settings.gyro_bias_pitch;
        end if;
      end if;

      if rst = '1' then
        channel_r    <= (others => '0');
        angle_now_r  <= (others => '0');
        angle_next_r <= (others => '0');
        bias_now_r   <= (others => '0');
        bias_next_r  <= (others => '0');
        started_r    <= '0';
        restarted_r  <= '0';
        saturated_r  <= '0';
        multiply_r   <= '0';
        state_r      <= first_state;
      end if;
    end if;
  end process main;

  one_channel : if CHANNELS = 1 generate
    -- The angles stay where they are.
    stored_started    <= started_r;
    stored_angle_now  <= (others => '0');
    stored_angle_next <= (others => '0');
    stored_bias_now   <= (others => '0');
    stored_bias_next  <= (others => '0');
  end generate one_channel;

  several_channels : if CHANNELS > 1 generate
    function angle_words return positive is
    begin
      if has_both_c then
        return 2;
      end if;
      return 1;
    end function angle_words;

    function words return positive is
    begin
      if has_integral_c then
        return 2 * angle_words;
      end if;
      return angle_words;
    end function words;

    constant word_bits_c : positive := 32 * words + 1;
    type memory_t is array (natural range 0 to 2 ** channel_bits_c - 1)
      of std_logic_vector(word_bits_c - 1 downto 0);
    signal memory_r : memory_t;
    signal word_r   : std_logic_vector(word_bits_c - 1 downto 0);
    signal word     : std_logic_vector(word_bits_c - 1 downto 0);
    signal address  : unsigned(channel_bits_c - 1 downto 0);
    signal read     : std_logic;
    signal write    : std_logic;
  begin

    address <= in_channel when state_r = idle else channel_r;
    read    <= in_valid when state_r = idle else '0';
    write   <= '1' when state_r = finished or state_r = clearing else '0';

    memory : process (clk)
    begin
      if rising_edge(clk) then
        if write = '1' then
          memory_r(to_integer(address)) <= word;
        end if;
        if read = '1' then
          word_r <= memory_r(to_integer(address));
        end if;
      end if;
    end process memory;

    word(0)             <= '1' when state_r = finished else '0';
    word(32 downto 1)   <= std_logic_vector(angle_now_r);
    stored_started      <= word_r(0);
    stored_angle_now    <= signed(word_r(32 downto 1));

    with_next : if has_both_c generate
      word(64 downto 33) <= std_logic_vector(angle_next_r);
      stored_angle_next  <= signed(word_r(64 downto 33));
    end generate with_next;

    without_next : if not has_both_c generate
      stored_angle_next <= (others => '0');
      stored_bias_next  <= (others => '0');
    end generate without_next;

    with_bias : if has_integral_c generate
      word(32 * angle_words + 32 downto 32 * angle_words + 1) <= std_logic_vector(bias_now_r);
      stored_bias_now <= signed(word_r(32 * angle_words + 32 downto 32 * angle_words + 1));
    end generate with_bias;

    with_next_bias : if has_integral_c and has_both_c generate
      word(128 downto 97) <= std_logic_vector(bias_next_r);
      stored_bias_next    <= signed(word_r(128 downto 97));
    end generate with_next_bias;

    without_bias : if not has_integral_c generate
      stored_bias_now <= (others => '0');
    end generate without_bias;

    without_next_bias : if has_both_c and not has_integral_c generate
      stored_bias_next <= (others => '0');
    end generate without_next_bias;

  end generate several_channels;

  multiplier : entity work.hk_multiplier
    port map (
      clk         => clk,
      enable      => multiply_r,
      factor      => factor_r,
      coefficient => coefficient_r,
      product     => product
    );

  second <= '1' when has_pitch_c and not uses_arcsin_c else '0';
  offset <= settings.tilt_offset_roll when axis_r = roll else settings.tilt_offset_pitch;

  arctan : entity work.hk_arctan
    port map (
      clk             => clk,
      rst             => rst,
      in_valid        => arctan_start,
      in_ready        => arctan_free,
      x               => x,
      y               => y,
      x_negative      => x_negative,
      y_negative      => y_negative,
      second          => second,
      y_second        => size_pitch_r,
      second_negative => down_pitch_r,
      zero            => offset,
      out_valid       => arctan_done,
      angle           => tilt,
      length          => open,
      stretch         => open,
      multiply        => arctan_multiply,
      factor          => arctan_factor,
      coefficient     => arctan_coefficient,
      product         => product
    );

  with_arctan : if not uses_arcsin_c generate
    -- Straight from the inputs.
    arctan_start <= in_valid when state_r = idle else '0';
    x            <= shift_left(resize(size_of(force_up), 30), guard_bits_c);
    x_negative   <= force_up(16);
    y            <= size_of(force_side);
    y_negative   <= force_side(16);
  end generate with_arctan;

  with_root : if uses_arcsin_c generate
    signal root_start   : std_logic;
    signal root_free    : std_logic;
    signal radicand     : unsigned(2 * root_integers_c - 1 downto 0);
    signal radicand_r   : unsigned(2 * root_integers_c - 1 downto 0);
    signal root         : unsigned(root_integers_c + root_fraction_bits_c - 1 downto 0);
    signal more_r       : std_logic;  -- the root of pitch follows that of roll
    signal pitch_next_r : std_logic;  -- the root in work is that of pitch
  begin

    -- The root of pitch runs beside the arc tangent of roll.
    root_order : process (clk)
    begin
      if rising_edge(clk) then
        if state_r = idle then
          pitch_next_r <= '0';
          if not has_roll_c then
            pitch_next_r <= '1';
          end if;
        end if;
        if state_r = preparing and step_r(square_pitch_c + 2) = '1' and has_both_c then
          radicand_r <= rest_of_square(product);
          more_r     <= '1';
        end if;
        if more_r = '1' and root_free = '1' then
          more_r       <= '0';
          pitch_next_r <= '1';
        end if;
        if rst = '1' then
          more_r <= '0';
        end if;
      end if;
    end process root_order;

    root_start <= '1' when more_r = '1'
                  or (state_r = preparing and step_r(square_roll_c + 2) = '1' and has_roll_c)
                  or (state_r = preparing and step_r(square_pitch_c + 2) = '1' and not has_roll_c)
                  else '0';
    radicand   <= radicand_r when more_r = '1' else rest_of_square(product);

    x          <= shift_left(resize(root, 30), root_shift_c);
    x_negative <= '0';
    y          <= size_pitch_r when pitch_next_r = '1' else size_roll_r;
    y_negative <= down_pitch_r when pitch_next_r = '1' else down_roll_r;

    square_root : entity work.hk_root
      generic map (
        INTEGER_BITS  => root_integers_c,
        FRACTION_BITS => root_fraction_bits_c
      )
      port map (
        clk       => clk,
        rst       => rst,
        in_valid  => root_start,
        in_ready  => root_free,
        radicand  => radicand,
        out_valid => arctan_start,
        out_ready => arctan_free,
        root      => root
      );
  end generate with_root;

end architecture rtl;
