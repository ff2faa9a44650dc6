-- I2C master, one byte or condition a command. A bit has three parts of one length: SCL low with
-- the old SDA, SCL low with the new one, SCL high. Both lines are read back, so a slave may stretch
-- the clock, and a line that is held low is noticed. After an error the lines are let go; the
-- command that may follow then is i2c_recover_c.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.hk_i2c_pkg.all;

entity hk_i2c_master is
  generic (
    CLOCK_HZ           : positive;
    BUS_HZ             : positive := 400000;  -- at most; fast-mode minima hold at any clock
    STRETCH_TIMEOUT_US : positive := 400      -- at least so long a slave may hold SCL low
  );
  port (
    clk              : in  std_logic;
    rst              : in  std_logic;  -- synchronous, active high
    command_valid    : in  std_logic;
    command_ready    : out std_logic;
    command          : in  hk_i2c_command_t;
    write_data       : in  std_logic_vector(7 downto 0);
    reply_valid      : out std_logic;  -- one reply to each command
    reply_ready      : in  std_logic;
    read_data        : out std_logic_vector(7 downto 0);
    nack             : out std_logic;  -- a written byte was not acknowledged
    timed_out        : out std_logic;  -- SCL stayed low
    arbitration_lost : out std_logic;  -- SDA was low where it was let go
    stuck            : out std_logic;  -- recovery did not free the bus
    scl_in           : in  std_logic;  -- asynchronous: the lines as they are
    sda_in           : in  std_logic;
    scl_low          : out std_logic;  -- '1' pulls the line low
    sda_low          : out std_logic
  );
end entity hk_i2c_master;

architecture rtl of hk_i2c_master is

  -- Clocks that last at least so long.
  function clocks_of (ns : positive) return positive is
  begin
    return ((CLOCK_HZ + 999) / 1000 * ns + 999999) / 1000000;
  end function clocks_of;

  function larger (a, b : integer) return integer is
  begin
    if a > b then
      return a;
    end if;
    return b;
  end function larger;

  -- Two phases low last at least 1.3 us, one phase at least 0.6 us.
  constant phase_clocks_c : positive :=
    larger(clocks_of(650), (CLOCK_HZ + 3 * BUS_HZ - 1) / (3 * BUS_HZ));
  -- SCL has been high for as long as its filter takes when it is seen to be.
  constant filter_clocks_c : positive := 4;
  constant high_clocks_c   : positive := larger(phase_clocks_c - filter_clocks_c, 1);
  -- What SDA becomes after a start or stop must have come through its filter.
  constant mark_clocks_c   : positive := larger(phase_clocks_c, filter_clocks_c + 4);
  constant patience_c      : positive :=
    (CLOCK_HZ + 999999) / 1000000 * STRETCH_TIMEOUT_US / phase_clocks_c + 1;

  function bits_of (value : positive) return positive is
    variable bits_v : positive := 1;
  begin
    while 2 ** bits_v <= value loop
      bits_v := bits_v + 1;
    end loop;
    return bits_v;
  end function bits_of;

  constant timer_bits_c    : positive := bits_of(mark_clocks_c);
  constant patience_bits_c : positive := bits_of(patience_c);

  subtype timer_t is unsigned(timer_bits_c - 1 downto 0);
  constant phase_c : timer_t := to_unsigned(phase_clocks_c - 1, timer_bits_c);
  constant high_c  : timer_t := to_unsigned(high_clocks_c - 1, timer_bits_c);
  constant mark_c  : timer_t := to_unsigned(mark_clocks_c - 1, timer_bits_c);

  type state_t is (
    idle,
    holding,   -- SDA as it was
    setting,   -- SDA as it will be
    rising,    -- wait for SCL
    high,
    marking,   -- the edge of SDA that is a start or a stop
    finished
  );
  signal state_r : state_t;

  signal scl_line_r : std_logic_vector(3 downto 0);  -- two of the synchroniser, two of the filter
  signal sda_line_r : std_logic_vector(3 downto 0);
  signal scl_r      : std_logic;
  signal sda_r      : std_logic;

  signal scl_low_r  : std_logic;
  signal sda_low_r  : std_logic;
  signal command_r  : hk_i2c_command_t;
  signal byte_r     : std_logic_vector(8 downto 0);  -- to be sent, then received; ACK is last
  signal left_r     : unsigned(3 downto 0);          -- bits, or attempts at a stop, after this one
  signal timer_r    : timer_t;
  signal patience_r : unsigned(patience_bits_c downto 0);  -- phases; the highest bit ends it
  signal late_r     : std_logic;
  signal lost_r     : std_logic;

