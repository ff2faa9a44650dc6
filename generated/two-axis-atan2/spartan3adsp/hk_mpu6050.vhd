-- Driver of the MPU-6050: sets it up, reads a sample in one transfer for each edge of its INT pin,
-- and passes on only what is new, whole, and measured with the registers of the design. Works
-- through the program of hk_mpu6050_pkg, then round and round: a sample, the registers that say
-- what a count means, one more register.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.hk_i2c_pkg.all;
use work.hk_mpu6050_pkg.all;

entity hk_mpu6050 is
  generic (
    CLOCK_HZ     : positive;
    BUS_HZ       : positive := 400000;
    TIME_DIVISOR : positive := 1  -- for simulation: of the sensor's waits and sample period
  );
  port (
    clk          : in  std_logic;
    rst          : in  std_logic;  -- synchronous, active high
    time_us      : in  unsigned(63 downto 0);
    int_pin      : in  std_logic;  -- asynchronous; data ready, active high
    scl_in       : in  std_logic;  -- asynchronous: the lines as they are
    sda_in       : in  std_logic;
    scl_low      : out std_logic;  -- '1' pulls the line low
    sda_low      : out std_logic;
    out_valid    : out std_logic;  -- a sample; what follows holds while it waits
    out_ready    : in  std_logic;
    out_time_us  : out unsigned(63 downto 0);  -- when it was announced, or else found
    out_sequence : out unsigned(31 downto 0);  -- its number; one that was lost has a number too
    accel_x      : out signed(15 downto 0);    -- counts, sensor axes
    accel_y      : out signed(15 downto 0);
    accel_z      : out signed(15 downto 0);
    temperature  : out signed(15 downto 0);
    gyro_x       : out signed(15 downto 0);
    gyro_y       : out signed(15 downto 0);
    gyro_z       : out signed(15 downto 0);
    identity     : out std_logic_vector(7 downto 0);  -- WHO_AM_I as read last
    running      : out std_logic;  -- samples come
    failed       : out std_logic;  -- no sensor that is known; tried again every second
    errors       : out unsigned(15 downto 0);  -- transfers that failed
    nacks        : out unsigned(15 downto 0);  -- of these, without an acknowledge
    timeouts     : out unsigned(15 downto 0);  -- of these, with SCL held low
    stuck_buses  : out unsigned(15 downto 0);  -- attempts to free the bus that did not
    restarts     : out unsigned(15 downto 0);  -- set-ups after the first
    lost_samples : out unsigned(15 downto 0)   -- read while another one waited
  );
end entity hk_mpu6050;

