-- The feedback of one axis of the pipelined filter: predict, compare with the measured tilt,
-- correct. Keeps the state of every channel. The clocks at the ports count from where the measured
-- tilt is there; a sample of a channel must not come before the write of the one before it.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.hk_common_pkg.all;
use work.hk_complementary_design_pkg.all;
use work.hk_complementary_pkg.all;
use work.hk_design_pkg.all;
use work.hk_pipelined_pkg.all;
use work.hk_polar_pkg.all;

entity hk_complementary_loop is
  generic (
    CHANNEL_BITS  : positive;
    FRACTION_BITS : positive  -- of the rate gain
  );
  port (
    clk           : in  std_logic;
    rst           : in  std_logic;  -- synchronous, active high
    blend         : in  signed(17 downto 0);
    integral_gain : in  signed(17 downto 0);
    rate_gain     : in  signed(17 downto 0);
    tilt_offset   : in  signed(31 downto 0);
    gyro_bias     : in  signed(31 downto 0);
    rate          : in  signed(16 downto 0);  -- product_clocks_c + 1 before
    force_angle   : in  signed(31 downto 0);
    corrects      : in  std_logic;            -- with force_angle, as read_channel
    read_channel  : in  unsigned(CHANNEL_BITS - 1 downto 0);
    write         : in  std_logic;            -- when the result is there, loop_clocks later
    clear         : in  std_logic;            -- write that the channel has had no sample
    write_channel : in  unsigned(CHANNEL_BITS - 1 downto 0);
    angle         : out signed(31 downto 0);
    bias          : out signed(31 downto 0);
    restarted     : out std_logic
  );
end entity hk_complementary_loop;

architecture rtl of hk_complementary_loop is

  function word_bits return positive is
  begin
    if has_integral_c then
      return 65;
    end if;
    return 33;
  end function word_bits;

  -- Whether a channel has had a sample, its angle, its bias.
  constant channels_c  : positive := 2**CHANNEL_BITS;
  constant word_bits_c : positive := word_bits;

  type memory_t is array (0 to channels_c - 1) of std_logic_vector(word_bits_c - 1 downto 0);
  signal memory_r : memory_t;
  signal read_r   : std_logic_vector(word_bits_c - 1 downto 0);
  signal word     : std_logic_vector(word_bits_c - 1 downto 0);

  signal rate_factor  : signed(17 downto 0);
  signal rate_product : signed(35 downto 0);
  signal step_r       : signed(31 downto 0);
  signal turn_1_r     : signed(31 downto 0);  -- what the rate turns, after a clock
  signal turn_2_r     : signed(31 downto 0);
  signal tilt_1_r     : signed(31 downto 0);
  signal tilt_2_r     : signed(31 downto 0);
  signal target_2_r   : signed(31 downto 0);  -- the tilt less that turn
  signal corrects_r   : std_logic_vector(1 to 2);

  signal started_2_r : std_logic;
  signal angle_2_r   : signed(31 downto 0);

  -- As the innovation needs them.
  signal still       : std_logic;             -- the sample corrects nothing
  signal innovation  : signed(31 downto 0);
  signal predicted   : signed(31 downto 0);
  signal first       : std_logic;
  signal product     : signed(49 downto 0);
  signal predicted_r : std_logic_vector(31 downto 0);
  signal late        : std_logic_vector(31 downto 0);
  signal angle_r     : signed(31 downto 0);
  signal first_in    : std_logic_vector(0 downto 0);
  signal first_late  : std_logic_vector(0 downto 0);

