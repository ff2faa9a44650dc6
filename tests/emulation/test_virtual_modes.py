"""Power, pins and faults of the virtual sensor beyond those that a driver meets every day."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from sensor_bench import (
    ADDRESS,
    CONFIG,
    GYRO_CONFIG,
    INT_PIN_CFG,
    MS,
    POWER,
    SIGNAL_PATH_RESET,
    SMPLRT_DIV,
    WHO_AM_I,
    Bench,
    library,
    table,
)

from hostkit.emulation.virtual_sensor import NEVER

__all__ = ["library"]

STANDBY = 0x6C
CYCLE, NO_TEMPERATURE = 0x20, 0x08


@pytest.fixture
def bench(library: Path) -> Bench:
    return Bench(library, table(60))


@pytest.mark.parametrize(("setting", "period_ms"), [(0, 800), (1, 200), (2, 50), (3, 25)])
def test_cycle_mode_samples_the_accelerometer_alone(
    bench: Bench, setting: int, period_ms: int
) -> None:
    bench.configure()
    bench.write(STANDBY, setting << 6)
    bench.write(POWER, CYCLE | 0x01)
    bench.enable()
    assert bench.sensor.next_event_ns == bench.now + period_ms * MS
    for row in range(2):
        bench.wait(period_ms * MS)
        assert bench.sensor.rows_played == row + 1
        assert bench.burst()[:4] == bench.expected(row)[:4]
        assert bench.burst()[4:] == bench.expected(0)[4:]
    bench.write(POWER, 0x01)
    bench.wait(10 * MS)
    assert bench.sensor.rows_played == 3


def test_sleep_wins_over_cycle_mode(bench: Bench) -> None:
    bench.configure()
    bench.write(POWER, CYCLE | 0x40)
    assert bench.sensor.next_event_ns == NEVER


@pytest.mark.parametrize("clock", [4, 5, 7])
def test_without_a_clock_there_are_no_samples(bench: Bench, clock: int) -> None:
    bench.configure()
    bench.enable()
    bench.wait(10 * MS)
    bench.write(POWER, clock)
    bench.wait(100 * MS)
    assert bench.sensor.rows_played == 1
    bench.write(POWER, 1)
    bench.wait(31 * MS)
    assert bench.sensor.rows_played == 1
    bench.wait(10 * MS)
    assert bench.sensor.rows_played == 2


@pytest.mark.parametrize("axis", range(6))
def test_an_axis_in_standby_keeps_its_count(bench: Bench, axis: int) -> None:
    bench.configure()
    bench.enable()
    bench.wait(10 * MS)
    bench.write(STANDBY, 0x20 >> axis)
    bench.wait(10 * MS)
    column = axis if axis < 3 else axis + 1
    wanted = bench.expected(1)
    wanted[column] = bench.expected(0)[column]
    assert bench.burst() == wanted
    bench.write(STANDBY, 0)
    bench.wait(10 * MS)
    assert bench.burst() == bench.expected(2)


def test_the_thermometer_can_be_switched_off(bench: Bench) -> None:
    bench.configure()
    bench.write(POWER, NO_TEMPERATURE | 1)
    before = bench.burst()[3]
    bench.enable()
    bench.wait(20 * MS)
    wanted = bench.expected(1)
    wanted[3] = before
    assert bench.burst() == wanted
    assert before == bench.expected(0)[3]


@pytest.mark.parametrize(("bit", "columns"), [(0x01, (3,)), (0x02, (0, 1, 2)), (0x04, (4, 5, 6))])
def test_a_single_path_is_reset(bench: Bench, bit: int, columns: tuple[int, ...]) -> None:
    bench.configure()
    bench.enable()
    bench.wait(10 * MS)
    bench.write(SIGNAL_PATH_RESET, bit)
    cleared = [0 if c in columns else n for c, n in enumerate(bench.expected(0))]
    assert bench.burst() == cleared
    bench.wait(10 * MS)
    still = [0 if c in columns else n for c, n in enumerate(bench.expected(1))]
    assert bench.burst() == still, "the others go on"
    bench.wait(30 * MS)
    assert bench.burst() == bench.expected(4)


def test_signal_conditions_are_reset_by_user_control(bench: Bench) -> None:
    bench.configure()
    bench.wait(50 * MS)
    bench.write(0x6A, 0x01)
    assert bench.burst() == [0] * 7
    assert bench.read(0x6A) == [0]


@pytest.mark.parametrize(
    ("pin", "idle_driven", "up_driven"),
    [(0x20, True, True), (0x60, True, False), (0xA0, True, True), (0xE0, False, True)],
)
def test_an_open_drain_only_pulls_down(
    library: Path, pin: int, idle_driven: bool, up_driven: bool
) -> None:
    bench = Bench(library, table(5))
    bench.configure(pin=pin)
    bench.enable()
    assert bench.sensor.int_pin is bool(pin & 0x80)
    assert bench.sensor.int_driven is idle_driven
    bench.wait(10 * MS)
    assert bench.sensor.int_pin is not bool(pin & 0x80)
    assert bench.sensor.int_driven is up_driven


def test_the_time_of_an_announcement_is_that_of_its_edge(library: Path) -> None:
    bench = Bench(library, table(5))
    bench.configure(pin=0x20)
    bench.enable()
    edge = bench.now + 10 * MS
    bench.wait(35 * MS)
    assert bench.sensor.announced_ns == edge, "two more samples came while it was up"


def test_bits_of_fsync_and_bypass_are_kept(bench: Bench) -> None:
    bench.write(INT_PIN_CFG, 0x0E)
    bench.write(CONFIG, 0x28)
    assert bench.read(INT_PIN_CFG) == [0x0E]
    assert bench.read(CONFIG) == [0x28]


def test_ad0_sets_the_last_bit_of_the_address(bench: Bench) -> None:
    bench.sensor.set_ad0(high=True)
    assert not bench.sensor.start(ADDRESS, read=False)
    assert bench.sensor.start(ADDRESS + 1, read=False)
    bench.sensor.write(WHO_AM_I)
    bench.sensor.start(ADDRESS + 1, read=True)
    assert bench.sensor.read() == 0x68, "which does not show there"


def test_the_response_of_the_self_test_grows(library: Path) -> None:
    rest = replace(
        table(40), angular_rate_rad_s=np.zeros((40, 3)), specific_force_m_s2=np.zeros((40, 3))
    )
    bench = Bench(library, rest)
    bench.sensor.set_self_test((1, 1, 1, 0))
    bench.sensor.set_settling(100 * MS)
    bench.sensor.set_response(3, 0.5)
    bench.configure()
    bench.enable()
    bench.write(GYRO_CONFIG, 0xE0)
    heard = []
    for _ in range(12):
        bench.wait(10 * MS)
        heard.append(bench.burst()[4:])
    whole = np.array([0.5 * 3275, -3275, 3275])
    shares = np.minimum(np.arange(1, 13) / 10, 1.0)
    np.testing.assert_allclose(heard, whole * shares[:, None], atol=0.51)


def test_the_supply_dips_in_a_write(bench: Bench) -> None:
    bench.configure()
    bench.plan("brown-out-write", amount=1)
    assert bench.write(SMPLRT_DIV, 7)
    assert bench.write(GYRO_CONFIG, 0x18), "acknowledged, as if it were written"
    assert not bench.sensor.start(ADDRESS, read=False)
    bench.wait(30 * MS)
    assert bench.read(GYRO_CONFIG) == [0]
    assert bench.read(SMPLRT_DIV) == [0]
    assert bench.read(POWER) == [0x40]
    assert bench.write(GYRO_CONFIG, 0x18)
    assert bench.read(GYRO_CONFIG) == [0x18], "once"


@pytest.mark.parametrize("axis", range(6))
@pytest.mark.parametrize(("name", "value"), [("stuck-value", None), ("saturated-axis", 32767)])
def test_an_axis_is_spoilt_for_some_samples(
    library: Path, axis: int, name: str, value: int | None
) -> None:
    bench = Bench(library, table(8))
    bench.plan(name, row=2, amount=3 * 256 + axis)
    bench.configure()
    bench.enable()
    column = axis if axis < 3 else axis + 1
    for row in range(7):
        bench.wait(10 * MS)
        wanted = bench.expected(row)
        if 2 <= row < 5:
            wanted[column] = bench.expected(1)[column] if value is None else value
        assert bench.burst() == wanted


def test_an_axis_is_spoilt_until_a_reset(library: Path) -> None:
    bench = Bench(library, table(8))
    bench.plan("saturated-axis", row=0, amount=0)
    bench.configure()
    bench.enable()
    bench.wait(50 * MS)
    assert bench.burst()[0] == 32767
    bench.write(POWER, 0x80)
    bench.wait(100 * MS)
    bench.configure()
    bench.enable()
    bench.wait(10 * MS)
    assert bench.burst() == bench.expected(5)
