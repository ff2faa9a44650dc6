-- Bench of hk_system: the model of the sensor plays a table of counts, and what comes over the
-- serial line is written to a file.
--
-- COUNT_FILE: the table of hk_mpu6050_model. RESULT_FILE: a line for each byte of the serial line,
-- the time in microseconds at which its stop bit ended and two hex digits.
--
-- The bench ends by itself DRAIN_US after ROWS lines of the table have been played: without an error
-- if every character had a start and a stop bit and no bit was unknown; and LIMIT_US after the reset
-- even if the sensor was never read, unless that is 0. The other generics are those
-- of hk_system and of the model, whose faults they are; a fault at 0 never comes.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use std.textio.all;

entity hk_system_tb is
  generic (
    COUNT_FILE     : string   := "counts.txt";
    RESULT_FILE    : string   := "bytes.txt";
    ROWS           : natural;
    DRAIN_US       : positive := 2000;
    LIMIT_US       : natural  := 0;
    CLOCK_HZ       : positive := 4000000;
    BAUD           : positive := 1000000;
    TIME_DIVISOR   : positive := 1;
    IDENTITY       : natural  := 16#68#;
    NACK_AT        : natural  := 0;
    NACKS          : positive := 1;
    STRETCH_AT     : natural  := 0;
    STRETCH_US     : natural  := 0;
    STUCK_AT_US    : natural  := 0;
    STUCK_CLOCKS   : positive := 5;
    TORN_AT_US     : natural  := 0;
    UPSET_AT_US    : natural  := 0;
    UPSET_REGISTER : natural  := 16#1B#;
    UPSET_BITS     : natural  := 16#10#;
    RESET_AT_US    : natural  := 0;
    FROZEN_AT_US   : natural  := 0;
    MUTE_AT_US     : natural  := 0;
    MUTE_SAMPLES   : natural  := 5
  );
end entity hk_system_tb;

architecture sim of hk_system_tb is

  constant clock_period_c : time := 1 sec / CLOCK_HZ;
  constant bit_time_c     : time := 1 sec / BAUD;

  type hex_digits_t is array (0 to 15) of character;
  constant hex_digits_c : hex_digits_t := "0123456789abcdef";

  signal clk   : std_logic := '0';
  signal rst   : std_logic := '1';
  signal ended : boolean   := false;

  signal scl         : std_logic;
  signal sda         : std_logic;
  signal scl_in      : std_logic;
  signal sda_in      : std_logic;
  signal scl_low     : std_logic;
  signal sda_low     : std_logic;
  signal int_pin     : std_logic;
  signal uart_tx     : std_logic;
  signal running     : std_logic;
  signal failed      : std_logic;
  signal rows_played : natural;

begin

  clock : process
  begin
    while not ended loop
      wait for clock_period_c / 2;
      clk <= '1';
      wait for clock_period_c - clock_period_c / 2;
      clk <= '0';
    end loop;
    wait;
  end process clock;

  rst <= '1', '0' after 4 * clock_period_c;

  -- Open drain with pull-ups.
  scl    <= 'H';
  sda    <= 'H';
  scl    <= '0' when scl_low = '1' else 'Z';
  sda    <= '0' when sda_low = '1' else 'Z';
  scl_in <= to_x01(scl);
  sda_in <= to_x01(sda);

  system : entity work.hk_system
    generic map (
      CLOCK_HZ     => CLOCK_HZ,
      BAUD         => BAUD,
      TIME_DIVISOR => TIME_DIVISOR
    )
    port map (
      clk     => clk,
      rst     => rst,
      scl_in  => scl_in,
      sda_in  => sda_in,
      scl_low => scl_low,
      sda_low => sda_low,
      int_pin => int_pin,
      uart_tx => uart_tx,
      running => running,
      failed  => failed
    );

  sensor : entity work.hk_mpu6050_model
    generic map (
      COUNTS_FILE    => COUNT_FILE,
      TIME_DIVISOR   => TIME_DIVISOR,
      IDENTITY       => IDENTITY,
      NACK_AT        => NACK_AT,
      NACKS          => NACKS,
      STRETCH_AT     => STRETCH_AT,
      STRETCH_US     => STRETCH_US,
      STUCK_AT_US    => STUCK_AT_US,
      STUCK_CLOCKS   => STUCK_CLOCKS,
      TORN_AT_US     => TORN_AT_US,
      UPSET_AT_US    => UPSET_AT_US,
      UPSET_REGISTER => UPSET_REGISTER,
      UPSET_BITS     => UPSET_BITS,
      RESET_AT_US    => RESET_AT_US,
      FROZEN_AT_US   => FROZEN_AT_US,
      MUTE_AT_US     => MUTE_AT_US,
      MUTE_SAMPLES   => MUTE_SAMPLES
    )
    port map (
      scl     => scl,
      sda     => sda,
      int_pin => int_pin,
      rows    => rows_played
    );

  -- A receiver that is as strict as the standard: it looks at the middle of every bit.
  receive : process
    file results    : text open write_mode is RESULT_FILE;
    variable line_v : line;
    variable byte_v : unsigned(7 downto 0);
  begin
    wait until rst = '0';
    loop
      if uart_tx /= '0' then
        wait until uart_tx = '0';
      end if;
      wait for bit_time_c / 2;
      assert uart_tx = '0' report "a start bit is too short" severity failure;
      for i in 0 to 7 loop
        wait for bit_time_c;
        assert uart_tx = '0' or uart_tx = '1' report "an unknown bit was sent" severity failure;
        byte_v := uart_tx & byte_v(7 downto 1);
      end loop;
      wait for bit_time_c;
      exit when ended;  -- the clock has stopped within a character
      assert uart_tx = '1' report "a stop bit is missing" severity failure;
      write(line_v, now / 1 us);
      write(line_v, ' ');
      write(line_v, hex_digits_c(to_integer(byte_v(7 downto 4))));
      write(line_v, hex_digits_c(to_integer(byte_v(3 downto 0))));
      writeline(results, line_v);
    end loop;
    wait;
  end process receive;

  finish : process
  begin
    if LIMIT_US = 0 then
      wait until rows_played >= ROWS;
    else
      wait until rows_played >= ROWS for LIMIT_US * 1 us;
    end if;
    wait for DRAIN_US * 1 us;
    ended <= true;
    wait;
  end process finish;

end architecture sim;
