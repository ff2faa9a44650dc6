from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from sensor_bench import (
    ACCEL_CONFIG,
    ADDRESS,
    BURST,
    CONFIG,
    GYRO_CONFIG,
    INT_ENABLE,
    INT_STATUS,
    MS,
    PART,
    POWER,
    SIGNAL_PATH_RESET,
    SMPLRT_DIV,
    WHO_AM_I,
    Bench,
    library,
    table,
)

from hostkit.emulation.board import PlannedFault
from hostkit.emulation.fault import KINDS
from hostkit.emulation.virtual_sensor import NEVER

__all__ = ["library"]


@pytest.fixture
def bench(library: Path) -> Bench:
    return Bench(library, table())


def test_reset_values(bench: Bench) -> None:
    assert bench.read(WHO_AM_I) == [0x68]
    assert bench.read(POWER) == [0x40]
    bench.sensor.set_self_test((0, 0, 0, 0))
    for register in PART.registers:
        assert bench.read(register.address) == [register.reset_value], register.name


def test_answers_to_its_address_only(bench: Bench) -> None:
    assert bench.sensor.start(0x68, read=False)
    bench.sensor.stop()
    for address in (0x00, 0x34, 0x67, 0x69, 0x7F):
        assert not bench.sensor.start(address, read=False)
        assert not bench.sensor.write(0x6B)
        assert bench.sensor.read() == 0xFF


def test_asleep_after_power_up_and_no_sample_until_awake(bench: Bench) -> None:
    assert bench.sensor.next_event_ns == NEVER
    bench.write(INT_ENABLE, 1)
    bench.wait(1000 * MS)
    assert not bench.sensor.int_pin
    assert bench.burst() == [0] * 7
    bench.write(POWER, 0x01)
    bench.wait(29 * MS)
    assert bench.sensor.rows_played == 0
    bench.wait(3 * MS)
    assert bench.sensor.rows_played > 0


def test_sleep_stops_samples(bench: Bench) -> None:
    bench.configure()
    bench.enable()
    bench.wait(35 * MS)
    played = bench.sensor.rows_played
    assert played == 3
    bench.write(POWER, 0x41)
    bench.wait(500 * MS)
    assert bench.sensor.rows_played == played
    assert bench.sensor.next_event_ns == NEVER


def test_gyroscope_is_not_to_be_believed_before_the_pll_has_settled(bench: Bench) -> None:
    bench.write(POWER, 0x01)
    bench.wait(35 * MS)
    assert bench.burst()[4:] == [0x5555] * 3
    assert bench.burst()[:4] == bench.expected(0)[:4]
    bench.wait(10 * MS)
    assert bench.burst() == bench.expected(0)


def test_device_reset_takes_time_and_clears_itself(bench: Bench) -> None:
    bench.configure()
    bench.write(GYRO_CONFIG, 0x18)
    assert bench.write(POWER, 0x80)
    assert not bench.sensor.start(ADDRESS, read=False), "deaf at first"
    bench.wait(2 * MS)
    assert bench.read(POWER) == [0x80]
    bench.write(GYRO_CONFIG, 0x10)
    assert bench.read(GYRO_CONFIG) == [0], "writes are lost meanwhile"
    bench.wait(100 * MS)
    assert bench.read(POWER) == [0x40]
    assert bench.read(GYRO_CONFIG) == [0]
    assert bench.read(SMPLRT_DIV) == [0]


def test_signal_path_reset_clears_the_data_and_is_not_kept(bench: Bench) -> None:
    bench.configure()
    bench.wait(50 * MS)
    assert bench.burst() == bench.expected(0)
    bench.write(SIGNAL_PATH_RESET, 0x07)
    assert bench.burst() == [0] * 7
    assert bench.read(SIGNAL_PATH_RESET) == [0]


