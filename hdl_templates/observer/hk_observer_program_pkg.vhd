-- The observer as programs for hk_sequencer: the words of its memory and the steps of a sample, in
-- the order and with the names of hostkit's integer model. A number after a semicolon says fraction
-- bits. hk_sequence_pkg says what an instruction does.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.hk_common_pkg.all;
use work.hk_design_pkg.all;
use work.hk_observer_design_pkg.all;
use work.hk_sequence_pkg.all;

package hk_observer_program_pkg is

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
  constant accel_h_x    : word_t := 49;  -- horizontal acceleration, m/s^2; 25
  constant accel_h_y    : word_t := 50;
  constant d_x          : word_t := 51;  -- correction about the earth's axes
  constant d_y          : word_t := 52;
  constant half_x       : word_t := 53;  -- half-angle of the correction; 32
  constant half_y       : word_t := 54;
  constant per_force    : word_t := 55;
  constant align_x      : word_t := 56;
  constant align_y      : word_t := 57;
  constant more         : word_t := 58;  -- what the orientation lacks in length; 32
  constant follow_x     : word_t := 59;  -- what the bias follows, about the earth's axes
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
  constant times_32           : word_t := one_c + 4;
  constant times_acceleration : word_t := one_c + 5;
  constant times_first_bias   : word_t := one_c + 6;
  constant times_rest         : word_t := one_c + 7;
  constant times_count        : word_t := one_c + 8;  -- a doubled count with 14 fraction bits

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
  type words_t is array (natural range 2 ** word_bits_c - 1 downto 0) of std_logic_vector(31 downto 0);
  function initial_words return words_t;

  -- The programs, one behind the other: first sample; any other; angles, which follow both.
  function first_program return program_t;
  function step_program return program_t;
  function angles_program return program_t;
  function whole_program return program_t;
  function step_place return natural;
  function angles_place return natural;

end package hk_observer_program_pkg;

