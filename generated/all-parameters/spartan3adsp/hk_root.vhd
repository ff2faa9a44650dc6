-- Square root, one bit of the result a clock: root = floor(sqrt(radicand) * 2**FRACTION_BITS).
-- The result is there INTEGER_BITS + FRACTION_BITS clocks after the radicand was taken.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

entity hk_root is
  generic (
    INTEGER_BITS  : positive;  -- of the root; the radicand has twice as many
    FRACTION_BITS : positive
  );
  port (
    clk       : in  std_logic;
    rst       : in  std_logic;  -- synchronous, active high
    in_valid  : in  std_logic;
    in_ready  : out std_logic;
    radicand  : in  unsigned(2 * INTEGER_BITS - 1 downto 0);
    out_valid : out std_logic;
    out_ready : in  std_logic;
    root      : out unsigned(INTEGER_BITS + FRACTION_BITS - 1 downto 0)
  );
end entity hk_root;

architecture rtl of hk_root is

  constant root_bits_c : positive := INTEGER_BITS + FRACTION_BITS;

  type state_t is (idle, working, finished);
  signal state_r : state_t;

begin

  in_ready  <= '1' when state_r = idle else '0';
  out_valid <= '1' when state_r = finished else '0';

  process (clk)
    variable radicand_v : unsigned(2 * INTEGER_BITS - 1 downto 0);
    variable rest_v     : unsigned(root_bits_c + 1 downto 0);
    variable trial_v    : unsigned(root_bits_c + 1 downto 0);
    variable root_v     : unsigned(root_bits_c - 1 downto 0);
    variable bits_v     : natural range 0 to root_bits_c;
  begin
    if rising_edge(clk) then
      if state_r = idle then
        if in_valid = '1' then
          radicand_v := radicand;
          rest_v     := (others => '0');
          root_v     := (others => '0');
          bits_v     := root_bits_c;
          state_r    <= working;
        end if;
      elsif state_r = working then
        rest_v     := rest_v(root_bits_c - 1 downto 0)
                      & radicand_v(2 * INTEGER_BITS - 1 downto 2 * INTEGER_BITS - 2);
        radicand_v := radicand_v(2 * INTEGER_BITS - 3 downto 0) & "00";
        trial_v    := root_v & "01";
        if rest_v >= trial_v then
          rest_v := rest_v - trial_v;
          root_v := root_v(root_bits_c - 2 downto 0) & '1';
        else
          root_v := root_v(root_bits_c - 2 downto 0) & '0';
        end if;
        bits_v := bits_v - 1;
        if bits_v = 0 then
          root    <= root_v;
          state_r <= finished;
        end if;
      else
        if out_ready = '1' then
          state_r <= idle;
        end if;
      end if;
      if rst = '1' then
        state_r <= idle;
      end if;
    end if;
  end process;

end architecture rtl;
