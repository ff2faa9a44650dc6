-- The words of the observer's program: where they stand in the memory of hk_sequencer, and what is
-- there before the first sample. A number after a semicolon says fraction bits; a word without one
-- has a format of the design.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.hk_observer_design_pkg.all;
use work.hk_sequence_pkg.all;

package hk_observer_words_pkg is

  -- State, in the order in which it is told.
  constant q_0          : word_t := 0;   -- orientation, sensor to earth; 30
  constant q_1          : word_t := 1;
  constant q_2          : word_t := 2;
  constant q_3          : word_t := 3;
  constant u_x          : word_t := 4;   -- correction that the velocity asks for
  constant u_y          : word_t := 5;
  constant b_x          : word_t := 6;   -- bias of the gyroscope
  constant b_y          : word_t := 7;
  constant b_z          : word_t := 8;
  constant gyro_mean_x  : word_t := 9;   -- running means, counts; 14
  constant gyro_mean_y  : word_t := 10;
  constant gyro_mean_z  : word_t := 11;
  constant accel_mean_x : word_t := 12;
  constant accel_mean_y : word_t := 13;
  constant accel_mean_z : word_t := 14;
  constant start_gain   : word_t := 15;  -- weight of the alignment; 31
  constant still        : word_t := 16;  -- samples without motion
  constant rested       : word_t := 17;  -- 1 after the first rest

  -- Words of one sample.
  constant loud         : word_t := 24;  -- 1 if something moves
  constant least_gain   : word_t := 25;  -- of the alignment
  constant turn_x       : word_t := 26;  -- half-angle of the sample; 32
  constant turn_y       : word_t := 27;
  constant turn_z       : word_t := 28;
  constant force_x      : word_t := 29;  -- specific force
  constant force_y      : word_t := 30;
  constant force_z      : word_t := 31;
  constant square       : word_t := 32;  -- of the half-angle; 32
  constant part         : word_t := 33;  -- 1/24 of it; 32
  constant cosine       : word_t := 34;  -- one less the cosine; 32
  constant sine         : word_t := 35;  -- one less the sine over the angle; 32
  constant sine_x       : word_t := 36;  -- vector part of the turn; 32
  constant sine_y       : word_t := 37;
  constant sine_z       : word_t := 38;
  constant n_0          : word_t := 39;  -- orientation before its correction; 30
  constant n_1          : word_t := 40;
  constant n_2          : word_t := 41;
  constant n_3          : word_t := 42;
  constant row_xx       : word_t := 43;  -- rows of the rotation that give x and y; 30
  constant row_xy       : word_t := 44;
  constant row_xz       : word_t := 45;
  constant row_yx       : word_t := 46;
  constant row_yy       : word_t := 47;
  constant row_yz       : word_t := 48;
  constant accel_h_x    : word_t := 49;  -- horizontal acceleration, m/s^2; 24
  constant accel_h_y    : word_t := 50;
  constant d_x          : word_t := 51;  -- correction about the earth's axes
  constant d_y          : word_t := 52;
  constant half_x       : word_t := 53;  -- half-angle of the correction; 32
  constant half_y       : word_t := 54;
  constant per_force    : word_t := 55;
  constant align_x      : word_t := 56;
  constant align_y      : word_t := 57;
  constant more         : word_t := 58;  -- what the orientation lacks in length; 32
  constant follow_x     : word_t := 59;  -- what the bias follows, about x and against y
  constant follow_y     : word_t := 60;
  constant rest_gain    : word_t := 61;
  constant up_x         : word_t := 62;  -- the earth's up in sensor axes; 27
  constant up_y         : word_t := 63;
  constant up_z         : word_t := 64;
  constant wide_x       : word_t := 65;  -- the same; 30
  constant wide_y       : word_t := 66;
  constant wide_z       : word_t := 67;
  constant lead_x       : word_t := 68;  -- turn by which it is told ahead; 25
  constant lead_y       : word_t := 69;
  constant lead_z       : word_t := 70;
  constant spare_x      : word_t := 71;  -- between two instructions
  constant spare_y      : word_t := 72;
  constant spare_z      : word_t := 73;
  constant d_away_y     : word_t := 74;  -- correction against the earth's y

  -- Constants; as a factor b they have 32 fraction bits.
  constant zero               : word_t := 96;
  constant unit               : word_t := 97;   -- 1
  constant sixth              : word_t := 98;
  constant fifth              : word_t := 99;
  constant twenty_fourth      : word_t := 100;
  constant nearly_half        : word_t := 101;  -- the largest word
  constant half_per_g         : word_t := 102;  -- 1 / (2 g); 35
  constant one_27             : word_t := 103;  -- 1; 27
  constant one_28             : word_t := 104;
  constant half_30            : word_t := 105;  -- 1 / 2; 30
  constant accel_offset_x     : word_t := 106;
  constant accel_offset_y     : word_t := 107;
  constant accel_offset_z     : word_t := 108;
  constant acceleration_limit : word_t := 109;
  constant first_force_limit  : word_t := 110;
  constant correction_limit   : word_t := 111;
  constant bias_limit         : word_t := 112;
  constant start_limit        : word_t := 113;
  constant first_start_gain   : word_t := 114;
  constant start_end          : word_t := 115;
  constant clip_gain          : word_t := 116;
  constant rate_limit         : word_t := 117;
  constant force_limit        : word_t := 118;
  constant mean_limit         : word_t := 119;
  constant rest_samples       : word_t := 120;
  constant design_rest_gain   : word_t := 121;
  constant clip_count         : word_t := 122;  -- doubled, as the counts are
  constant lead               : word_t := 123;
  constant lead_limit         : word_t := 124;

  -- Constants with 16 fraction bits as a factor b.
  constant gyro_gain_x  : word_t := first_whole_c;
  constant gyro_gain_y  : word_t := first_whole_c + 1;
  constant gyro_gain_z  : word_t := first_whole_c + 2;
  constant accel_gain_x : word_t := first_whole_c + 3;
  constant accel_gain_y : word_t := first_whole_c + 4;
  constant accel_gain_z : word_t := first_whole_c + 5;
  constant by_turn      : word_t := first_whole_c + 6;  -- shifts to the right
  constant by_bias      : word_t := first_whole_c + 7;
  constant by_mean      : word_t := first_whole_c + 8;

  -- The same without a fraction: shifts to the left.
  constant times_2            : word_t := one_c + 1;
  constant times_8            : word_t := one_c + 2;
  constant times_16           : word_t := one_c + 3;
  constant times_64           : word_t := one_c + 4;
  constant times_acceleration : word_t := one_c + 5;
  constant times_first_bias   : word_t := one_c + 6;
  constant times_rest         : word_t := one_c + 7;
  constant times_first_force  : word_t := one_c + 8;
  constant times_count        : word_t := one_c + 9;  -- a doubled count with 14 fraction bits

  -- Inputs. Counts are doubled: their gains have 15 fraction bits.
  constant accel_x     : word_t := first_input_c;
  constant accel_y     : word_t := first_input_c + 1;
  constant accel_z     : word_t := first_input_c + 2;
  constant gyro_x      : word_t := first_input_c + 3;
  constant gyro_y      : word_t := first_input_c + 4;
  constant gyro_z      : word_t := first_input_c + 5;
  constant kt          : word_t := first_input_c + 6;
  constant kv          : word_t := first_input_c + 7;
  constant kb          : word_t := first_input_c + 8;
  constant gyro_bias_x : word_t := first_input_c + 9;
  constant gyro_bias_y : word_t := first_input_c + 10;
  constant gyro_bias_z : word_t := first_input_c + 11;

  -- What stands in the memory before the first sample.
  type words_t is array (natural range 2 ** word_bits_c - 1 downto 0)
    of std_logic_vector(31 downto 0);
  function initial_words return words_t;

