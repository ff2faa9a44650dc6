-- hk_mpu6050 and its simulated sensor on one bus. Writes what comes out, one event a line:
--   I time           INT rose
--   S time sequence  accel x y z, temperature, gyro x y z
--   E time           errors, nacks, timeouts, stuck buses, restarts, lost samples, running, failed,
--                    identity, rows: at the end
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use std.textio.all;

entity hk_mpu6050_bench is
  generic (
    COUNTS_FILE      : string   := "counts.txt";
    RESULT_FILE      : string   := "results.txt";
    CLOCK_HZ         : positive := 4000000;
    TIME_DIVISOR     : positive := 32;
    SAMPLE_PERIOD_US : natural  := 0;
    LEAD_IN          : natural  := 2;
    RUN_US           : positive := 60000;
    STALL            : natural  := 0;   -- clocks that the consumer waits, at most
    RESET_AT_US      : natural  := 0;   -- of the driver
    IDENTITY         : natural  := 16#68#;
    NACK_AT          : natural  := 0;
    NACKS            : positive := 1;
    STRETCH_AT       : natural  := 0;
    STRETCH_US       : natural  := 0;
    STUCK_AT_US      : natural  := 0;
    STUCK_CLOCKS     : positive := 5;
    STUCK_MIDWAY     : natural  := 0;
    TORN_AT_US       : natural  := 0;
    UPSET_AT_US      : natural  := 0;
    UPSET_REGISTER   : natural  := 16#1B#;
    UPSET_BITS       : natural  := 16#10#;
    SELF_RESET_AT_US : natural  := 0;
    FROZEN_AT_US     : natural  := 0;
    MUTE_AT_US       : natural  := 0;
    MUTE_SAMPLES     : natural  := 5
  );
end entity hk_mpu6050_bench;

architecture bench of hk_mpu6050_bench is

  constant half_c : time := 1 sec / (2 * CLOCK_HZ);
  constant us_c   : positive := CLOCK_HZ / 500000;  -- half clocks in a microsecond

  signal clk     : std_logic := '0';
  signal rst     : std_logic := '1';
  signal ended   : boolean   := false;
  signal time_us : unsigned(63 downto 0) := (others => '0');
  signal scl     : std_logic;
  signal sda     : std_logic;
  signal scl_low : std_logic;
  signal sda_low : std_logic;
  signal int_pin : std_logic;
  signal rows    : natural;

  signal out_valid    : std_logic;
  signal out_ready    : std_logic := '1';
  signal out_time_us  : unsigned(63 downto 0);
  signal out_sequence : unsigned(31 downto 0);
  signal identity_out : std_logic_vector(7 downto 0);
  signal running      : std_logic;
  signal failed       : std_logic;

  type counts_t is array (0 to 6) of signed(15 downto 0);
  signal counts : counts_t;
  type counters_t is array (0 to 5) of unsigned(15 downto 0);
  signal counters : counters_t;

