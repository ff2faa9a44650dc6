-- Ticks at any rate up to one a clock: tick k comes floor(k * CLOCK_HZ / TICKS_HZ) clocks after the
-- restart, so each is less than a clock early, and in the long run their rate is exact.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

entity hk_ticks is
  generic (
    CLOCK_HZ : positive;
    TICKS_HZ : positive
  );
  port (
    clk     : in  std_logic;
    restart : in  std_logic;  -- synchronous, active high; time runs from the first clock without
    tick    : out std_logic  -- high for one clock
  );
end entity hk_ticks;

architecture rtl of hk_ticks is

  -- Euclid; two 31-bit numbers take 45 divisions at most.
  function common_divisor (a, b : positive) return positive is
    variable larger_v  : natural;
    variable smaller_v : natural;
    variable rest_v    : natural;
  begin
    larger_v  := a;
    smaller_v := b;
    for division in 1 to 48 loop
      if smaller_v /= 0 then
        rest_v    := larger_v mod smaller_v;
        larger_v  := smaller_v;
        smaller_v := rest_v;
      end if;
    end loop;
    return larger_v;
  end function common_divisor;

  function bits_of (number : positive) return positive is
    variable rest_v : natural;
    variable bits_v : natural;
  begin
    rest_v := number;
    bits_v := 0;
    for bit in 1 to 31 loop
      if rest_v /= 0 then
        bits_v := bits_v + 1;
        rest_v := rest_v / 2;
      end if;
    end loop;
    return bits_v;
  end function bits_of;

  constant divisor_c : positive := common_divisor(CLOCK_HZ, TICKS_HZ);
  constant clocks_c  : positive := CLOCK_HZ / divisor_c;
  constant ticks_c   : positive := TICKS_HZ / divisor_c;
  constant bits_c    : positive := bits_of(clocks_c);

  constant step_c : signed(bits_c downto 0) := to_signed(ticks_c, bits_c + 1);
  constant wrap_c : signed(bits_c downto 0) := to_signed(ticks_c - clocks_c, bits_c + 1);
  constant start_c : signed(bits_c downto 0) :=
    to_signed(ticks_c - clocks_c + (ticks_c - 1), bits_c + 1);

  -- Below zero the next tick is still to come.
  signal phase_r : signed(bits_c downto 0);

begin

  assert TICKS_HZ <= CLOCK_HZ
    report "hk_ticks: more than one tick a clock"
    severity failure;

  tick <= not phase_r(bits_c);

  process (clk)
  begin
    if rising_edge(clk) then
      if phase_r(bits_c) = '1' then
        phase_r <= phase_r + step_c;
      else
        phase_r <= phase_r + wrap_c;
      end if;
      if restart = '1' then
        phase_r <= start_c;
      end if;
    end if;
  end process;

end architecture rtl;