end package hk_observer_words_pkg;

package body hk_observer_words_pkg is

  function word (value : integer) return std_logic_vector is
  begin
    return std_logic_vector(to_signed(value, 32));
  end function word;

  function initial_words return words_t is
    variable words_v : words_t;
  begin
    words_v                     := (others => (others => '0'));
    words_v(unit)               := word(1);
    words_v(sixth)              := word(sixth_c);
    words_v(fifth)              := word(fifth_c);
    words_v(twenty_fourth)      := word(twenty_fourth_c);
    words_v(nearly_half)        := word(2147483647);
    words_v(half_per_g)         := word(half_per_g_c);
    words_v(one_27)             := word(2 ** 27);
    words_v(one_28)             := word(2 ** 28);
    words_v(half_30)            := word(2 ** 29);
    words_v(accel_offset_x)     := word(accel_offset_x_c);
    words_v(accel_offset_y)     := word(accel_offset_y_c);
    words_v(accel_offset_z)     := word(accel_offset_z_c);
    words_v(acceleration_limit) := word(acceleration_limit_c);
    words_v(first_force_limit)  := word(first_force_limit_c);
    words_v(correction_limit)   := word(correction_limit_c);
    words_v(bias_limit)         := word(bias_limit_c);
    words_v(start_limit)        := word(start_limit_c);
    words_v(first_start_gain)   := word(start_gain_c);
    words_v(start_end)          := word(start_end_c);
    words_v(clip_gain)          := word(clip_gain_c);
    words_v(rate_limit)         := word(rest_rate_c);
    words_v(force_limit)        := word(rest_force_c);
    words_v(mean_limit)         := word(mean_limit_c);
    words_v(rest_samples)       := word(rest_samples_c);
    words_v(design_rest_gain)   := word(rest_gain_c);
    words_v(clip_count)         := word(2 * clip_count_c);
    words_v(lead)               := word(lead_c);
    words_v(lead_limit)         := word(lead_limit_c);

    words_v(gyro_gain_x)  := word(gyro_gain_x_c);
    words_v(gyro_gain_y)  := word(gyro_gain_y_c);
    words_v(gyro_gain_z)  := word(gyro_gain_z_c);
    words_v(accel_gain_x) := word(accel_gain_x_c);
    words_v(accel_gain_y) := word(accel_gain_y_c);
    words_v(accel_gain_z) := word(accel_gain_z_c);
    words_v(by_turn)      := word(2 ** (16 - turn_right_c));
    words_v(by_bias)      := word(2 ** (16 - bias_right_c));
    words_v(by_mean)      := word(2 ** (16 - mean_shift_c));

    words_v(one_c)              := word(2 ** 16);
    words_v(times_2)            := word(2 ** 17);
    words_v(times_8)            := word(2 ** 19);
    words_v(times_16)           := word(2 ** 20);
    words_v(times_64)           := word(2 ** 22);
    words_v(times_acceleration) := word(2 ** (16 + acceleration_left_c));
    words_v(times_first_bias)   := word(2 ** (16 + first_bias_left_c));
    words_v(times_rest)         := word(2 ** (16 + rest_left_c));
    words_v(times_first_force)  := word(2 ** (16 + first_force_left_c));
    words_v(times_count)        := word(2 ** 29);
    return words_v;
  end function initial_words;

end package body hk_observer_words_pkg;
