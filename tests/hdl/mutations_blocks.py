"""Deliberate faults of the blocks around the filter: sensor, link, registers, polar core, whole."""

from mutation import table

SENSOR = (
    *table(
        "sensor",
        "hk_i2c_master.vhd",
        (
            "acknowledge ignored",
            "nack             <= byte_r(0) when",
            "nack             <= '0' when",
        ),
        (
            "stretch not waited for",
            "if scl_r = '1' then\n          timer_r <= high_c",
            "if true then\n          timer_r <= high_c",
        ),
        (
            "no stop",
            "sda_low_r <= '0';\n            state_r   <= marking",
            "sda_low_r <= '1';\n            state_r   <= marking",
        ),
        ("every byte acknowledged", '"11111111" & command(0)', '"111111110"'),
    ),
    *table(
        "sensor",
        "hk_mpu6050.vhd",
        (
            "registers not compared",
            "if compares = '1' and read_data /= step(7 downto 0) then",
            "if false then",
        ),
        (
            "torn burst passed on",
            "elsif ones_r = '1' and (mismatch_r = '1' or operation = sample_c) then",
            "elsif false then",
        ),
        ("sample passed on twice", "fresh_r <= fresh_r or read_data(0)", "fresh_r <= '1'"),
        ("a lost sample has no number", "number_r      <= '1'", "number_r      <= fill_r"),
        (
            "time of the transfer",
            "stamp_v  := announced_r = '0'",
            "stamp_v  := true",
        ),
    ),
    *table(
        "bus master",
        "hk_i2c_master.vhd",
        ("reply not waited for", "if reply_ready = '1' then", "if true then"),
        (
            "SCL waited for without end",
            "if patience_r(patience_bits_c) = '1' then",
            "if false then",
        ),
        (
            "lines kept after an error",
            "if late_r = '1' or lost_r = '1' then",
            "if late_r = '1' then",
        ),
    ),
)

LINK = table(
    "transmitter",
    "hk_uart_tx.vhd",
    (
        "a bit less",
        "unsigned(bits_r(9 downto 1)) = 0",
        "unsigned(bits_r(9 downto 2)) = 0",
    ),
)

REGISTERS = (
    *table(
        "registers",
        "hk_regs.vhd",
        (
            "event lost while cleared",
            "if from_core.saturated = '1' then",
            "if from_core.saturated = '1' and write = '0' then",
        ),
        (
            "commit while busy",
            "if committing_r = '1' and from_core.core_busy = '0' then",
            "if committing_r = '1' then",
        ),
        ("strobes ignored", "if strobes(i) = '1' then", "if true then"),
        (
            "byte popped twice",
            "when read = '1' and index = uart_rx_word_c",
            "when (read = '1' or reading_r = '1') and index = uart_rx_word_c",
        ),
        (
            "refused write told as good",
            "bad_r or (write and not accepted)",
            "bad_r",
        ),
    ),
    *table(
        "axi4lite",
        "hk_axi4lite.vhd",
        ("refusal answered OKAY", "s_axi_bresp   <= write_bad_r & '0'", 's_axi_bresp   <= "00"'),
        ("response not held", "if written_r = '1' and s_axi_bready = '1'", "if written_r = '1'"),
        ("written twice", "has_write_data_r and not written_r", "has_write_data_r"),
        ("read twice", "has_read_address_r and not have_read_r", "has_read_address_r"),
        (
            "write and read at once",
            "to_write <= can_write and not can_read",
            "to_write <= can_write",
        ),
    ),
    *table(
        "wishbone",
        "hk_wishbone.vhd",
        ("cycle given up is answered", "acknowledge and not gone_r", "acknowledge"),
        (
            "asked twice",
            "read          <= asked and not wb_we and not waiting_r",
            "read          <= asked and not wb_we",
        ),
    ),
)

PIPELINES = (
    *table(
        "queue",
        "hk_result_queue.vhd",
        ("one more than it holds", "words_c - 3", "words_c - 1"),
        (
            "result goes on while it waits",
            "(out_valid_r = '0' or out_ready = '1')",
            "(out_valid_r = '0' or count_r = 3 or out_ready = '1')",
        ),
    ),
    *table(
        "polar",
        "hk_polar_pipelined.vhd",
        (
            "arc sine of more than 1",
            "if arcsine_r(2) = '1' and y_size_2_r > x_size_2_r then",
            "if false then",
        ),
        (
            "stretch of another turn",
            "shrinks_c(to_integer(unsigned(late_turn)))",
            "shrinks_c(to_integer(turn))",
        ),
    ),
    *table(
        "pipelined",
        "hk_pipelined_pkg.vhd",
        ("interlock a clock short", "return loop_clocks + 1", "return loop_clocks"),
    ),
    *table(
        "pipelined",
        "hk_complementary_entry.vhd",
        (
            "channel of the next sample",
            "first_channel_r <= second_channel_r;",
            "first_channel_r <= in_channel;",
        ),
        (
            "second place loses",
            "second_valid_r   <= in_valid and ready",
            "second_valid_r   <= '0'",
        ),
    ),
)

SYSTEM = table(
    "system",
    "hk_system.vhd",
    ("heartbeat too slow", "15625 / TIME_DIVISOR", "16625 / TIME_DIVISOR"),
    (
        "sample overwritten while it is sent",
        "if kept_r = '0' and sensor_valid = '1' then",
        "if sensor_valid = '1' then",
    ),
    (
        "flags swapped",
        "restarted       => restarted,\n      saturated       => saturated,",
        "restarted       => saturated,\n      saturated       => restarted,",
    ),
)
