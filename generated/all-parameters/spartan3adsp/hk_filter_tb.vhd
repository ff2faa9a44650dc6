-- made by hostkit 0.1.0 from design 0099cab74159; do not edit; template sim/hk_filter_tb.vhd.j2
-- Bench of hk_complementary: plays a vector file and writes what comes out.
--
-- VECTOR_FILE: one sample a line, seven 16-bit hex words: channel, accel x y z, gyro x y z. A line
-- that begins with "s " holds new settings, 32-bit hex words in the order of hk_settings_t; they are
-- taken over when every sample before them has come out.
-- RESULT_FILE: first line the design digest; then one sample a line: channel as 16-bit hex word,
-- roll, pitch and the hidden words as 32-bit hex words, restarted and saturated as 0 or 1, the
-- clock at which the sample was taken, and its latency in clocks.
--
-- The bench ends by itself: without an error when every sample has come out, with a failure when
-- the core breaks the handshake, changes a waiting result, says that it is not busy while it is,
-- mixes up channels, or gives nothing for WATCHDOG_CLOCKS.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use std.textio.all;

use work.hk_common_pkg.all;
use work.hk_complementary_pkg.all;
use work.hk_design_pkg.all;

entity hk_filter_tb is
  generic (
    CHANNELS        : positive := channels_c;
    PIPELINED       : boolean  := false;
    VECTOR_FILE     : string   := "vectors.txt";
    RESULT_FILE     : string   := "results.txt";
    RANDOM_STALLS   : boolean  := false;  -- gaps on both sides, unknown inputs in the gaps
    ABANDON_CLOCKS  : natural  := 0;      -- if not 0: reset so long after a first try, then start
    WATCHDOG_CLOCKS : positive := 1000
  );
end entity hk_filter_tb;

