-- The observer as programs for hk_sequencer: the steps of a sample, with the names of hostkit's
-- integer model and nearly in its order: where a step would wait for a result, one that does not
-- need it comes before. hk_sequence_pkg says what an instruction does.
use work.hk_common_pkg.all;
use work.hk_design_pkg.all;
use work.hk_observer_design_pkg.all;
use work.hk_observer_parts_pkg.all;
use work.hk_observer_words_pkg.all;
use work.hk_sequence_pkg.all;

package hk_observer_program_pkg is

  -- The programs, one behind the other: first sample; any other; angles, which follow both.
  function first_program return program_t;
  function step_program return program_t;
  function angles_program return program_t;
  function whole_program return program_t;
  function step_place return natural;
  function angles_place return natural;

end package hk_observer_program_pkg;

package body hk_observer_program_pkg is

  constant forces_c : program_t := (
    take(accel_x, accel_gain_x),
    less(accel_offset_x, into => force_x),
    take(accel_y, accel_gain_y),
    less(accel_offset_y, into => force_y),
    take(accel_z, accel_gain_z),
    less(accel_offset_z, into => force_z)
  );

  -- Renormalise, to first order: what is lacking in length, in two steps, and the orientation.
  constant lack_c : program_t := (
    take(one_28),
    less(q_0, q_0),
    less(q_1, q_1),
    less(q_2, q_2),
    less(q_3, q_3, into => more)
  );

  constant lack_30_c : program_t(0 to 0) := (0 => take(more, times_8, into => more));

  constant lengthen_c : program_t := (
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

  -- A force, clamped; 27.
  function first_force (force, into : word_t) return program_t is
  begin
    return take(force) & clamp(first_force_limit, into) & take(into, times_first_force, into);
  end function first_force;

  function first_program return program_t is
    constant loading_c : program_t :=
      load_c & only_with(has_rest_c, load_means_c) & only_with(not has_rest_c, no_means_c);
    constant upright_first_c : program_t :=
      first_force(force_x, spare_x) & first_force(force_y, spare_y)
      & first_force(force_z, spare_z) & upright_c;
  begin
    return ending(forces_c & loading_c & upright_first_c
                  & repeated(lack_c & lack_30_c & lengthen_c, first_rounds_c));
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

  constant square_c : program_t := (
    take(turn_x, turn_x),
    plus(turn_y, turn_y),
    plus(turn_z, turn_z, into => square)
  );

  constant series_c : program_t := (
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
    take(u_x, into => d_away_y),
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
      plus(align_y, times_64, into => half_x),
      take(half_y),
      less(align_x, times_64, into => half_y)
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

  -- The bias follows the rate at rest, and else the correction. One product is taken off and one is
  -- added, so that what they lose by rounding does not add up.
  constant followed_c : program_t := (
    take(kb, d_x, into => follow_x),
    take(kb, d_away_y, into => follow_y),
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
      plus(along_y, follow_y),
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
    constant motion_c : program_t := turn_c & square_c & forces_c & series_c & propagate_c
                                        & rows_c;
    constant bias_c   : program_t :=
      follow(b_x, row_xx, row_yx, spare_x) & follow(b_y, row_xy, row_yy, spare_y)
      & follow(b_z, row_xz, row_yz, spare_z);
  begin
    return only_with(has_rest_c, rest) & only_with(has_clip_c, clipping) & motion_c & velocity
           & correction_c & only_with(has_align_c, align) & correct_c
           & lack_c & decay_c & lack_30_c & followed_c & lengthen_c & bias_c;
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
    -- The word that is there last comes first, so that every mounting takes as long.
    return ending(up_c & only_with(has_lead_c, ahead) & take(up_z) & show(body_x_c, true)
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
