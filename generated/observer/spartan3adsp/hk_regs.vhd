-- made by hostkit 0.1.0 from design f27a2d565bf0; do not edit; template registers/hk_regs.vhd.j2
-- The registers behind a bus. A request is one clock of `read` or `write`, never both; a write is
-- acknowledged in the next clock and a read in the one after. Settings are written to a copy, which
-- a commit hands over while the core is free.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.hk_observer_pkg.all;
use work.hk_regs_pkg.all;

entity hk_regs is
  port (
    clk           : in  std_logic;
    rst           : in  std_logic;  -- synchronous, active high
    address       : in  unsigned(7 downto 0);  -- bytes; the low two bits are ignored
    write         : in  std_logic;
    read          : in  std_logic;
    write_data    : in  std_logic_vector(31 downto 0);
    write_strobes : in  std_logic_vector(3 downto 0);   -- one a byte
    read_data     : out std_logic_vector(31 downto 0);  -- holds until the next read
    acknowledge   : out std_logic;
    error         : out std_logic;  -- with acknowledge: no such register, or nothing was written
    from_core     : in  hk_regs_in_t;
    to_core       : out hk_regs_out_t
  );
end entity hk_regs;

architecture rtl of hk_regs is

  type words_t is array (0 to 3) of std_logic_vector(31 downto 0);

  signal index    : hk_regs_word_t;
  signal known    : std_logic;  -- the address has a register
  signal accepted : std_logic;  -- a write there is taken, or ignored, without an error
  signal restore  : std_logic;  -- the design's settings are written back

  signal acknowledge_r : std_logic;
  signal error_r       : std_logic;
  signal reading_r     : std_logic;
  signal bad_r         : std_logic;  -- the read had no register
  signal quarters_r    : words_t;    -- all but the one that is read are 0
  signal read_data_r   : std_logic_vector(31 downto 0);
  signal time_us_r     : unsigned(31 downto 0);  -- high word when the low one was read

  signal staged_r     : std_logic;
  signal committing_r : std_logic;
  signal retuned_r    : std_logic;
  signal enable_r     : std_logic;
  signal clear_r      : std_logic;
  signal interrupt_r  : std_logic;

  -- What the bus writes and reads, and what the core has. No record: all its bits are too long a
  -- constant for GHDL's Verilog writer.
  signal kt_r : signed(31 downto 0);
  signal kt_used_r : signed(31 downto 0);
  signal kv_r : signed(31 downto 0);
  signal kv_used_r : signed(31 downto 0);
  signal kb_r : signed(31 downto 0);
  signal kb_used_r : signed(31 downto 0);
  signal gyro_bias_x_r : signed(31 downto 0);
  signal gyro_bias_x_used_r : signed(31 downto 0);
  signal gyro_bias_y_r : signed(31 downto 0);
  signal gyro_bias_y_used_r : signed(31 downto 0);
  signal gyro_bias_z_r : signed(31 downto 0);
  signal gyro_bias_z_used_r : signed(31 downto 0);

  signal new_sample_r : std_logic;
  signal new_sample_interrupt_r : std_logic;
  signal restarted_r : std_logic;
  signal restarted_interrupt_r : std_logic;
  signal saturated_r : std_logic;
  signal saturated_interrupt_r : std_logic;
  signal overrun_r : std_logic;
  signal overrun_interrupt_r : std_logic;
  signal bus_error_r : std_logic;
  signal bus_error_interrupt_r : std_logic;
  signal uart_overrun_r : std_logic;
  signal uart_overrun_interrupt_r : std_logic;
  signal uart_framing_r : std_logic;
  signal uart_framing_interrupt_r : std_logic;

  function with_written (old, data, strobes : std_logic_vector) return std_logic_vector is
    variable word_v : std_logic_vector(31 downto 0);
  begin
    word_v := old;
    for i in 0 to 3 loop
      if strobes(i) = '1' then
        word_v(8 * i + 7 downto 8 * i) := data(8 * i + 7 downto 8 * i);
      end if;
    end loop;
    return word_v;
  end function with_written;

