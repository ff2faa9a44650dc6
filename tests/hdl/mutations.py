"""Deliberate faults of the RTL: each must be caught by the check that it names."""

from mutation import table
from mutations_blocks import LINK, PIPELINES, REGISTERS, SENSOR, SYSTEM

CORE = "hk_complementary_iterative.vhd"
ARCTAN = "hk_arctan.vhd"

MUTATIONS = (
    *table(
        "plain",
        CORE,
        (
            "rates swapped",
            "rate_roll_r  <= body_count(body_x_c",
            "rate_roll_r  <= body_count(body_y_c",
        ),
        ("pitch upside down", "force_back <= -body_count", "force_back <= body_count"),
        (
            "blend of the gain",
            "coefficient_r <= settings.blend;\n            if",
            "coefficient_r <= settings.rate_gain_roll;\n            if",
        ),
        (
            "carry lost",
            "carry_v       := product(blend_fraction_bits_c - 1)",
            "carry_v       := '0'",
        ),
        ("first sample steps", "restarted_r <= not stored_started", "restarted_r <= '0'"),
        ("always first", "started_r <= '1'", "started_r <= '0'"),
        (
            "never ready",
            "in_ready    <= '1' when state_r = idle",
            "in_ready    <= '1' when state_r = clearing",
        ),
        ("greedy", "in_ready    <= '1' when state_r = idle else '0'", "in_ready    <= '1'"),
        ("takes back", "if out_ready = '1' then", "if true then"),
        ("half range", "saturated_r <= '1'", "saturated_r <= '0'"),
        (
            "roll only",
            "if has_both_c and axis_r = roll then",
            "if has_both_c and axis_r = pitch then",
        ),
        (
            "digest",
            "design_digest(23 downto 0)  <= design_digest_c(23 downto 0)",
            "design_digest(23 downto 0)  <= design_digest_c(47 downto 24)",
        ),
    ),
    *table(
        "plain",
        "hk_common_pkg.vhd",
        ("size of -1", "size_v := -count;", "size_v := not count;"),
        ("sum without carry", "(b & carry)", "(b & '0')"),
    ),
    *table(
        "plain",
        "hk_common_pkg.vhd",
        (
            "-32767 is inside",
            "unsigned(count(14 downto 1)) = 0",
            "unsigned(count(14 downto 0)) = 0",
        ),
    ),
    *table(
        "plain",
        "hk_multiplier.vhd",
        ("stale product", "if enable = '1' then", "if enable = '0' then"),
    ),
    *table(
        "measured",
        ARCTAN,
        ("no zero rule", "nothing_r <= '1'", "nothing_r <= '0'"),
        (
            "sort by the wrong side",
            "if digit_v = '1' then\n          along_r",
            "if digit_v = '0' then\n          along_r",
        ),
        ("behind is ahead", "(steep_r and below_r)", "(steep_r and behind_r)"),
        (
            "a digit less",
            "          if count_r(turn_digits_c - 1) = '1' then",
            "          if count_r(turn_digits_c - 2) = '1' then",
        ),
        ("octant not negated", "octant_r xor negate_v, negate_r", "octant_r xor negate_v, '0'"),
        ("length not corrected", 'along_r + (unsigned(product(30 downto 16)) & "000")', "along_r"),
        ("second angle of the first length", "behind_r    <= '0';", "behind_r    <= x_negative;"),
    ),
    *table(
        "measured",
        "hk_design_pkg.vhd",
        ("slope", "to_signed(41719, 18)", "to_signed(41718, 18)"),
        ("an angle", " 531488619", " 531488618"),
        ("a stretch", " 105699", " 105698"),
    ),
    *table(
        "options",
        CORE,
        (
            "gate without its upper bound",
            "square_r <= settings.gate_highest",
            "square_r < settings.gate_highest",
        ),
        (
            "gate without its lower bound",
            "square_r >= settings.gate_lowest",
            "square_r > settings.gate_lowest",
        ),
        ("bias of the other axis", "bias_now_r  <= bias_next_r;", "bias_now_r  <= bias_now_r;"),
        (
            "bias starts at zero",
            "bias_now_r  <= settings.gyro_bias_roll;",
            "bias_now_r  <= (others => '0');",
        ),
        ("learns while restarting", "if restarted_r = '1' then", "if false then"),
    ),
    *table(
        "functions",
        "hk_complementary_pkg.vhd",
        ("bias unlimited above", "return bias_limit_c", "return bias"),
        ("bias unlimited below", "return -bias_limit_c", "return bias"),
    ),
    *table(
        "arcsin",
        "hk_root.vhd",
        ("root not floored", "if rest_v >= trial_v then", "if rest_v > trial_v then"),
        ("root a bit short", "if bits_v = 0 then", "if bits_v = 1 then"),
    ),
    *table(
        "arcsin", "hk_complementary_pkg.vhd", ("no clamp", "count > gravity_count_c or", "false or")
    ),
    *table(
        "channels",
        CORE,
        ("channel lost", "channel_r    <= in_channel", "channel_r    <= (others => '0')"),
        (
            "memory not cleared",
            "word(0)             <= '1' when state_r = finished else '0'",
            "word(0)             <= '1'",
        ),
        (
            "read too late",
            "address <= in_channel when state_r = idle else channel_r",
            "address <= channel_r",
        ),
        ("never written", "write   <= '1' when state_r = finished or", "write   <= '1' when"),
        (
            "sweep stops early",
            "if channel_r = 2 ** channel_bits_c - 1 then",
            "if channel_r = 2 then",
        ),
    ),
    *table(
        "handshake",
        CORE,
        (
            "result moves while it waits",
            "sum_v := hk_sum(angle_now_r, addend_v, carry_v);",
            "sum_v := hk_sum(angle_now_r, addend_v, carry_v);\n"
            "if state_r = finished and in_valid = '1' then restarted_r <= '1'; end if;",
        ),
        (
            "valid falls without ready",
            "out_valid   <= '1' when state_r = finished else '0'",
            "out_valid   <= out_ready when state_r = finished else '0'",
        ),
    ),
    *table(
        "uart",
        "hk_uart_tx.vhd",
        ("no start bit", "bits_r <= '1' & in_data & '0'", "bits_r <= '1' & in_data & '1'"),
        ("highest bit first", "tx_r   <= bits_r(0);", "tx_r   <= bits_r(1);"),
    ),
    *table(
        "uart",
        "hk_uart_rx.vhd",
        ("no vote", "vote   <= (recent_r(1) and", "vote   <= level or (recent_r(1) and"),
        (
            "break goes on",
            "elsif state_r = waiting and level = '1' then",
            "elsif state_r = waiting then",
        ),
        ("byte overwritten", "elsif valid_r = '1' and out_ready = '0' then", "elsif false then"),
    ),
    *table(
        "mavlink",
        "hk_mavlink_tx.vhd",
        ("checksum", "crc_r(10)  <= crc_r(11) xor feedback_v", "crc_r(10)  <= crc_r(11)"),
        ("zeros sent", "if is_measured_r = '0' and next_bit = '1'", "if is_measured_r = '0'"),
        ("sequence stands", "(sequence_r(0) xor carry_r)", "sequence_r(0)"),
        (
            "heartbeat starves",
            "(is_heartbeat_r = '0' or sample_valid = '0')",
            "(sample_valid = '0')",
        ),
    ),
    *table(
        "stopwatch",
        "hk_ticks.vhd",
        ("time drifts", "phase_r <= phase_r + step_c", "phase_r <= phase_r + step_c + 1"),
    ),
    *SENSOR,
    *LINK,
    *REGISTERS,
    *PIPELINES,
    *SYSTEM,
)
