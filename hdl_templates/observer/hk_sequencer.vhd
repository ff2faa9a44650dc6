-- Runs a program of the observer (hk_sequence_pkg): one multiplier of 32 x 18 bits, which takes the
-- lower and the upper half of b one after the other, one accumulator, one memory that reads two
-- words at a time. A clock each:
--
--   1 read a and b   2 operands   3 product   4 sum of both halves   5 accumulate   6 write
--
-- While no program runs, the multiplier is the caller's, as hk_arctan wants it.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.hk_observer_program_pkg.all;
use work.hk_sequence_pkg.all;

entity hk_sequencer is
  port (
    clk         : in  std_logic;
    rst         : in  std_logic;  -- synchronous, active high
    start       : in  std_logic;
    place       : in  unsigned(place_bits_c - 1 downto 0);  -- of the first instruction
    done        : out std_logic;  -- for one clock: the last result is there
    input_index : out std_logic_vector(5 downto 0);
    input_word  : in  signed(31 downto 0);  -- the word of that index, at once
    measure     : out std_logic;  -- for one clock: result is one for the arc tangent
    result      : out signed(31 downto 0);
    state_index : in  unsigned(4 downto 0);  -- while no program runs
    state_word  : out signed(31 downto 0);   -- a clock later
    multiply    : in  std_logic;
    factor      : in  signed(30 downto 0);
    coefficient : in  signed(17 downto 0);
    product     : out signed(49 downto 0)
  );
end entity hk_sequencer;

architecture rtl of hk_sequencer is

  -- Clocks of the steps above.
  constant operands_c   : positive := 2;
  constant product_c    : positive := 3;
  constant sum_c        : positive := 4;
  constant accumulate_c : positive := 5;
  constant write_c      : positive := 6;

  constant codes_c : codes_t := assembled(whole_program);

  -- What later steps need of an instruction.
  type step_t is record
    into  : unsigned(7 downto 0);
    short : std_logic;
    whole : std_logic;
    keep  : std_logic;
    minus : std_logic;
    mode : std_logic_vector(1 downto 0);
    last  : std_logic;
  end record;
  type steps_t is array (operands_c to write_c) of step_t;

  signal fetch_r  : std_logic;  -- there is no instruction yet
  signal runs_r   : std_logic;
  signal place_r  : unsigned(place_bits_c - 1 downto 0);
  signal code_r   : code_t;
  signal waited_r : unsigned(2 downto 0);
  signal second_r : std_logic;  -- the second clock of an instruction
  signal now      : fields_t;
  signal begins   : std_logic;
  signal short    : std_logic;  -- it takes one clock
  signal lower    : std_logic;  -- the lower half of b goes, and the upper half
  signal upper    : std_logic;

  signal steps_r  : steps_t;
  signal lowers_r : std_logic_vector(operands_c to sum_c);
  signal uppers_r : std_logic_vector(operands_c to write_c);

  signal reads         : std_logic;
  signal reads_b       : std_logic;
  signal read_b        : unsigned(7 downto 0);
  signal word_a        : signed(31 downto 0);
  signal word_b        : signed(31 downto 0);
  signal input_r       : std_logic;
  signal input_index_r : std_logic_vector(5 downto 0);
  signal multiply_r    : std_logic;
  signal factor_r      : signed(31 downto 0);
  signal coefficient_r : signed(17 downto 0);
  signal raw_product   : signed(49 downto 0);
  signal lower_r       : signed(33 downto 0);
  signal sum_r         : signed(49 downto 0);
  signal executes      : std_logic;
  signal executed_r    : std_logic;
  signal accumulator_r : signed(33 downto 0);
  signal negative      : std_logic;  -- at the last test
  signal negative_r    : std_logic;
  signal write         : std_logic;