begin

  rate_factor <= resize(rate, 18);

  turning : entity work.hk_product
    port map (
      clk         => clk,
      factor      => rate_factor,
      coefficient => rate_gain,
      product     => rate_product
    );

  prepare : process (clk)
    variable product_v : signed(49 downto 0);
  begin
    if rising_edge(clk) then
      product_v := resize(rate_product, 50);
      step_r    <= shift_rounded(product_v, FRACTION_BITS);
      turn_1_r  <= step_r;
      if not has_integral_c then
        turn_1_r <= step_r - gyro_bias;
      end if;
      turn_2_r   <= turn_1_r;
      tilt_1_r   <= force_angle - tilt_offset;
      tilt_2_r   <= tilt_1_r;
      target_2_r <= tilt_1_r - turn_1_r;
      corrects_r <= corrects & corrects_r(1);
    end if;
  end process prepare;

  memory : process (clk)
  begin
    if rising_edge(clk) then
      if write = '1' then
        memory_r(to_integer(write_channel)) <= word;
      end if;
      read_r <= memory_r(to_integer(read_channel));
    end if;
  end process memory;

  -- A memory's output is late in its clock: registers behind it.
  fetch : process (clk)
  begin
    if rising_edge(clk) then
      started_2_r <= read_r(0);
      angle_2_r   <= signed(read_r(32 downto 1));
    end if;
  end process fetch;

  word(0)           <= not clear;

  constant_bias : if not has_integral_c generate

    still      <= not corrects_r(2) or not started_2_r;
    first      <= not started_2_r;
    innovation <= (others => '0') when still = '1' else target_2_r - angle_2_r;
    predicted  <= tilt_2_r when first = '1' else angle_2_r + turn_2_r;
    angle      <= angle_r;
    bias       <= (others => '0');

    word(32 downto 1) <= std_logic_vector(angle_r);

  end generate constant_bias;

  learned_bias : if has_integral_c generate

    signal bias_2_r     : signed(31 downto 0);
    signal bias_3_r     : signed(31 downto 0);
    signal drift_3_r    : signed(31 downto 0);  -- what the bias turns
    signal angle_3_r    : signed(31 downto 0);  -- with what the rate turns
    signal distance_3_r : signed(31 downto 0);  -- from there to the tilt
    signal tilt_3_r     : signed(31 downto 0);
    signal still_3_r    : std_logic;
    signal first_3_r    : std_logic;
    signal change       : signed(49 downto 0);
    signal bias_in      : std_logic_vector(31 downto 0);
    signal bias_late    : std_logic_vector(31 downto 0);
    signal bias_r       : signed(31 downto 0);
    signal limited_r    : signed(31 downto 0);
    signal settled_r    : signed(31 downto 0);

  begin

    process (clk)
    begin
      if rising_edge(clk) then
        bias_2_r <= signed(read_r(64 downto 33));
        if read_r(0) = '0' then
          bias_2_r <= gyro_bias;
        end if;
        bias_3_r     <= bias_2_r;
        drift_3_r    <= shift_rounded(resize(bias_2_r, 50), bias_fraction_bits_c);
        angle_3_r    <= angle_2_r + turn_2_r;
        distance_3_r <= target_2_r - angle_2_r;
        tilt_3_r     <= tilt_2_r;
        still_3_r    <= not corrects_r(2) or not started_2_r;
        first_3_r    <= not started_2_r;
      end if;
    end process;

    still      <= still_3_r;
    first      <= first_3_r;
    innovation <= (others => '0') when still = '1' else distance_3_r + drift_3_r;
    predicted  <= tilt_3_r when first = '1' else angle_3_r - drift_3_r;

    learning : entity work.hk_multiplier_pipelined
      port map (
        clk         => clk,
        factor      => innovation,
        coefficient => integral_gain,
        product     => change
      );

    bias_in <= std_logic_vector(bias_3_r);

    beside_change : entity work.hk_delay
      generic map (
        BITS   => 32,
        CLOCKS => multiplier_clocks_c
      )
      port map (
        clk      => clk,
        rst      => rst,
        in_data  => bias_in,
        out_data => bias_late
      );

    process (clk)
    begin
      if rising_edge(clk) then
        bias_r    <= hk_sum(signed(bias_late),
                            not shift_floored(change, integral_gain_fraction_bits_c),
                            not change(integral_gain_fraction_bits_c - 1));
        limited_r <= limited(bias_r);
        settled_r <= angle_r;
      end if;
    end process;

    word(32 downto 1)  <= std_logic_vector(settled_r);
    word(64 downto 33) <= std_logic_vector(limited_r);
    angle              <= settled_r;
    bias               <= limited_r;

  end generate learned_bias;

  correcting : entity work.hk_multiplier_pipelined
    port map (
      clk         => clk,
      factor      => innovation,
      coefficient => blend,
      product     => product
    );

  process (clk)
  begin
    if rising_edge(clk) then
      predicted_r <= std_logic_vector(predicted);
      angle_r     <= hk_sum(signed(late), shift_floored(product, blend_fraction_bits_c),
                            product(blend_fraction_bits_c - 1));
    end if;
  end process;

  beside_product : entity work.hk_delay
    generic map (
      BITS   => 32,
      CLOCKS => multiplier_clocks_c - 1
    )
    port map (
      clk      => clk,
      rst      => rst,
      in_data  => predicted_r,
      out_data => late
    );

  first_in(0) <= not started_2_r;

  beside_all : entity work.hk_delay
    generic map (
      BITS   => 1,
      CLOCKS => loop_clocks - 2
    )
    port map (
      clk      => clk,
      rst      => rst,
      in_data  => first_in,
      out_data => first_late
    );

  restarted <= first_late(0);

end architecture rtl;
