-- Where the results of a pipeline wait that nothing can stop: what has been taken in and not yet
-- been handed over is counted, and `room` falls before there could be more of it than the queue
-- holds.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

entity hk_result_queue is
  generic (
    BITS         : positive;
    ADDRESS_BITS : positive  -- the queue holds 2**ADDRESS_BITS results
  );
  port (
    clk       : in  std_logic;
    rst       : in  std_logic;  -- synchronous, active high
    taken     : in  std_logic;  -- the pipeline takes something on this clock
    room      : out std_logic;  -- it may take more
    busy      : out std_logic;  -- something is in work or waits
    in_valid  : in  std_logic;  -- a result leaves the pipeline
    in_data   : in  std_logic_vector(BITS - 1 downto 0);
    out_valid : out std_logic;
    out_ready : in  std_logic;
    out_data  : out std_logic_vector(BITS - 1 downto 0)
  );
end entity hk_result_queue;

architecture rtl of hk_result_queue is

  constant words_c : positive := 2**ADDRESS_BITS;

  -- `room` is a clock late, and so is what it allows.
  constant most_c : positive := words_c - 3;

  type memory_t is array (0 to words_c - 1) of std_logic_vector(BITS - 1 downto 0);
  signal memory_r : memory_t;

  signal write_r     : unsigned(ADDRESS_BITS - 1 downto 0);
  signal read_r      : unsigned(ADDRESS_BITS - 1 downto 0);
  signal count_r     : unsigned(ADDRESS_BITS - 1 downto 0);
  signal room_r      : std_logic;
  signal busy_r      : std_logic;
  signal out_valid_r : std_logic;
  signal load        : std_logic;

begin

  room      <= room_r;
  busy      <= busy_r;
  out_valid <= out_valid_r;
  load      <= '1' when read_r /= write_r and (out_valid_r = '0' or out_ready = '1') else '0';

  process (clk)
    variable handed_over_v : std_logic;
    variable count_v       : unsigned(ADDRESS_BITS - 1 downto 0);
  begin
    if rising_edge(clk) then
      handed_over_v := out_valid_r and out_ready;
      count_v       := count_r;
      if taken = '1' and handed_over_v = '0' then
        count_v := count_r + 1;
      elsif taken = '0' and handed_over_v = '1' then
        count_v := count_r - 1;
      end if;
      count_r <= count_v;
      room_r  <= '0';
      if count_r < most_c then
        room_r <= '1';
      end if;
      busy_r <= '1';
      if count_v = 0 then
        busy_r <= '0';
      end if;

      if in_valid = '1' then
        write_r <= write_r + 1;
      end if;
      if load = '1' then
        read_r      <= read_r + 1;
        out_valid_r <= '1';
      elsif out_ready = '1' then
        out_valid_r <= '0';
      end if;

      if rst = '1' then
        write_r     <= (others => '0');
        read_r      <= (others => '0');
        count_r     <= (others => '0');
        room_r      <= '0';
        busy_r      <= '0';
        out_valid_r <= '0';
      end if;
    end if;
  end process;

  memory : process (clk)
  begin
    if rising_edge(clk) then
      if in_valid = '1' then
        memory_r(to_integer(write_r)) <= in_data;
      end if;
      if load = '1' then
        out_data <= memory_r(to_integer(read_r));
      end if;
    end if;
  end process memory;

end architecture rtl;
