-- The bounded-velocity observer. Takes raw counts in sensor axes, follows the orientation, velocity
-- and bias of the gyroscope, and tells roll and pitch. It is a program (hk_observer_program_pkg)
-- that hk_sequencer runs for each sample; the arc tangent follows it on the same multiplier.
-- The first sample after reset loads its state from the specific force.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.hk_common_pkg.all;
use work.hk_design_pkg.all;
use work.hk_observer_pkg.all;
use work.hk_observer_program_pkg.all;
use work.hk_sequence_pkg.all;

entity hk_observer is
  generic (
    CHANNELS : positive range 1 to 1 := channels_c
  );
  port (
    clk           : in  std_logic;
    rst           : in  std_logic;  -- synchronous, active high
    settings      : in  hk_settings_t;  -- may change only while busy = '0'
    busy          : out std_logic;      -- a sample is in work
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
    state_index   : in  unsigned(4 downto 0);  -- of a word of the state; while out_valid = '1'
    state_word    : out signed(31 downto 0);   -- that word, from two clocks after the index on
    restarted     : out std_logic;            -- first sample: it loaded the state
    saturated     : out std_logic;            -- a count stands at the end of its range
    design_digest : out std_logic_vector(47 downto 0)  -- constant: which design this core is
  );
end entity hk_observer;

architecture rtl of hk_observer is

  constant step_place_c   : natural := step_place;
  constant angles_place_c : natural := angles_place;

  type state_t is (
    idle,
    loading,    -- the first sample
    stepping,   -- with the angles program behind it
    measuring,  -- the arc tangent
    finished
  );
  signal state_r : state_t;

  type counts_t is array (0 to 5) of signed(15 downto 0);
  signal counts_r    : counts_t;
  signal started_r   : std_logic;  -- it has had its first sample
  signal restarted_r : std_logic;
  signal saturated_r : std_logic;
  signal roll_next_r : std_logic;
  signal roll_r      : signed(31 downto 0);
  signal pitch_r     : signed(31 downto 0);

  signal start       : std_logic;
  signal place       : unsigned(place_bits_c - 1 downto 0);
  signal done        : std_logic;
  signal input_index : std_logic_vector(5 downto 0);
  signal input_word  : signed(31 downto 0);
  signal measure     : std_logic;
  signal result      : signed(31 downto 0);

  -- Components of up: against body x, along body y, and along body z, which is the last to come.
  type sizes_t is array (0 to 2) of unsigned(29 downto 0);
  signal sizes_r  : sizes_t;
  signal signs_r  : std_logic_vector(0 to 2);
  signal begins_r : std_logic;

  signal arctan_done : std_logic;
  signal no_offset   : signed(31 downto 0);
  signal angle       : signed(31 downto 0);
  signal multiply    : std_logic;
  signal factor      : signed(30 downto 0);
  signal coefficient : signed(17 downto 0);
  signal product     : signed(49 downto 0);

