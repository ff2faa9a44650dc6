-- Bench of hk_complementary: plays a vector file and writes what comes out.
--
-- VECTOR_FILE: one sample a line, six 16-bit hex words: accel x y z, gyro x y z.
-- RESULT_FILE: first line the design digest; then one sample a line: roll, pitch and the biases of
-- both as 32-bit hex words, restarted as 0 or 1, and the latency in clocks.
--
-- The bench ends by itself: without an error when every sample has come out, with a failure when
-- the core breaks the handshake, changes a waiting result, or gives nothing for WATCHDOG_CLOCKS.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use std.textio.all;

entity hk_complementary_tb is
  generic (
    VECTOR_FILE     : string   := "vectors.txt";
    RESULT_FILE     : string   := "results.txt";
    RANDOM_STALLS   : boolean  := false;  -- gaps on both sides, unknown inputs in the gaps
    ABANDON_CLOCKS  : natural  := 0;      -- if not 0: reset so long after a first try, then start
    WATCHDOG_CLOCKS : positive := 1000
  );
end entity hk_complementary_tb;

architecture sim of hk_complementary_tb is

  constant clock_period_c : time := 10 ns;

  type hex_digits_t is array (0 to 15) of character;
  constant hex_digits_c : hex_digits_t := "0123456789abcdef";

  subtype noise_t is unsigned(15 downto 0);
  subtype count_t is signed(15 downto 0);
  type sample_t is array (0 to 5) of count_t;
  type state_t is array (0 to 3) of signed(31 downto 0);

  signal clk      : std_logic := '0';
  signal rst      : std_logic := '1';
  signal started  : boolean   := false;
  signal all_sent : boolean   := false;
  signal sent     : natural   := 0;
  signal ended    : boolean   := false;

  signal in_valid      : std_logic := '0';
  signal in_ready      : std_logic;
  signal sample        : sample_t;
  signal out_valid     : std_logic;
  signal out_ready     : std_logic := '0';
  signal state         : state_t;
  signal restarted     : std_logic;
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

  procedure read_sample (text_line : inout line; value : out sample_t) is
    variable word_v  : count_t;
    variable digit_v : character;
  begin
    for i in sample_t'range loop
      if i > 0 then
        read(text_line, digit_v);
        assert digit_v = ' ' report "words in the vector file are not one space apart"
          severity failure;
      end if;
      for nibble in 1 to 4 loop
        read(text_line, digit_v);
        word_v := word_v(11 downto 0) & to_signed(digit_value(digit_v), 5)(3 downto 0);
      end loop;
      value(i) := word_v;
    end loop;
    assert text_line'length = 0 report "a line of the vector file is longer than six words"
      severity failure;
  end procedure read_sample;

  procedure write_hex (text_line : inout line; value : in std_logic_vector) is
    alias bits_v : std_logic_vector(value'length - 1 downto 0) is value;
  begin
    assert not is_x(value) report "the core gives an unknown value" severity failure;
    for nibble in value'length / 4 - 1 downto 0 loop
      write(text_line,
            hex_digits_c(to_integer(unsigned(bits_v(4 * nibble + 3 downto 4 * nibble)))));
    end loop;
  end procedure write_hex;

begin

  core : entity work.hk_complementary
    port map (
      clk           => clk,
      rst           => rst,
      in_valid      => in_valid,
      in_ready      => in_ready,
      accel_x       => sample(0),
      accel_y       => sample(1),
      accel_z       => sample(2),
      gyro_x        => sample(3),
      gyro_y        => sample(4),
      gyro_z        => sample(5),
      out_valid     => out_valid,
      out_ready     => out_ready,
      angle_roll    => state(0),
      angle_pitch   => state(1),
      bias_roll     => state(2),
      bias_pitch    => state(3),
      restarted     => restarted,
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
    file vectors       : text open read_mode is VECTOR_FILE;
    variable line_v    : line;
    variable sample_v  : sample_t;
    variable noise_v   : noise_t := x"ACE1";

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

    procedure offer (value : sample_t) is
    begin
      in_valid <= '1';
      sample   <= value;
      wait until rising_edge(clk) and in_ready = '1';
      in_valid <= '0';
    end procedure offer;

  begin
    reset;
    if ABANDON_CLOCKS > 0 then
      offer((others => x"1234"));
      wait_clocks(ABANDON_CLOCKS);
      reset;
    end if;
    started <= true;
    while not endfile(vectors) loop
      readline(vectors, line_v);
      read_sample(line_v, sample_v);
      if RANDOM_STALLS then
        noise_v := stirred(noise_v);
        if noise_v(0) = '1' then
          sample <= (others => (others => 'X'));
          wait_clocks(to_integer(noise_v(7 downto 1)));
        end if;
      end if;
      offer(sample_v);
      sent <= sent + 1;
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
    variable clock_v   : natural := 0;
    variable taken_v   : natural := 0;  -- clock at which the core took the sample
    variable last_v    : natural := 0;  -- clock at which something happened
    variable latency_v : natural := 0;
    variable results_v : natural := 0;
  begin
    wait until started;
    write_hex(line_v, design_digest);
    writeline(results, line_v);
    while not (all_sent and results_v = sent) loop
      wait until rising_edge(clk);
      clock_v := clock_v + 1;

      if in_valid = '1' and in_ready = '1' then
        assert not waiting_v report "the core takes a sample while a result waits" severity failure;
        taken_v := clock_v;
      end if;

      if out_valid = '1' then
        if not waiting_v then
          latency_v := clock_v - taken_v;
          state_v   := state;
          waiting_v := true;
        end if;
        assert state = state_v
          report "the core changes a result that waits" severity failure;
        if out_ready = '1' then
          for i in state_t'range loop
            write_hex(line_v, std_logic_vector(state(i)));
            write(line_v, ' ');
          end loop;
          if restarted = '1' then
            write(line_v, string'("1 "));
          else
            write(line_v, string'("0 "));
          end if;
          write(line_v, latency_v);
          writeline(results, line_v);
          results_v := results_v + 1;
          waiting_v := false;
          last_v    := clock_v;
        end if;
      else
        assert not waiting_v report "the core takes back a result" severity failure;
      end if;

      assert clock_v - last_v < WATCHDOG_CLOCKS
        report "nothing has come out for " & integer'image(WATCHDOG_CLOCKS) & " clocks"
        severity failure;

      if RANDOM_STALLS then
        noise_v   := stirred(noise_v);
        out_ready <= noise_v(0);
      else
        out_ready <= '1';
      end if;
    end loop;
    ended <= true;
    wait;
  end process collect;

end architecture sim;
