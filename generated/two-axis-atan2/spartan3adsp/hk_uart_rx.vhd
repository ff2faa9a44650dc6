-- Serial receiver, 8 data bits, no parity, 1 stop bit. Three samples about the middle of a bit vote
-- on it, the start bit included, so a glitch makes no byte.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

entity hk_uart_rx is
  generic (
    CLOCK_HZ : positive;
    BAUD     : positive  -- a quarter of the clock at most
  );
  port (
    clk           : in  std_logic;
    rst           : in  std_logic;  -- synchronous, active high
    rx            : in  std_logic;  -- asynchronous
    out_valid     : out std_logic;
    out_ready     : in  std_logic;
    out_data      : out std_logic_vector(7 downto 0);
    framing_error : out std_logic;  -- one clock: a stop bit was 0; a break makes one such pulse
    overrun       : out std_logic  -- one clock: a byte was dropped, the one before is not yet taken
  );
end entity hk_uart_rx;

architecture rtl of hk_uart_rx is

  -- Three samples need four in a bit, or two would fall on one clock.
  function sample_bits return positive is
  begin
    if CLOCK_HZ / 8 >= BAUD then
      return 3;
    end if;
    return 2;
  end function sample_bits;

  constant sample_bits_c : positive := sample_bits;
  constant samples_c     : positive := 2 ** sample_bits_c;
  -- The vote ends with the sample after the middle of the bit.
  constant vote_c        : unsigned(sample_bits_c - 1 downto 0) :=
    to_unsigned(samples_c / 2, sample_bits_c);

  type state_t is (idle, starting, receiving, waiting);  -- the last: for the end of a break
  signal state_r : state_t;

  signal sync_r   : std_logic_vector(1 downto 0);
  signal level    : std_logic;
  signal recent_r : std_logic_vector(1 downto 0);
  signal vote     : std_logic;

  signal tick     : std_logic;
  signal sample_r : unsigned(sample_bits_c - 1 downto 0);
  signal voting   : std_logic;
  signal ending   : std_logic;
  signal free     : std_logic;

  -- Ones at first, so a 0 at the low end is the start bit: all data are in.
  signal bits_r : std_logic_vector(8 downto 0);

  signal data_r          : std_logic_vector(7 downto 0);
  signal valid_r         : std_logic;
  signal framing_error_r : std_logic;
  signal overrun_r       : std_logic;

begin

  assert BAUD <= CLOCK_HZ / 4
    report "hk_uart_rx: BAUD must be a quarter of CLOCK_HZ at most"
    severity failure;

  out_valid     <= valid_r;
  out_data      <= data_r;
  framing_error <= framing_error_r;
  overrun       <= overrun_r;

  level  <= sync_r(1);
  vote   <= (recent_r(1) and recent_r(0)) or ((recent_r(1) or recent_r(0)) and level);
  voting <= '1' when tick = '1' and sample_r = vote_c else '0';
  ending <= '1' when voting = '1' and state_r = receiving and bits_r(0) = '0' else '0';
  -- A fast sender's start bit may be there with the last vote on the stop bit.
  free   <= '1' when state_r = idle or ending = '1' else '0';

  ticks : entity work.hk_ticks
    generic map (
      CLOCK_HZ => CLOCK_HZ,
      TICKS_HZ => samples_c * BAUD
    )
    port map (
      clk     => clk,
      restart => free,
      tick    => tick
    );

  process (clk)
  begin
    if rising_edge(clk) then
      sync_r          <= sync_r(0) & rx;
      framing_error_r <= '0';
      overrun_r       <= '0';
      if tick = '1' then
        sample_r <= sample_r + 1;
        recent_r <= recent_r(0) & level;
      end if;
      if voting = '1' then
        bits_r <= vote & bits_r(8 downto 1);
      end if;
      if valid_r = '1' and out_ready = '1' then
        valid_r <= '0';
      end if;

      if state_r = starting and voting = '1' then
        state_r <= receiving;
        if vote = '1' then
          state_r <= idle;
        end if;
      elsif state_r = waiting and level = '1' then
        state_r <= idle;
      end if;

      if ending = '1' then
        if vote = '0' then
          framing_error_r <= '1';
        elsif valid_r = '1' and out_ready = '0' then
          overrun_r <= '1';
        else
          data_r  <= bits_r(8 downto 1);
          valid_r <= '1';
        end if;
      end if;
      if free = '1' then
        sample_r <= (others => '0');
        bits_r   <= (others => '1');
        if ending = '1' and vote = '0' then
          state_r <= waiting;
        elsif level = '0' then
          state_r <= starting;
        else
          state_r <= idle;
        end if;
      end if;

      if rst = '1' then
        sync_r          <= (others => '1');
        state_r         <= idle;
        valid_r         <= '0';
        framing_error_r <= '0';
        overrun_r       <= '0';
      end if;
    end if;
  end process;

end architecture rtl;
