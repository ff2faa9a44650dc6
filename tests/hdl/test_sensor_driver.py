"""The VHDL driver of the MPU-6050 against its simulated sensor, which checks the bus as well."""

from itertools import pairwise
from pathlib import Path

import pytest
from sensor_run import (
    SensorRun,
    build_sensor,
    in_order_of_the_bench,
    run_counters,
    sensor_rows,
    simulate,
)

from hostkit.render.environment import template_root

ROWS = [in_order_of_the_bench(row) for row in sensor_rows()]
PERIOD_US = 50_000 // 32
"""Of the simulated sensor: the design's, by the divisor of the bench."""


@pytest.fixture(scope="module")
def bench(tmp_path_factory: pytest.TempPathFactory, ghdl_installed: None) -> Path:
    return build_sensor(tmp_path_factory.mktemp("sensor"))


def played(run: SensorRun) -> list[int]:
    """Return which line of the file each sample is; one that is none fails."""
    return [ROWS.index(sample.counts) for sample in run.samples]


def check_samples(run: SensorRun, *, missing: int, late_us: int = 1) -> None:
    """Every sample is one of the sensor's, in order, numbered, and has the time of its edge."""
    lines = played(run)
    assert lines == sorted(set(lines))
    assert [sample.sequence for sample in run.samples] == list(range(len(lines)))
    # The last one may still be on its way.
    assert run.rows_played - len(lines) <= missing + 1
    for sample in run.samples:
        assert min(abs(sample.time_us - edge) for edge in run.announced_us) <= late_us
    assert run.running
    assert not run.failed