begin

  index       <= address(7 downto 2);
  acknowledge <= acknowledge_r;
  error       <= error_r;
  read_data   <= read_data_r;

  to_core.settings.kt <= kt_used_r;
  to_core.settings.kv <= kv_used_r;
  to_core.settings.kb <= kb_used_r;
  to_core.settings.gyro_bias_x <= gyro_bias_x_used_r;
  to_core.settings.gyro_bias_y <= gyro_bias_y_used_r;
  to_core.settings.gyro_bias_z <= gyro_bias_z_used_r;
  to_core.enable    <= enable_r;
  to_core.clear     <= clear_r;
  to_core.retuned   <= retuned_r;
  to_core.interrupt <= interrupt_r;
  to_core.uart_read <= from_core.uart_valid when read = '1' and index = uart_rx_word_c else '0';

  restore <= '1' when write = '1' and index = control_word_c and write_strobes(0) = '1'
                      and write_data(3) = '1' else '0';

  known <= '1' when
    (index >= 0 and index <= 13) or
    (index >= 16 and index <= 21) or
    (index >= 32 and index <= 36) or
    (index >= 39 and index <= 42) or
    (index >= 48 and index <= 51)
    else '0';

  accepting : process (index, write_data, write_strobes, committing_r)
  begin
    accepted <= '0';
    if index >= 9 and index <= 9 then
      accepted <= '1';
    end if;
    if index >= 11 and index <= 12 then
      accepted <= '1';
    end if;
    if index >= 16 and index <= 21 then
      accepted <= '1';
    end if;
    -- What is being handed over must not change.
    if committing_r = '1' and index >= 16 and index <= 21 then
      accepted <= '0';
    end if;
  end process accepting;

  -- Reading takes two clocks: one for each quarter of the map, one for all.
  quarter_0 : process (clk)
    variable word_v : std_logic_vector(31 downto 0);
  begin
    if rising_edge(clk) then
      word_v := (others => '0');
      if index(3 downto 0) = identity_word_c(3 downto 0) then
        word_v(31 downto 0) := "01001000010010110100100101010100";
      elsif index(3 downto 0) = version_word_c(3 downto 0) then
        word_v(15 downto 8) := "00000001";
        word_v(31 downto 24) := "00000001";
      elsif index(3 downto 0) = digest_high_word_c(3 downto 0) then
        word_v(15 downto 0) := "1111001001111010";
      elsif index(3 downto 0) = digest_low_word_c(3 downto 0) then
        word_v(31 downto 0) := "00101101010101100101101111110000";
      elsif index(3 downto 0) = features_word_c(3 downto 0) then
        word_v(0) := '1';
        word_v(1) := '1';
        word_v(2) := '1';
        word_v(3) := '1';
        word_v(4) := '1';
        word_v(6) := '1';
        word_v(31 downto 16) := "0000000000000001";
      elsif index(3 downto 0) = sensor_word_c(3 downto 0) then
        word_v(15 downto 0) := "0000000111110100";
        word_v(23 downto 16) := "00001001";
        word_v(28 downto 24) := "00100";
        word_v(31 downto 29) := "010";
      elsif index(3 downto 0) = rate_word_c(3 downto 0) then
        word_v(31 downto 0) := "00000000000000011000011010100000";
      elsif index(3 downto 0) = formats_word_c(3 downto 0) then
        word_v(7 downto 0) := "00101010";
        word_v(15 downto 8) := "00100000";
        word_v(23 downto 16) := "00100111";
        word_v(31 downto 24) := "00100111";
      elsif index(3 downto 0) = scales_word_c(3 downto 0) then
        word_v(31 downto 16) := "0010000000000000";
      elsif index(3 downto 0) = control_word_c(3 downto 0) then
        word_v(0) := enable_r;
      elsif index(3 downto 0) = status_word_c(3 downto 0) then
        word_v(0) := from_core.running;
        word_v(1) := from_core.failed;
        word_v(2) := from_core.core_busy;
        word_v(3) := retuned_r;
        word_v(4) := staged_r;
        word_v(5) := committing_r;
        word_v(15 downto 8) := from_core.identity;
      elsif index(3 downto 0) = events_word_c(3 downto 0) then
        word_v(0) := new_sample_r;
        word_v(1) := restarted_r;
        word_v(2) := saturated_r;
        word_v(3) := overrun_r;
        word_v(4) := bus_error_r;
        word_v(5) := uart_overrun_r;
        word_v(6) := uart_framing_r;
      elsif index(3 downto 0) = interrupts_word_c(3 downto 0) then
        word_v(0) := new_sample_interrupt_r;
        word_v(1) := restarted_interrupt_r;
        word_v(2) := saturated_interrupt_r;
        word_v(3) := overrun_interrupt_r;
        word_v(4) := bus_error_interrupt_r;
        word_v(5) := uart_overrun_interrupt_r;
        word_v(6) := uart_framing_interrupt_r;
      elsif index(3 downto 0) = uart_rx_word_c(3 downto 0) then
        word_v(7 downto 0) := from_core.uart_data;
        word_v(8) := from_core.uart_valid;
      end if;
      quarters_r(0) <= word_v;
      if index(5 downto 4) /= 0 then
        quarters_r(0) <= (others => '0');
      end if;
    end if;
  end process quarter_0;

  quarter_1 : process (clk)
    variable word_v : std_logic_vector(31 downto 0);
  begin
    if rising_edge(clk) then
      word_v := (others => '0');
      if index(3 downto 0) = kt_word_c(3 downto 0) then
        word_v(31 downto 0) := std_logic_vector(resize(kt_r, 32));
      elsif index(3 downto 0) = kv_word_c(3 downto 0) then
        word_v(31 downto 0) := std_logic_vector(resize(kv_r, 32));
      elsif index(3 downto 0) = kb_word_c(3 downto 0) then
        word_v(31 downto 0) := std_logic_vector(resize(kb_r, 32));
      elsif index(3 downto 0) = gyro_bias_x_word_c(3 downto 0) then
        word_v(31 downto 0) := std_logic_vector(resize(gyro_bias_x_r, 32));
      elsif index(3 downto 0) = gyro_bias_y_word_c(3 downto 0) then
        word_v(31 downto 0) := std_logic_vector(resize(gyro_bias_y_r, 32));
      elsif index(3 downto 0) = gyro_bias_z_word_c(3 downto 0) then
        word_v(31 downto 0) := std_logic_vector(resize(gyro_bias_z_r, 32));
      end if;
      quarters_r(1) <= word_v;
      if index(5 downto 4) /= 1 then
        quarters_r(1) <= (others => '0');
      end if;
    end if;
  end process quarter_1;

  quarter_2 : process (clk)
    variable word_v : std_logic_vector(31 downto 0);
  begin
    if rising_edge(clk) then
      word_v := (others => '0');
      if index(3 downto 0) = sample_number_word_c(3 downto 0) then
        word_v(31 downto 0) := std_logic_vector(from_core.sequence(31 downto 0));
      elsif index(3 downto 0) = time_low_word_c(3 downto 0) then
        word_v(31 downto 0) := std_logic_vector(from_core.time_us(31 downto 0));
      elsif index(3 downto 0) = time_high_word_c(3 downto 0) then
        word_v(31 downto 0) := std_logic_vector(time_us_r);
      elsif index(3 downto 0) = angle_roll_word_c(3 downto 0) then
        word_v(31 downto 0) := std_logic_vector(from_core.angle_roll);
      elsif index(3 downto 0) = angle_pitch_word_c(3 downto 0) then
        word_v(31 downto 0) := std_logic_vector(from_core.angle_pitch);
      elsif index(3 downto 0) = accel_xy_word_c(3 downto 0) then
        word_v(15 downto 0) := std_logic_vector(from_core.accel_x);
        word_v(31 downto 16) := std_logic_vector(from_core.accel_y);
      elsif index(3 downto 0) = accel_z_temperature_word_c(3 downto 0) then
        word_v(15 downto 0) := std_logic_vector(from_core.accel_z);
        word_v(31 downto 16) := std_logic_vector(from_core.temperature);
      elsif index(3 downto 0) = gyro_xy_word_c(3 downto 0) then
        word_v(15 downto 0) := std_logic_vector(from_core.gyro_x);
        word_v(31 downto 16) := std_logic_vector(from_core.gyro_y);
      elsif index(3 downto 0) = gyro_z_word_c(3 downto 0) then
        word_v(15 downto 0) := std_logic_vector(from_core.gyro_z);
      end if;
      quarters_r(2) <= word_v;
      if index(5 downto 4) /= 2 then
        quarters_r(2) <= (others => '0');
      end if;
    end if;
  end process quarter_2;

  quarter_3 : process (clk)
    variable word_v : std_logic_vector(31 downto 0);
  begin
    if rising_edge(clk) then
      word_v := (others => '0');
      if index(3 downto 0) = bus_counts_word_c(3 downto 0) then
        word_v(15 downto 0) := std_logic_vector(from_core.errors);
        word_v(31 downto 16) := std_logic_vector(from_core.nacks);
      elsif index(3 downto 0) = stuck_counts_word_c(3 downto 0) then
        word_v(15 downto 0) := std_logic_vector(from_core.timeouts);
        word_v(31 downto 16) := std_logic_vector(from_core.stuck_buses);
      elsif index(3 downto 0) = loss_counts_word_c(3 downto 0) then
        word_v(15 downto 0) := std_logic_vector(from_core.restarts);
        word_v(31 downto 16) := std_logic_vector(from_core.lost_samples);
      elsif index(3 downto 0) = link_counts_word_c(3 downto 0) then
        word_v(15 downto 0) := std_logic_vector(from_core.link_lost);
      end if;
      quarters_r(3) <= word_v;
      if index(5 downto 4) /= 3 then
        quarters_r(3) <= (others => '0');
      end if;
    end if;
  end process quarter_3;

  answer : process (clk)
  begin
    if rising_edge(clk) then
      reading_r <= read;
      bad_r     <= read and not known;
      if reading_r = '1' then
        read_data_r <= quarters_r(0) or quarters_r(1) or quarters_r(2) or quarters_r(3);
      end if;
      if read = '1' and index = time_low_word_c then
        time_us_r <= from_core.time_us(63 downto 32);
      end if;

      acknowledge_r <= reading_r or write;
      error_r       <= bad_r or (write and not accepted);
      if rst = '1' then
        reading_r     <= '0';
        bad_r         <= '0';
        acknowledge_r <= '0';
        error_r       <= '0';
      end if;
    end if;
  end process answer;

  setting : process (clk)
    variable word_v : std_logic_vector(31 downto 0);
  begin
    if rising_edge(clk) then
      if committing_r = '1' and from_core.core_busy = '0' then
        kt_used_r <= kt_r;
        kv_used_r <= kv_r;
        kb_used_r <= kb_r;
        gyro_bias_x_used_r <= gyro_bias_x_r;
        gyro_bias_y_used_r <= gyro_bias_y_r;
        gyro_bias_z_used_r <= gyro_bias_z_r;
        committing_r <= '0';
        staged_r     <= '0';
      end if;

      if write = '1' and accepted = '1' then
        if index = kt_word_c then
          word_v := with_written(std_logic_vector(resize(kt_r, 32)),
                                 write_data, write_strobes);
          kt_r <= signed(word_v(31 downto 0));
          staged_r <= '1';
        elsif index = kv_word_c then
          word_v := with_written(std_logic_vector(resize(kv_r, 32)),
                                 write_data, write_strobes);
          kv_r <= signed(word_v(31 downto 0));
          staged_r <= '1';
        elsif index = kb_word_c then
          word_v := with_written(std_logic_vector(resize(kb_r, 32)),
                                 write_data, write_strobes);
          kb_r <= signed(word_v(31 downto 0));
          staged_r <= '1';
        elsif index = gyro_bias_x_word_c then
          word_v := with_written(std_logic_vector(resize(gyro_bias_x_r, 32)),
                                 write_data, write_strobes);
          gyro_bias_x_r <= signed(word_v(31 downto 0));
          staged_r <= '1';
        elsif index = gyro_bias_y_word_c then
          word_v := with_written(std_logic_vector(resize(gyro_bias_y_r, 32)),
                                 write_data, write_strobes);
          gyro_bias_y_r <= signed(word_v(31 downto 0));
          staged_r <= '1';
        elsif index = gyro_bias_z_word_c then
          word_v := with_written(std_logic_vector(resize(gyro_bias_z_r, 32)),
                                 write_data, write_strobes);
          gyro_bias_z_r <= signed(word_v(31 downto 0));
          staged_r <= '1';
        elsif index = control_word_c and write_strobes(0) = '1' then
          committing_r <= committing_r or write_data(2);
        end if;
      end if;

      retuned_r <= '0';
      if kt_used_r /= design_settings_c.kt then
        retuned_r <= '1';
      end if;
      if kv_used_r /= design_settings_c.kv then
        retuned_r <= '1';
      end if;
      if kb_used_r /= design_settings_c.kb then
        retuned_r <= '1';
      end if;
      if gyro_bias_x_used_r /= design_settings_c.gyro_bias_x then
        retuned_r <= '1';
      end if;
      if gyro_bias_y_used_r /= design_settings_c.gyro_bias_y then
        retuned_r <= '1';
      end if;
      if gyro_bias_z_used_r /= design_settings_c.gyro_bias_z then
        retuned_r <= '1';
      end if;

      if restore = '1' then
        staged_r <= '1';
      end if;
      if restore = '1' or rst = '1' then
        kt_r <= design_settings_c.kt;
        kv_r <= design_settings_c.kv;
        kb_r <= design_settings_c.kb;
        gyro_bias_x_r <= design_settings_c.gyro_bias_x;
        gyro_bias_y_r <= design_settings_c.gyro_bias_y;
        gyro_bias_z_r <= design_settings_c.gyro_bias_z;
      end if;
      if rst = '1' then
        kt_used_r <= design_settings_c.kt;
        kv_used_r <= design_settings_c.kv;
        kb_used_r <= design_settings_c.kb;
        gyro_bias_x_used_r <= design_settings_c.gyro_bias_x;
        gyro_bias_y_used_r <= design_settings_c.gyro_bias_y;
        gyro_bias_z_used_r <= design_settings_c.gyro_bias_z;
        staged_r     <= '0';
        committing_r <= '0';
        retuned_r    <= '0';
      end if;
    end if;
  end process setting;

  controlling : process (clk)
  begin
    if rising_edge(clk) then
      clear_r <= '0';
      if write = '1' and index = control_word_c and write_strobes(0) = '1' then
        enable_r <= write_data(0);
        clear_r  <= write_data(1);
      end if;
      if write = '1' and index = interrupts_word_c and write_strobes(0) = '1' then
        new_sample_interrupt_r <= write_data(0);
        restarted_interrupt_r <= write_data(1);
        saturated_interrupt_r <= write_data(2);
        overrun_interrupt_r <= write_data(3);
        bus_error_interrupt_r <= write_data(4);
        uart_overrun_interrupt_r <= write_data(5);
        uart_framing_interrupt_r <= write_data(6);
      end if;

      -- What happens while it is being cleared is kept.
      if from_core.new_sample = '1' then
        new_sample_r <= '1';
      elsif write = '1' and index = events_word_c and write_strobes(0) = '1'
            and write_data(0) = '1' then
        new_sample_r <= '0';
      end if;
      if from_core.restarted = '1' then
        restarted_r <= '1';
      elsif write = '1' and index = events_word_c and write_strobes(0) = '1'
            and write_data(1) = '1' then
        restarted_r <= '0';
      end if;
      if from_core.saturated = '1' then
        saturated_r <= '1';
      elsif write = '1' and index = events_word_c and write_strobes(0) = '1'
            and write_data(2) = '1' then
        saturated_r <= '0';
      end if;
      if from_core.overrun = '1' then
        overrun_r <= '1';
      elsif write = '1' and index = events_word_c and write_strobes(0) = '1'
            and write_data(3) = '1' then
        overrun_r <= '0';
      end if;
      if from_core.bus_error = '1' then
        bus_error_r <= '1';
      elsif write = '1' and index = events_word_c and write_strobes(0) = '1'
            and write_data(4) = '1' then
        bus_error_r <= '0';
      end if;
      if from_core.uart_overrun = '1' then
        uart_overrun_r <= '1';
      elsif write = '1' and index = events_word_c and write_strobes(0) = '1'
            and write_data(5) = '1' then
        uart_overrun_r <= '0';
      end if;
      if from_core.uart_framing = '1' then
        uart_framing_r <= '1';
      elsif write = '1' and index = events_word_c and write_strobes(0) = '1'
            and write_data(6) = '1' then
        uart_framing_r <= '0';
      end if;

      interrupt_r <= '0';
      if new_sample_r = '1' and new_sample_interrupt_r = '1' then
        interrupt_r <= '1';
      end if;
      if restarted_r = '1' and restarted_interrupt_r = '1' then
        interrupt_r <= '1';
      end if;
      if saturated_r = '1' and saturated_interrupt_r = '1' then
        interrupt_r <= '1';
      end if;
      if overrun_r = '1' and overrun_interrupt_r = '1' then
        interrupt_r <= '1';
      end if;
      if bus_error_r = '1' and bus_error_interrupt_r = '1' then
        interrupt_r <= '1';
      end if;
      if uart_overrun_r = '1' and uart_overrun_interrupt_r = '1' then
        interrupt_r <= '1';
      end if;
      if uart_framing_r = '1' and uart_framing_interrupt_r = '1' then
        interrupt_r <= '1';
      end if;

      if rst = '1' then
        enable_r    <= '1';
        clear_r     <= '0';
        interrupt_r <= '0';
        new_sample_r           <= '0';
        new_sample_interrupt_r <= '0';
        restarted_r           <= '0';
        restarted_interrupt_r <= '0';
        saturated_r           <= '0';
        saturated_interrupt_r <= '0';
        overrun_r           <= '0';
        overrun_interrupt_r <= '0';
        bus_error_r           <= '0';
        bus_error_interrupt_r <= '0';
        uart_overrun_r           <= '0';
        uart_overrun_interrupt_r <= '0';
        uart_framing_r           <= '0';
        uart_framing_interrupt_r <= '0';
      end if;
    end if;
  end process controlling;

end architecture rtl;