package body hk_observer_program_pkg is

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
    words_v(times_32)           := word(2 ** 21);
    words_v(times_acceleration) := word(2 ** (16 + acceleration_left_c));
    words_v(times_first_bias)   := word(2 ** (16 + first_bias_left_c));
    words_v(times_rest)         := word(2 ** (16 + rest_left_c));
    words_v(times_count)        := word(2 ** 29);
    return words_v;
  end function initial_words;

  constant nothing_c : program_t(1 to 0) := (others => take(zero));

  -- Part of a program that a design may lack.
  function only_with (has : boolean; program : program_t) return program_t is
  begin
    if has then
      return program;
    end if;
    return nothing_c;
  end function only_with;

  function repeated (program : program_t; times : positive) return program_t is
  begin
    if times = 1 then
      return program;
    end if;
    return program & repeated(program, times - 1);
  end function repeated;

  -- What the accumulator holds, at most the limit in size, goes into a word.
  function clamp (limit, into : word_t) return program_t is
    constant program_c : program_t := (
      less(limit, mode => test),
      take(zero, mode => if_not),
      plus(limit),
      plus(limit, mode => test),
      take(zero, mode => if_negative),
      less(limit, into => into)
    );
  begin
    return program_c;
  end function clamp;

  -- Noted in a word if a value is larger than a limit, in size.
  function note_beyond (value, limit, note : word_t) return program_t is
    constant program_c : program_t := (
      take(limit),
      less(value, mode => test),
      take(unit, into => note, mode => if_negative),
      take(limit),
      plus(value, mode => test),
      take(unit, into => note, mode => if_negative)
    );
  begin
    return program_c;
  end function note_beyond;

  -- The sum of three products.
  function dot (a_1, b_1, a_2, b_2, a_3, b_3 : word_t) return program_t is
    constant program_c : program_t := (
      take(a_1, b_1),
      plus(a_2, b_2),
      plus(a_3, b_3)
    );
  begin
    return program_c;
  end function dot;

  constant forces_c : program_t := (
    take(accel_x, accel_gain_x),
    less(accel_offset_x, into => force_x),
    take(accel_y, accel_gain_y),
    less(accel_offset_y, into => force_y),
    take(accel_z, accel_gain_z),
    less(accel_offset_z, into => force_z)
  );

  -- Renormalise, to first order.
  constant normalise_c : program_t := (
    take(one_28),
    less(q_0, q_0),
    less(q_1, q_1),
    less(q_2, q_2),
    less(q_3, q_3, into => more),
    take(more, times_8, into => more),
    take(q_0),
    plus(q_0, more, into => q_0),
    take(q_1),
    plus(q_1, more, into => q_1),
    take(q_2),
    plus(q_2, more, into => q_2),
    take(q_3),
    plus(q_3, more, into => q_3)
  );

  -- The first sample: its force is up.

  constant upright_c : program_t := (
    take(spare_x, half_per_g, into => spare_x),
    take(spare_y, half_per_g, into => spare_y),
    take(spare_z, half_per_g, into => spare_z),
    take(zero, into => q_3),
    take(spare_y, into => q_1),
    negate(spare_x, into => q_2),
    take(half_30),
    plus(spare_z, into => q_0),
    take(spare_z, mode => test),
    take(half_30),
    less(spare_z, into => q_1, mode => if_negative),
    take(spare_y, into => q_0, mode => if_negative),
    take(zero, into => q_2, mode => if_negative),
    take(spare_x, into => q_3, mode => if_negative)
  );

  constant load_c : program_t := (
    take(zero, into => u_x),
    take(zero, into => u_y),
    take(gyro_bias_x, into => b_x),
    take(gyro_bias_y, into => b_y),
    take(gyro_bias_z, into => b_z),
    take(first_start_gain, into => start_gain),
    take(zero, into => still),
    take(zero, into => rested),
    take(zero, into => turn_x),
    take(zero, into => turn_y),
    take(zero, into => turn_z)
  );

  constant load_means_c : program_t := (
    take(gyro_x, times_count, into => gyro_mean_x),
    take(gyro_y, times_count, into => gyro_mean_y),
    take(gyro_z, times_count, into => gyro_mean_z),
    take(accel_x, times_count, into => accel_mean_x),
    take(accel_y, times_count, into => accel_mean_y),
    take(accel_z, times_count, into => accel_mean_z)
  );

  constant no_means_c : program_t := (
    take(zero, into => gyro_mean_x),
    take(zero, into => gyro_mean_y),
    take(zero, into => gyro_mean_z),
    take(zero, into => accel_mean_x),
    take(zero, into => accel_mean_y),
    take(zero, into => accel_mean_z)
  );

  -- A force in 1 g, 25 fraction bits, clamped.
  function first_force (force, into : word_t) return program_t is
  begin
    return take(force) & clamp(first_force_limit, into) & take(into, times_acceleration, into);
  end function first_force;

  function first_program return program_t is
    constant loading_c : program_t :=
      load_c & only_with(has_rest_c, load_means_c) & only_with(not has_rest_c, no_means_c);
    constant upright_first_c : program_t :=
      first_force(force_x, spare_x) & first_force(force_y, spare_y)
      & first_force(force_z, spare_z) & upright_c;
  begin
    return ending(forces_c & loading_c & upright_first_c & repeated(normalise_c, first_rounds_c));
  end function first_program;

  -- Rest: a running mean, and whether the count is far from it.
  function follow_mean (count, mean, limit, apart : word_t) return program_t is
    constant program_c : program_t := (
      take(count, times_count),
      less(mean, into => apart),
      take(mean),
      plus(apart, by_mean, into => mean)
    );
  begin
    return program_c & note_beyond(apart, limit, loud);
  end function follow_mean;

  function means return program_t is
  begin
    return take(zero, into => loud)
           & follow_mean(gyro_x, gyro_mean_x, rate_limit, spare_x)
           & follow_mean(gyro_y, gyro_mean_y, rate_limit, spare_y)
           & follow_mean(gyro_z, gyro_mean_z, rate_limit, spare_z)
           & follow_mean(accel_x, accel_mean_x, force_limit, spare_x)
           & follow_mean(accel_y, accel_mean_y, force_limit, spare_y)
           & follow_mean(accel_z, accel_mean_z, force_limit, spare_z)
           & note_beyond(gyro_mean_x, mean_limit, loud)
           & note_beyond(gyro_mean_y, mean_limit, loud)
           & note_beyond(gyro_mean_z, mean_limit, loud);
  end function means;

  -- Samples without motion, up to rest_samples.
  constant count_still_c : program_t := (
    take(still),
    plus(unit),
    less(rest_samples, mode => test),
    take(zero, mode => if_not),
    plus(rest_samples, into => still),
    negate(loud, mode => test),
    take(zero, into => still, mode => if_negative)
  );

  -- The first rest: the mean rate becomes the bias, and the alignment starts again.
  function first_bias (mean, gain, into : word_t) return program_t is
    constant program_c : program_t := (
      take(gain, mean, into => into),
      take(into, times_first_bias)
    );
  begin
    return program_c & clamp(bias_limit, into);
  end function first_bias;

  constant first_rest_c : program_t := (
    take(still),
    less(rest_samples),
    less(rested, mode => test),  -- negative but on the first rest
    take(spare_x, into => b_x, mode => if_not),
    take(spare_y, into => b_y, mode => if_not),
    take(spare_z, into => b_z, mode => if_not),
    take(first_start_gain, into => start_gain, mode => if_not),
    take(unit, into => rested, mode => if_not)
  );

  function rest return program_t is
    constant biases_c : program_t :=
      first_bias(gyro_mean_x, gyro_gain_x, spare_x) & first_bias(gyro_mean_y, gyro_gain_y, spare_y)
      & first_bias(gyro_mean_z, gyro_gain_z, spare_z);
  begin
    return means & count_still_c & biases_c & first_rest_c;
  end function rest;

  -- After a rate that was clipped the alignment has some weight again.
  constant clipped_c : program_t := (
    negate(loud, mode => test),
    take(zero, into => least_gain),
    take(clip_gain, into => least_gain, mode => if_negative),
    take(start_gain),
    less(least_gain, mode => test),
    take(zero, mode => if_negative),
    plus(least_gain, into => start_gain)
  );

  function clipping return program_t is
  begin
    return take(zero, into => loud)
           & note_beyond(gyro_x, clip_count, loud)
           & note_beyond(gyro_y, clip_count, loud)
           & note_beyond(gyro_z, clip_count, loud)
           & clipped_c;
  end function clipping;

  -- The half-angle that the sensor turned by, its cosine and sine.
  constant turn_c : program_t := (
    take(gyro_x, gyro_gain_x),
    less(b_x, by_bias, into => turn_x),
    take(gyro_y, gyro_gain_y),
    less(b_y, by_bias, into => turn_y),
    take(gyro_z, gyro_gain_z),
    less(b_z, by_bias, into => turn_z)
  );

  constant series_c : program_t := (
    take(turn_x, turn_x),
    plus(turn_y, turn_y),
    plus(turn_z, turn_z, into => square),
    take(square, twenty_fourth, into => part),
    take(nearly_half),
    less(part, into => cosine),
    take(sixth),
    less(part, fifth, into => sine),
    take(square, cosine, into => cosine),
    take(square, sine, into => sine),
    take(turn_x),
    less(turn_x, sine, into => sine_x),
    take(turn_y),
    less(turn_y, sine, into => sine_y),
    take(turn_z),
    less(turn_z, sine, into => sine_z)
  );

  constant propagate_c : program_t := (
    take(q_0),
    less(q_0, cosine),
    less(q_1, sine_x),
    less(q_2, sine_y),
    less(q_3, sine_z, into => n_0),
    take(q_1),
    less(q_1, cosine),
    plus(q_0, sine_x),
    plus(q_2, sine_z),
    less(q_3, sine_y, into => n_1),
    take(q_2),
    less(q_2, cosine),
    plus(q_0, sine_y),
    plus(q_3, sine_x),
    less(q_1, sine_z, into => n_2),
    take(q_3),
    less(q_3, cosine),
    plus(q_0, sine_z),
    plus(q_1, sine_y),
    less(q_2, sine_x, into => n_3)
  );

  constant rows_c : program_t := (
    take(n_1, n_2),
    less(n_0, n_3, into => row_xy),
    take(n_1, n_2),
    plus(n_0, n_3, into => row_yx),
    take(one_27),
    less(n_1, n_1),
    less(n_3, n_3, into => row_yy),
    take(one_27),
    less(n_2, n_2),
    less(n_3, n_3, into => row_xx),
    take(n_1, n_3),
    plus(n_0, n_2, into => row_xz),
    take(n_2, n_3),
    less(n_0, n_1, into => row_yz),
    take(row_xx, times_8, into => row_xx),
    take(row_xy, times_8, into => row_xy),
    take(row_yx, times_8, into => row_yx),
    take(row_yy, times_8, into => row_yy),
    take(row_xz, times_8, into => row_xz),
    take(row_yz, times_8, into => row_yz)
  );

  -- What is not gravity: it is believed to be an acceleration, and its sum a velocity.
  function velocity return program_t is
  begin
    return dot(row_xx, force_x, row_xy, force_y, row_xz, force_z)
           & clamp(acceleration_limit, accel_h_x)
           & dot(row_yx, force_x, row_yy, force_y, row_yz, force_z)
           & clamp(acceleration_limit, accel_h_y)
           & take(accel_h_x, times_acceleration, into => accel_h_x)
           & take(accel_h_y, times_acceleration, into => accel_h_y)
           & take(u_x) & plus(kt, accel_h_x) & clamp(correction_limit, u_x)
           & take(u_y) & plus(kt, accel_h_y) & clamp(correction_limit, u_y);
  end function velocity;

  constant correction_c : program_t := (
    negate(u_x, into => d_y),
    take(u_y, into => d_x),
    take(start_gain, half_per_g, into => per_force),
    take(u_y, by_turn, into => half_x),
    take(d_y, by_turn, into => half_y)
  );

  -- The share of the tilt that the force shows; its weight falls as one over the samples.
  function align return program_t is
    constant turns_c : program_t := (
      take(half_x),
      plus(align_y, times_32, into => half_x),
      take(half_y),
      less(align_x, times_32, into => half_y)
    );
    constant weight_c : program_t := (
      take(start_gain, start_gain, into => spare_x),
      take(start_gain),
      less(spare_x, times_2, into => start_gain),
      take(start_end),
      less(start_gain, mode => test),
      take(zero, into => start_gain, mode => if_not),
      take(u_x, start_gain, into => spare_x),
      take(u_y, start_gain, into => spare_y),
      take(u_x),
      less(spare_x, times_2, into => u_x),
      take(u_y),
      less(spare_y, times_2, into => u_y)
    );
  begin
    return take(accel_h_x, per_force) & clamp(start_limit, align_x)
           & take(accel_h_y, per_force) & clamp(start_limit, align_y) & weight_c & turns_c;
  end function align;

  -- Turn about the earth's axes.
  constant correct_c : program_t := (
    take(n_0),
    less(half_x, n_1),
    less(half_y, n_2, into => q_0),
    take(n_1),
    plus(half_x, n_0),
    plus(half_y, n_3, into => q_1),
    take(n_2),
    plus(half_y, n_0),
    less(half_x, n_3, into => q_2),
    take(n_3),
    plus(half_x, n_2),
    less(half_y, n_1, into => q_3)
  );

  -- The bias follows the rate at rest, and else the correction.
  constant followed_c : program_t := (
    take(kb, d_x, into => follow_x),
    take(kb, d_y, into => follow_y),
    take(turn_x, times_rest, into => spare_x),
    take(turn_y, times_rest, into => spare_y),
    take(turn_z, times_rest, into => spare_z),
    take(design_rest_gain, into => rest_gain),
    take(still),
    less(rest_samples, mode => test),
    take(zero, into => follow_x, mode => if_not),
    take(zero, into => follow_y, mode => if_not),
    take(zero, into => rest_gain, mode => if_negative)
  );

  function follow (bias, along_x, along_y, turn : word_t) return program_t is
    constant program_c : program_t := (
      take(bias),
      less(along_x, follow_x),
      less(along_y, follow_y),
      plus(turn, rest_gain)
    );
  begin
    return program_c & clamp(bias_limit, bias);
  end function follow;

  constant decay_c : program_t := (
    take(u_x),
    less(kv, u_x, into => u_x),
    take(u_y),
    less(kv, u_y, into => u_y)
  );

  function step_program return program_t is
    constant motion_c : program_t := turn_c & forces_c & series_c & propagate_c & rows_c;
    constant bias_c   : program_t :=
      followed_c & follow(b_x, row_xx, row_yx, spare_x) & follow(b_y, row_xy, row_yy, spare_y)
      & follow(b_z, row_xz, row_yz, spare_z);
  begin
    return only_with(has_rest_c, rest) & only_with(has_clip_c, clipping) & motion_c & velocity
           & correction_c & only_with(has_align_c, align) & correct_c & normalise_c & bias_c & decay_c;
  end function step_program;

  -- Up in sensor axes.
  constant up_c : program_t := (
    take(q_1, q_3),
    less(q_0, q_2, into => up_x),
    take(q_2, q_3),
    plus(q_0, q_1, into => up_y),
    take(one_27),
    less(q_1, q_1),
    less(q_2, q_2, into => up_z)
  );

  -- Told ahead: up less the cross product of the turn with it.
  function ahead return program_t is
    constant wide_c : program_t := (
      take(up_x, times_8, into => wide_x),
      take(up_y, times_8, into => wide_y),
      take(up_z, times_8, into => wide_z)
    );
    constant turned_c : program_t := (
      take(wide_y, lead_z),
      less(wide_z, lead_y, into => spare_x),
      take(wide_z, lead_x),
      less(wide_x, lead_z, into => spare_y),
      take(wide_x, lead_y),
      less(wide_y, lead_x, into => spare_z),
      take(up_x),
      plus(spare_x, times_16, into => up_x),
      take(up_y),
      plus(spare_y, times_16, into => up_y),
      take(up_z),
      plus(spare_z, times_16, into => up_z)
    );
  begin
    return wide_c & take(turn_x, lead) & clamp(lead_limit, lead_x)
           & take(turn_y, lead) & clamp(lead_limit, lead_y)
           & take(turn_z, lead) & clamp(lead_limit, lead_z) & turned_c;
  end function ahead;

  -- A component of up along a body axis, or against it, goes to the arc tangent.
  function show (axis : hk_body_axis_t; against : boolean) return instruction_t is
  begin
    if axis.negative /= against then
      return negate(up_x + axis.source, into => component_c);
    end if;
    return take(up_x + axis.source, into => component_c);
  end function show;

  function angles_program return program_t is
  begin
    return ending(up_c & only_with(has_lead_c, ahead) & show(body_x_c, true)
                  & show(body_y_c, false) & show(body_z_c, false));
  end function angles_program;

  function whole_program return program_t is
  begin
    return first_program & step_program & angles_program;
  end function whole_program;

  function step_place return natural is
    constant before_c : program_t := first_program;
  begin
    return before_c'length;
  end function step_place;

  function angles_place return natural is
    constant before_c : program_t := first_program & step_program;
  begin
    return before_c'length;
  end function angles_place;

end package body hk_observer_program_pkg;
