-- Entry of the pipelined filter: two places for samples, so that ready depends on nothing outside,
-- and the interlock. A sample goes on when none of its channel has done so in the last
-- CHANNEL_CLOCKS - 1 clocks; until then those behind it wait.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

entity hk_complementary_entry is
  generic (
    BITS           : positive;
    CHANNEL_BITS   : positive;
    CHANNEL_CLOCKS : positive
  );
  port (
    clk         : in  std_logic;
    rst         : in  std_logic;  -- synchronous, active high
    room        : in  std_logic;  -- the filter may take a sample
    in_valid    : in  std_logic;
    in_ready    : out std_logic;
    in_channel  : in  unsigned(CHANNEL_BITS - 1 downto 0);
    in_data     : in  std_logic_vector(BITS - 1 downto 0);
    out_valid   : out std_logic;  -- on this clock the sample goes on
    out_channel : out unsigned(CHANNEL_BITS - 1 downto 0);
    out_data    : out std_logic_vector(BITS - 1 downto 0)
  );
end entity hk_complementary_entry;

architecture rtl of hk_complementary_entry is

  subtype channel_t is unsigned(CHANNEL_BITS - 1 downto 0);
  type channels_t is array (1 to CHANNEL_CLOCKS - 1) of channel_t;

  -- The sample that goes on next, and one behind it.
  signal first_valid_r    : std_logic;
  signal first_channel_r  : channel_t;
  signal first_data_r     : std_logic_vector(BITS - 1 downto 0);
  signal second_valid_r   : std_logic;
  signal second_channel_r : channel_t;
  signal second_data_r    : std_logic_vector(BITS - 1 downto 0);

  -- What has gone on so many clocks ago.
  signal gone_valid_r   : std_logic_vector(1 to CHANNEL_CLOCKS - 1);
  signal gone_channel_r : channels_t;

  signal ready   : std_logic;
  signal free_r  : std_logic;  -- the first sample may go on
  signal goes_on : std_logic;

  -- Whether one of this channel will have gone on in the clocks before the next, the last one
  -- left out.
  function has_gone (
    channel  : channel_t;
    valid    : std_logic_vector(1 to CHANNEL_CLOCKS - 1);
    channels : channels_t
  ) return std_logic is
    variable gone_v : std_logic;
  begin
    gone_v := '0';
    for clock in 1 to CHANNEL_CLOCKS - 2 loop
      if valid(clock) = '1' and channels(clock) = channel then
        gone_v := '1';
      end if;
    end loop;
    return gone_v;
  end function has_gone;

begin

  ready       <= room and not second_valid_r;
  in_ready    <= ready;
  goes_on     <= first_valid_r and free_r;
  out_valid   <= goes_on;
  out_channel <= first_channel_r;
  out_data    <= first_data_r;

  -- Channels are compared a clock ahead, each place by itself: that a sample goes on enables many
  -- registers.
  interlock : process (clk)
    variable first_v  : std_logic;
    variable second_v : std_logic;
    variable in_v     : std_logic;
  begin
    if rising_edge(clk) then
      first_v  := has_gone(first_channel_r, gone_valid_r, gone_channel_r);
      second_v := has_gone(second_channel_r, gone_valid_r, gone_channel_r);
      in_v     := has_gone(in_channel, gone_valid_r, gone_channel_r);
      if goes_on = '1' and second_channel_r = first_channel_r then
        second_v := '1';
      end if;
      if goes_on = '1' and in_channel = first_channel_r then
        in_v := '1';
      end if;

      if goes_on = '0' and first_valid_r = '1' then
        free_r <= not first_v;
      elsif second_valid_r = '1' then
        free_r <= not second_v;
      else
        free_r <= not in_v;
      end if;
    end if;
  end process interlock;

  process (clk)
  begin
    if rising_edge(clk) then
      gone_valid_r   <= goes_on & gone_valid_r(1 to CHANNEL_CLOCKS - 2);
      gone_channel_r <= first_channel_r & gone_channel_r(1 to CHANNEL_CLOCKS - 2);

      if goes_on = '1' or first_valid_r = '0' then
        if second_valid_r = '1' then
          first_channel_r <= second_channel_r;
          first_data_r    <= second_data_r;
          second_valid_r  <= '0';
          first_valid_r   <= '1';
        else
          first_channel_r <= in_channel;
          first_data_r    <= in_data;
          first_valid_r   <= in_valid and ready;
        end if;
      else
        if second_valid_r = '0' then
          second_channel_r <= in_channel;
          second_data_r    <= in_data;
          second_valid_r   <= in_valid and ready;
        end if;
      end if;

      if rst = '1' then
        first_valid_r  <= '0';
        second_valid_r <= '0';
        gone_valid_r   <= (others => '0');
      end if;
    end if;
  end process;

end architecture rtl;
