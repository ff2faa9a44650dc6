-- made by hostkit 0.1.0 from design 0099cab74159; do not edit; template link/hk_mavlink_tx.vhd.j2
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

  -- Places of the bytes of a frame: the payload from 1, the trailer, the header. Counting on leads
  -- from measuring the payload to the header, and from there to the payload again.
  constant payload_at_c  : natural := 1;
  constant payload_end_c : natural := 2 ** place_bits_c - 13;
  constant extra_at_c    : natural := payload_end_c + 1;  -- goes into the checksum only
  constant end_at_c      : natural := payload_end_c + 3;  -- second byte of the checksum
  constant magic_at_c    : natural := payload_end_c + 4;
  constant length_at_c   : natural := payload_end_c + 5;
  constant sequence_at_c : natural := payload_end_c + 8;
  constant system_at_c   : natural := payload_end_c + 9;
  constant sender_at_c   : natural := payload_end_c + 10;
  constant id_0_at_c     : natural := payload_end_c + 11;
  constant id_1_at_c     : natural := payload_end_c + 12;
  constant id_2_at_c     : natural := 0;

  subtype place_t is unsigned(place_bits_c - 1 downto 0);

  -- A byte that is the same in every frame of its kind; those that are not named are zero.
  function fixed (is_heartbeat : std_logic; place : place_t) return hk_byte_t is
    variable byte_v : hk_byte_t;
  begin
    byte_v := x"00";
    if place = magic_at_c then
      byte_v := magic_c;
    elsif place = system_at_c then
      byte_v := system_id_c;
    elsif place = sender_at_c then
      byte_v := component_id_c;
    elsif is_heartbeat = '0' then
      if place = id_0_at_c then
        byte_v := sample_id_0_c;
      elsif place = id_1_at_c then
        byte_v := sample_id_1_c;
      elsif place = id_2_at_c then
        byte_v := sample_id_2_c;
      elsif place = extra_at_c then
        byte_v := sample_crc_extra_c;
      end if;
    elsif place = id_0_at_c then
      byte_v := heartbeat_id_0_c;
    elsif place = id_1_at_c then
      byte_v := heartbeat_id_1_c;
    elsif place = id_2_at_c then
      byte_v := heartbeat_id_2_c;
    elsif place = extra_at_c then
      byte_v := heartbeat_crc_extra_c;
    elsif place = payload_at_c + heartbeat_type_at_c then
      byte_v := vehicle_type_c;
    elsif place = payload_at_c + heartbeat_autopilot_at_c then
      byte_v := autopilot_c;
    elsif place = payload_at_c + heartbeat_mavlink_version_at_c then
      byte_v := mavlink_version_c;
    end if;
    return byte_v;
  end function fixed;

  function bit_of (byte : hk_byte_t; number : unsigned(2 downto 0)) return std_logic is
    variable left_v : hk_byte_t;
  begin
    left_v := byte;
    if number(2) = '1' then
      left_v(3 downto 0) := left_v(7 downto 4);
    end if;
    if number(1) = '1' then
      left_v(1 downto 0) := left_v(3 downto 2);
    end if;
    if number(0) = '1' then
      left_v(0) := left_v(1);
    end if;
    return left_v(0);
  end function bit_of;

  -- A sample's payload in the order of the wire, lowest bit first.
  constant bits_c : positive := 8 * sample_bytes_c;
  constant half_c : positive := bits_c / 2;
  signal payload  : std_logic_vector(bits_c - 1 downto 0);
  signal flags    : hk_byte_t;

  -- It is sent from a shift register of half its length, in which a table of four inputs before
  -- each flip-flop both shifts and loads: of the two halves it loads the one that the bit shifted
  -- in says, and all of those are fill.
  signal chain_r : std_logic_vector(half_c - 1 downto 0);
  signal fill_r  : std_logic;
  signal load_r  : std_logic;

  type state_t is (idle, shifting, offering, finished);
  signal state_r : state_t;

  signal is_heartbeat_r : std_logic;
  signal is_measured_r  : std_logic;  -- before, the payload goes by only to find its length
  signal is_closing_r   : std_logic;  -- the checksum itself is being sent
  signal place_r        : place_t;
  signal bit_r          : unsigned(2 downto 0);
  signal length_r       : place_t;
  signal sequence_r     : std_logic_vector(7 downto 0);
  signal carry_r        : std_logic;
  signal varying        : hk_byte_t;
  signal next_bit       : std_logic;
  signal byte_r         : hk_byte_t;
  signal crc_r          : std_logic_vector(15 downto 0);