begin

  command_ready    <= '1' when state_r = idle else '0';
  reply_valid      <= '1' when state_r = finished else '0';
  read_data        <= byte_r(8 downto 1);
  nack             <= byte_r(0) when command_r = i2c_write_c else '0';
  timed_out        <= late_r;
  arbitration_lost <= lost_r;
  stuck            <= late_r or lost_r when command_r = i2c_recover_c else '0';
  scl_low          <= scl_low_r;
  sda_low          <= sda_low_r;

  -- A level counts when three samples in a row have it.
  lines : process (clk)
  begin
    if rising_edge(clk) then
      scl_line_r <= scl_line_r(2 downto 0) & scl_in;
      sda_line_r <= sda_line_r(2 downto 0) & sda_in;
      if scl_line_r(3 downto 1) = "111" then
        scl_r <= '1';
      elsif scl_line_r(3 downto 1) = "000" then
        scl_r <= '0';
      end if;
      if sda_line_r(3 downto 1) = "111" then
        sda_r <= '1';
      elsif sda_line_r(3 downto 1) = "000" then
        sda_r <= '0';
      end if;
      if rst = '1' then
        scl_line_r <= (others => '1');
        sda_line_r <= (others => '1');
        scl_r      <= '1';
        sda_r      <= '1';
      end if;
    end if;
  end process lines;

  main : process (clk)
    variable expired_v : boolean;
  begin
    if rising_edge(clk) then
      expired_v := timer_r = 0;
      timer_r   <= timer_r - 1;

      if state_r = idle then
        timer_r    <= phase_c;
        patience_r <= (others => '0');
        command_r  <= command;
        late_r     <= '0';
        lost_r     <= '0';
        byte_r     <= write_data & '1';
        left_r     <= "1000";
        if command(2) = '1' then
          byte_r <= "11111111" & command(0);
        elsif command = i2c_start_c or command = i2c_stop_c then
          left_r <= "0000";
        end if;
        if command_valid = '1' then
          state_r <= holding;
          if command /= i2c_start_c then
            scl_low_r <= '1';
          end if;
        end if;

      elsif state_r = holding then
        if expired_v then
          timer_r   <= phase_c;
          state_r   <= setting;
          sda_low_r <= not byte_r(8);
          if command_r = i2c_start_c then
            sda_low_r <= '0';
          elsif command_r = i2c_stop_c or command_r = i2c_recover_c then
            sda_low_r <= '1';
          end if;
        end if;

      elsif state_r = setting then
        if expired_v then
          timer_r   <= phase_c;
          scl_low_r <= '0';
          state_r   <= rising;
        end if;

      elsif state_r = rising then
        if scl_r = '1' then
          timer_r <= high_c;
          state_r <= high;
        elsif expired_v then
          timer_r    <= phase_c;
          patience_r <= patience_r + 1;
          if patience_r(patience_bits_c) = '1' then
            late_r  <= '1';
            state_r <= finished;
          end if;
        end if;

      elsif state_r = high then
        if expired_v then
          timer_r <= mark_c;
          if command_r(2) = '1' or command_r = i2c_write_c then
            timer_r <= phase_c;
            byte_r  <= byte_r(7 downto 0) & sda_r;
            left_r  <= left_r - 1;
            if left_r /= 0 and command_r(2) = '0' and byte_r(8) = '1' and sda_r = '0' then
              lost_r  <= '1';
              state_r <= finished;
            else
              scl_low_r <= '1';
              state_r   <= holding;
              if left_r = 0 then
                state_r <= finished;
              end if;
            end if;
          elsif command_r = i2c_start_c then
            if sda_r = '1' then
              sda_low_r <= '1';
              state_r   <= marking;
            else
              lost_r  <= '1';
              state_r <= finished;
            end if;
          else
            sda_low_r <= '0';
            state_r   <= marking;
          end if;
        end if;

      elsif state_r = marking then
        if expired_v then
          timer_r <= phase_c;
          left_r  <= left_r - 1;
          state_r <= finished;
          if command_r = i2c_start_c then
            scl_low_r <= '1';
          elsif sda_r = '0' then
            if left_r = 0 then
              lost_r <= '1';
            else
              scl_low_r <= '1';
              state_r   <= holding;
            end if;
          end if;
        end if;

      else
        if late_r = '1' or lost_r = '1' then
          scl_low_r <= '0';
          sda_low_r <= '0';
        end if;
        if reply_ready = '1' then
          state_r <= idle;
        end if;
      end if;

      if rst = '1' then
        scl_low_r <= '0';
        sda_low_r <= '0';
        state_r   <= idle;
      end if;
    end if;
  end process main;

end architecture rtl;
