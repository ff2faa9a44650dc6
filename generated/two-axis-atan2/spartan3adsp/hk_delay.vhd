-- Data as it was CLOCKS clocks ago. A few clocks are registers; more are a memory, which fills no
-- registers. What comes out in the first CLOCKS clocks after reset is not defined.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.hk_common_pkg.all;

entity hk_delay is
  generic (
    BITS   : positive;
    CLOCKS : natural
  );
  port (
    clk      : in  std_logic;
    rst      : in  std_logic;  -- synchronous, active high
    in_data  : in  std_logic_vector(BITS - 1 downto 0);
    out_data : out std_logic_vector(BITS - 1 downto 0)
  );
end entity hk_delay;

architecture rtl of hk_delay is

  constant least_memory_c : positive := 4;

begin

  as_registers : if CLOCKS < least_memory_c generate
    type words_t is array (0 to CLOCKS) of std_logic_vector(BITS - 1 downto 0);
    signal words : words_t;
  begin

    words(0) <= in_data;
    out_data <= words(CLOCKS);

    stages : for stage in 1 to CLOCKS generate
      process (clk)
      begin
        if rising_edge(clk) then
          words(stage) <= words(stage - 1);
        end if;
      end process;
    end generate stages;

  end generate as_registers;

  as_memory : if CLOCKS >= least_memory_c generate
    -- Two clocks are those of the registers at the memory's output.
    constant address_bits_c : positive := hk_index_bits(CLOCKS - 1);
    constant words_c        : positive := 2**address_bits_c;
    constant start_c        : natural  := words_c - (CLOCKS - 2);

    type memory_t is array (0 to words_c - 1) of std_logic_vector(BITS - 1 downto 0);
    signal memory_r : memory_t;
    signal word_r   : std_logic_vector(BITS - 1 downto 0);
    signal write_r  : unsigned(address_bits_c - 1 downto 0);
    signal read_r   : unsigned(address_bits_c - 1 downto 0);
  begin

    process (clk)
    begin
      if rising_edge(clk) then
        memory_r(to_integer(write_r)) <= in_data;
        word_r                        <= memory_r(to_integer(read_r));
      end if;
    end process;

    process (clk)
    begin
      if rising_edge(clk) then
        out_data <= word_r;
        write_r  <= write_r + 1;
        read_r   <= read_r + 1;
        if rst = '1' then
          write_r <= (others => '0');
          read_r  <= to_unsigned(start_c, address_bits_c);
        end if;
      end if;
    end process;

  end generate as_memory;

end architecture rtl;