def test_address_increments_over_reads_and_writes(bench: Bench) -> None:
    bench.write(SMPLRT_DIV, 1, 2, 0x08, 0x10)
    assert bench.read(SMPLRT_DIV, 4) == [1, 2, 0x08, 0x10]
    assert bench.read(GYRO_CONFIG) == [0x08]


@pytest.mark.parametrize("register", [INT_STATUS, BURST, BURST + 13, WHO_AM_I, 0x00, 0x7F])
def test_registers_that_cannot_be_written_stay(bench: Bench, register: int) -> None:
    before = bench.read(register)
    bench.write(register, 0xA5)
    assert bench.read(register) == before


@pytest.mark.parametrize("gyro", range(4))
@pytest.mark.parametrize("accel", range(4))
def test_counts_follow_the_range_registers(bench: Bench, gyro: int, accel: int) -> None:
    bench.write(GYRO_CONFIG, gyro << 3)
    bench.write(ACCEL_CONFIG, accel << 3)
    bench.configure()
    bench.enable()
    for row in range(20):
        bench.wait(10 * MS)
        assert bench.burst() == bench.expected(row, gyro=gyro, accel=accel)


def test_extreme_values_saturate(library: Path) -> None:
    limit = 250 * np.pi / 180
    rows = np.array([[1e9, -1e9, 0.0], [limit, -limit, limit * 32766.4 / 32768], [-1e-9, 1e-9, 0]])
    feels = replace(table(3), angular_rate_rad_s=rows)
    bench = Bench(library, feels)
    bench.configure()
    bench.enable()
    got = []
    for _ in range(3):
        bench.wait(10 * MS)
        got.append(bench.burst()[4:])
    assert got == [[32767, -32768, 0], [32767, -32768, 32766], [0, 0, 0]]


@pytest.mark.parametrize(
    ("low_pass", "divider", "period_ns"),
    [(0, 0, 125_000), (0, 7, MS), (1, 0, MS), (3, 9, 10 * MS), (6, 255, 256 * MS), (7, 3, 500_000)],
)
def test_sample_rate(library: Path, low_pass: int, divider: int, period_ns: int) -> None:
    bench = Bench(library, table(8))
    bench.configure()
    bench.write(CONFIG, low_pass)
    bench.write(SMPLRT_DIV, divider)
    bench.enable()
    for row in range(8):
        bench.wait(period_ns - 1)
        assert bench.sensor.rows_played == row
        bench.wait(1)
        assert bench.sensor.rows_played == row + 1


def test_burst_is_one_sampling_instant(bench: Bench) -> None:
    bench.configure()
    bench.enable()
    bench.wait(10 * MS)
    sensor = bench.sensor
    sensor.start(ADDRESS, read=False)
    sensor.write(BURST)
    sensor.start(ADDRESS, read=True)
    data = []
    for i in range(14):
        data.append(sensor.read())
        if i == 5:
            bench.wait(10 * MS)
            assert not sensor.int_pin, "the next sample waits for the end of the transaction"
    sensor.stop()
    assert np.frombuffer(bytes(data), dtype=">i2").tolist() == bench.expected(0)
    assert sensor.int_pin
    assert bench.burst() == bench.expected(1)
    assert sensor.unread_samples == 0


def test_samples_nobody_read_are_counted(bench: Bench) -> None:
    bench.configure()
    bench.enable()
    bench.wait(40 * MS)
    assert bench.sensor.unread_samples == 3
    assert bench.burst() == bench.expected(3)


def test_int_latched_until_status_is_read(library: Path) -> None:
    bench = Bench(library, table())
    bench.configure(pin=0x20)
    bench.enable()
    bench.wait(10 * MS)
    assert bench.sensor.int_pin
    bench.burst()
    assert bench.sensor.int_pin, "only reading INT_STATUS clears it"
    assert bench.read(INT_STATUS) == [1]
    assert not bench.sensor.int_pin
    assert bench.read(INT_STATUS) == [0]


