-- MAVLink 2 frames of samples and heartbeats, byte by byte. A frame is made of the inputs as they
-- stand, so they must hold until ready says that they are sent.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.hk_design_pkg.all;
use work.hk_mavlink_pkg.all;

entity hk_mavlink_tx is
  port (
    clk             : in  std_logic;
    rst             : in  std_logic;  -- synchronous, active high
    sample_valid    : in  std_logic;
    sample_ready    : out std_logic;
    time_us         : in  unsigned(63 downto 0);
    sequence        : in  unsigned(31 downto 0);
    angle_roll      : in  signed(31 downto 0);
    angle_pitch     : in  signed(31 downto 0);
    bias_roll       : in  signed(31 downto 0);
    bias_pitch      : in  signed(31 downto 0);
    accel_x         : in  signed(15 downto 0);
    accel_y         : in  signed(15 downto 0);
    accel_z         : in  signed(15 downto 0);
    temperature     : in  signed(15 downto 0);
    gyro_x          : in  signed(15 downto 0);
    gyro_y          : in  signed(15 downto 0);
    gyro_z          : in  signed(15 downto 0);
    i2c_errors      : in  unsigned(15 downto 0);
    restarted       : in  std_logic;
    saturated       : in  std_logic;
    retuned         : in  std_logic;
    heartbeat_valid : in  std_logic;
    heartbeat_ready : out std_logic;
    system_status   : in  unsigned(7 downto 0);  -- MAV_STATE
    byte_valid      : out std_logic;
    byte_ready      : in  std_logic;
    byte_data       : out std_logic_vector(7 downto 0)
  );
end entity hk_mavlink_tx;

architecture rtl of hk_mavlink_tx is

  -- Addresses of the bytes of a frame: payload, trailer, header. Counting on leads from measuring
  -- the payload to the header, and from there to the payload again.
  constant payload_end_c : natural := 51;
  constant extra_at_c    : natural := 51;  -- goes into the checksum only
  constant crc_at_c      : natural := 52;
  constant end_at_c      : natural := 53;
  constant magic_at_c    : natural := 54;
  constant length_at_c   : natural := 55;
  constant sequence_at_c : natural := 58;
  constant sender_at_c   : natural := 59;
  constant id_at_c       : natural := 61;

  constant bytes_c : positive := 64;

  -- One message after the other; no address leaves it.
  type bytes_t is array (0 to 2 * bytes_c - 1) of hk_byte_t;

  signal bytes  : bytes_t;
  signal count  : unsigned(7 downto 0);
  signal flags  : std_logic_vector(7 downto 0);
  signal hidden : std_logic_vector(63 downto 0);

  type state_t is (idle, loading, measuring, summing, offering, finished);
  signal state_r : state_t;

  signal is_heartbeat_r : std_logic;
  signal is_measured_r  : std_logic;
  signal is_closing_r   : std_logic;  -- the checksum itself is being sent
  signal address_r      : unsigned(5 downto 0);
  signal last_r         : unsigned(5 downto 0);  -- the last byte of the payload that is not zero
  signal sequence_r     : unsigned(7 downto 0);
  signal byte_r         : hk_byte_t;
  signal bit_r          : unsigned(2 downto 0);
  signal crc_r          : std_logic_vector(15 downto 0);