architecture rtl of hk_mpu6050 is

  -- Time is counted in changes of one bit of time_us, which come every 2**bit us.
  function divided (bit_of_time : natural) return natural is
    variable bit_v  : natural  := bit_of_time;
    variable rest_v : positive := TIME_DIVISOR;
  begin
    while rest_v > 1 and bit_v > 0 loop
      rest_v := rest_v / 2;
      bit_v  := bit_v - 1;
    end loop;
    return bit_v;
  end function divided;

  constant wait_bit_c   : natural := divided(12);
  constant period_bit_c : natural := divided(period_unit_c);

  -- Each trouble in a row adds to what ends in a restart at 64: the fifth identity that is not
  -- accepted, the eleventh failed transfer, the 64th look in vain.
  subtype trouble_t is unsigned(6 downto 0);
  constant stranger_c : trouble_t := to_unsigned(13, 7);
  constant failure_c  : trouble_t := to_unsigned(6, 7);
  constant nothing_c  : trouble_t := to_unsigned(1, 7);

  type state_t is (
    decode,    -- a step of the program
    transfer,
    judge,     -- what came of it
    accept,    -- a sample
    deliver,
    worry,     -- something went wrong
    recover,
    resolve,
    pause,
    restart
  );
  signal state_r : state_t;

  -- The commands of a transfer, in order. The third of a reading is a repeated start.
  subtype phase_t is unsigned(2 downto 0);
  constant start_c   : phase_t := "000";
  constant address_c : phase_t := "001";
  constant pointer_c : phase_t := "010";
  constant third_c   : phase_t := "011";
  constant again_c   : phase_t := "100";  -- the address once more
  constant receive_c : phase_t := "101";
  constant stop_c    : phase_t := "110";
  signal phase_r : phase_t;

  -- Behind the set-up: which part of a round.
  type part_t is (set_up, sample, scale, one_more);
  signal part_r : part_t;

  signal place_r   : unsigned(4 downto 0);  -- in the program
  signal more_r    : unsigned(4 downto 0);  -- the register to be looked at next
  signal step      : hk_step_t;
  signal operation : hk_operation_t;
  signal verify_r  : std_logic;  -- the registers have been written, they are read back
  signal variant_r : std_logic;
  signal writes    : std_logic;  -- the step writes
  signal compares  : std_logic;  -- the step reads what is known

  signal command_valid_r : std_logic;
  signal command_ready   : std_logic;
  signal command         : hk_i2c_command_t;
  signal write_data      : std_logic_vector(7 downto 0);
  signal reply_valid     : std_logic;
  signal read_data       : std_logic_vector(7 downto 0);
  signal nack            : std_logic;
  signal timed_out       : std_logic;
  signal lost            : std_logic;
  signal stuck           : std_logic;

  signal index_r    : unsigned(3 downto 0);  -- of the byte that is read
  signal last_byte  : std_logic;
  signal mismatch_r : std_logic;
  signal ones_r     : std_logic;  -- the last byte was nothing else: the sensor let go of the bus
  signal failure_r  : std_logic;  -- of a transfer, which is to be repeated
  signal trouble_r  : trouble_t;

  signal int_r       : std_logic_vector(2 downto 0);
  signal announced_r : std_logic;
  signal by_pin_r    : std_logic;  -- this sample was announced
  signal fresh_r     : std_logic;  -- the sensor has a sample that was not passed on
  signal fill_r      : std_logic;  -- it may go into the output
  signal same_r      : std_logic;  -- it is like the one before
  signal left_r      : unsigned(8 downto 0);  -- samples until settled, or taken for frozen
  signal settled_r   : std_logic;

  signal event_time_r : unsigned(63 downto 0);
  signal ticking_r    : std_logic_vector(1 downto 0);
  signal timer_r      : unsigned(7 downto 0);

  signal out_valid_r : std_logic;
  signal bytes_r     : std_logic_vector(111 downto 0);
  signal keep        : std_logic;

  signal failed_transfer_r : std_logic;  -- events, pulses of one clock
  signal nack_r            : std_logic;
  signal timeout_r         : std_logic;
  signal stuck_r           : std_logic;
  signal restart_r         : std_logic;
  signal lost_sample_r     : std_logic;
  signal number_r          : std_logic;
  signal events            : std_logic_vector(5 downto 0);
  signal counting          : std_logic;

  signal identity_r : std_logic_vector(7 downto 0);
  signal failed_r   : std_logic;

