"""The self-test of the driver against the register map's formula, on a sensor of many faults."""

from pathlib import Path

import numpy as np
import pytest
from boards import require_or_skip
from designs import design
from driver_bench import Report, at_once, build, fault, run

from hostkit.emulation.board import Stimulus
from hostkit.sensors.mpu6050 import settle_samples

NONE, PASSED, FAILED, NO_TRIM, MOVED, VARIANT = range(6)
CODE = design(rate_hz=100.0)
ROWS = 400
CODES = (0x6C, 0x71, 0x69, 0x2D)  # accelerometer 14, 15, 13, gyroscope 12, 17, 9


def trims() -> list[float]:
    """RM-MPU-6000A 4.2, section 4.1."""
    accel = [4096 * 0.34 * (0.92 / 0.34) ** ((code - 1) / 30) for code in (14, 15, 13)]
    gyro = [25 * 131 * 1.046 ** (code - 1) for code in (12, 17, 9)]
    return [*accel, gyro[0], -gyro[1], gyro[2]]


def at_rest(noise: float = 1.0) -> Stimulus:
    """A sensor on a table, with the noise of the data sheet times a factor, and offsets."""
    rng = np.random.default_rng(8)
    return Stimulus(
        angular_rate_rad_s=np.radians([3.0, -8.0, 1.0] + 0.05 * noise * rng.normal(size=(ROWS, 3))),
        specific_force_m_s2=9.80665
        * ([0.03, -0.04, 1.0] + 3e-3 * noise * rng.normal(size=(ROWS, 3))),
        temperature_deg_c=25.0 + 0.05 * rng.normal(size=ROWS),
        settle_samples=settle_samples(CODE.sensor, CODE.rate_hz),
    )


@pytest.fixture(scope="module", params=["burst", "fifo"])
def program(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    require_or_skip("gcc")
    return build(tmp_path_factory.mktemp("tested"), CODE, fifo=request.param == "fifo")


def verdict(report: Report) -> tuple[int, list[int], list[int]]:
    assert len(report.tested) == 1
    result, *pairs = report.tested[0]
    return result, pairs[::2], pairs[1::2]


def set_codes(*codes: int) -> str:
    return "codes " + " ".join(str(code) for code in codes)


def test_a_good_sensor_passes_and_is_set_up_anew(program: Path) -> None:
    report = run(program, at_rest(), set_codes(*CODES), "run 600", "test", "run 2500")
    result, response, trim = verdict(report)
    assert result == PASSED
    np.testing.assert_allclose(trim, trims(), atol=0.5)
    np.testing.assert_allclose(response, trims(), atol=8.0)
    assert report.starts == 2
    assert report.errors == {}
    gaps = np.diff(report.time_us)
    assert 0.9e6 < gaps.max() < 1.4e6
    assert np.sort(gaps)[:-1].max() == 10_000
    counts = report.samples[-50:].mean(axis=0)
    assert counts[2] == pytest.approx(32768 / CODE.sensor.accel_full_scale_g, rel=0.01)


@pytest.mark.parametrize("code", [1, 16, 31])
def test_trims_are_the_formulas(program: Path, code: int) -> None:
    high, low = code >> 2 << 5 | code, (code & 3) * 0b010101
    report = run(
        program, at_rest(0.0), set_codes(high, high, high, low), "run 500", "test", "run 1500"
    )
    result, _, trim = verdict(report)
    assert result == PASSED
    accel = 4096 * 0.34 * (0.92 / 0.34) ** ((code - 1) / 30)
    gyro = 25 * 131 * 1.046 ** (code - 1)
    np.testing.assert_allclose(trim, [accel] * 3 + [gyro, -gyro, gyro], atol=0.5)


@pytest.mark.parametrize(
    ("axis", "percent", "result"),
    [
        *[(axis, 85, FAILED) for axis in range(6)],
        *[(axis, 87, PASSED) for axis in (0, 4)],
        *[(axis, 113, PASSED) for axis in (1, 5)],
        *[(axis, 115, FAILED) for axis in (2, 4)],
        (3, 0, FAILED),
    ],
)
def test_the_limit_is_14_percent_on_every_axis(
    program: Path, axis: int, percent: int, result: int
) -> None:
    commands = (set_codes(*CODES), f"response {axis} {percent}", "run 500", "test", "run 1500")
    assert verdict(run(program, at_rest(), *commands))[0] == result


def test_a_sensor_that_moves_is_told_from_a_bad_one(program: Path) -> None:
    feels = at_rest()
    turning = feels.angular_rate_rad_s.copy()
    turning[:, 2] += np.radians(5.0) * np.sin(np.arange(ROWS) * 0.5)
    moving = Stimulus(
        angular_rate_rad_s=turning,
        specific_force_m_s2=feels.specific_force_m_s2.copy(),
        temperature_deg_c=feels.temperature_deg_c.copy(),
        settle_samples=feels.settle_samples,
    )
    commands = ("rate 10000", set_codes(*CODES), "run 600", "test", "run 1500")
    assert verdict(run(program, moving, *commands))[0] == MOVED
    assert verdict(run(program, feels, *commands))[0] == PASSED, (
        "the noise of the part is no motion"
    )


def test_a_sensor_without_codes_has_no_figures(program: Path) -> None:
    report = run(program, at_rest(), at_once("no-trim"), "run 500", "test", "run 1500")
    result, _, trim = verdict(report)
    assert result == NO_TRIM
    assert trim == [0] * 6
    one_missing = (CODES[0] & 0xE0, *CODES[1:])
    result, _, trim = verdict(
        run(program, at_rest(), set_codes(*one_missing), "run 500", "test", "run 1500")
    )
    assert result == NO_TRIM
    assert [t == 0 for t in trim] == [False, False, False, True, False, False]


def test_a_failed_axis_counts_more_than_a_missing_code(program: Path) -> None:
    commands = (
        set_codes(CODES[0] & 0xE0, *CODES[1:]),
        "response 1 50",
        "run 500",
        "test",
        "run 1500",
    )
    assert verdict(run(program, at_rest(), *commands))[0] == FAILED


def test_another_part_is_not_tested(program: Path) -> None:
    report = run(program, at_rest(), "identity 112", "run 600", "test", "run 300")
    assert verdict(report)[0] == VARIANT
    assert report.starts == 1
    assert set(np.diff(report.time_us)) == {10_000}, "it goes on"


def test_a_fault_of_the_bus_does_not_spoil_the_test(program: Path) -> None:
    for what in (("nack-address", 5), ("torn-burst", 4), ("nack-data", 3)):
        commands = (set_codes(*CODES), "run 500", "test", fault(*what), "run 3000")
        assert verdict(run(program, at_rest(), *commands))[0] == PASSED
    feels = at_rest()
    commands = (
        set_codes(*CODES),
        "run 500",
        "test",
        "run 300",
        at_once("nack-address", 12),
        "run 3000",
    )
    report = run(program, feels, *commands)
    assert report.errors["dead bus"] == 1
    assert verdict(report)[0] == PASSED, "it is made after the restart"