@pytest.mark.parametrize(
    ("clock_hz", "divisor"), [(4_000_000, 32), (25_000_000, 64), (50_000_000, 64), (62_500_000, 64)]
)
def test_counts_arrive_in_order_with_their_time(bench: Path, clock_hz: int, divisor: int) -> None:
    run = simulate(bench, run_us=15_000 * 64 // divisor, CLOCK_HZ=clock_hz, TIME_DIVISOR=divisor)
    assert len(run.samples) >= 5
    check_samples(run, missing=0)
    assert played(run) == list(range(len(run.samples)))
    assert (run.errors, run.restarts, run.lost_samples, run.identity) == (0, 0, 0, 0x68)


@pytest.mark.parametrize(
    ("fault", "errors", "nacks"),
    [
        ({"NACK_AT": 1, "NACKS": 4}, 4, 4),
        ({"NACK_AT": 12, "NACKS": 2}, 2, 2),
        ({"NACK_AT": 60}, 1, 1),
        ({"NACK_AT": 61, "NACKS": 3}, 3, 3),
        ({"TORN_AT_US": 20_000}, 1, 0),
        ({"STUCK_AT_US": 1, "STUCK_CLOCKS": 7}, 0, 0),
        ({"STUCK_AT_US": 20_000, "STUCK_CLOCKS": 9}, 1, 0),
        ({"STRETCH_AT": 80, "STRETCH_US": 200}, 0, 0),
    ],
    ids=str,
)
def test_a_short_fault_costs_no_sample(
    bench: Path, fault: dict[str, int], errors: int, nacks: int
) -> None:
    run = simulate(bench, **fault)
    check_samples(run, missing=0)
    assert (run.errors, run.nacks, run.timeouts, run.restarts) == (errors, nacks, 0, 0)
    assert len(run.samples) >= 24


def test_eleven_failures_in_a_row_are_a_restart(bench: Path) -> None:
    run = simulate(bench, NACK_AT=90, NACKS=13)
    check_samples(run, missing=3)
    assert (run.errors, run.nacks, run.restarts) == (13, 13, 1)


def test_a_bus_that_stays_low_is_counted_and_left_when_it_is_free(bench: Path) -> None:
    run = simulate(bench, STUCK_AT_US=20_000, STUCK_CLOCKS=60)
    check_samples(run, missing=2)
    assert run.errors == run.stuck_buses + 1 == 7
    run = simulate(bench, STUCK_AT_US=20_000, STUCK_CLOCKS=100_000)
    assert len(run.samples) == 3
    assert run.failed
    assert not run.running
    assert run.restarts == 1


def test_sda_held_within_a_transfer_to_its_end_spoils_no_sample(bench: Path) -> None:
    run = simulate(bench, STUCK_AT_US=20_000, STUCK_CLOCKS=150, STUCK_MIDWAY=1)
    check_samples(run, missing=3)
    assert run.errors > 0


@pytest.mark.parametrize(("stretch_us", "timeouts"), [(900, 1), (8_000, 8)])
def test_a_clock_that_is_held_too_long_is_a_timeout(
    bench: Path, stretch_us: int, timeouts: int
) -> None:
    run = simulate(bench, STRETCH_AT=80, STRETCH_US=stretch_us)
    check_samples(run, missing=6)
    assert run.timeouts == timeouts == run.errors
    assert run.restarts == 0


@pytest.mark.parametrize("identity", [0x12, 0xFF, 0x00])
def test_an_unknown_part_is_refused(bench: Path, identity: int) -> None:
    run = simulate(bench, run_us=20_000, IDENTITY=identity)
    assert not run.samples
    assert (run.failed, run.running, run.identity) == (1, 0, identity)


@pytest.mark.parametrize("identity", [0x98, 0x72])
def test_a_variant_is_accepted(bench: Path, identity: int) -> None:
    run = simulate(bench, run_us=30_000, IDENTITY=identity)
    check_samples(run, missing=0)
    assert run.identity == identity
    assert run.restarts == 0


@pytest.mark.parametrize(
    ("register", "bits", "lost"),
    [(0x1B, 0x10, 2), (0x19, 0x80, 2), (0x6B, 0x40, 1), (0x38, 0x01, 1), (0x37, 0x20, 2)],
    ids=hex,
)
def test_a_register_that_changes_is_noticed(
    bench: Path, register: int, bits: int, lost: int
) -> None:
    run = simulate(bench, UPSET_AT_US=20_000, UPSET_REGISTER=register, UPSET_BITS=bits)
    check_samples(run, missing=lost)
    assert run.restarts == 1
    assert run.errors == 0
    if register in (0x19, 0x1B):
        # These give the counts their meaning: none is passed on until it is set up anew.
        assert not [s for s in run.samples if 20_000 <= s.time_us < 27_000]


def test_an_axis_in_standby_is_noticed_within_a_round_of_the_registers(bench: Path) -> None:
    run = simulate(bench, UPSET_AT_US=20_000, UPSET_REGISTER=0x6C, UPSET_BITS=0x20)
    assert run.restarts == 1
    spoilt = [sample for sample in run.samples if sample.counts not in ROWS]
    assert len(spoilt) <= 11
    assert all(s.counts[1:] in [row[1:] for row in ROWS] for s in spoilt)
    assert run.samples[-1].counts in ROWS


@pytest.mark.parametrize("at_us", [20_000, 20_500, 21_200])
def test_a_sensor_that_resets_itself_is_set_up_anew(bench: Path, at_us: int) -> None:
    run = simulate(bench, SELF_RESET_AT_US=at_us)
    check_samples(run, missing=2)
    assert run.restarts == 1
    assert len(run.samples) > 12


def test_without_int_the_sensor_is_polled(bench: Path) -> None:
    run = simulate(bench, MUTE_AT_US=20_000, MUTE_SAMPLES=8)
    check_samples(run, missing=4, late_us=9 * PERIOD_US)
    assert (run.errors, run.restarts) == (0, 0)
    times = [sample.time_us for sample in run.samples]
    assert max(b - a for a, b in pairwise(times)) < 2.5 * PERIOD_US


def test_a_frozen_sensor_is_restarted(bench: Path) -> None:
    run = simulate(bench, run_us=120_000, FROZEN_AT_US=17_000)
    assert run.restarts == 1
    repeated = [a.counts == b.counts for a, b in pairwise(run.samples)]
    assert sum(repeated) == 49
    assert not any(repeated[-5:])


@pytest.mark.parametrize("at_us", range(19_700, 20_700, 330))
def test_a_reset_of_the_driver_in_the_middle_of_a_burst(bench: Path, at_us: int) -> None:
    run = simulate(bench, RESET_AT_US=at_us)
    lines = played(run)
    assert lines == sorted(set(lines))
    fresh = [sample.sequence for sample in run.samples].index(0, 1)
    assert [s.sequence for s in run.samples[fresh:]] == list(range(len(run.samples) - fresh))
    assert run.running
    assert run.restarts == 0


@pytest.mark.parametrize("stall", [3_000, 20_000])
def test_a_slow_consumer_loses_samples_but_gets_no_other(bench: Path, stall: int) -> None:
    run = simulate(bench, STALL=stall)
    lines = played(run)
    assert lines == [sample.sequence for sample in run.samples]
    assert lines == sorted(set(lines))
    assert run.lost_samples > 0
    taken_or_lost = len(lines) + run.lost_samples
    assert run.rows_played - 2 <= taken_or_lost <= run.rows_played


@pytest.mark.usefixtures("ghdl_installed")
def test_counters_stop_and_numbers_go_on_beyond_16_bits(tmp_path: Path) -> None:
    source = template_root("fpga") / "sensor" / "hk_event_counters.vhd"
    assert run_counters(tmp_path, source) == ""
    broken = tmp_path / source.name
    broken.write_text(source.read_text().replace("number or not sum(16)", "'1'"))
    assert "a counter is wrong" in run_counters(tmp_path, broken)