def test_int_latched_until_any_read(library: Path) -> None:
    bench = Bench(library, table())
    bench.configure(pin=0x30)
    bench.enable()
    bench.wait(10 * MS)
    assert bench.sensor.int_pin
    bench.read(WHO_AM_I)
    assert not bench.sensor.int_pin
    assert bench.read(INT_STATUS) == [0]


def test_int_pulse(library: Path) -> None:
    bench = Bench(library, table())
    bench.configure(pin=0x00)
    bench.enable()
    bench.wait(10 * MS)
    assert bench.sensor.int_pin
    bench.burst()
    assert bench.sensor.int_pin
    bench.wait(49_999)
    assert bench.sensor.int_pin
    bench.wait(1)
    assert not bench.sensor.int_pin


def test_int_active_low(library: Path) -> None:
    bench = Bench(library, table())
    bench.configure(pin=0xB0)
    bench.enable()
    assert bench.sensor.int_pin
    bench.wait(10 * MS)
    assert not bench.sensor.int_pin
    bench.burst()
    assert bench.sensor.int_pin


def test_no_interrupt_unless_enabled(bench: Bench) -> None:
    bench.configure()
    bench.wait(100 * MS)
    assert not bench.sensor.int_pin
    assert bench.read(INT_STATUS) == [0]
    assert bench.burst() == bench.expected(0)


def test_settle_samples_come_before_the_table(library: Path) -> None:
    bench = Bench(library, table(6, settle=3))
    bench.configure()
    bench.wait(1000 * MS)
    assert bench.burst() == bench.expected(0), "row 0 until data-ready is enabled"
    bench.enable()
    rows = []
    for _ in range(9):
        bench.wait(10 * MS)
        assert bench.sensor.int_pin
        rows.append(bench.burst())
    wanted = [0, 0, 0, *range(6)]
    assert rows == [bench.expected(row) for row in wanted]


def test_enabling_while_a_sample_waits_adds_none(library: Path) -> None:
    bench = Bench(library, table(3, settle=1))
    bench.configure()
    bench.wait(9 * MS)
    sensor = bench.sensor
    sensor.start(ADDRESS, read=False)
    sensor.write(INT_ENABLE)
    bench.wait(1 * MS)  # a sample comes while the enabling is on its way
    sensor.write(0x01)
    sensor.stop()
    assert not sensor.int_pin
    rows = []
    for _ in range(4):
        bench.wait(10 * MS)
        rows.append(bench.burst())
    assert rows == [bench.expected(row) for row in (0, 0, 1, 2)]


def test_a_restart_plays_on_where_it_was(library: Path) -> None:
    bench = Bench(library, table(6, settle=2))
    rows = []
    for samples in (4, 6):
        bench.write(POWER, 0x80)
        bench.wait(100 * MS)
        bench.configure()
        bench.enable()
        for _ in range(samples):
            bench.wait(10 * MS)
            rows.append(bench.burst())
    assert rows == [bench.expected(row) for row in (0, 0, 0, 1, 2, 2, 2, 3, 4, 5)]


def test_table_ends(library: Path) -> None:
    bench = Bench(library, table(2))
    bench.configure()
    bench.enable()
    bench.wait(20 * MS)
    assert bench.sensor.rows_played == 2
    assert not bench.sensor.exhausted, "the last row has not been read"
    bench.burst()
    assert bench.sensor.exhausted
    bench.wait(1000 * MS)
    assert not bench.sensor.int_pin
    assert bench.sensor.next_event_ns == NEVER


def test_table_loops(library: Path) -> None:
    bench = Bench(library, table(3, loop=True))
    bench.configure()
    bench.enable()
    for k in range(7):
        bench.wait(10 * MS)
        assert bench.burst() == bench.expected(k % 3)
    assert bench.sensor.rows_played == 7
    assert not bench.sensor.exhausted


def test_nack_on_demand(bench: Bench) -> None:
    bench.sensor.nack_next(2)
    assert not bench.write(CONFIG, 1)
    assert not bench.sensor.start(ADDRESS, read=True)
    assert bench.write(CONFIG, 1)
    assert bench.read(CONFIG) == [1]