begin

  scl <= 'H';
  sda <= 'H';
  scl <= '0' when scl_low = '1' else 'Z';
  sda <= '0' when sda_low = '1' else 'Z';

  clock : process
  begin
    while not ended loop
      wait for half_c;
      clk <= not clk;
    end loop;
    wait;
  end process clock;

  stopwatch : process (clk)
    variable part_v : natural := 0;
  begin
    if rising_edge(clk) then
      part_v := part_v + 2;
      if part_v >= us_c then
        part_v  := part_v - us_c;
        time_us <= time_us + 1;
      end if;
    end if;
  end process stopwatch;

  control : process
  begin
    wait for 3 us;
    rst <= '0';
    if RESET_AT_US > 0 then
      wait for RESET_AT_US * 1 us;
      rst <= '1';
      wait for 1 us;
      rst <= '0';
      wait for (RUN_US - RESET_AT_US) * 1 us;
    else
      wait for RUN_US * 1 us;
    end if;
    ended <= true;
    wait;
  end process control;

  driver : entity work.hk_mpu6050
    generic map (
      CLOCK_HZ     => CLOCK_HZ,
      TIME_DIVISOR => TIME_DIVISOR
    )
    port map (
      clk          => clk,
      rst          => rst,
      time_us      => time_us,
      int_pin      => int_pin,
      scl_in       => to_x01(scl),
      sda_in       => to_x01(sda),
      scl_low      => scl_low,
      sda_low      => sda_low,
      out_valid    => out_valid,
      out_ready    => out_ready,
      out_time_us  => out_time_us,
      out_sequence => out_sequence,
      accel_x      => counts(0),
      accel_y      => counts(1),
      accel_z      => counts(2),
      temperature  => counts(3),
      gyro_x       => counts(4),
      gyro_y       => counts(5),
      gyro_z       => counts(6),
      identity     => identity_out,
      running      => running,
      failed       => failed,
      errors       => counters(0),
      nacks        => counters(1),
      timeouts     => counters(2),
      stuck_buses  => counters(3),
      restarts     => counters(4),
      lost_samples => counters(5)
    );

  sensor : entity work.hk_mpu6050_model
    generic map (
      COUNTS_FILE      => COUNTS_FILE,
      TIME_DIVISOR     => TIME_DIVISOR,
      SAMPLE_PERIOD_US => SAMPLE_PERIOD_US,
      LEAD_IN          => LEAD_IN,
      IDENTITY         => IDENTITY,
      NACK_AT          => NACK_AT,
      NACKS            => NACKS,
      STRETCH_AT       => STRETCH_AT,
      STRETCH_US       => STRETCH_US,
      STUCK_AT_US      => STUCK_AT_US,
      STUCK_CLOCKS     => STUCK_CLOCKS,
      STUCK_MIDWAY     => STUCK_MIDWAY,
      TORN_AT_US       => TORN_AT_US,
      UPSET_AT_US      => UPSET_AT_US,
      UPSET_REGISTER   => UPSET_REGISTER,
      UPSET_BITS       => UPSET_BITS,
      RESET_AT_US      => SELF_RESET_AT_US,
      FROZEN_AT_US     => FROZEN_AT_US,
      MUTE_AT_US       => MUTE_AT_US,
      MUTE_SAMPLES     => MUTE_SAMPLES,
      LENIENT_AT_US    => RESET_AT_US
    )
    port map (
      scl     => scl,
      sda     => sda,
      int_pin => int_pin,
      rows    => rows
    );

  consumer : process (clk, ended)
    file results      : text open write_mode is RESULT_FILE;
    variable line_v   : line;
    variable old_v    : counts_t;
    variable waits_v  : boolean := false;
    variable left_v   : natural := 0;
    variable random_v : natural := 1;
    variable int_v    : std_logic := '0';

    procedure put (value : unsigned) is
    begin
      write(line_v, ' ');
      write(line_v, to_integer(value(30 downto 0)));
    end procedure put;
  begin
    if rising_edge(clk) then
      if int_pin = '1' and int_v = '0' then
        write(line_v, string'("I"));
        put(time_us);
        writeline(results, line_v);
      end if;
      int_v := int_pin;
      if rst = '1' then
        waits_v := false;
      else
        if waits_v then
          assert out_valid = '1' and counts = old_v
            report "a sample changed while it waited"
            severity failure;
        end if;
        waits_v := out_valid = '1' and out_ready = '0';
        old_v   := counts;
        if out_valid = '1' and out_ready = '1' then
          write(line_v, string'("S"));
          put(out_time_us);
          put(resize(out_sequence, 64));
          for i in counts_t'range loop
            write(line_v, ' ');
            write(line_v, to_integer(counts(i)));
          end loop;
          writeline(results, line_v);
        end if;
      end if;
      if STALL > 0 then
        if left_v = 0 then
          random_v := (random_v * 1103 + 12345) mod 65536;
          left_v   := random_v mod STALL;
          out_ready <= '1';
        else
          left_v    := left_v - 1;
          out_ready <= '0';
        end if;
      end if;
    end if;
    if ended'event and ended then
      write(line_v, string'("E"));
      put(time_us);
      for i in counters_t'range loop
        put(resize(counters(i), 64));
      end loop;
      put(resize(unsigned'("" & running), 64));
      put(resize(unsigned'("" & failed), 64));
      put(resize(unsigned(identity_out), 64));
      put(to_unsigned(rows, 64));
      writeline(results, line_v);
    end if;
  end process consumer;

end architecture bench;
