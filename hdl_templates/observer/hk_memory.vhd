-- The words of the program: one copy with a port to read and a port to write. A word that is being
-- written cannot be read on the same clock.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.hk_observer_words_pkg.all;

entity hk_memory is
  port (
    clk        : in  std_logic;
    read       : in  std_logic;
    read_from  : in  unsigned(7 downto 0);
    word       : out signed(31 downto 0);  -- a clock later, until the next
    write      : in  std_logic;
    write_into : in  unsigned(7 downto 0);
    write_word : in  signed(31 downto 0)
  );
end entity hk_memory;

architecture rtl of hk_memory is

  signal words_r : words_t := initial_words;

begin

  process (clk)
  begin
    if rising_edge(clk) then
      if write = '1' then
        words_r(to_integer(write_into)) <= std_logic_vector(write_word);
      end if;
      if read = '1' then
        word <= signed(words_r(to_integer(read_from)));
      end if;
    end if;
  end process;

end architecture rtl;
