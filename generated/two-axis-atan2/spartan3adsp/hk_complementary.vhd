-- The complementary tilt filter. Takes raw counts in sensor axes; per axis it measures the tilt
-- from specific force, predicts with the angular rate, and corrects the prediction with the wrapped
-- difference, and the bias of the gyroscope with it. Every channel is a filter of its own, whose
-- first sample after reset loads the measured tilt. There are two cores for it: a small one, and
-- one that takes a sample a clock.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.hk_common_pkg.all;
use work.hk_complementary_design_pkg.all;
use work.hk_complementary_pkg.all;
use work.hk_design_pkg.all;

entity hk_complementary is
  generic (
    CHANNELS  : positive := channels_c;
    PIPELINED : boolean  := pipelined_c
  );
  port (
    clk           : in  std_logic;
    rst           : in  std_logic;  -- synchronous, active high
    settings      : in  hk_settings_t;  -- may change only while busy = '0'
    busy          : out std_logic;      -- a sample is in work, or channels are being cleared
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
    angle_roll    : out signed(31 downto 0);  -- half turns, wraps at +-pi; 0 if not in the design
    angle_pitch   : out signed(31 downto 0);
    bias_roll     : out signed(31 downto 0);  -- of the gyroscope, half turns per sample with
    bias_pitch    : out signed(31 downto 0);  -- bias_fraction_bits_c; 0 without an integral
    restarted     : out std_logic;            -- first of its channel: loaded the measured tilt
    saturated     : out std_logic;            -- a count stands at the end of its range
    design_digest : out std_logic_vector(47 downto 0)  -- constant: which design this core is
  );
end entity hk_complementary;

architecture rtl of hk_complementary is
begin

  small : if not PIPELINED generate
    core : entity work.hk_complementary_iterative
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
        bias_roll     => bias_roll,
        bias_pitch    => bias_pitch,
        restarted     => restarted,
        saturated     => saturated,
        design_digest => design_digest
      );
  end generate small;

  fast : if PIPELINED generate
    core : entity work.hk_complementary_pipelined
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
        bias_roll     => bias_roll,
        bias_pitch    => bias_pitch,
        restarted     => restarted,
        saturated     => saturated,
        design_digest => design_digest
      );
  end generate fast;

end architecture rtl;