begin

  now  <= decoded(code_r);
  begins <= '1' when runs_r = '1' and second_r = '0' and waited_r = decoded(code_r).waits else '0';
  short  <= now.b(7) and now.b(5);
  lower  <= begins and not short;
  upper  <= (begins and short) or second_r;

  fetch : process (clk)
  begin
    if rising_edge(clk) then
      if start = '1' then
        place_r <= place;
      elsif fetch_r = '1' or upper = '1' then
        code_r  <= codes_c(to_integer(place_r));
        place_r <= place_r + 1;
      end if;

      fetch_r  <= start;
      second_r <= lower;
      waited_r <= waited_r + 1;
      if fetch_r = '1' then
        runs_r <= '1';
      end if;
      if fetch_r = '1' or upper = '1' then
        waited_r <= (others => '0');
      end if;
      if upper = '1' and now.last = '1' then
        runs_r <= '0';
      end if;

      if rst = '1' then
        fetch_r  <= '0';
        runs_r   <= '0';
        second_r <= '0';
      end if;
    end if;
  end process fetch;

  follow : process (clk)
  begin
    if rising_edge(clk) then
      steps_r(operands_c) <= (into  => now.into,
                              short => short,
                              whole => now.b(7),
                              keep  => now.keep,
                              minus => now.minus,
                              mode => now.mode,
                              last  => now.last);
      steps_r(product_c to write_c) <= steps_r(operands_c to write_c - 1);

      lowers_r <= lower & lowers_r(operands_c to sum_c - 1);
      uppers_r <= upper & uppers_r(operands_c to write_c - 1);
      if rst = '1' then
        lowers_r <= (others => '0');
        uppers_r <= (others => '0');
      end if;
    end if;
  end process follow;

  reads   <= lower or upper;
  reads_b <= reads or not runs_r;
  read_b  <= now.b when runs_r = '1' else resize(state_index, 8);

  memory_a : entity work.hk_memory
    port map (
      clk        => clk,
      read       => reads,
      read_from  => now.a,
      word       => word_a,
      write      => write,
      write_into => steps_r(write_c).into,
      write_word => accumulator_r(31 downto 0)
    );

  memory_b : entity work.hk_memory
    port map (
      clk        => clk,
      read       => reads_b,
      read_from  => read_b,
      word       => word_b,
      write      => write,
      write_into => steps_r(write_c).into,
      write_word => accumulator_r(31 downto 0)
    );

  state_word  <= word_b;
  input_index <= input_index_r;

  operands : process (clk)
  begin
    if rising_edge(clk) then
      input_index_r <= std_logic_vector(now.a(5 downto 0));
      input_r       <= now.a(7) and now.a(6);

      factor_r <= word_a;
      if input_r = '1' then
        factor_r <= input_word;
      end if;
      coefficient_r <= resize(word_b(31 downto 16), 18);
      if lowers_r(operands_c) = '1' then
        coefficient_r <= signed(resize(unsigned(word_b(15 downto 0)), 18));
      end if;
      multiply_r <= lowers_r(operands_c) or uppers_r(operands_c);
      if multiply = '1' then
        factor_r      <= resize(factor, 32);
        coefficient_r <= coefficient;
        multiply_r    <= '1';
      end if;
      if rst = '1' then
        multiply_r <= '0';
      end if;
    end if;
  end process operands;

  multiplier : entity work.hk_multiplier
    port map (
      clk         => clk,
      enable      => multiply_r,
      factor      => factor_r,
      coefficient => coefficient_r,
      product     => raw_product
    );

  product <= raw_product;

  negative <= accumulator_r(33) when uppers_r(write_c) = '1' and steps_r(write_c).mode = test_c
              else negative_r;
  executes <= '1' when steps_r(accumulate_c).mode = always_c
                    or steps_r(accumulate_c).mode = test_c
                    or (steps_r(accumulate_c).mode = if_negative_c and negative = '1')
                    or (steps_r(accumulate_c).mode = if_not_c and negative = '0')
              else '0';

  accumulate : process (clk)
    variable base_v   : signed(33 downto 0);
    variable addend_v : signed(33 downto 0);
    variable sum_v    : signed(34 downto 0);
    variable minus_v  : signed(33 downto 0);
  begin
    if rising_edge(clk) then
      if lowers_r(sum_c) = '1' then
        lower_r <= raw_product(49 downto 16);
      end if;
      if steps_r(sum_c).short = '1' then
        sum_r <= raw_product;
      else
        sum_r <= raw_product + lower_r;
      end if;

      addend_v := resize(sum_r(47 downto 16), 34);
      if steps_r(accumulate_c).whole = '1' then
        addend_v := sum_r(33 downto 0);
      end if;
      minus_v := (others => steps_r(accumulate_c).minus);
      base_v  := (others => '0');
      if steps_r(accumulate_c).keep = '1' then
        base_v := accumulator_r;
      end if;
      -- A one and the carry below the words, so that it is one sum of two.
      sum_v := (base_v & '1') + ((addend_v xor minus_v) & steps_r(accumulate_c).minus);
      if uppers_r(accumulate_c) = '1' and executes = '1' then
        accumulator_r <= sum_v(34 downto 1);
      end if;
      executed_r <= uppers_r(accumulate_c) and executes;

      negative_r <= negative;
      if rst = '1' then
        executed_r <= '0';
      end if;
    end if;
  end process accumulate;

  write     <= executed_r and not steps_r(write_c).into(7);
  measure   <= executed_r and steps_r(write_c).into(7) and steps_r(write_c).into(6);
  result    <= accumulator_r(31 downto 0);
  done      <= uppers_r(write_c) and steps_r(write_c).last;

end architecture rtl;
