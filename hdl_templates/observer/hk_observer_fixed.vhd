-- The observer with the settings of its design, for those who need none at run time: synthesis
-- folds the constants. Ports as those of hk_observer.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.hk_common_pkg.all;
use work.hk_design_pkg.all;
use work.hk_observer_pkg.all;

entity hk_observer_fixed is
  generic (
    CHANNELS : positive range 1 to 1 := channels_c
  );
  port (
    clk           : in  std_logic;
    rst           : in  std_logic;  -- synchronous, active high
    busy          : out std_logic;
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
    angle_roll    : out signed(31 downto 0);  -- half turns, wraps at +-pi
    angle_pitch   : out signed(31 downto 0);
    state_index   : in  unsigned(4 downto 0);
    state_word    : out signed(31 downto 0);
    restarted     : out std_logic;
    saturated     : out std_logic;
    design_digest : out std_logic_vector(47 downto 0)
  );
end entity hk_observer_fixed;

architecture rtl of hk_observer_fixed is

  signal settings : hk_settings_t;

begin

  -- One by one, because GHDL 2.0 converts a constant of more than 32 bits wrongly.
  settings.kt          <= design_settings_c.kt;
  settings.kv          <= design_settings_c.kv;
  settings.kb          <= design_settings_c.kb;
  settings.gyro_bias_x <= design_settings_c.gyro_bias_x;
  settings.gyro_bias_y <= design_settings_c.gyro_bias_y;
  settings.gyro_bias_z <= design_settings_c.gyro_bias_z;

  core : entity work.hk_observer
    generic map (
      CHANNELS => CHANNELS
    )
    port map (
      clk           => clk,
      rst           => rst,
      settings      => settings,
      busy          => busy,
      in_valid      => in_valid,
      in_ready      => in_ready,
      in_channel    => in_channel,
      accel_x       => accel_x,
      accel_y       => accel_y,
      accel_z       => accel_z,
      gyro_x        => gyro_x,
      gyro_y        => gyro_y,
      gyro_z        => gyro_z,
      out_valid     => out_valid,
      out_ready     => out_ready,
      out_channel   => out_channel,
      angle_roll    => angle_roll,
      angle_pitch   => angle_pitch,
      state_index   => state_index,
      state_word    => state_word,
      restarted     => restarted,
      saturated     => saturated,
      design_digest => design_digest
    );

end architecture rtl;
