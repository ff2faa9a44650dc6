-- Square root, a new one every clock: root = floor(sqrt(radicand) * 2**FRACTION_BITS), there
-- INTEGER_BITS + FRACTION_BITS clocks after the radicand. Each stage finds one bit. A rest below
-- zero is not put back but added to in the next stage, which gives the same bits.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

entity hk_root_pipelined is
  generic (
    INTEGER_BITS  : positive;  -- of the root; the radicand has twice as many
    FRACTION_BITS : positive
  );
  port (
    clk      : in  std_logic;
    radicand : in  unsigned(2 * INTEGER_BITS - 1 downto 0);
    root     : out unsigned(INTEGER_BITS + FRACTION_BITS - 1 downto 0)
  );
end entity hk_root_pipelined;

architecture rtl of hk_root_pipelined is

  constant root_bits_c : positive := INTEGER_BITS + FRACTION_BITS;

  subtype radicand_t is unsigned(2 * root_bits_c - 1 downto 0);
  subtype root_t is unsigned(root_bits_c - 1 downto 0);
  subtype rest_t is signed(root_bits_c + 2 downto 0);

  -- An element a stage, the first is what comes in.
  type radicands_t is array (0 to root_bits_c) of radicand_t;
  type roots_t is array (0 to root_bits_c) of root_t;
  type rests_t is array (0 to root_bits_c) of rest_t;

  signal radicands : radicands_t;
  signal roots     : roots_t;
  signal rests     : rests_t;

begin

  radicands(0) <= shift_left(resize(radicand, 2 * root_bits_c), 2 * FRACTION_BITS);
  roots(0)     <= (others => '0');
  rests(0)     <= (others => '0');
  root         <= roots(root_bits_c);

  stages : for stage in 1 to root_bits_c generate

    process (clk)
      variable minuend_v : rest_t;
      variable trial_v   : rest_t;
    begin
      if rising_edge(clk) then
        minuend_v := rests(stage - 1)(root_bits_c downto 0)
                     & signed(radicands(stage - 1)(2 * root_bits_c - 1 downto 2 * root_bits_c - 2));
        if rests(stage - 1)(root_bits_c + 2) = '0' then
          trial_v := minuend_v - signed('0' & std_logic_vector(roots(stage - 1)) & "01");
        else
          trial_v := minuend_v + signed('0' & std_logic_vector(roots(stage - 1)) & "11");
        end if;
        rests(stage)     <= trial_v;
        roots(stage)     <= roots(stage - 1)(root_bits_c - 2 downto 0)
                            & not trial_v(root_bits_c + 2);
        radicands(stage) <= radicands(stage - 1)(2 * root_bits_c - 3 downto 0) & "00";
      end if;
    end process;

  end generate stages;

end architecture rtl;
