-- made by hostkit 0.1.0 from design f27a2d565bf0; do not edit; template observer/hk_observer_design_pkg.vhd.j2
-- What the observer knows of its design: words of 32 bits. Numbers behind them are fraction bits.
package hk_observer_design_pkg is

  -- Which parts the design has.
  constant has_rest_c  : boolean := true;
  constant has_clip_c  : boolean := true;
  constant has_align_c : boolean := true;
  constant has_lead_c  : boolean := true;

  -- How far words are shifted between formats, to the left or to the right.
  constant acceleration_left_c : natural range 0 to 14 := 1;
  constant first_force_left_c  : natural range 0 to 14 := 2;
  constant first_bias_left_c   : natural range 0 to 14 := 10;
  constant rest_left_c         : natural range 0 to 14 := 5;
  constant turn_right_c        : natural range 0 to 16 := 2;
  constant bias_right_c        : natural range 0 to 16 := 7;

  -- What can be set at run time; see hk_settings_t.
  constant kt_c : integer := 3892271;
  constant kv_c : integer := 16106127;
  constant kb_c : integer := 60473140;
  constant bias_x_c : integer := 28037547;
  constant bias_y_c : integer := -54425826;
  constant bias_z_c : integer := 83288006;

  -- All else.
  constant gyro_gain_x_c : integer := 191151367;  -- half-angle per count, 47 fraction bits
  constant gyro_gain_y_c : integer := 185529268;  -- half-angle per count, 47 fraction bits
  constant gyro_gain_z_c : integer := 189277334;  -- half-angle per count, 47 fraction bits
  constant accel_gain_x_c : integer := 1276739494;  -- m/s^2 per count, 40
  constant accel_gain_y_c : integer := 1342550808;  -- m/s^2 per count, 40
  constant accel_gain_z_c : integer := 1329388545;  -- m/s^2 per count, 40
  constant accel_offset_x_c : integer := 9764340;  -- m/s^2, 25
  constant accel_offset_y_c : integer := -6845104;  -- m/s^2, 25
  constant accel_offset_z_c : integer := 3388998;  -- m/s^2, 25
  constant first_force_limit_c : integer := 394867885;  -- m/s^2, 25
  constant acceleration_limit_c : integer := 671088640;  -- m/s^2, 23
  constant correction_limit_c : integer := 687194767;  -- half-angle, 34
  constant bias_limit_c : integer := 959504903;  -- half-angle per sample, 39
  constant half_per_g_c : integer := 1751859114;  -- 1 / (2 g), s^2/m, 35
  constant sixth_c : integer := 715827883;  -- 1/6, 32
  constant fifth_c : integer := 858993459;  -- 1/5, 32
  constant twenty_fourth_c : integer := 178956971;  -- 1/24, 32
  constant first_rounds_c : integer := 6;  -- renormalisations of the first orientation
  constant start_gain_c : integer := 1073741824;  -- 31
  constant start_end_c : integer := 21474836;  -- 31
  constant start_limit_c : integer := 16777216;  -- half-angle, 26
  constant clip_gain_c : integer := 67108864;  -- 31
  constant clip_count_c : integer := 26284;  -- counts
  constant mean_shift_c : integer := 6;  -- running means forget 2^-this at each sample
  constant mean_limit_c : integer := 12304175;  -- counts, 14
  constant rest_samples_c : integer := 100;  -- samples
  constant lead_c : integer := -33554432;  -- lead per half-angle, 25
  constant lead_limit_c : integer := 33554432;  -- rad, 25
  constant rest_rate_c : integer := 1845626;  -- counts, 14
  constant rest_force_c : integer := 4105920;  -- counts, 14
  constant rest_gain_c : integer := 85899346;  -- 34

end package hk_observer_design_pkg;
