-- A simulated MPU-6050 on an I2C bus; not for synthesis. Registers, sleep, resets that take their
-- time, INT pin and frozen data during a transfer as in hostkit's virtual sensor; counts come from
-- a file. Fails where SCL or SDA break a limit of the fast mode. A fault at 0 never comes.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use std.textio.all;

use work.hk_mpu6050_pkg.all;

entity hk_mpu6050_model is
  generic (
    COUNTS_FILE      : string;         -- a line a sample: accel x y z, gyro x y z, temperature; hex
    TIME_DIVISOR     : positive := 1;  -- of resets, waking and the sample period
    SAMPLE_PERIOD_US : natural  := 0;  -- 0: as the registers say, divided
    LEAD_IN          : natural  := settle_samples_c;  -- how often the first line comes again first
    IDENTITY         : natural  := 16#68#;
    NACK_AT          : natural  := 0;  -- which addressing; and how many
    NACKS            : positive := 1;
    STRETCH_AT       : natural  := 0;  -- which addressing
    STRETCH_US       : natural  := 0;
    STUCK_AT_US      : natural  := 0;  -- SDA held low, for so many clocks
    STUCK_CLOCKS     : positive := 5;
    STUCK_MIDWAY     : natural  := 0;  -- 1: even within a transfer
    TORN_AT_US       : natural  := 0;  -- lets go of the bus in the next burst
    UPSET_AT_US      : natural  := 0;  -- bits of a register turn over
    UPSET_REGISTER   : natural  := 16#1B#;
    UPSET_BITS       : natural  := 16#10#;
    RESET_AT_US      : natural  := 0;
    FROZEN_AT_US     : natural  := 0;  -- until a reset
    MUTE_AT_US       : natural  := 0;  -- so many samples without INT
    MUTE_SAMPLES     : natural  := 5;
    LENIENT_AT_US    : natural  := 0   -- when the master is reset: no limit is checked for 10 us
  );
  port (
    scl     : inout std_logic;  -- open drain: '0' or 'Z'
    sda     : inout std_logic;
    int_pin : out   std_logic;
    rows    : out   natural     -- lines of the file that have been played
  );
end entity hk_mpu6050_model;

architecture behaviour of hk_mpu6050_model is

  constant never_c : time := 1 hr;

  constant reset_time_c : time := 20 ms / TIME_DIVISOR;
  constant deaf_time_c  : time := 1 ms / TIME_DIVISOR;
  constant wake_time_c  : time := 30 ms / TIME_DIVISOR;
  constant lock_time_c  : time := 10 ms / TIME_DIVISOR;
  constant answer_c     : time := 300 ns;  -- from SCL low to the slave's bit

  function at_us (moment : natural) return time is
  begin
    if moment = 0 then
      return never_c;
    end if;
    return moment * 1 us;
  end function at_us;

  subtype byte_t is unsigned(7 downto 0);
  type registers_t is array (0 to 127) of byte_t;

  signal scl_level : std_logic;
  signal sda_level : std_logic;

