-- Six counters of 16 bits that stop at their maximum, and one of 32 bits that numbers samples and
-- wraps. They stand in a small memory with one adder, which visits each of them in turn; an event
-- is counted within 32 clocks and must not come again sooner.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

entity hk_event_counters is
  port (
    clk          : in  std_logic;
    rst          : in  std_logic;  -- synchronous, active high; clears them in 16 clocks
    events       : in  std_logic_vector(5 downto 0);  -- pulses of one clock
    next_sample  : in  std_logic;  -- a pulse: take the number of a sample
    keep         : in  std_logic;  -- sample_number stays as it is
    busy         : out std_logic;  -- a number is being taken
    count_0      : out unsigned(15 downto 0);
    count_1      : out unsigned(15 downto 0);
    count_2      : out unsigned(15 downto 0);
    count_3      : out unsigned(15 downto 0);
    count_4      : out unsigned(15 downto 0);
    count_5      : out unsigned(15 downto 0);
    sample_number : out unsigned(31 downto 0)  -- of the sample that was numbered last; from 0
  );
end entity hk_event_counters;

architecture rtl of hk_event_counters is

  type memory_t is array (0 to 7) of unsigned(15 downto 0);
  signal memory_r : memory_t;

  signal place_r   : unsigned(2 downto 0);  -- 0 to 5 the counters, 6 and 7 the halves of the number
  signal second_r  : std_logic;             -- of the two clocks of a visit
  signal clear_r   : std_logic;
  signal pending_r : std_logic_vector(7 downto 0);
  signal carry_r   : std_logic;
  signal number    : std_logic;  -- place_r is half of the number
  signal here      : std_logic_vector(7 downto 0);  -- place_r, one bit for each place
  signal due       : std_logic;
  signal addend    : std_logic;
  signal write     : std_logic;
  signal old_r     : unsigned(15 downto 0);
  signal sum       : unsigned(16 downto 0);

begin

  busy   <= next_sample or pending_r(6) or pending_r(7);
  number <= place_r(2) and place_r(1);

  places : for i in 0 to 7 generate
    here(i) <= '1' when place_r = i else '0';
  end generate places;

  due    <= '0' when clear_r = '1' or (pending_r and here) = "00000000" else '1';
  addend <= due and (carry_r or not (number and place_r(0)));
  sum    <= ('0' & old_r) + ("0000000000000000" & addend);
  -- A counter that would overflow is not written; the number of a sample wraps.
  write  <= second_r and (clear_r or (due and (number or not sum(16))));

  memory : process (clk)
  begin
    if rising_edge(clk) then
      if write = '1' then
        memory_r(to_integer(place_r)) <= sum(15 downto 0);
      end if;
      old_r <= memory_r(to_integer(place_r));
      if clear_r = '1' then
        old_r <= (others => '0');
      end if;
    end if;
  end process memory;

  visit : process (clk)
    variable pending_v : std_logic_vector(7 downto 0);
  begin
    if rising_edge(clk) then
      pending_v := pending_r;
      second_r  <= not second_r;
      if second_r = '1' then
        place_r <= place_r + 1;
        if clear_r = '0' then
          pending_v := pending_v and not here;
        end if;
        if place_r = 7 then
          clear_r <= '0';
        end if;
        -- The second half after the first, whose carry it needs.
        if here(6) = '1' then
          carry_r      <= sum(16);
          pending_v(7) := due;
        end if;
      end if;
      pending_v := pending_v or ('0' & next_sample & events);
      pending_r <= pending_v;
      if rst = '1' then
        second_r  <= '0';
        place_r   <= (others => '0');
        clear_r   <= '1';
        pending_r <= (others => '0');
      end if;
    end if;
  end process visit;

  show : process (clk)
  begin
    if rising_edge(clk) then
      if write = '1' then
        if place_r = 0 then
          count_0 <= sum(15 downto 0);
        end if;
        if place_r = 1 then
          count_1 <= sum(15 downto 0);
        end if;
        if place_r = 2 then
          count_2 <= sum(15 downto 0);
        end if;
        if place_r = 3 then
          count_3 <= sum(15 downto 0);
        end if;
        if place_r = 4 then
          count_4 <= sum(15 downto 0);
        end if;
        if place_r = 5 then
          count_5 <= sum(15 downto 0);
        end if;
        if place_r = 6 and keep = '0' then
          sample_number(15 downto 0) <= old_r;
        end if;
        if place_r = 7 and keep = '0' then
          sample_number(31 downto 16) <= old_r;
        end if;
      end if;
      if rst = '1' then
        count_0  <= (others => '0');
        count_1  <= (others => '0');
        count_2  <= (others => '0');
        count_3  <= (others => '0');
        count_4  <= (others => '0');
        count_5  <= (others => '0');
        sample_number <= (others => '0');
      end if;
    end if;
  end process show;

end architecture rtl;