begin

  in_ready    <= '1' when state_r = idle else '0';
  busy        <= '0' when state_r = idle else '1';
  out_valid   <= '1' when state_r = finished else '0';
  out_channel <= (others => '0');
  restarted   <= restarted_r;
  saturated   <= saturated_r;
  angle_roll  <= roll_r when has_roll_c else (others => '0');
  angle_pitch <= pitch_r when has_pitch_c else (others => '0');

  -- In halves, because GHDL 2.0 converts a constant of more than 32 bits wrongly.
  design_digest(47 downto 24) <= design_digest_c(47 downto 24);
  design_digest(23 downto 0)  <= design_digest_c(23 downto 0);

  -- The angles program follows both others: a step runs into it, the first sample ends before it.
  start <= in_valid when state_r = idle else done when state_r = loading else '0';
  place <= to_unsigned(angles_place_c, place_bits_c) when state_r /= idle
           else to_unsigned(step_place_c, place_bits_c) when started_r = '1'
           else (others => '0');

  main : process (clk)
  begin
    if rising_edge(clk) then
      if state_r = idle then
        if in_valid = '1' then
          counts_r    <= (accel_x, accel_y, accel_z, gyro_x, gyro_y, gyro_z);
          saturated_r <= '0';
          if at_end_of_range(accel_x) or at_end_of_range(accel_y) or at_end_of_range(accel_z)
            or at_end_of_range(gyro_x) or at_end_of_range(gyro_y) or at_end_of_range(gyro_z) then
            saturated_r <= '1';
          end if;
          roll_next_r <= '1';
          started_r   <= '1';
          restarted_r <= not started_r;
          state_r     <= stepping;
          if started_r = '0' then
            state_r <= loading;
          end if;
        end if;

      elsif state_r = loading then
        if done = '1' then
          state_r <= stepping;
        end if;

      elsif state_r = stepping then
        if done = '1' then
          state_r <= measuring;
        end if;

      elsif state_r = measuring then
        if arctan_done = '1' then
          roll_next_r <= '0';
          if roll_next_r = '1' then
            roll_r <= angle;
          else
            pitch_r <= angle;
            state_r <= finished;
          end if;
        end if;

      else
        if out_ready = '1' then
          state_r <= idle;
        end if;
      end if;

      if rst = '1' then
        started_r <= '0';
        state_r   <= idle;
      end if;
    end if;
  end process main;

  -- Counts doubled, then the settings in their order.
  inputs : process (input_index, counts_r, settings)
    variable count_v : signed(15 downto 0);
  begin
    if input_index(3) = '0' and input_index(2 downto 1) /= "11" then
      count_v    := counts_r(to_integer(unsigned(input_index(2 downto 0))));
      input_word <= shift_left(resize(count_v, 32), 1);
    elsif input_index(3 downto 0) = "0110" then
      input_word <= settings.kt;
    elsif input_index(3 downto 0) = "0111" then
      input_word <= settings.kv;
    elsif input_index(3 downto 0) = "1000" then
      input_word <= settings.kb;
    elsif input_index(3 downto 0) = "1001" then
      input_word <= settings.gyro_bias_x;
    elsif input_index(3 downto 0) = "1010" then
      input_word <= settings.gyro_bias_y;
    else
      input_word <= settings.gyro_bias_z;
    end if;
  end process inputs;

  sequencer : entity work.hk_sequencer
    port map (
      clk         => clk,
      rst         => rst,
      start       => start,
      place       => place,
      done        => done,
      input_index => input_index,
      input_word  => input_word,
      measure     => measure,
      result      => result,
      state_index => state_index,
      state_word  => state_word,
      multiply    => multiply,
      factor      => factor,
      coefficient => coefficient,
      product     => product
    );

  components : process (clk)
    variable size_v : signed(31 downto 0);
  begin
    if rising_edge(clk) then
      size_v := result;
      if result(31) = '1' then
        size_v := -result;
      end if;
      if measure = '1' then
        sizes_r <= sizes_r(1 to 2) & unsigned(size_v(29 downto 0));
        signs_r <= signs_r(1 to 2) & result(31);
      end if;
      begins_r <= '0';
      if state_r = stepping then
        begins_r <= done;
      end if;
      if rst = '1' then
        begins_r <= '0';
      end if;
    end if;
  end process components;

  no_offset <= (others => '0');

  arctan : entity work.hk_arctan
    generic map (
      SIZE_BITS => 30
    )
    port map (
      clk             => clk,
      rst             => rst,
      in_valid        => begins_r,
      in_ready        => open,
      x               => sizes_r(2),
      y               => sizes_r(1),
      x_negative      => signs_r(2),
      y_negative      => signs_r(1),
      second          => '1',
      y_second        => sizes_r(0),
      second_negative => signs_r(0),
      zero            => no_offset,
      out_valid       => arctan_done,
      angle           => angle,
      length          => open,
      stretch         => open,
      turn            => open,
      multiply        => multiply,
      factor          => factor,
      coefficient     => coefficient,
      product         => product
    );

end architecture rtl;