def test_sda_is_freed_by_clocks(bench: Bench) -> None:
    bench.sensor.hold_sda(6)
    for _ in range(6):
        assert bench.sensor.sda_low
        assert not bench.sensor.start(ADDRESS, read=False)
        bench.sensor.clock()
    assert not bench.sensor.sda_low
    assert bench.read(WHO_AM_I) == [0x68]


def test_identity_on_demand_survives_a_reset(bench: Bench) -> None:
    bench.sensor.set_identity(0x70)
    assert bench.read(WHO_AM_I) == [0x70]
    bench.write(POWER, 0x80)
    bench.wait(100 * MS)
    assert bench.read(WHO_AM_I) == [0x70]


def running(bench: Bench) -> Bench:
    """Sampling, with row 0 read."""
    bench.configure(pin=0x20)
    bench.enable()
    bench.wait(10 * MS)
    assert bench.burst() == bench.expected(0)
    bench.read(INT_STATUS)
    return bench


def test_written_bytes_are_not_acknowledged(bench: Bench) -> None:
    bench.plan("nack-data", amount=2)
    assert not bench.write(CONFIG, 1)
    assert not bench.write(CONFIG, 1)
    assert bench.write(CONFIG, 1)
    assert bench.sensor.struck == 1


def test_a_burst_breaks_off_once(bench: Bench) -> None:
    bench.plan("torn-burst", row=1, amount=5)
    running(bench)
    bench.wait(10 * MS)
    assert bench.read(CONFIG, 4)[0] == 3, "a shorter read is not touched"
    data = bench.read(BURST, 14)
    assert data[5:] == [0xFF] * 9
    assert bench.burst() == bench.expected(1)
    assert data[:5] == bench.read(BURST, 5)


def test_the_clock_is_held_once(bench: Bench) -> None:
    bench.plan("clock-stretch", row=1, amount=250)
    running(bench)
    assert bench.sensor.stretch_ns == 0
    bench.wait(10 * MS)
    assert bench.sensor.stretch_ns == 250_000
    bench.wait(100_000)
    assert bench.sensor.stretch_ns == 150_000
    bench.wait(150_000)
    assert bench.sensor.stretch_ns == 0


def test_a_register_upset_acts_from_its_row_on(bench: Bench) -> None:
    bench.plan("register-upset", row=2, amount=GYRO_CONFIG * 256 + 0x18)
    running(bench)
    bench.wait(10 * MS)
    assert bench.burst() == bench.expected(1)
    bench.wait(10 * MS)
    assert bench.burst() == bench.expected(2, gyro=3)
    assert bench.read(GYRO_CONFIG) == [0x18]


def test_a_rate_upset_gives_no_row_twice(bench: Bench) -> None:
    bench.plan("register-upset", row=1, amount=SMPLRT_DIV * 256 + 0x08)
    running(bench)
    bench.wait(10 * MS)
    assert bench.sensor.rows_played == 1
    bench.wait(2 * MS)
    assert bench.sensor.rows_played == 2
    assert bench.burst() == bench.expected(1)


def test_a_self_reset_loses_all_registers_and_no_row(bench: Bench) -> None:
    bench.plan("self-reset", row=1)
    running(bench)
    bench.wait(10 * MS)
    assert not bench.sensor.start(ADDRESS, read=False), "deaf at first"
    bench.wait(2 * MS)
    assert bench.read(POWER) == [0x80]
    bench.wait(20 * MS)
    assert bench.read(POWER) == [0x40]
    assert bench.read(SMPLRT_DIV, 4) == [0] * 4
    assert not bench.sensor.int_pin
    bench.configure(pin=0x20)
    bench.enable()
    bench.wait(10 * MS)
    assert bench.burst() == bench.expected(1)


