-- Microseconds since reset, exact in the long run at every clock of 1 MHz or more. 48 bits count,
-- which is nine years; the rest of the 64 is zero.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

entity hk_stopwatch is
  generic (
    CLOCK_HZ : positive
  );
  port (
    clk     : in  std_logic;
    rst     : in  std_logic;  -- synchronous, active high
    time_us : out unsigned(63 downto 0)
  );
end entity hk_stopwatch;

architecture rtl of hk_stopwatch is

  signal tick   : std_logic;
  signal time_r : unsigned(47 downto 0);

begin

  time_us <= resize(time_r, 64);

  ticks : entity work.hk_ticks
    generic map (
      CLOCK_HZ => CLOCK_HZ,
      TICKS_HZ => 1000000
    )
    port map (
      clk     => clk,
      restart => rst,
      tick    => tick
    );

  process (clk)
  begin
    if rising_edge(clk) then
      if tick = '1' then
        time_r <= time_r + 1;
      end if;
      if rst = '1' then
        time_r <= (others => '0');
      end if;
    end if;
  end process;

end architecture rtl;