architecture sim of hk_filter_tb is

  constant clock_period_c : time := 10 ns;

  type hex_digits_t is array (0 to 15) of character;
  constant hex_digits_c : hex_digits_t := "0123456789abcdef";

  subtype noise_t is unsigned(15 downto 0);
  subtype count_t is signed(15 downto 0);
  type sample_t is array (0 to 5) of count_t;
  type state_t is array (0 to 3) of signed(31 downto 0);
  type words_t is array (natural range <>) of signed(31 downto 0);

  constant channel_bits_c : positive := hk_index_bits(CHANNELS);
  subtype channel_t is unsigned(channel_bits_c - 1 downto 0);

  -- Samples in work, oldest first.
  constant in_work_most_c : positive := 255;
  type clocks_t is array (0 to in_work_most_c) of natural;
  type channels_t is array (0 to in_work_most_c) of channel_t;

  signal clk      : std_logic := '0';
  signal rst      : std_logic := '1';
  signal started  : boolean   := false;
  signal all_sent : boolean   := false;
  signal sent     : natural   := 0;
  signal ended    : boolean   := false;

  signal done     : natural   := 0;

  signal settings      : hk_settings_t := design_settings_c;
  signal busy          : std_logic;
  signal in_valid      : std_logic := '0';
  signal in_ready      : std_logic;
  signal in_channel    : channel_t := (others => '0');
  signal sample        : sample_t;
  signal out_valid     : std_logic;
  signal out_ready     : std_logic := '0';
  signal out_channel   : channel_t;
  signal state         : state_t;
  signal restarted     : std_logic;
  signal saturated     : std_logic;
  signal design_digest : std_logic_vector(47 downto 0);

  -- Next state of a 16-bit linear feedback shift register, x^16 + x^14 + x^13 + x^11 + 1.
  function stirred (noise : noise_t) return noise_t is
  begin
    return noise(14 downto 0) & (noise(15) xor noise(13) xor noise(12) xor noise(10));
  end function stirred;

  function digit_value (digit : character) return natural is
  begin
    case digit is
      when '0' to '9' => return character'pos(digit) - character'pos('0');
      when 'a' to 'f' => return character'pos(digit) - character'pos('a') + 10;
      when 'A' to 'F' => return character'pos(digit) - character'pos('A') + 10;
      when others =>
        report "not a hex digit in the vector file: " & digit severity failure;
        return 0;
    end case;
  end function digit_value;

  procedure read_word (text_line : inout line; digits : in positive; value : out signed) is
    variable word_v  : signed(31 downto 0) := (others => '0');
    variable digit_v : character;
  begin
    for nibble in 1 to digits loop
      read(text_line, digit_v);
      word_v := word_v(27 downto 0) & to_signed(digit_value(digit_v), 5)(3 downto 0);
    end loop;
    value := word_v(value'length - 1 downto 0);
  end procedure read_word;

  procedure read_space (text_line : inout line) is
    variable space_v : character;
  begin
    read(text_line, space_v);
    assert space_v = ' ' report "words in the vector file are not one space apart"
      severity failure;
  end procedure read_space;

  procedure read_sample (
    text_line : inout line;
    channel   : out channel_t;
    value     : out sample_t
  ) is
    variable channel_v : signed(16 downto 0);
  begin
    read_word(text_line, 4, channel_v);
    assert channel_v < CHANNELS report "there is no such channel" severity failure;
    channel := unsigned(channel_v(channel_bits_c - 1 downto 0));
    for i in sample_t'range loop
      read_space(text_line);
      read_word(text_line, 4, value(i));
    end loop;
    assert text_line'length = 0 report "a line of the vector file is longer than seven words"
      severity failure;
  end procedure read_sample;

  procedure read_settings (text_line : inout line; value : out hk_settings_t) is
    variable words_v : words_t(0 to 9);
    variable mark_v  : character;
  begin
    read(text_line, mark_v);
    for i in words_v'range loop
      read_space(text_line);
      read_word(text_line, 8, words_v(i));
    end loop;
    assert text_line'length = 0 report "a line of settings is longer than the settings"
      severity failure;
    value.blend             := signed(words_v(0)(17 downto 0));
    value.rate_gain_roll    := signed(words_v(1)(17 downto 0));
    value.rate_gain_pitch   := signed(words_v(2)(17 downto 0));
    value.integral_gain     := signed(words_v(3)(17 downto 0));
    value.tilt_offset_roll  := signed(words_v(4)(31 downto 0));
    value.tilt_offset_pitch := signed(words_v(5)(31 downto 0));
    value.gyro_bias_roll    := signed(words_v(6)(31 downto 0));
    value.gyro_bias_pitch   := signed(words_v(7)(31 downto 0));
    value.gate_lowest       := unsigned(words_v(8)(31 downto 0));
    value.gate_highest      := unsigned(words_v(9)(31 downto 0));
  end procedure read_settings;

  procedure write_hex (text_line : inout line; value : in std_logic_vector) is
    alias bits_v : std_logic_vector(value'length - 1 downto 0) is value;
  begin
    assert not is_x(value) report "the core gives an unknown value" severity failure;
    for nibble in value'length / 4 - 1 downto 0 loop
      write(text_line,
            hex_digits_c(to_integer(unsigned(bits_v(4 * nibble + 3 downto 4 * nibble)))));
    end loop;
  end procedure write_hex;

  procedure write_flag (text_line : inout line; value : in std_logic) is
  begin
    assert not is_x(value) report "the core gives an unknown value" severity failure;
    if value = '1' then
      write(text_line, string'("1 "));
    else
      write(text_line, string'("0 "));
    end if;
  end procedure write_flag;

begin

  core : entity work.hk_complementary
    generic map (
      CHANNELS  => CHANNELS,
      PIPELINED => PIPELINED
    )
    port map (
      clk           => clk,
      rst           => rst,
      settings      => settings,
      busy          => busy,
      in_valid      => in_valid,
      in_ready      => in_ready,
      in_channel    => in_channel,
      accel_x       => sample(0),
      accel_y       => sample(1),
      accel_z       => sample(2),
      gyro_x        => sample(3),
      gyro_y        => sample(4),
      gyro_z        => sample(5),
      out_valid     => out_valid,
      out_ready     => out_ready,
      out_channel   => out_channel,
      angle_roll    => state(0),
      angle_pitch   => state(1),
      bias_roll     => state(2 + 0),
      bias_pitch    => state(2 + 1),
      restarted     => restarted,
      saturated     => saturated,
      design_digest => design_digest
    );

  clock : process
  begin
    while not ended loop
      wait for clock_period_c / 2;
      clk <= '1';
      wait for clock_period_c / 2;
      clk <= '0';
    end loop;
    wait;
  end process clock;

  send : process
    file vectors        : text open read_mode is VECTOR_FILE;
    variable line_v     : line;
    variable sample_v   : sample_t;
    variable channel_v  : channel_t;
    variable settings_v : hk_settings_t;
    variable sent_v     : natural := 0;
    variable noise_v    : noise_t := x"ACE1";

    procedure wait_clocks (clocks : natural) is
    begin
      for i in 1 to clocks loop
        wait until rising_edge(clk);
      end loop;
    end procedure wait_clocks;

    procedure reset is
    begin
      rst <= '1';
      wait_clocks(2);
      rst <= '0';
    end procedure reset;

    procedure offer (channel : channel_t; value : sample_t) is
    begin
      in_valid   <= '1';
      in_channel <= channel;
      sample     <= value;
      wait until rising_edge(clk) and in_ready = '1';
      in_valid   <= '0';
    end procedure offer;

  begin
    reset;
    if ABANDON_CLOCKS > 0 then
      offer((others => '0'), (others => x"1234"));
      wait_clocks(ABANDON_CLOCKS);
      reset;
    end if;
    started <= true;
    while not endfile(vectors) loop
      readline(vectors, line_v);
      if line_v(line_v'left) = 's' then
        read_settings(line_v, settings_v);
        while done /= sent_v or busy = '1' loop
          wait until rising_edge(clk);
        end loop;
        settings <= settings_v;
      else
        read_sample(line_v, channel_v, sample_v);
        if RANDOM_STALLS then
          noise_v := stirred(noise_v);
          if noise_v(0) = '1' then
            in_channel <= (others => 'X');
            sample     <= (others => (others => 'X'));
            wait_clocks(to_integer(noise_v(7 downto 1)));
          end if;
        end if;
        offer(channel_v, sample_v);
        sent_v := sent_v + 1;
        sent   <= sent_v;
      end if;
    end loop;
    all_sent <= true;
    wait;
  end process send;

  collect : process
    file results       : text open write_mode is RESULT_FILE;
    variable line_v    : line;
    variable noise_v   : noise_t := x"1D0F";
    variable waiting_v : boolean := false;
    variable state_v   : state_t;
    variable flags_v   : std_logic_vector(0 to 1);
    variable channel_v : channel_t;
    variable clock_v   : natural := 0;
    variable taken_v   : clocks_t;    -- clocks at which the core took the samples in work
    variable of_v      : channels_t;  -- and their channels
    variable in_work_v : natural := 0;
    variable last_v    : natural := 0;  -- clock at which something happened
    variable latency_v : natural := 0;
    variable results_v : natural := 0;
  begin
    wait until started;
    write_hex(line_v, design_digest);
    writeline(results, line_v);
    last_v := 2 ** channel_bits_c;  -- the channels are cleared first
    while not (all_sent and results_v = sent) loop
      wait until rising_edge(clk);
      clock_v := clock_v + 1;

      if out_valid = '1' then
        assert in_work_v > 0 report "the core gives a result too many" severity failure;
        if not waiting_v then
          latency_v := clock_v - taken_v(0);
          state_v   := state;
          flags_v   := restarted & saturated;
          channel_v := out_channel;
          waiting_v := true;
        end if;
        assert state = state_v and flags_v = (restarted & saturated) and out_channel = channel_v
          report "the core changes a result that waits" severity failure;
        if out_ready = '1' then
          assert out_channel = of_v(0) report "the core mixes up channels" severity failure;
          write_hex(line_v, std_logic_vector(resize(out_channel, 16)));
          write(line_v, ' ');
          for i in state_t'range loop
            write_hex(line_v, std_logic_vector(state_v(i)));
            write(line_v, ' ');
          end loop;
          write_flag(line_v, restarted);
          write_flag(line_v, saturated);
          write(line_v, taken_v(0));
          write(line_v, ' ');
          write(line_v, latency_v);
          writeline(results, line_v);
          results_v := results_v + 1;
          done      <= results_v;
          waiting_v := false;
          in_work_v := in_work_v - 1;
          last_v    := clock_v;
          taken_v   := taken_v(1 to in_work_most_c) & 0;
          of_v      := of_v(1 to in_work_most_c) & of_v(0);
        end if;
      else
        assert not waiting_v report "the core takes back a result" severity failure;
      end if;

      assert in_work_v = 0 or busy = '1'
        report "the core has a sample and is not busy" severity failure;

      if in_valid = '1' and in_ready = '1' then
        assert PIPELINED or (in_work_v = 0 and out_valid = '0')
          report "the core takes a sample while a result waits" severity failure;
        taken_v(in_work_v) := clock_v;
        of_v(in_work_v)    := in_channel;
        in_work_v          := in_work_v + 1;
      end if;

      assert clock_v < last_v + WATCHDOG_CLOCKS
        report "nothing has come out for " & integer'image(WATCHDOG_CLOCKS) & " clocks"
        severity failure;

      if RANDOM_STALLS then
        noise_v   := stirred(noise_v);
        out_ready <= noise_v(0);
      else
        out_ready <= '1';
      end if;
    end loop;

    -- Idle again, and for good.
    for clock in 1 to 100 loop
      wait until rising_edge(clk);
      assert out_valid = '0' report "the core gives a result too many" severity failure;
    end loop;
    assert busy = '0' report "the core has no sample and is busy" severity failure;
    ended <= true;
    wait;
  end process collect;

end architecture sim;