begin

  assert sample_bytes_c <= payload_end_c and heartbeat_bytes_c <= payload_end_c
    report "hk_mavlink_tx: a payload is too long"
    severity failure;

  sample_ready    <= '1' when state_r = finished and is_heartbeat_r = '0' else '0';
  heartbeat_ready <= '1' when state_r = finished and is_heartbeat_r = '1' else '0';
  byte_valid      <= '1' when state_r = offering else '0';
  byte_data       <= byte_r;

  count <= resize(last_r, 8) + 1;

  process (restarted, saturated, retuned)
  begin
    flags                   <= (others => '0');
    flags(flag_restarted_c) <= restarted;
    flags(flag_saturated_c) <= saturated;
    flags(flag_retuned_c)   <= retuned;
  end process;

  process (bias_roll, bias_pitch)
    variable hidden_v : std_logic_vector(63 downto 0);
  begin
    hidden_v := (others => '0');
    if hides_bias_roll_c then
      hidden_v(32 * bias_roll_word_c + 31 downto 32 * bias_roll_word_c) :=
        std_logic_vector(bias_roll);
    end if;
    if hides_bias_pitch_c then
      hidden_v(32 * bias_pitch_word_c + 31 downto 32 * bias_pitch_word_c) :=
        std_logic_vector(bias_pitch);
    end if;
    hidden <= hidden_v;
  end process;

  process (
    time_us, sequence, angle_roll, angle_pitch, accel_x, accel_y, accel_z, temperature, gyro_x,
    gyro_y, gyro_z, i2c_errors, flags, hidden, system_status, count, sequence_r
  )
    variable bytes_v : bytes_t;
  begin
    bytes_v := (others => x"00");
    for i in 0 to 7 loop
      bytes_v(sample_time_usec_at_c + i) := std_logic_vector(time_us(8 * i + 7 downto 8 * i));
    end loop;
    for i in 0 to 3 loop
      bytes_v(sample_sequence_at_c + i) := std_logic_vector(sequence(8 * i + 7 downto 8 * i));
      bytes_v(sample_roll_at_c + i) := std_logic_vector(angle_roll(8 * i + 7 downto 8 * i));
      bytes_v(sample_pitch_at_c + i) := std_logic_vector(angle_pitch(8 * i + 7 downto 8 * i));
    end loop;
    for i in 0 to 1 loop
      bytes_v(sample_accel_at_c + i) := std_logic_vector(accel_x(8 * i + 7 downto 8 * i));
      bytes_v(sample_accel_at_c + 2 + i) := std_logic_vector(accel_y(8 * i + 7 downto 8 * i));
      bytes_v(sample_accel_at_c + 4 + i) := std_logic_vector(accel_z(8 * i + 7 downto 8 * i));
      bytes_v(sample_gyro_at_c + i) := std_logic_vector(gyro_x(8 * i + 7 downto 8 * i));
      bytes_v(sample_gyro_at_c + 2 + i) := std_logic_vector(gyro_y(8 * i + 7 downto 8 * i));
      bytes_v(sample_gyro_at_c + 4 + i) := std_logic_vector(gyro_z(8 * i + 7 downto 8 * i));
      bytes_v(sample_temperature_at_c + i) :=
        std_logic_vector(temperature(8 * i + 7 downto 8 * i));
      bytes_v(sample_i2c_errors_at_c + i) :=
        std_logic_vector(i2c_errors(8 * i + 7 downto 8 * i));
    end loop;
    for i in 0 to 5 loop
      bytes_v(sample_digest_at_c + i) := design_digest_c(47 - 8 * i downto 40 - 8 * i);
    end loop;
    bytes_v(sample_flags_at_c) := flags;
    for i in 0 to sample_bytes_c - 1 - sample_hidden_at_c loop
      bytes_v(sample_hidden_at_c + i) := hidden(8 * i + 7 downto 8 * i);
    end loop;
    bytes_v(extra_at_c)  := sample_crc_extra_c;
    bytes_v(id_at_c)     := sample_id_0_c;
    bytes_v(id_at_c + 1) := sample_id_1_c;
    bytes_v(id_at_c + 2) := sample_id_2_c;

    -- The fields of a heartbeat that are not named here are zero.
    bytes_v(bytes_c + heartbeat_type_at_c)            := vehicle_type_c;
    bytes_v(bytes_c + heartbeat_autopilot_at_c)       := autopilot_c;
    bytes_v(bytes_c + heartbeat_system_status_at_c)   := std_logic_vector(system_status);
    bytes_v(bytes_c + heartbeat_mavlink_version_at_c) := mavlink_version_c;
    bytes_v(bytes_c + extra_at_c)                     := heartbeat_crc_extra_c;
    bytes_v(bytes_c + id_at_c)                        := heartbeat_id_0_c;
    bytes_v(bytes_c + id_at_c + 1)                    := heartbeat_id_1_c;
    bytes_v(bytes_c + id_at_c + 2)                    := heartbeat_id_2_c;

    for message in 0 to 1 loop
      bytes_v(bytes_c * message + magic_at_c)      := magic_c;
      bytes_v(bytes_c * message + length_at_c)     := std_logic_vector(count);
      bytes_v(bytes_c * message + sequence_at_c)   := std_logic_vector(sequence_r);
      bytes_v(bytes_c * message + sender_at_c)     := system_id_c;
      bytes_v(bytes_c * message + sender_at_c + 1) := component_id_c;
    end loop;
    bytes <= bytes_v;
  end process;

  process (clk)
    variable feedback_v : std_logic;
    variable next_v     : std_logic;
  begin
    if rising_edge(clk) then
      if state_r = idle then
        -- By turns if both are waiting, so that neither starves.
        is_measured_r <= '0';
        address_r     <= (others => '0');
        last_r        <= (others => '0');
        if heartbeat_valid = '1' and (is_heartbeat_r = '0' or sample_valid = '0') then
          is_heartbeat_r <= '1';
          state_r        <= loading;
        elsif sample_valid = '1' then
          is_heartbeat_r <= '0';
          state_r        <= loading;
        end if;

      elsif state_r = loading then
        byte_r <= bytes(to_integer(is_heartbeat_r & address_r));
        if is_measured_r = '0' then
          state_r <= measuring;
        else
          state_r <= summing;
        end if;

      elsif state_r = measuring then
        if address_r = end_at_c then
          is_measured_r <= '1';
        end if;
        if unsigned(byte_r) /= 0 and address_r < payload_end_c then
          last_r <= address_r;
        end if;
        address_r <= address_r + 1;
        state_r   <= loading;

      elsif state_r = summing then
        -- CRC-16/MCRF4XX, a bit a clock, while the byte goes round; the checksum comes out the
        -- same way.
        feedback_v := (crc_r(0) xor byte_r(0)) and not is_closing_r;
        next_v     := byte_r(0);
        if is_closing_r = '1' then
          next_v := crc_r(0);
        end if;
        byte_r    <= next_v & byte_r(7 downto 1);
        crc_r     <= '0' & crc_r(15 downto 1);
        crc_r(15) <= feedback_v;
        crc_r(10) <= crc_r(11) xor feedback_v;
        crc_r(3)  <= crc_r(4) xor feedback_v;
        bit_r     <= bit_r + 1;
        if bit_r = 7 then
          state_r <= offering;
          if address_r = extra_at_c then
            -- Nobody sees this byte; the checksum is next.
            is_closing_r <= '1';
            address_r    <= address_r + 1;
            state_r      <= summing;
          end if;
        end if;

      elsif state_r = offering then
        if byte_ready = '1' then
          address_r <= address_r + 1;
          state_r   <= loading;
          if is_closing_r = '1' then
            state_r <= summing;
            if address_r = end_at_c then
              state_r <= finished;
            end if;
          elsif address_r = last_r then
            address_r <= to_unsigned(extra_at_c, 6);
          end if;
        end if;

      else
        is_closing_r <= '0';
        sequence_r   <= sequence_r + 1;
        state_r      <= idle;
      end if;

      if address_r = magic_at_c then
        crc_r <= (others => '1');  -- the checksum begins with the byte behind it
      end if;

      if rst = '1' then
        state_r        <= idle;
        is_heartbeat_r <= '0';
        is_closing_r   <= '0';
        sequence_r     <= (others => '0');
        bit_r          <= (others => '0');
      end if;
    end if;
  end process;

end architecture rtl;
