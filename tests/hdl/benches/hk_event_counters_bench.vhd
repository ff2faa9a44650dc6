-- hk_event_counters beyond the ends of its counters; events and samples meet it at every place.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

entity hk_event_counters_bench is
end entity hk_event_counters_bench;

architecture bench of hk_event_counters_bench is

  constant rounds_c : positive := 65540;

  signal clk     : std_logic := '0';
  signal rst     : std_logic := '1';
  signal events  : std_logic_vector(5 downto 0) := "000000";
  signal numbers : std_logic := '0';
  signal keep    : std_logic := '0';
  signal busy    : std_logic;
  type counts_t is array (0 to 5) of unsigned(15 downto 0);
  signal counts  : counts_t;
  signal number  : unsigned(31 downto 0);

begin

  counters : entity work.hk_event_counters
    port map (
      clk           => clk,
      rst           => rst,
      events        => events,
      next_sample   => numbers,
      keep          => keep,
      busy          => busy,
      count_0       => counts(0),
      count_1       => counts(1),
      count_2       => counts(2),
      count_3       => counts(3),
      count_4       => counts(4),
      count_5       => counts(5),
      sample_number => number
    );

  main : process
    procedure tick is
    begin
      wait for 5 ns;
      clk <= '1';
      wait for 5 ns;
      clk <= '0';
    end procedure tick;
  begin
    tick;
    rst <= '0';
    for round in 0 to rounds_c - 1 loop
      -- Counter 0 every time, counter 5 once in 1000, right from the reset on.
      events(0) <= '1';
      numbers   <= '1';
      if round mod 1000 = 0 then
        events(5) <= '1';
      end if;
      tick;
      events  <= "000000";
      numbers <= '0';
      for i in 1 to 16 loop
        tick;
      end loop;
      while busy = '1' loop
        tick;
      end loop;
      assert number = round
        report "the number of a sample is wrong"
        severity failure;
    end loop;
    keep    <= '1';
    numbers <= '1';
    tick;
    numbers <= '0';
    for i in 1 to 40 loop
      tick;
    end loop;
    assert number = rounds_c - 1
      report "a number that is kept has changed"
      severity failure;
    assert counts(0) = 65535 and counts(1) = 0 and counts(5) = 66
      report "a counter is wrong"
      severity failure;
    wait;
  end process main;

end architecture bench;