begin

  out_valid   <= out_valid_r;
  accel_x     <= signed(bytes_r(111 downto 96));
  accel_y     <= signed(bytes_r(95 downto 80));
  accel_z     <= signed(bytes_r(79 downto 64));
  temperature <= signed(bytes_r(63 downto 48));
  gyro_x      <= signed(bytes_r(47 downto 32));
  gyro_y      <= signed(bytes_r(31 downto 16));
  gyro_z      <= signed(bytes_r(15 downto 0));
  identity    <= identity_r;
  running     <= settled_r;
  failed      <= failed_r;

  step      <= program_c(to_integer(place_r));
  operation <= step(18 downto 16);
  writes    <= '1' when (operation = write_c and part_r = set_up)
                        or ((operation = set_c or operation = variant_c) and verify_r = '0')
               else '0';
  compares  <= '0' when operation = identify_c or operation = drop_c or operation = sample_c
               else '1';
  last_byte <= '1' when (operation /= sample_c and part_r /= scale) or index_r = 15
                        or (part_r = scale and index_r = last_scale_c - first_scale_c)
               else '0';

  command <= i2c_recover_c when state_r = recover else
             i2c_start_c   when phase_r = start_c or (phase_r = third_c and writes = '0') else
             i2c_stop_c    when phase_r = stop_c else
             i2c_last_c    when phase_r = receive_c and last_byte = '1' else
             i2c_read_c    when phase_r = receive_c else
             i2c_write_c;

  write_data <= step(7 downto 0)       when phase_r(1 downto 0) = third_c(1 downto 0) else
                step(15 downto 8)      when phase_r(1 downto 0) = pointer_c(1 downto 0) else
                sensor_address_c & '0' when phase_r(1 downto 0) = address_c(1 downto 0) else
                sensor_address_c & '1';

  main : process (clk)
    variable gone_v    : boolean;  -- the next state has a command of the bus
    variable stamp_v   : boolean;  -- this is the time of a sample
    variable taken_v   : boolean;  -- a byte of it
    variable trouble_v : trouble_t;
  begin
    if rising_edge(clk) then
      failed_transfer_r <= '0';
      nack_r            <= '0';
      timeout_r         <= '0';
      stuck_r           <= '0';
      restart_r         <= '0';
      lost_sample_r     <= '0';
      number_r          <= '0';

      gone_v  := false;
      stamp_v := false;
      taken_v := false;

      if command_ready = '1' then
        command_valid_r <= '0';
      end if;
      if out_ready = '1' then
        out_valid_r <= '0';
      end if;

      ticking_r(1) <= ticking_r(0);
      ticking_r(0) <= time_us(wait_bit_c);
      if part_r /= set_up then
        ticking_r(0) <= time_us(period_bit_c);
      end if;
      if ticking_r(1) /= ticking_r(0) then
        timer_r <= timer_r - 1;
      end if;

      if state_r = decode then
        phase_r    <= start_c;
        index_r    <= (others => '0');
        mismatch_r <= '0';
        timer_r    <= unsigned(step(7 downto 0));
        if operation = wait_c then
          state_r <= pause;
        elsif operation = variant_c and variant_r = '0' then
          state_r <= judge;
        else
          gone_v  := true;
          state_r <= transfer;
        end if;
        if operation = sample_c then
          if part_r = set_up then
            fresh_r <= '0';
            left_r  <= to_unsigned(settle_samples_c, 9);
          end if;
          part_r <= sample;
          if failure_r = '0' then
            by_pin_r <= announced_r;
            stamp_v  := announced_r = '0';
          end if;
          announced_r <= '0';
          failure_r   <= '0';
          same_r      <= '1';
          fill_r      <= not out_valid_r;
        end if;

      elsif state_r = transfer then
        if reply_valid = '1' then
          nack_r    <= nack;
          timeout_r <= timed_out;
          if nack = '1' or timed_out = '1' or lost = '1' then
            failed_transfer_r <= '1';
            failure_r         <= '1';
            state_r           <= worry;
          elsif phase_r = stop_c then
            state_r <= judge;
          else
            gone_v  := true;
            phase_r <= phase_r + 1;
            if phase_r = start_c then
              if operation = sample_c and fill_r = '1' then
                out_time_us <= event_time_r;
              end if;
            elsif phase_r = third_c then
              if writes = '1' then
                phase_r <= stop_c;
              end if;
            elsif phase_r = receive_c then
              index_r <= index_r + 1;
              if last_byte = '0' then
                phase_r <= receive_c;
              end if;
              if part_r = scale then
                place_r <= place_r + 1;
              end if;
              ones_r <= '0';
              if read_data = "11111111" then
                ones_r <= '1';
              end if;
              if compares = '1' and read_data /= step(7 downto 0) then
                mismatch_r <= '1';
              end if;
              if operation = identify_c then
                identity_r <= read_data;
              end if;
              if operation = sample_c then
                if index_r = 0 then
                  fresh_r <= fresh_r or read_data(0);
                end if;
                taken_v := fill_r = '1' and index_r /= 0 and index_r /= 15;
              end if;
            end if;
          end if;
        end if;

      elsif state_r = judge then
        state_r <= decode;
        if operation = identify_c and is_accepted(identity_r) = '0' then
          failure_r <= '1';
          state_r   <= worry;
        elsif ones_r = '1' and (mismatch_r = '1' or operation = sample_c) then
          failed_transfer_r <= '1';
          failure_r         <= '1';
          state_r           <= worry;
        elsif mismatch_r = '1' then
          failure_r <= '1';
          state_r   <= restart;
          if operation = poll_c then
            state_r <= worry;
          end if;
        elsif part_r = set_up then
          if operation = identify_c then
            failed_r  <= '0';
            variant_r <= is_variant(identity_r);
          end if;
          trouble_r <= (others => '0');
          place_r   <= place_r + 1;
          if place_r = last_set_c and verify_r = '0' then
            verify_r <= '1';
            place_r  <= to_unsigned(first_set_c, 5);
          end if;
        elsif part_r = sample then
          place_r <= to_unsigned(first_scale_c, 5);
          part_r  <= scale;
        elsif part_r = scale then
          place_r <= more_r;
          part_r  <= one_more;
        else
          more_r <= place_r + 1;
          if place_r = sample_step_c - 1 then
            more_r <= to_unsigned(first_set_c, 5);
          end if;
          state_r <= worry;
          if fresh_r = '1' then
            state_r <= accept;
          end if;
        end if;

      elsif state_r = accept then
        trouble_r <= (others => '0');
        fresh_r   <= '0';
        place_r   <= to_unsigned(unlooked_step_c, 5);
        if by_pin_r = '1' then
          place_r <= to_unsigned(overdue_step_c, 5);
        end if;
        left_r  <= left_r - 1;
        state_r <= decode;
        if settled_r = '0' then
          if left_r = 1 then
            settled_r <= '1';
            left_r    <= to_unsigned(frozen_samples_c, 9);
          end if;
        else
          lost_sample_r <= not fill_r;
          number_r      <= '1';
          state_r       <= deliver;
          if fill_r = '0' or same_r = '0' then
            left_r <= to_unsigned(frozen_samples_c, 9);
          elsif left_r = 1 then
            lost_sample_r <= '0';
            number_r      <= '0';
            state_r       <= restart;
          end if;
        end if;

      elsif state_r = deliver then
        if counting = '0' then
          if fill_r = '1' then
            out_valid_r <= '1';
          end if;
          state_r <= decode;
        end if;

      elsif state_r = worry then
        trouble_v := nothing_c;
        if operation = identify_c then
          trouble_v := stranger_c;
        elsif failure_r = '1' then
          trouble_v := failure_c;
        end if;
        trouble_r <= trouble_r + trouble_v;
        gone_v    := true;
        state_r   <= recover;

      elsif state_r = recover then
        if reply_valid = '1' then
          stuck_r <= stuck;
          state_r <= resolve;
        end if;

      elsif state_r = resolve then
        state_r <= decode;
        if operation = identify_c then
          place_r <= to_unsigned(begin_step_c, 5);
          if trouble_r(6) = '1' then
            failed_r  <= '1';
            trouble_r <= (others => '0');
            place_r   <= to_unsigned(refused_step_c, 5);
          end if;
        elsif trouble_r(6) = '1' then
          state_r <= restart;
        elsif part_r /= set_up then
          place_r <= to_unsigned(gap_step_c, 5);
        elsif operation = poll_c then
          place_r <= to_unsigned(poll_step_c - 1, 5);
        end if;

      elsif state_r = pause then
        if timer_r = 0 or (part_r /= set_up and (announced_r = '1' or failure_r = '1')) then
          state_r <= decode;
          place_r <= place_r + 1;
          if part_r /= set_up then
            place_r <= to_unsigned(sample_step_c, 5);
          end if;
        end if;

      else  -- restart
        restart_r <= '1';
        settled_r <= '0';
        part_r    <= set_up;
        verify_r  <= '0';
        place_r   <= to_unsigned(begin_step_c, 5);
        trouble_r <= (others => '0');
        gone_v    := true;
        state_r   <= recover;
      end if;

      -- An edge while a sample is read announces the next one.
      int_r <= int_r(1 downto 0) & int_pin;
      if int_r(2 downto 1) = "01" then
        announced_r <= '1';
        stamp_v     := true;
      end if;
      if stamp_v then
        event_time_r <= time_us;
      end if;
      if taken_v then
        bytes_r <= bytes_r(103 downto 0) & read_data;
        if bytes_r(111 downto 104) /= read_data then
          same_r <= '0';
        end if;
      end if;
      if gone_v then
        command_valid_r <= '1';
      end if;

      if rst = '1' then
        command_valid_r <= '1';
        state_r         <= recover;
        part_r          <= set_up;
        place_r         <= to_unsigned(begin_step_c, 5);
        more_r          <= to_unsigned(first_set_c, 5);
        verify_r        <= '0';
        trouble_r       <= (others => '0');
        settled_r       <= '0';
        failed_r        <= '0';
        failure_r       <= '0';
        announced_r     <= '0';
        identity_r      <= (others => '0');
        out_valid_r     <= '0';
        int_r           <= (others => '1');
      end if;
    end if;
  end process main;

  master : entity work.hk_i2c_master
    generic map (
      CLOCK_HZ => CLOCK_HZ,
      BUS_HZ   => BUS_HZ
    )
    port map (
      clk              => clk,
      rst              => rst,
      command_valid    => command_valid_r,
      command_ready    => command_ready,
      command          => command,
      write_data       => write_data,
      reply_valid      => reply_valid,
      reply_ready      => '1',
      read_data        => read_data,
      nack             => nack,
      timed_out        => timed_out,
      arbitration_lost => lost,
      stuck            => stuck,
      scl_in           => scl_in,
      sda_in           => sda_in,
      scl_low          => scl_low,
      sda_low          => sda_low
    );

  events <= lost_sample_r & restart_r & stuck_r & timeout_r & nack_r & failed_transfer_r;
  keep   <= not fill_r;

  counters : entity work.hk_event_counters
    port map (
      clk         => clk,
      rst         => rst,
      events      => events,
      next_sample => number_r,
      keep        => keep,
      busy        => counting,
      count_0     => errors,
      count_1     => nacks,
      count_2     => timeouts,
      count_3     => stuck_buses,
      count_4     => restarts,
      count_5     => lost_samples,
      sample_number => out_sequence
    );

end architecture rtl;
