-- Rectangular to polar: the angle and the magnitude of a vector, or the arc sine of y / x.
-- PIPELINED chooses between a new result every clock and a small core that does one at a time.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

entity hk_polar is
  generic (
    PIPELINED : boolean  := true;
    ID_BITS   : positive := 1
  );
  port (
    clk       : in  std_logic;
    rst       : in  std_logic;  -- synchronous, active high
    in_valid  : in  std_logic;
    in_ready  : out std_logic;
    in_id     : in  unsigned(ID_BITS - 1 downto 0);
    arcsine   : in  std_logic;             -- 0: atan2(y, x); 1: arcsin(y / x), x is 1 g
    x         : in  signed(16 downto 0);   -- counts; beyond +-32768 they are taken as that
    y         : in  signed(16 downto 0);
    out_valid : out std_logic;
    out_ready : in  std_logic;
    out_id    : out unsigned(ID_BITS - 1 downto 0);
    angle     : out signed(31 downto 0);   -- half turns, wraps at +-pi
    magnitude : out unsigned(29 downto 0)  -- counts, guard_bits_c fraction bits
  );
end entity hk_polar;

architecture rtl of hk_polar is
begin

  one_a_clock : if PIPELINED generate
    core : entity work.hk_polar_pipelined
      generic map (
        ID_BITS => ID_BITS
      )
      port map (
        clk       => clk,
        rst       => rst,
        in_valid  => in_valid,
        in_ready  => in_ready,
        in_id     => in_id,
        arcsine   => arcsine,
        x         => x,
        y         => y,
        out_valid => out_valid,
        out_ready => out_ready,
        out_id    => out_id,
        angle     => angle,
        magnitude => magnitude
      );
  end generate one_a_clock;

  one_at_a_time : if not PIPELINED generate
    core : entity work.hk_polar_iterative
      generic map (
        ID_BITS => ID_BITS
      )
      port map (
        clk       => clk,
        rst       => rst,
        in_valid  => in_valid,
        in_ready  => in_ready,
        in_id     => in_id,
        arcsine   => arcsine,
        x         => x,
        y         => y,
        out_valid => out_valid,
        out_ready => out_ready,
        out_id    => out_id,
        angle     => angle,
        magnitude => magnitude
      );
  end generate one_at_a_time;

end architecture rtl;
