"""The FIFO of the virtual sensor, statement by statement of RM-MPU-6000A 4.2, 4.6, 4.27 to 4.31."""

from pathlib import Path

import numpy as np
import pytest
from sensor_bench import ADDRESS, INT_ENABLE, INT_STATUS, MS, Bench, library, table

__all__ = ["library"]

FIFO_EN, USER_CTRL, COUNT, DATA = 0x23, 0x6A, 0x72, 0x74
ALL, ON, RESET = 0xF8, 0x40, 0x04
SIZE = 1024


def count(bench: Bench) -> int:
    high, low = bench.read(COUNT, 2)
    return high * 256 + low


def packets(bench: Bench, number: int = 1) -> list[list[int]]:
    data = bytes(bench.read(DATA, 14 * number))
    return np.frombuffer(data, dtype=">i2").reshape(number, 7).astype(int).tolist()


@pytest.fixture
def bench(library: Path) -> Bench:
    """At 1 kHz, with an endless table; nothing enters the FIFO yet."""
    bench = Bench(library, table(300, loop=True))
    bench.configure(divider=0, pin=0x20)
    return bench


def filling(bench: Bench, which: int = ALL) -> Bench:
    assert bench.write(INT_ENABLE, 0x11)
    assert bench.write(USER_CTRL, ON)
    assert bench.write(FIFO_EN, which)
    return bench


def test_nothing_enters_unless_both_switches_are_on(bench: Bench) -> None:
    bench.write(INT_ENABLE, 1)
    bench.write(FIFO_EN, ALL)
    bench.wait(5 * MS)
    assert count(bench) == 0
    bench.write(FIFO_EN, 0)
    bench.write(USER_CTRL, ON)
    bench.wait(5 * MS)
    assert count(bench) == 0
    bench.write(FIFO_EN, ALL)
    bench.wait(5 * MS)
    assert count(bench) == 5 * 14


@pytest.mark.parametrize(
    ("which", "columns"),
    [
        (0xF8, (0, 1, 2, 3, 4, 5, 6)),
        (0x78, (0, 1, 2, 4, 5, 6)),
        (0x08, (0, 1, 2)),
        (0x80, (3,)),
        (0x40, (4,)),
        (0x20, (5,)),
        (0x10, (6,)),
        (0xD0, (3, 4, 6)),
        (0x07, ()),
    ],
)
def test_what_is_selected_enters_in_the_order_of_the_registers(
    bench: Bench, which: int, columns: tuple[int, ...]
) -> None:
    filling(bench, which)
    bench.wait(2 * MS)
    assert count(bench) == 4 * len(columns)
    data = np.frombuffer(bytes(bench.read(DATA, 4 * len(columns))), dtype=">i2").tolist()
    wanted = [bench.expected(row)[c] for row in range(2) for c in columns]
    assert data == wanted