begin

  assert sample_bytes_c <= payload_end_c and heartbeat_bytes_c <= payload_end_c
    report "hk_mavlink_tx: a payload is too long"
    severity failure;

  sample_ready    <= '1' when state_r = finished and is_heartbeat_r = '0' else '0';
  heartbeat_ready <= '1' when state_r = finished and is_heartbeat_r = '1' else '0';
  byte_valid      <= '1' when state_r = offering else '0';
  byte_data       <= byte_r;

  payload(8 * sample_time_usec_at_c + 63 downto 8 * sample_time_usec_at_c) <=
    std_logic_vector(time_us);
  payload(8 * sample_sequence_at_c + 31 downto 8 * sample_sequence_at_c) <=
    std_logic_vector(sequence);
  payload(8 * sample_roll_at_c + 31 downto 8 * sample_roll_at_c) <= std_logic_vector(angle_roll);
  payload(8 * sample_pitch_at_c + 31 downto 8 * sample_pitch_at_c) <=
    std_logic_vector(angle_pitch);
  payload(8 * sample_accel_at_c + 47 downto 8 * sample_accel_at_c) <=
    std_logic_vector(accel_z) & std_logic_vector(accel_y) & std_logic_vector(accel_x);
  payload(8 * sample_gyro_at_c + 47 downto 8 * sample_gyro_at_c) <=
    std_logic_vector(gyro_z) & std_logic_vector(gyro_y) & std_logic_vector(gyro_x);
  payload(8 * sample_temperature_at_c + 15 downto 8 * sample_temperature_at_c) <=
    std_logic_vector(temperature);
  payload(8 * sample_i2c_errors_at_c + 15 downto 8 * sample_i2c_errors_at_c) <=
    std_logic_vector(i2c_errors);
  digest : for i in 0 to 5 generate
    payload(8 * (sample_digest_at_c + i) + 7 downto 8 * (sample_digest_at_c + i)) <=
      design_digest_c(47 - 8 * i downto 40 - 8 * i);
  end generate digest;
  payload(8 * sample_flags_at_c + 7 downto 8 * sample_flags_at_c) <= flags;
  payload(8 * sample_hidden_at_c + 32 * 0 + 31 downto 8 * sample_hidden_at_c + 32 * 0) <=
    std_logic_vector(bias_roll);
  payload(8 * sample_hidden_at_c + 32 * 1 + 31 downto 8 * sample_hidden_at_c + 32 * 1) <=
    std_logic_vector(bias_pitch);

  process (restarted, saturated, retuned)
  begin
    flags                   <= (others => '0');
    flags(flag_restarted_c) <= restarted;
    flags(flag_saturated_c) <= saturated;
    flags(flag_retuned_c)   <= retuned;
  end process;

  process (clk)
  begin
    if rising_edge(clk) then
      -- One half is loaded in front of the payload, the other with the last bit of the first; this
      -- is known a bit before, which is of the same byte because half_c is a multiple of four.
      load_r <= '0';
      if state_r = shifting and (
        (place_r = payload_at_c - 1 and bit_r = 6) or
        (place_r = payload_at_c + (half_c - 1) / 8 and bit_r = (half_c - 1) mod 8 - 1)
      ) then
        load_r <= '1';
      end if;
      if state_r = shifting then
        for i in 0 to half_c - 2 loop
          chain_r(i) <= chain_r(i + 1);
          if load_r = '1' then
            if chain_r(i + 1) = '0' then
              chain_r(i) <= payload(i);
            else
              chain_r(i) <= payload(half_c + i);
            end if;
          end if;
        end loop;
        chain_r(half_c - 1) <= fill_r;
        if load_r = '1' then
          fill_r <= not fill_r;
          if fill_r = '0' then
            chain_r(half_c - 1) <= payload(half_c - 1);
          else
            chain_r(half_c - 1) <= payload(bits_c - 1);
          end if;
        end if;
      end if;
      if state_r = idle or is_heartbeat_r = '1' or place_r = extra_at_c then
        chain_r <= (others => '0');
        fill_r  <= '0';
      end if;
    end if;
  end process;

  process (is_heartbeat_r, place_r, length_r, system_status)
  begin
    varying <= fixed(is_heartbeat_r, place_r);
    if place_r = length_at_c then
      varying <= std_logic_vector(resize(length_r, 8));
    elsif is_heartbeat_r = '1' and place_r = payload_at_c + heartbeat_system_status_at_c then
      varying <= std_logic_vector(system_status);
    end if;
  end process;

  process (is_closing_r, crc_r, place_r, sequence_r, chain_r, varying, bit_r)
  begin
    next_bit <= chain_r(0) or bit_of(varying, bit_r);
    if is_closing_r = '1' then
      next_bit <= crc_r(0);
    elsif place_r = sequence_at_c then
      next_bit <= sequence_r(0);
    end if;
  end process;

  process (clk)
    variable feedback_v : std_logic;
  begin
    if rising_edge(clk) then
      if state_r = idle then
        -- By turns if both are waiting, so that neither starves.
        is_measured_r <= '0';
        is_closing_r  <= '0';
        place_r       <= to_unsigned(payload_at_c - 1, place_bits_c);
        bit_r         <= to_unsigned(6, 3);
        length_r      <= to_unsigned(1, place_bits_c);
        if heartbeat_valid = '1' and (is_heartbeat_r = '0' or sample_valid = '0') then
          is_heartbeat_r <= '1';
          state_r        <= shifting;
        elsif sample_valid = '1' then
          is_heartbeat_r <= '0';
          state_r        <= shifting;
        end if;

      elsif state_r = shifting then
        byte_r <= next_bit & byte_r(7 downto 1);
        bit_r  <= bit_r + 1;

        -- CRC-16/MCRF4XX; at the end it comes out the way it was made.
        feedback_v := (crc_r(0) xor next_bit) and not is_closing_r;
        crc_r      <= feedback_v & crc_r(15 downto 1);
        crc_r(10)  <= crc_r(11) xor feedback_v;
        crc_r(3)   <= crc_r(4) xor feedback_v;
        if place_r = magic_at_c then
          crc_r <= (others => '1');  -- it begins with the byte behind
        end if;

        -- One is added to the sequence number while it goes by.
        carry_r <= '1';
        if place_r = sequence_at_c then
          sequence_r <= (sequence_r(0) xor carry_r) & sequence_r(7 downto 1);
          carry_r    <= sequence_r(0) and carry_r;
        end if;

        if is_measured_r = '0' and next_bit = '1' and place_r <= payload_end_c then
          length_r <= place_r;
        end if;
        if bit_r = 7 then
          if is_measured_r = '0' then
            place_r <= place_r + 1;
            if place_r = end_at_c then
              is_measured_r <= '1';
            end if;
          elsif place_r = extra_at_c then
            place_r      <= place_r + 1;
            is_closing_r <= '1';
          else
            state_r <= offering;
          end if;
        end if;

      elsif state_r = offering then
        if byte_ready = '1' then
          place_r <= place_r + 1;
          state_r <= shifting;
          if place_r = length_r then
            place_r <= to_unsigned(extra_at_c, place_bits_c);
          elsif place_r = end_at_c then
            state_r <= finished;
          end if;
        end if;

      else
        state_r <= idle;
      end if;

      if rst = '1' then
        state_r        <= idle;
        is_heartbeat_r <= '0';
        sequence_r     <= (others => '0');
      end if;
    end if;
  end process;

end architecture rtl;
