"""The driver in FIFO mode at 1 kHz, and both modes when the processor or the bus is away."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from boards import expected_counts, require_or_skip
from designs import design
from driver_bench import Report, at_once, build, fault, run

from hostkit.emulation.board import Stimulus
from hostkit.sensors.mpu6050 import settle_samples

CODE = design(rate_hz=1000.0, low_pass_setting=1)
PERIOD_US = 1000
JITTER_US = 420
"""INT waits for the end of a transaction, the longest of which takes so long."""


def wild(rows: int = 2000) -> Stimulus:
    """Wild motion of a sensor whose temperature is what it is in a room."""
    rng = np.random.default_rng(3)
    return Stimulus(
        angular_rate_rad_s=rng.normal(0.0, 3.0, (rows, 3)),
        specific_force_m_s2=rng.normal(0.0, 8.0, (rows, 3)),
        temperature_deg_c=25.0 + rng.normal(0.0, 0.1, rows),
        settle_samples=settle_samples(CODE.sensor, CODE.rate_hz),
    )


FEELS = wild()


def rows_of(report: Report, feels: Stimulus = FEELS) -> np.ndarray:
    """Which row of the table each sample is; all must be one."""
    counts = expected_counts(feels, CODE)
    table = [tuple(row) for row in np.hstack([counts.accel, counts.gyro]).tolist()]
    place = {row: i for i, row in enumerate(table)}
    sent = np.delete(report.samples, 3, axis=1).tolist()
    rows = [place.get(tuple(row), -1) for row in sent]
    assert -1 not in rows, f"sample {rows.index(-1)} is no row"
    return np.array(rows)


def spoilt_samples(report: Report) -> np.ndarray:
    """Return which samples are rows up to the temperature, but not behind it; all others are rows.

    The rows must come in order.
    """
    counts = expected_counts(FEELS, CODE)
    place = {tuple(row): i for i, row in enumerate(counts.accel.tolist())}
    rows = [place.get(tuple(row), -1) for row in report.samples[:, :3].tolist()]
    assert -1 not in rows, f"sample {rows.index(-1)} does not begin like a row"
    assert (np.diff(rows) > 0).all()
    return np.flatnonzero((report.samples[:, 4:] != counts.gyro[rows]).any(axis=1))


def assert_times_are_true(report: Report, rows: np.ndarray, jitter_us: int = JITTER_US) -> None:
    """Each sample has the time at which the sensor took it, by its row, between two restarts."""
    begins = np.flatnonzero(np.diff(report.time_us, prepend=-(10**6)) > 150_000)
    for begin, end in zip(begins, [*begins[1:], len(rows)], strict=True):
        wanted = (rows[begin:end] - rows[begin]) * PERIOD_US
        late = report.time_us[begin:end] - report.time_us[begin] - wanted
        assert np.abs(late).max() <= jitter_us
    assert (np.diff(report.time_us) > 0).all()


@pytest.fixture(scope="module")
def fifo(tmp_path_factory: pytest.TempPathFactory) -> Path:
    require_or_skip("gcc")
    return build(tmp_path_factory.mktemp("fifo"), CODE, fifo=True)


@pytest.fixture(scope="module")
def burst(tmp_path_factory: pytest.TempPathFactory) -> Path:
    require_or_skip("gcc")
    return build(tmp_path_factory.mktemp("burst"), CODE, fifo=False)


def test_every_row_comes_once_and_at_its_time(fifo: Path) -> None:
    report = run(fifo, FEELS, "run 700")
    rows = rows_of(report)
    assert rows.tolist() == list(range(len(rows)))
    assert len(rows) > 480
    assert set(np.diff(report.time_us)) == {PERIOD_US}
    assert (report.errors, report.starts, report.lost) == ({}, 1, 0)


@pytest.mark.parametrize("silent_ms", [5, 20, 60, 70])
def test_a_silent_processor_loses_nothing(fifo: Path, silent_ms: int) -> None:
    report = run(fifo, FEELS, "run 500", f"stall {silent_ms}", "run 300")
    rows = rows_of(report)
    assert rows.tolist() == list(range(len(rows)))
    assert_times_are_true(report, rows)
    assert (report.errors, report.starts, report.lost) == ({}, 1, 0)


@pytest.mark.parametrize(
    "what",
    [
        ("nack-address", 1),
        ("nack-address", 60),
        ("nack-data", 5),
        ("clock-stretch", 800),
        ("clock-stretch", 60_000),
        ("stuck-sda", 9),
        ("stuck-sda", 500),
    ],
    ids=str,
)
def test_a_silent_bus_loses_nothing(fifo: Path, what: tuple[str, int]) -> None:
    report = run(fifo, FEELS, "run 400", fault(*what), "run 300")
    rows = rows_of(report)
    assert rows.tolist() == list(range(len(rows)))
    assert len(rows) > 480
    held_us = what[1] if what[0] == "clock-stretch" and what[1] < 1000 else 0
    assert_times_are_true(report, rows, JITTER_US + held_us)
    assert set(report.errors) <= {"transfer"}
    assert report.starts == 1


def test_what_costs_the_fifo_nothing_costs_single_samples(burst: Path) -> None:
    """The measure of the two tests above: without the FIFO the same silences lose samples."""
    report = run(burst, FEELS, "run 500", "stall 60", "run 300")
    steps = np.diff(rows_of(report))
    assert steps.max() >= 58
    assert report.starts == 1, "a processor that was away finds its sensor announcing"
    report = run(burst, FEELS, "run 400", fault("clock-stretch", 60_000), "run 600")
    assert report.errors["dead bus"] == 1


@pytest.mark.parametrize("silent_ms", [80, 300])
def test_a_longer_silence_overflows_and_is_told(fifo: Path, silent_ms: int) -> None:
    report = run(fifo, FEELS, "run 500", f"stall {silent_ms}", "run 300")
    rows = rows_of(report)
    steps = np.diff(rows)
    assert sorted(set(steps)) == [1, steps.max()]
    assert silent_ms <= steps.max() <= silent_ms + 4
    assert report.errors == {"overflow": 1}
    assert report.starts == 1
    gap = int(steps.argmax()) + 1
    assert np.flatnonzero(report.after_gap).tolist() == [gap]
    assert report.time_us[gap] - report.time_us[gap - 1] == pytest.approx(
        steps.max() * PERIOD_US, abs=JITTER_US
    )


def test_a_bus_that_is_dead_for_longer_restarts(fifo: Path) -> None:
    report = run(fifo, FEELS, "run 400", fault("clock-stretch", 100_000), "run 700")
    rows_of(report)
    assert report.errors["dead bus"] == 1
    assert report.starts == 2


@pytest.mark.parametrize(
    ("what", "errors", "lost"),
    [
        (("fifo-overflow", 80), {"overflow": 1}, 2),
        (("torn-count", 0x6A), {"torn": 1}, 0),
        (("torn-count", 0x01), {"transfer": 1}, 0),
        (("misaligned", 1), {"transfer": 1, "misaligned": 1}, 3),
        (("misaligned", 7), {"transfer": 1, "misaligned": 1}, 3),
        (("misaligned", 13), {"transfer": 1, "misaligned": 1}, 3),
        (("misaligned", 14), {}, 1),
        (("torn-burst", 0), {"torn": 1}, 0),
        (("torn-burst", 1), {"transfer": 1}, 0),
        (("torn-burst", 3), {"torn": 1}, 0),
        (("torn-burst", 6), {"torn": 1}, 3),
        (("torn-burst", 13), {"torn": 1}, 3),
        (("lost-data-ready", 50), {"lost ready": 1}, 0),
        (("lost-data-ready", 100_000), {"lost ready": 1}, 0),
    ],
    ids=str,
)
def test_faults_are_told_and_repaired_without_a_restart(
    fifo: Path, what: tuple[str, int], errors: dict[str, int], lost: int
) -> None:
    report = run(fifo, FEELS, "run 400", fault(*what), "run 300")
    rows = rows_of(report)
    assert report.errors == errors
    assert report.starts == 1
    assert (np.diff(rows) > 0).all()
    assert rows[-1] + 1 - len(rows) <= lost
    assert rows[-1] > 480


@pytest.mark.parametrize(
    ("what", "error", "lost"),
    [
        (("self-reset", 0), "self reset", 1),
        (("register-upset", 0x1B10), "register", 3),
        (("register-upset", 0x1C08), "register", 3),
        (("register-upset", 0x1901), "register", 3),
        (("register-upset", 0x6A40), "register", 40),
    ],
    ids=str,
)
def test_what_has_lost_its_registers_restarts(
    fifo: Path, what: tuple[str, int], error: str, lost: int
) -> None:
    report = run(fifo, FEELS, "run 400", fault(*what), "run 900")
    rows = rows_of(report)
    assert report.errors == {error: 1}
    assert report.starts == 2
    assert rows[-1] + 1 - len(rows) <= lost


def test_a_packet_of_another_length_is_a_misaligned_one(fifo: Path) -> None:
    report = run(fifo, FEELS, "run 400", fault("register-upset", 0x2380), "run 400")
    rows_of(report)
    assert report.errors == {"transfer": 1, "misaligned": 1}
    assert report.starts == 1, "emptying it sets the register again"


@pytest.mark.parametrize(("every_ms", "spoilt"), [(1, 0), (2, 0), (3, 3)])
def test_bytes_that_are_lost_are_found_whenever_they_are_lost(
    fifo: Path, every_ms: int, spoilt: int
) -> None:
    """Twelve times; up to three of them within the reading itself, behind the temperature."""
    commands = [c for _ in range(12) for c in (fault("misaligned", 1), f"run {every_ms}")]
    report = run(fifo, FEELS, "run 400", *commands, "run 900")
    found = spoilt_samples(report)
    assert len(found) <= spoilt
    assert (np.diff(found) > 1).all(), "the one sample in which the byte was lost"
    assert report.errors["misaligned"] >= 5
    assert report.samples.shape[0] > 1000


def test_a_fifo_that_cannot_be_repaired_restarts_the_sensor(
    tmp_path: Path,
) -> None:
    """A model that loses a byte of every sample."""
    require_or_skip("gcc")
    program = build(tmp_path / "code", CODE, fifo=True, losing=True)
    report = run(program, FEELS, "run 900")
    assert report.samples.size == 0
    assert report.errors["misaligned"] >= 5
    assert report.errors["silent"] >= 1
    assert report.starts >= 2


def test_a_jump_of_the_temperature_is_taken_for_a_shift_once(fifo: Path) -> None:
    """A jump of 10 degC is taken for one; that of the next sample is believed."""
    jump = FEELS.temperature_deg_c.copy()
    jump[300:] += 10.0
    report = run(fifo, replace(FEELS, temperature_deg_c=jump), "run 800")
    rows = rows_of(report)
    assert report.errors == {"misaligned": 1}
    assert np.flatnonzero(np.diff(rows) > 1).size == 1
    assert report.starts == 1


def test_a_slow_change_of_temperature_is_none(fifo: Path) -> None:
    drift = np.linspace(-20.0, 60.0, len(FEELS))
    report = run(fifo, replace(FEELS, temperature_deg_c=drift), "run 800")
    rows = rows_of(report)
    assert rows.tolist() == list(range(len(rows)))
    assert report.errors == {}


def test_a_frozen_sensor_is_found_in_the_fifo_too(fifo: Path) -> None:
    report = run(fifo, FEELS, "run 400", fault("frozen-data"), "run 1100")
    assert report.errors == {"frozen": 1}
    assert report.starts == 2


@pytest.mark.parametrize("writes", range(0, 24, 3))
@pytest.mark.parametrize("mode", ["fifo", "burst"])
def test_a_dip_of_the_supply_in_any_write_is_survived(
    fifo: Path, burst: Path, mode: str, writes: int
) -> None:
    program = {"fifo": fifo, "burst": burst}[mode]
    report = run(program, FEELS, at_once("brown-out-write", writes), "run 1500")
    rows = rows_of(report)
    assert rows[0] <= 1
    assert (np.diff(rows) == 1).all()
    assert len(rows) > 500


def test_a_foreign_part_is_refused(fifo: Path) -> None:
    assert run(fifo, FEELS, "identity 18", "run 300").refused == [18]


def test_the_other_rates_work_in_fifo_mode(tmp_path: Path) -> None:
    require_or_skip("gcc")
    for rate_hz, low_pass in ((4.0, 5), (100.0, 3), (500.0, 0)):
        code = design(rate_hz=rate_hz, low_pass_setting=low_pass)
        feels = replace(wild(200), settle_samples=settle_samples(code.sensor, rate_hz))
        program = build(tmp_path / f"at{rate_hz:g}", code, fifo=True)
        report = run(program, feels, f"run {round(400 + 50000 / rate_hz)}")
        rows = rows_of(report, feels)
        assert rows.tolist() == list(range(len(rows)))
        assert len(rows) >= 40
        assert set(np.diff(report.time_us)) == {round(1e6 / rate_hz)}
        assert report.errors == {}
