-- The fast core of the complementary filter: a sample a clock. Nothing stops the pipeline; results
-- wait in a queue, and a sample is taken only if there is room for its result. A sample of a
-- channel waits in front of the pipeline until the feedback has written what the last one of it
-- left.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.hk_common_pkg.all;
use work.hk_complementary_design_pkg.all;
use work.hk_complementary_pkg.all;
use work.hk_design_pkg.all;
use work.hk_pipelined_pkg.all;
use work.hk_polar_pkg.all;

entity hk_complementary_pipelined is
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
end entity hk_complementary_pipelined;

architecture rtl of hk_complementary_pipelined is

  constant channel_bits_c : positive := hk_index_bits(CHANNELS);

  -- Clocks after a sample went on.
  constant measured_c : positive := tilt_clocks;
  constant finished_c : positive := tilt_clocks + loop_clocks;
  constant rate_c     : positive := measured_c - product_clocks_c - 1;

  function judged_clocks return positive is
  begin
    if uses_gate_c then
      return gate_clocks_c;
    end if;
    return 1;
  end function judged_clocks;

  constant judged_c : positive := judged_clocks;

  -- What goes beside the tilt: corrects, saturated, channel, rates.
  constant flags_c     : positive := channel_bits_c + 2;
  constant side_bits_c : positive := flags_c + 34;

  function result_words return positive is
    variable words_v : positive;
  begin
    words_v := 1;
    if has_both_c then
      words_v := 2;
    end if;
    if has_integral_c then
      words_v := 2 * words_v;
    end if;
    return words_v;
  end function result_words;

  -- A result: its words, restarted, saturated, channel.
  constant words_c       : positive := result_words;
  constant result_bits_c : positive := 32 * words_c + flags_c;

  subtype channel_t is unsigned(channel_bits_c - 1 downto 0);

  signal clearing_r : std_logic;
  signal sweep_r    : channel_t;

  signal room       : std_logic;
  signal open_entry : std_logic;
  signal ready      : std_logic;
  signal taken      : std_logic;
  signal in_work    : std_logic;
  signal in_data    : std_logic_vector(95 downto 0);
  signal data       : std_logic_vector(95 downto 0);
  signal channel    : channel_t;
  signal goes_on    : std_logic;
  signal valid_r    : std_logic_vector(1 to finished_c);

  signal force_x     : signed(15 downto 0);
  signal force_y     : signed(15 downto 0);
  signal force_z     : signed(15 downto 0);
  signal turn_x      : signed(15 downto 0);
  signal turn_y      : signed(15 downto 0);
  signal turn_z      : signed(15 downto 0);
  signal force_roll  : signed(31 downto 0);
  signal force_pitch : signed(31 downto 0);

  signal saturated_r  : std_logic;
  signal channel_r    : std_logic_vector(channel_bits_c - 1 downto 0);
  signal rate_roll_r  : signed(16 downto 0);
  signal rate_pitch_r : signed(16 downto 0);
  signal corrects     : std_logic;
  signal counted      : std_logic_vector(side_bits_c - 2 downto 0);
  signal judged       : std_logic_vector(side_bits_c - 2 downto 0);
  signal side         : std_logic_vector(side_bits_c - 1 downto 0);
  signal late         : std_logic_vector(side_bits_c - 1 downto 0);
  signal rate_roll    : signed(16 downto 0);
  signal rate_pitch   : signed(16 downto 0);
  signal flags        : std_logic_vector(flags_c - 1 downto 0);
  signal measured     : std_logic_vector(flags_c - 1 downto 0);
  signal finished     : std_logic_vector(flags_c - 1 downto 0);

  signal read_channel    : channel_t;
  signal write_channel   : channel_t;
  signal write           : std_logic;
  signal roll_angle      : signed(31 downto 0);
  signal roll_bias       : signed(31 downto 0);
  signal roll_restarted  : std_logic;
  signal pitch_angle     : signed(31 downto 0);
  signal pitch_bias      : signed(31 downto 0);
  signal pitch_restarted : std_logic;

  signal result   : std_logic_vector(result_bits_c - 1 downto 0);
  signal out_data : std_logic_vector(result_bits_c - 1 downto 0);