def test_frozen_data_are_announced_until_a_reset(bench: Bench) -> None:
    bench.plan("frozen-data", row=1)
    running(bench)
    for _ in range(3):
        bench.wait(10 * MS)
        assert bench.sensor.int_pin
        assert bench.burst() == bench.expected(0)
        bench.read(INT_STATUS)
    bench.write(POWER, 0x80)
    bench.wait(100 * MS)
    bench.configure()
    bench.enable()
    bench.wait(10 * MS)
    assert bench.burst() == bench.expected(4)


def test_lost_data_ready_stands_in_the_status_only(bench: Bench) -> None:
    bench.plan("lost-data-ready", row=1, amount=2)
    running(bench)
    for row, pin in ((1, False), (2, False), (3, True)):
        bench.wait(10 * MS)
        assert bench.sensor.int_pin is pin
        assert bench.read(INT_STATUS) == [1]
        assert bench.burst() == bench.expected(row)


def test_what_concerns_the_bus_strikes_at_power_up(bench: Bench) -> None:
    bench.plan("wrong-identity", amount=0x98)
    bench.plan("stuck-sda", amount=1)
    bench.plan("self-reset")
    assert bench.sensor.struck == 2
    assert bench.sensor.sda_low
    bench.sensor.clock()
    assert bench.read(WHO_AM_I) == [0x98]


def test_no_more_faults_than_there_is_room_for(bench: Bench) -> None:
    for row in range(16):
        bench.plan("self-reset", row=row + 1)
    assert not bench.sensor.plan(PlannedFault(code=7, row=0, amount=0))
    beyond = PlannedFault(code=len(KINDS), row=0, amount=0)
    assert not Bench(bench.library, table()).sensor.plan(beyond)


@pytest.mark.parametrize(
    ("identity", "kept"), [(0x68, 0), (0x70, 5), (0x98, 5), (0x72, 0), (0x74, 5)]
)
def test_only_some_parts_have_an_accelerometer_filter_of_their_own(
    bench: Bench, identity: int, kept: int
) -> None:
    bench.sensor.set_identity(identity)
    bench.write(0x1D, 5)
    assert bench.read(0x1D) == [kept]


@pytest.mark.parametrize("gyro", range(4))
@pytest.mark.parametrize("accel", range(4))
def test_self_test_adds_the_factory_trim(library: Path, gyro: int, accel: int) -> None:
    """RM-MPU-6000A, section 4.1: the trim by the codes, in every range, y of the gyro negative."""
    rest = replace(
        table(40), angular_rate_rad_s=np.zeros((40, 3)), specific_force_m_s2=np.zeros((40, 3))
    )
    bench = Bench(library, rest)
    codes = {"accel": (0b01010, 0b00111, 0), "gyro": (1, 12, 31)}
    high = [a >> 2 << 5 | g for a, g in zip(codes["accel"], codes["gyro"], strict=True)]
    low = (codes["accel"][0] & 3) << 4 | (codes["accel"][1] & 3) << 2
    bench.sensor.set_self_test((high[0], high[1], high[2], low))
    bench.configure()
    bench.write(GYRO_CONFIG, 0xE0 | gyro << 3)
    bench.write(ACCEL_CONFIG, 0xC0 | accel << 3)
    bench.enable()
    bench.wait(110 * MS)
    counts = bench.burst()
    gyro_trim = [25 * 131 * 1.046 ** (code - 1) / 2**gyro for code in codes["gyro"]]
    accel_trim = [
        4096 * 0.34 * (0.92 / 0.34) ** ((c - 1) / 30) * 4 / 2**accel for c in codes["accel"][:2]
    ]
    wanted = [*accel_trim, 0.0, gyro_trim[0], -gyro_trim[1], gyro_trim[2]]
    np.testing.assert_allclose([*counts[:3], *counts[4:]], wanted, atol=0.51)
    bench.write(GYRO_CONFIG, gyro << 3)
    bench.write(ACCEL_CONFIG, accel << 3)
    bench.wait(10 * MS)
    assert [*bench.burst()[:3], *bench.burst()[4:]] == [0] * 6