def test_the_count_is_held_when_its_high_byte_is_read(bench: Bench) -> None:
    filling(bench)
    bench.wait(20 * MS)
    assert bench.read(COUNT) == [280 // 256]
    bench.wait(40 * MS)
    assert bench.read(COUNT + 1) == [280 % 256], "the low byte is the one of then"
    assert count(bench) == 60 * 14


def test_the_address_stays_at_the_data(bench: Bench) -> None:
    filling(bench)
    bench.wait(3 * MS)
    assert packets(bench, 3) == [bench.expected(row) for row in range(3)]
    assert count(bench) == 0


def test_an_empty_fifo_repeats_its_last_byte(bench: Bench) -> None:
    filling(bench)
    bench.wait(1 * MS)
    bench.write(FIFO_EN, 0)
    last = bench.expected(0)[6] & 0xFF
    assert packets(bench) == [bench.expected(0)]
    assert bench.read(DATA, 5) == [last] * 5


def test_it_goes_on_filling_during_a_transaction(bench: Bench) -> None:
    filling(bench)
    bench.wait(1 * MS)
    sensor = bench.sensor
    sensor.start(ADDRESS, read=False)
    sensor.write(DATA)
    sensor.start(ADDRESS, read=True)
    data = []
    for i in range(28):
        data.append(sensor.read())
        if i == 6:
            bench.wait(1 * MS)
    sensor.stop()
    rows = np.frombuffer(bytes(data), dtype=">i2").reshape(2, 7).tolist()
    assert rows == [bench.expected(0), bench.expected(1)]


def test_a_full_fifo_loses_its_oldest_and_says_so(bench: Bench) -> None:
    filling(bench)
    bench.wait(73 * MS)
    assert count(bench) == 73 * 14
    assert bench.read(INT_STATUS) == [0x01]
    bench.wait(1 * MS)
    assert count(bench) == SIZE
    assert bench.read(INT_STATUS) == [0x11]
    assert bench.sensor.unread_samples == 1
    bench.write(FIFO_EN, 0)
    data = bytes(bench.read(DATA, SIZE))
    rows = b"".join(np.array(bench.expected(row), dtype=">i2").tobytes() for row in range(74))
    assert data == rows[-SIZE:], "12 bytes of row 0 are gone, and with them the alignment"


def test_overflow_raises_the_pin_by_itself(bench: Bench) -> None:
    bench.write(INT_ENABLE, 0x01)
    filling(bench)
    bench.write(INT_ENABLE, 0x11)
    bench.wait(73 * MS)
    bench.read(INT_STATUS)
    bench.write(INT_ENABLE, 0x10)
    assert not bench.sensor.int_pin
    bench.wait(1 * MS)
    assert bench.sensor.int_pin
    assert bench.read(INT_STATUS) == [0x10]


def test_overflow_is_not_told_unless_enabled(bench: Bench) -> None:
    filling(bench)
    bench.write(INT_ENABLE, 0x01)
    bench.wait(80 * MS)
    assert bench.read(INT_STATUS) == [0x01]


@pytest.mark.parametrize(
    ("before", "written", "after"), [(ON, ON | RESET, 70), (ON, RESET, 70), (0, RESET, 0)]
)
def test_the_reset_acts_while_the_fifo_is_off(
    bench: Bench, before: int, written: int, after: int
) -> None:
    filling(bench)
    bench.wait(5 * MS)
    bench.write(FIFO_EN, 0)
    bench.write(USER_CTRL, before)
    bench.write(USER_CTRL, written)
    assert bench.read(USER_CTRL) == [written & ON], "the bit clears itself"
    assert count(bench) == after


def test_switched_off_it_keeps_what_it_has_and_gives_nothing(bench: Bench) -> None:
    filling(bench)
    bench.wait(5 * MS)
    bench.write(USER_CTRL, 0)
    bench.read(DATA, 14)
    bench.wait(5 * MS)
    assert count(bench) == 70
    bench.write(USER_CTRL, ON)
    assert packets(bench) == [bench.expected(0)]


def test_bytes_can_be_written(bench: Bench) -> None:
    bench.write(USER_CTRL, ON)
    bench.write(DATA, 0x12, 0x34, 0x56)
    assert count(bench) == 3
    assert bench.read(DATA, 3) == [0x12, 0x34, 0x56]


def test_a_device_reset_empties_it(bench: Bench) -> None:
    filling(bench)
    bench.wait(5 * MS)
    bench.write(0x6B, 0x80)
    bench.wait(100 * MS)
    assert count(bench) == 0


def test_the_table_begins_with_the_first_sample_that_can_enter(library: Path) -> None:
    bench = Bench(library, table(10, settle=2))
    bench.configure(divider=0, pin=0x20)
    bench.write(USER_CTRL, ON)
    bench.write(INT_ENABLE, 0x11)
    bench.wait(5 * MS)
    assert bench.sensor.rows_played == 0
    bench.write(FIFO_EN, ALL)
    bench.wait(4 * MS)
    assert packets(bench, 4) == [bench.expected(row) for row in (0, 0, 0, 1)]


def test_the_end_of_the_table_waits_for_the_last_packet(library: Path) -> None:
    bench = Bench(library, table(3))
    bench.configure(divider=0, pin=0x20)
    filling(bench)
    bench.wait(10 * MS)
    bench.read(INT_STATUS)
    assert not bench.sensor.exhausted
    packets(bench, 3)
    assert bench.sensor.exhausted


@pytest.mark.parametrize(("amount", "wanted"), [(3, 5 * 14), (80, SIZE)])
def test_extra_packets(bench: Bench, amount: int, wanted: int) -> None:
    bench.plan("fifo-overflow", row=1, amount=amount)
    filling(bench)
    bench.wait(2 * MS)
    assert count(bench) == wanted
    assert bool(bench.read(INT_STATUS)[0] & 0x10) is (wanted == SIZE)


def test_a_torn_count_is_torn_once(bench: Bench) -> None:
    bench.plan("torn-count", row=1, amount=0x6A)
    filling(bench)
    bench.wait(2 * MS)
    assert count(bench) == 0x6A00 + 28
    assert count(bench) == 28


def test_lost_bytes_shift_what_follows(bench: Bench) -> None:
    bench.plan("misaligned", row=1, amount=3)
    filling(bench)
    bench.wait(2 * MS)
    assert count(bench) == 25
    rows = b"".join(np.array(bench.expected(row), dtype=">i2").tobytes() for row in range(2))
    assert bytes(bench.read(DATA, 25)) == rows[3:]