begin

  -- In halves, because GHDL 2.0 converts a constant of more than 32 bits wrongly.
  design_digest(47 downto 24) <= design_digest_c(47 downto 24);
  design_digest(23 downto 0)  <= design_digest_c(23 downto 0);

  busy       <= in_work or clearing_r;
  open_entry <= room and not clearing_r;
  in_ready   <= ready;
  taken      <= in_valid and ready;

  sweep : process (clk)
  begin
    if rising_edge(clk) then
      sweep_r <= sweep_r + 1;
      if sweep_r = 2**channel_bits_c - 1 then
        clearing_r <= '0';
      end if;
      valid_r <= goes_on & valid_r(1 to finished_c - 1);
      if rst = '1' then
        sweep_r    <= (others => '0');
        clearing_r <= '1';
        valid_r    <= (others => '0');
      end if;
    end if;
  end process sweep;

  in_data <= std_logic_vector(gyro_z) & std_logic_vector(gyro_y) & std_logic_vector(gyro_x)
             & std_logic_vector(accel_z) & std_logic_vector(accel_y) & std_logic_vector(accel_x);

  entry : entity work.hk_complementary_entry
    generic map (
      BITS           => 96,
      CHANNEL_BITS   => channel_bits_c,
      CHANNEL_CLOCKS => channel_clocks
    )
    port map (
      clk         => clk,
      rst         => rst,
      room        => open_entry,
      in_valid    => in_valid,
      in_ready    => ready,
      in_channel  => in_channel,
      in_data     => in_data,
      out_valid   => goes_on,
      out_channel => channel,
      out_data    => data
    );

  force_x <= signed(data(15 downto 0));
  force_y <= signed(data(31 downto 16));
  force_z <= signed(data(47 downto 32));
  turn_x  <= signed(data(63 downto 48));
  turn_y  <= signed(data(79 downto 64));
  turn_z  <= signed(data(95 downto 80));

  tilt : entity work.hk_tilt_pipelined
    port map (
      clk         => clk,
      rst         => rst,
      accel_x     => force_x,
      accel_y     => force_y,
      accel_z     => force_z,
      force_roll  => force_roll,
      force_pitch => force_pitch
    );

  counts : process (clk)
  begin
    if rising_edge(clk) then
      channel_r    <= std_logic_vector(channel);
      rate_roll_r  <= body_count(body_x_c, turn_x, turn_y, turn_z);
      rate_pitch_r <= body_count(body_y_c, turn_x, turn_y, turn_z);
      saturated_r  <= '0';
      if at_end_of_range(force_x) or at_end_of_range(force_y) or at_end_of_range(force_z)
        or at_end_of_range(turn_x) or at_end_of_range(turn_y) or at_end_of_range(turn_z) then
        saturated_r <= '1';
      end if;
    end if;
  end process counts;

  ungated : if not uses_gate_c generate
    corrects <= '1';
  end generate ungated;

  gated : if uses_gate_c generate
    gate : entity work.hk_gate_pipelined
      port map (
        clk      => clk,
        lowest   => settings.gate_lowest,
        highest  => settings.gate_highest,
        accel_x  => force_x,
        accel_y  => force_y,
        accel_z  => force_z,
        corrects => corrects
      );
  end generate gated;

  counted <= saturated_r & channel_r & std_logic_vector(rate_roll_r)
             & std_logic_vector(rate_pitch_r);

  beside_gate : entity work.hk_delay
    generic map (
      BITS   => side_bits_c - 1,
      CLOCKS => judged_c - 1
    )
    port map (
      clk      => clk,
      rst      => rst,
      in_data  => counted,
      out_data => judged
    );

  side <= corrects & judged;

  beside_tilt : entity work.hk_delay
    generic map (
      BITS   => side_bits_c,
      CLOCKS => rate_c - judged_c
    )
    port map (
      clk      => clk,
      rst      => rst,
      in_data  => side,
      out_data => late
    );

  flags      <= late(side_bits_c - 1 downto 34);
  rate_roll  <= signed(late(33 downto 17));
  rate_pitch <= signed(late(16 downto 0));

  beside_rates : entity work.hk_delay
    generic map (
      BITS   => flags_c,
      CLOCKS => measured_c - rate_c
    )
    port map (
      clk      => clk,
      rst      => rst,
      in_data  => flags,
      out_data => measured
    );

  read_channel <= unsigned(measured(channel_bits_c - 1 downto 0));

  beside_loop : entity work.hk_delay
    generic map (
      BITS   => flags_c,
      CLOCKS => finished_c - measured_c
    )
    port map (
      clk      => clk,
      rst      => rst,
      in_data  => measured,
      out_data => finished
    );

  write         <= valid_r(finished_c) or clearing_r;
  write_channel <= sweep_r when clearing_r = '1'
                   else unsigned(finished(channel_bits_c - 1 downto 0));

  with_roll : if has_roll_c generate
    roll_loop : entity work.hk_complementary_loop
      generic map (
        CHANNEL_BITS  => channel_bits_c,
        FRACTION_BITS => rate_gain_roll_fraction_bits_c
      )
      port map (
        clk           => clk,
        rst           => rst,
        blend         => settings.blend,
        integral_gain => settings.integral_gain,
        rate_gain     => settings.rate_gain_roll,
        tilt_offset   => settings.tilt_offset_roll,
        gyro_bias     => settings.gyro_bias_roll,
        rate          => rate_roll,
        force_angle   => force_roll,
        corrects      => measured(flags_c - 1),
        read_channel  => read_channel,
        write         => write,
        clear         => clearing_r,
        write_channel => write_channel,
        angle         => roll_angle,
        bias          => roll_bias,
        restarted     => roll_restarted
      );
  end generate with_roll;

  with_pitch : if has_pitch_c generate
    pitch_loop : entity work.hk_complementary_loop
      generic map (
        CHANNEL_BITS  => channel_bits_c,
        FRACTION_BITS => rate_gain_pitch_fraction_bits_c
      )
      port map (
        clk           => clk,
        rst           => rst,
        blend         => settings.blend,
        integral_gain => settings.integral_gain,
        rate_gain     => settings.rate_gain_pitch,
        tilt_offset   => settings.tilt_offset_pitch,
        gyro_bias     => settings.gyro_bias_pitch,
        rate          => rate_pitch,
        force_angle   => force_pitch,
        corrects      => measured(flags_c - 1),
        read_channel  => read_channel,
        write         => write,
        clear         => clearing_r,
        write_channel => write_channel,
        angle         => pitch_angle,
        bias          => pitch_bias,
        restarted     => pitch_restarted
      );
  end generate with_pitch;

  -- A result has only the words that the design has: roll, pitch, then their biases.
  result(result_bits_c - 2 downto 32 * words_c) <= finished(flags_c - 2 downto 0);

  roll_words : if has_roll_c generate
    result(result_bits_c - 1) <= roll_restarted;
    result(31 downto 0)       <= std_logic_vector(roll_angle);
    angle_roll                <= signed(out_data(31 downto 0));
  end generate roll_words;

  only_pitch_words : if not has_roll_c generate
    result(result_bits_c - 1) <= pitch_restarted;
    result(31 downto 0)       <= std_logic_vector(pitch_angle);
    angle_roll                <= (others => '0');
    angle_pitch               <= signed(out_data(31 downto 0));
  end generate only_pitch_words;

  both_words : if has_both_c generate
    result(63 downto 32) <= std_logic_vector(pitch_angle);
    angle_pitch          <= signed(out_data(63 downto 32));
  end generate both_words;

  only_roll_words : if not has_pitch_c generate
    angle_pitch <= (others => '0');
  end generate only_roll_words;

  both_biases : if has_integral_c and has_both_c generate
    result(95 downto 64)  <= std_logic_vector(roll_bias);
    result(127 downto 96) <= std_logic_vector(pitch_bias);
    bias_roll             <= signed(out_data(95 downto 64));
    bias_pitch            <= signed(out_data(127 downto 96));
  end generate both_biases;

  only_roll_bias : if has_integral_c and not has_pitch_c generate
    result(63 downto 32) <= std_logic_vector(roll_bias);
    bias_roll            <= signed(out_data(63 downto 32));
    bias_pitch           <= (others => '0');
  end generate only_roll_bias;

  only_pitch_bias : if has_integral_c and not has_roll_c generate
    result(63 downto 32) <= std_logic_vector(pitch_bias);
    bias_roll            <= (others => '0');
    bias_pitch           <= signed(out_data(63 downto 32));
  end generate only_pitch_bias;

  without_bias : if not has_integral_c generate
    bias_roll  <= (others => '0');
    bias_pitch <= (others => '0');
  end generate without_bias;

  queue : entity work.hk_result_queue
    generic map (
      BITS         => result_bits_c,
      ADDRESS_BITS => 7
    )
    port map (
      clk       => clk,
      rst       => rst,
      taken     => taken,
      room      => room,
      busy      => in_work,
      in_valid  => valid_r(finished_c),
      in_data   => result,
      out_valid => out_valid,
      out_ready => out_ready,
      out_data  => out_data
    );

  restarted   <= out_data(result_bits_c - 1);
  saturated   <= out_data(result_bits_c - 2);
  out_channel <= unsigned(out_data(32 * words_c + channel_bits_c - 1 downto 32 * words_c));

end architecture rtl;
