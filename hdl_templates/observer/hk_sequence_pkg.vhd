-- Programs for hk_sequencer. It knows one operation, on an accumulator:
--
--   accumulator := [accumulator] +- floor(a * b / 2**32)      and, if wanted, into := accumulator
--
-- a and b are words of 32 bits. For a b from first_whole_c on it is 2**16 in place of 2**32; those
-- are constants with 16 fraction bits. From one_c on their fraction is 0: with them words are
-- moved, added and shifted to the left, in one clock instead of two.
-- A condition looks at the sign that the accumulator had at the last test.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

package hk_sequence_pkg is

  constant word_bits_c : positive := 8;
  subtype word_t is natural range 0 to 2 ** word_bits_c - 1;

  constant first_whole_c : word_t := 128;  -- constants with 16 fraction bits
  constant one_c         : word_t := 160;  -- and those without a fraction
  constant first_input_c : word_t := 192;  -- as a only: ports of the core
  constant nowhere_c     : word_t := 128;  -- as the place of a result
  constant component_c   : word_t := 192;  -- the same: a component for the arc tangent

  type condition_t is (always, if_negative, if_not, test);  -- test: always, and note the sign

  type instruction_t is record
    a     : word_t;
    b     : word_t;
    into  : word_t;
    keep  : boolean;  -- what the accumulator holds
    minus : boolean;
    mode : condition_t;
    last  : boolean;  -- of its program
  end record;
  type program_t is array (natural range <>) of instruction_t;

  -- The product alone, or less than nothing, or onto what the accumulator holds, or off it.
  function take (a : word_t; b : word_t := one_c; into : word_t := nowhere_c;
                 mode : condition_t := always) return instruction_t;
  function negate (a : word_t; b : word_t := one_c; into : word_t := nowhere_c;
                   mode : condition_t := always) return instruction_t;
  function plus (a : word_t; b : word_t := one_c; into : word_t := nowhere_c;
                 mode : condition_t := always) return instruction_t;
  function less (a : word_t; b : word_t := one_c; into : word_t := nowhere_c;
                 mode : condition_t := always) return instruction_t;

  -- The program with its last instruction marked.
  function ending (program : program_t) return program_t;

  -- Clocks that an instruction takes, and from its last one to one that reads its result. The
  -- sequencer waits where a result is not there yet.
  function clocks_of (instruction : instruction_t) return positive;
  constant result_clocks_c : positive := 6;

  -- The program as it stands in memory.
  constant place_bits_c : positive := 10;
  subtype code_t is std_logic_vector(31 downto 0);
  type codes_t is array (natural range 2 ** place_bits_c - 1 downto 0) of code_t;
  function assembled (program : program_t) return codes_t;

  -- A code in its fields.
  type fields_t is record
    a, b, into : unsigned(7 downto 0);
    waits      : unsigned(2 downto 0);  -- clocks behind the instruction before
    keep       : std_logic;
    minus      : std_logic;
    mode      : std_logic_vector(1 downto 0);
    last       : std_logic;
  end record;
  function decoded (code : code_t) return fields_t;

  constant always_c      : std_logic_vector(1 downto 0) := "00";
  constant if_negative_c : std_logic_vector(1 downto 0) := "01";
  constant if_not_c      : std_logic_vector(1 downto 0) := "10";
  constant test_c        : std_logic_vector(1 downto 0) := "11";

end package hk_sequence_pkg;

package body hk_sequence_pkg is

  function take (a : word_t; b : word_t := one_c; into : word_t := nowhere_c;
                 mode : condition_t := always) return instruction_t is
    variable instruction_v : instruction_t;
  begin
    instruction_v := (a, b, into, keep => false, minus => false, mode => mode,
                      last => false);
    return instruction_v;
  end function take;

  function negate (a : word_t; b : word_t := one_c; into : word_t := nowhere_c;
                   mode : condition_t := always) return instruction_t is
    variable instruction_v : instruction_t;
  begin
    instruction_v := (a, b, into, keep => false, minus => true, mode => mode,
                      last => false);
    return instruction_v;
  end function negate;

  function plus (a : word_t; b : word_t := one_c; into : word_t := nowhere_c;
                 mode : condition_t := always) return instruction_t is
    variable instruction_v : instruction_t;
  begin
    instruction_v := (a, b, into, keep => true, minus => false, mode => mode,
                      last => false);
    return instruction_v;
  end function plus;

  function less (a : word_t; b : word_t := one_c; into : word_t := nowhere_c;
                 mode : condition_t := always) return instruction_t is
    variable instruction_v : instruction_t;
  begin
    instruction_v := (a, b, into, keep => true, minus => true, mode => mode,
                      last => false);
    return instruction_v;
  end function less;

  function ending (program : program_t) return program_t is
    variable program_v : program_t(0 to program'length - 1);
  begin
    program_v := program;
    program_v(program_v'right).last := true;
    return program_v;
  end function ending;

  function clocks_of (instruction : instruction_t) return positive is
  begin
    if instruction.b >= one_c then
      return 1;
    end if;
    return 2;
  end function clocks_of;

  function bit_of (value : boolean) return std_logic is
  begin
    if value then
      return '1';
    end if;
    return '0';
  end function bit_of;

  function coded (instruction : instruction_t; waits : natural) return code_t is
    variable code_v : code_t;
  begin
    code_v(7 downto 0)   := std_logic_vector(to_unsigned(instruction.a, 8));
    code_v(15 downto 8)  := std_logic_vector(to_unsigned(instruction.b, 8));
    code_v(23 downto 16) := std_logic_vector(to_unsigned(instruction.into, 8));
    code_v(26 downto 24) := std_logic_vector(to_unsigned(waits, 3));
    code_v(27)           := bit_of(instruction.keep);
    code_v(28)           := bit_of(instruction.minus);
    code_v(30 downto 29) :=
      std_logic_vector(to_unsigned(condition_t'pos(instruction.mode), 2));
    code_v(31)           := bit_of(instruction.last);
    return code_v;
  end function coded;

  function assembled (program : program_t) return codes_t is
    type clocks_t is array (word_t) of natural;
    variable codes_v : codes_t;
    variable there_v : clocks_t;  -- clock from which on a word can be read
    variable free_v  : natural;   -- clock on which the instruction before has gone
    variable begin_v : natural;
    variable place_v : natural;
  begin
    codes_v := (others => (others => '0'));
    there_v := (others => 0);
    free_v  := 0;
    place_v := 0;
    for i in program'range loop
      begin_v := free_v;
      if there_v(program(i).a) > begin_v then
        begin_v := there_v(program(i).a);
      end if;
      if there_v(program(i).b) > begin_v then
        begin_v := there_v(program(i).b);
      end if;
      codes_v(place_v) := coded(program(i), begin_v - free_v);
      if program(i).into < nowhere_c then
        there_v(program(i).into) := begin_v + clocks_of(program(i)) - 1 + result_clocks_c;
      end if;
      free_v  := begin_v + clocks_of(program(i));
      place_v := place_v + 1;
    end loop;
    return codes_v;
  end function assembled;

  function decoded (code : code_t) return fields_t is
    variable fields_v : fields_t;
  begin
    fields_v.a     := unsigned(code(7 downto 0));
    fields_v.b     := unsigned(code(15 downto 8));
    fields_v.into  := unsigned(code(23 downto 16));
    fields_v.waits := unsigned(code(26 downto 24));
    fields_v.keep  := code(27);
    fields_v.minus := code(28);
    fields_v.mode := code(30 downto 29);
    fields_v.last  := code(31);
    return fields_v;
  end function decoded;

end package body hk_sequence_pkg;