begin

  scl_level <= to_x01(scl);
  sda_level <= to_x01(sda);

  sensor : process
    file counts       : text open read_mode is COUNTS_FILE;
    type burst_t is array (0 to 13) of byte_t;
    type talk_t is (idle, ignored, addressed, pointed, written, read);

    variable register_v : registers_t;
    variable pending_v  : burst_t;
    variable full_v     : boolean;   -- pending_v waits for the end of a transfer
    variable ready_v    : boolean;   -- and announces itself then
    variable lead_v     : natural;
    variable plays_v    : boolean;
    variable row_v      : burst_t;
    variable row_read_v : boolean;
    variable rows_v     : natural := 0;

    variable sample_at_v : time;
    variable awake_at_v  : time;     -- reset ends
    variable hears_at_v  : time;
    variable locked_at_v : time;
    variable pulse_at_v  : time;     -- ends
    variable latch_v     : boolean;

    variable stuck_at_v  : time := at_us(STUCK_AT_US);
    variable torn_at_v   : time := at_us(TORN_AT_US);
    variable upset_at_v  : time := at_us(UPSET_AT_US);
    variable reset_at_v  : time := at_us(RESET_AT_US);
    variable frozen_at_v : time := at_us(FROZEN_AT_US);
    variable mute_at_v   : time := at_us(MUTE_AT_US);
    variable frozen_v    : boolean;
    variable mute_v      : natural;
    variable stuck_v     : natural;
    variable calls_v     : natural;  -- addressings

    variable talk_v      : talk_t := idle;
    variable open_v      : boolean;
    variable bits_v      : natural;
    variable byte_v      : byte_t;
    variable place_v     : natural;
    variable bytes_v     : natural;  -- read in this transfer
    variable gone_v      : boolean;
    variable low_v       : boolean;  -- the slave pulls SDA
    variable stretch_v   : boolean;

    variable old_scl_v    : std_logic := '1';
    variable old_sda_v    : std_logic := '1';
    variable scl_rise_v   : time := 0 ns;
    variable scl_fall_v   : time := 0 ns;
    variable sda_change_v : time := 0 ns;
    variable start_v      : time := 0 ns;
    variable stop_v       : time := 0 ns;
    variable began_v      : boolean;

    impure function awake return boolean is
    begin
      return register_v(16#6B#)(6) = '0';
    end function awake;

    impure function period return time is
      variable tick_v : time := 1 ms;
    begin
      if SAMPLE_PERIOD_US /= 0 then
        return SAMPLE_PERIOD_US * 1 us;
      end if;
      if register_v(16#1A#)(2 downto 0) = 0 or register_v(16#1A#)(2 downto 0) = 7 then
        tick_v := 125 us;
      end if;
      return tick_v * (1 + to_integer(register_v(16#19#))) / TIME_DIVISOR;
    end function period;

    procedure sample_after (delay : time) is
    begin
      sample_at_v := never_c;
      if awake then
        sample_at_v := now + delay + period;
      end if;
    end procedure sample_after;

    procedure load_reset_values is
    begin
      register_v         := (others => (others => '0'));
      register_v(16#6B#) := x"40";
      register_v(16#75#) := to_unsigned(IDENTITY, 8);
      pending_v          := (others => (others => '0'));
      full_v             := false;
      ready_v            := false;
      latch_v            := false;
      plays_v            := false;
      frozen_v           := false;
      pulse_at_v         := never_c;
      sample_at_v        := never_c;
    end procedure load_reset_values;

    procedure begin_reset is
    begin
      load_reset_values;
      register_v(16#6B#) := x"80";
      awake_at_v         := now + reset_time_c;
      hears_at_v         := now + deaf_time_c;
    end procedure begin_reset;

    procedure write_register (place : natural; value : byte_t) is
      variable was_awake_v : boolean;
    begin
      if place = 16#6B# then
        if value(7) = '1' then
          begin_reset;
          return;
        end if;
        was_awake_v       := awake;
        register_v(place) := value;
        if awake and not was_awake_v then
          locked_at_v := now + wake_time_c + lock_time_c;
        end if;
        if awake /= was_awake_v then
          sample_after(wake_time_c);
        end if;
      elsif place = 16#68# then
        if value(2 downto 0) = "111" then
          register_v(16#3B# to 16#48#) := (others => (others => '0'));
          pending_v                    := (others => (others => '0'));
          sample_after(wake_time_c);
        end if;
      elsif place = 16#19# or place = 16#1A# then
        register_v(place) := value;
        if sample_at_v /= never_c then
          sample_after(0 ns);
        end if;
      elsif place = 16#38# then
        register_v(place) := value;
        if value(0) = '1' and not plays_v then
          lead_v := LEAD_IN;
        end if;
        plays_v := value(0) = '1';
      elsif place = 16#37# then
        register_v(place) := value;
        latch_v           := false;
      elsif place = 16#6A# then
        register_v(place) := value and x"F8";
      elsif place = 16#1B# or place = 16#1C# or place = 16#23# or place = 16#6C# then
        register_v(place) := value;
      elsif place = 16#1D# and is_variant(std_logic_vector(to_unsigned(IDENTITY, 8))) = '1' then
        register_v(place) := value;
      end if;
    end procedure write_register;

    impure function read_register (place : natural) return byte_t is
      variable value_v : byte_t;
    begin
      value_v := register_v(place);
      if place = 16#3A# or register_v(16#37#)(4) = '1' then
        register_v(16#3A#) := (others => '0');
        if register_v(16#37#)(5) = '1' then
          latch_v := false;
        end if;
      end if;
      return value_v;
    end function read_register;

    procedure publish is
    begin
      full_v := false;
      for i in 0 to 13 loop
        register_v(16#3B# + i) := pending_v(i);
      end loop;
      if ready_v and register_v(16#38#)(0) = '1' then
        register_v(16#3A#)(0) := '1';
        if mute_v > 0 then
          mute_v := mute_v - 1;
        else
          latch_v := true;
          if register_v(16#37#)(5) = '0' then
            pulse_at_v := now + 50 us;
          end if;
        end if;
      end if;
    end procedure publish;

    -- The next line of the file into row_v; false where it ends.
    procedure read_row (found : out boolean) is
      variable line_v  : line;
      variable char_v  : character;
      variable good_v  : boolean;
      variable value_v : natural;
      type place_t is array (0 to 6) of natural;
      constant place_c : place_t := (0, 2, 4, 8, 10, 12, 6);
    begin
      found := false;
      if endfile(counts) then
        return;
      end if;
      readline(counts, line_v);
      for word in 0 to 6 loop
        value_v := 0;
        for digit in 0 to 3 loop
          char_v := ' ';
          while char_v = ' ' loop
            read(line_v, char_v, good_v);
            assert good_v
              report "a line of " & COUNTS_FILE & " is too short"
              severity failure;
          end loop;
          if char_v >= '0' and char_v <= '9' then
            value_v := 16 * value_v + character'pos(char_v) - character'pos('0');
          elsif char_v >= 'a' and char_v <= 'f' then
            value_v := 16 * value_v + 10 + character'pos(char_v) - character'pos('a');
          else
            value_v := 16 * value_v + 10 + character'pos(char_v) - character'pos('A');
          end if;
        end loop;
        row_v(place_c(word))     := to_unsigned(value_v / 256, 8);
        row_v(place_c(word) + 1) := to_unsigned(value_v mod 256, 8);
      end loop;
      found := true;
    end procedure read_row;

    procedure take_sample is
      variable found_v   : boolean;
      variable standby_v : boolean;
    begin
      if not row_read_v then
        read_row(found_v);
        if not found_v then
          sample_at_v := never_c;
          return;
        end if;
        row_read_v := true;
      end if;
      if plays_v then
        if lead_v > 0 then
          lead_v := lead_v - 1;
        else
          row_read_v := false;
          rows_v     := rows_v + 1;
        end if;
      end if;
      if not frozen_v then
        for axis in 0 to 5 loop
          standby_v := register_v(16#6C#)(5 - axis) = '1';
          if not standby_v then
            for i in 2 * axis + 2 * (axis / 3) to 2 * axis + 2 * (axis / 3) + 1 loop
              pending_v(i) := row_v(i);
              if axis >= 3 and now < locked_at_v then
                pending_v(i) := x"55";
              end if;
            end loop;
          end if;
        end loop;
        pending_v(6) := row_v(6);
        pending_v(7) := row_v(7);
      end if;
      full_v  := true;
      ready_v := register_v(16#38#)(0) = '1';
      if not open_v then
        publish;
      end if;
      sample_at_v := now + period;
    end procedure take_sample;

    -- What a byte from the master does; whether it is acknowledged.
    impure function take_byte return boolean is
    begin
      if talk_v = addressed then
        if byte_v(7 downto 1) /= unsigned(sensor_address_c) or now < hears_at_v
           or stuck_v > 0 then
          talk_v := ignored;
          return false;
        end if;
        calls_v := calls_v + 1;
        if NACK_AT > 0 and calls_v >= NACK_AT and calls_v < NACK_AT + NACKS then
          talk_v := ignored;
          return false;
        end if;
        stretch_v := STRETCH_AT > 0 and calls_v = STRETCH_AT;
        open_v    := true;
        bytes_v   := 0;
        gone_v    := false;
        talk_v    := pointed;
        if byte_v(0) = '1' then
          talk_v := read;
        end if;
      elsif talk_v = pointed then
        place_v := to_integer(byte_v) mod 128;
        talk_v  := written;
      else
        if awake_at_v = never_c then
          write_register(place_v, byte_v);
        end if;
        if place_v /= 16#74# then
          place_v := (place_v + 1) mod 128;
        end if;
      end if;
      return true;
    end function take_byte;

    procedure give_byte is
    begin
      if now >= torn_at_v and bytes_v = 6 then
        torn_at_v := never_c;
        gone_v    := true;
      end if;
      byte_v  := x"FF";
      bytes_v := bytes_v + 1;
      if not gone_v then
        byte_v := read_register(place_v);
        if place_v /= 16#74# then
          place_v := (place_v + 1) mod 128;
        end if;
      end if;
    end procedure give_byte;

    impure function lenient return boolean is
      constant from_c : time := at_us(LENIENT_AT_US);
    begin
      return now >= from_c and now <= from_c + 10 us;
    end function lenient;

    procedure on_scl_fall is
    begin
      assert lenient or now - scl_rise_v >= 600 ns or scl_rise_v = 0 ns
        report "SCL was high for less than 0.6 us"
        severity failure;
      assert lenient or not began_v or now - start_v >= 600 ns
        report "SCL fell less than 0.6 us after a start"
        severity failure;
      began_v    := false;
      scl_fall_v := now;
      if stuck_v > 0 then
        stuck_v := stuck_v - 1;
      end if;
      low_v := false;
      if bits_v = 8 then
        if talk_v = addressed or talk_v = pointed or talk_v = written then
          low_v := take_byte;
        end if;
      else
        if bits_v = 9 then
          bits_v := 0;
          if stretch_v then
            stretch_v := false;
            scl       <= '0', 'Z' after STRETCH_US * 1 us;
          end if;
          if talk_v = read then
            give_byte;
          end if;
        end if;
        if talk_v = read then
          low_v := byte_v(7 - bits_v) = '0';
        end if;
      end if;
    end procedure on_scl_fall;

    procedure on_scl_rise is
    begin
      assert lenient or now - scl_fall_v >= 1300 ns
        report "SCL was low for less than 1.3 us"
        severity failure;
      assert lenient or now - sda_change_v >= 100 ns
        report "SDA changed less than 0.1 us before SCL rose"
        severity failure;
      assert lenient or now - scl_rise_v >= 2500 ns or scl_rise_v = 0 ns
        report "the clock is faster than 400 kHz"
        severity failure;
      scl_rise_v := now;
      if bits_v = 8 and talk_v = read and sda_level = '1' then
        talk_v := ignored;
      end if;
      if bits_v < 8 and talk_v /= read then
        byte_v := byte_v(6 downto 0) & sda_level;
      end if;
      if talk_v /= idle and bits_v < 9 then
        bits_v := bits_v + 1;
      end if;
    end procedure on_scl_rise;

    procedure on_start is
    begin
      assert lenient or now - scl_rise_v >= 600 ns
        report "a start less than 0.6 us after SCL rose"
        severity failure;
      assert lenient or now - stop_v >= 1300 ns or stop_v = 0 ns
        report "the bus was free for less than 1.3 us"
        severity failure;
      start_v := now;
      began_v := true;
      talk_v  := addressed;
      bits_v  := 0;
    end procedure on_start;

    procedure on_stop is
    begin
      assert lenient or now - scl_rise_v >= 600 ns
        report "a stop less than 0.6 us after SCL rose"
        severity failure;
      stop_v := now;
      talk_v := idle;
      bits_v := 0;
      open_v := false;
      if full_v then
        publish;
      end if;
    end procedure on_stop;

    impure function next_event return time is
      variable next_v : time := never_c;

      procedure consider (event : time) is
      begin
        if event < next_v then
          next_v := event;
        end if;
      end procedure consider;
    begin
      consider(sample_at_v);
      consider(awake_at_v);
      consider(pulse_at_v);
      if not open_v or STUCK_MIDWAY = 1 then
        consider(stuck_at_v);
      end if;
      consider(upset_at_v);
      consider(reset_at_v);
      consider(frozen_at_v);
      consider(mute_at_v);
      return next_v;
    end function next_event;

    procedure on_time is
    begin
      if now >= stuck_at_v and (not open_v or STUCK_MIDWAY = 1) then
        stuck_at_v := never_c;
        stuck_v    := STUCK_CLOCKS;
      end if;
      if now >= upset_at_v then
        upset_at_v := never_c;
        write_register(UPSET_REGISTER,
                       register_v(UPSET_REGISTER) xor to_unsigned(UPSET_BITS, 8));
      end if;
      if now >= reset_at_v then
        reset_at_v := never_c;
        begin_reset;
      end if;
      if now >= frozen_at_v then
        frozen_at_v := never_c;
        frozen_v    := true;
      end if;
      if now >= mute_at_v then
        mute_at_v := never_c;
        mute_v    := MUTE_SAMPLES;
      end if;
      if now >= awake_at_v then
        awake_at_v := never_c;
        load_reset_values;
      end if;
      if now >= pulse_at_v then
        pulse_at_v := never_c;
        latch_v    := false;
      end if;
      if now >= sample_at_v then
        take_sample;
      end if;
    end procedure on_time;

  begin
    scl        <= 'Z';
    sda        <= 'Z';
    int_pin    <= '0';
    rows       <= 0;
    awake_at_v := never_c;
    load_reset_values;
    loop
      if next_event = never_c then
        wait on scl_level, sda_level;
      elsif next_event > now then
        wait on scl_level, sda_level for next_event - now;
      end if;
      on_time;
      if scl_level = '0' and old_scl_v = '1' then
        on_scl_fall;
      elsif scl_level = '1' and old_scl_v = '0' then
        on_scl_rise;
      end if;
      if sda_level /= old_sda_v then
        sda_change_v := now;
        if scl_level = '1' and old_scl_v = '1' then
          if sda_level = '0' and stuck_v = 0 then
            on_start;
          elsif sda_level = '1' then
            on_stop;
          end if;
        end if;
      end if;
      old_scl_v := scl_level;
      old_sda_v := sda_level;
      if stuck_v > 0 and scl_level = '1' then
        sda <= '0';
      elsif low_v or stuck_v > 0 then
        sda <= transport '0' after answer_c;
      else
        sda <= transport 'Z' after answer_c;
      end if;
      rows <= rows_v;
      if latch_v xor register_v(16#37#)(7) = '1' then
        int_pin <= '1';
      else
        int_pin <= '0';
      end if;
    end loop;
  end process sensor;

end architecture behaviour;
