"""Checks of the blocks around the filter, short enough to be run on many faults."""

import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path

import numpy as np
from cocotb_run import run_bench
from designs import design
from formal.bounds import CASES
from formal.prove import Verdict, prove
from sensor_run import SOURCES, STANDARD, sensor_rows, simulate
from test_sensor_driver import ROWS, check_samples, played

from hostkit.emulation.fpga_system import timing_of
from hostkit.emulation.system_bench import SystemTiming, build_system, run_system
from hostkit.filters.complementary import lower, run_integer
from hostkit.link.frames.decoder import Decoder, trace_of
from hostkit.records import AXES
from hostkit.synthesis import convert
from hostkit.synthesis.convert import needed_sources

BENCHES = Path(__file__).parent / "benches"
DESIGNS = {"sensor": design(rate_hz=20.0), "system": design(rate_hz=25.0, accel_full_scale_g=4)}
BEAT_US = 1_000_000
RESTARTED, SATURATED = 1, 2


def verdict_of(
    folder: Path, work: Path, check: str, tight: dict[str, int] | None = None
) -> Verdict:
    """Decide on the properties of a block, with some of its bounds changed."""
    case = CASES[check]
    core = convert(folder, case.entity, case.generics).text
    return prove(
        core,
        check.replace(" ", "_"),
        work,
        case.bounds | (tight or {}),
        free_products=False,
        by_induction=case.by_induction,
    )


def proof(folder: Path, work: Path, check: str) -> None:
    """Expect that the properties of a block hold."""
    assert verdict_of(folder, work, check).proved


def bench(
    folder: Path,
    entity: str,
    name: str,
    work: Path,
    generics: dict[str, object],
    environment: dict[str, str],
) -> None:
    """Run a bench on what an entity needs, and nothing else of the folder."""
    few = work / "sources"
    few.mkdir(parents=True)
    for source in needed_sources(folder, entity):
        shutil.copy(folder / source, few)
    try:
        run_bench(
            few,
            entity,
            name,
            build=work,
            parameters=generics,
            environment=environment,
            ieee_asserts="disable",
        )
    except SystemExit as error:
        raise AssertionError(f"{name} fails") from error


def registers(folder: Path, work: Path) -> None:
    """Every check of the registers once, without gaps, over Wishbone."""
    shutil.copy(BENCHES / "hk_regs_bench.vhd", folder)
    chosen = {"DESIGN": "plain", "COCOTB_TEST_FILTER": "gaps=False"}
    bench(folder, "hk_regs_bench", "wishbone_bench", work, {"WISHBONE": "true"}, chosen)


def polar(folder: Path, work: Path) -> None:
    """Corners and a few more, one a clock."""
    chosen = {
        "PIPELINED": "true",
        "RANDOM_SAMPLES": "40",
        "LATENCIES": "67",
        "COCOTB_TEST_FILTER": "full_speed",
    }
    bench(folder, "hk_polar", "polar_bench", work, {"PIPELINED": "true", "ID_BITS": 6}, chosen)


def sensor(folder: Path, work: Path) -> None:
    """Play three short runs: faults of the bus, a register that changes, a slow consumer."""
    rows = (" ".join(f"{v & 0xFFFF:04x}" for v in row) for row in sensor_rows())
    (folder / "counts.txt").write_text("\n".join(rows) + "\n", encoding="ascii")
    sources = [*(folder / name for name in SOURCES), BENCHES / "hk_mpu6050_bench.vhd"]
    for command in (["-a", *map(str, sources)], ["-e", "hk_mpu6050_bench"]):
        subprocess.run(["ghdl", command[0], STANDARD, *command[1:]], cwd=folder, check=True)

    run = simulate(
        folder, run_us=26_000, NACK_AT=60, STRETCH_AT=80, STRETCH_US=200, TORN_AT_US=20_000
    )
    assert {sample.counts for sample in run.samples} <= set(ROWS)
    check_samples(run, missing=0)
    assert (run.errors, run.nacks, run.timeouts, run.restarts) == (2, 1, 0, 0)
    run = simulate(folder, run_us=36_000, UPSET_AT_US=20_000)
    check_samples(run, missing=2)
    assert run.restarts == 1
    run = simulate(folder, run_us=36_000, STALL=20_000)
    lines = played(run)
    assert lines == [sample.sequence for sample in run.samples]
    assert run.lost_samples > 0


def system(folder: Path, work: Path) -> None:
    """Play eight samples over a link that is too slow for them, then listen to heartbeats."""
    build_system(folder)
    built = DESIGNS["system"]
    timing = timing_of(built)
    slow = SystemTiming(baud=200_000, time_divisor=timing.time_divisor)
    table = np.zeros((8, 7), dtype=np.int64)
    table[:, 2] = 8192 + 31 * np.arange(8)
    table[:, 0] = 500 * np.arange(8)
    table[4:, 5] = 32767
    run = run_system(folder, table, slow, (("DRAIN_US", "80000"),))

    frames = Decoder().feed(run.stream)
    samples = [frame.message for frame in frames if frame.name == "TILT_SAMPLE"]
    trace = trace_of(frames, AXES[built.axes])
    assert len(samples) >= 3
    counts = np.hstack([trace.accel_count, trace.gyro_count])
    np.testing.assert_array_equal(counts, table[trace.sequence, :6])
    wanted = run_integer(lower(built), trace.accel_count, trace.gyro_count)
    np.testing.assert_array_equal(trace.state_raw, wanted)
    flags = [SATURATED * int(number >= 4) for number in trace.sequence]
    flags[0] |= RESTARTED
    assert [message.flags for message in samples] == flags

    period_us = BEAT_US / timing.time_divisor
    decoder = Decoder()
    beats = [
        int(time)
        for byte, time in zip(run.stream, run.time_us.tolist(), strict=True)
        for frame in decoder.feed(bytes([byte]))
        if frame.name == "HEARTBEAT"
    ]
    assert len(beats) >= 4
    assert abs(beats[-1] - beats[-2] - period_us) < period_us / 50


CHECKS: dict[str, Callable[[Path, Path], None]] = {
    "registers": registers,
    "polar": polar,
    "sensor": sensor,
    "system": system,
}
