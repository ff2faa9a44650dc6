"""Runs the VHDL driver of the sensor against its simulated sensor, in GHDL."""

import random
import subprocess
from dataclasses import dataclass
from pathlib import Path

from designs import design

from hostkit.render import render_target, write
from hostkit.targets import TARGETS

BENCHES = Path(__file__).parent / "benches"
STANDARD = "--std=93c"
RATE_HZ = 20.0
SOURCES = (
    "hk_i2c_pkg.vhd",
    "hk_i2c_master.vhd",
    "hk_event_counters.vhd",
    "hk_mpu6050_pkg.vhd",
    "hk_mpu6050.vhd",
    "hk_mpu6050_model.vhd",
)
ROWS = 150

Row = tuple[int, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class Sample:
    """What came out: accelerometer, temperature, gyroscope."""

    time_us: int
    sequence: int
    counts: Row


@dataclass(frozen=True, slots=True, kw_only=True)
class SensorRun:
    """A simulation: when INT rose, the samples, and how the driver stood at the end."""

    announced_us: tuple[int, ...]
    samples: tuple[Sample, ...]
    errors: int
    nacks: int
    timeouts: int
    stuck_buses: int
    restarts: int
    lost_samples: int
    running: int
    failed: int
    identity: int
    rows_played: int


def sensor_rows(seed: int = 1) -> tuple[Row, ...]:
    """Return counts as the file has them: accelerometer, gyroscope, temperature."""
    rng = random.Random(seed)
    return tuple(tuple(rng.randrange(-(2**15), 2**15) for _ in range(7)) for _ in range(ROWS))


def in_order_of_the_bench(row: Row) -> Row:
    return (*row[:3], row[6], *row[3:6])


def build_sensor(folder: Path, *, change: tuple[str, str, str] | None = None) -> Path:
    """Build the bench; `change` is a file, a text in it, and what stands there instead."""
    write(render_target(design(rate_hz=RATE_HZ), TARGETS["spartan3adsp"]), folder)
    if change is not None:
        name, good, bad = change
        text = (folder / name).read_text(encoding="ascii")
        assert good in text
        (folder / name).write_text(text.replace(good, bad), encoding="ascii")
    lines = (" ".join(f"{v & 0xFFFF:04x}" for v in row) for row in sensor_rows())
    (folder / "counts.txt").write_text("\n".join(lines) + "\n", encoding="ascii")
    sources = [*(folder / name for name in SOURCES), BENCHES / "hk_mpu6050_bench.vhd"]
    for command in (["-a", "-O2", *map(str, sources)], ["-e", "-O2", "hk_mpu6050_bench"]):
        subprocess.run(["ghdl", command[0], STANDARD, *command[1:]], cwd=folder, check=True)
    return folder


def simulate(folder: Path, *, run_us: int = 60_000, **generics: int) -> SensorRun:
    """Run the bench with some of its generics; a failed assertion of the model is one here."""
    generics["RUN_US"] = run_us
    done = subprocess.run(
        [
            *("ghdl", "-r", STANDARD, "hk_mpu6050_bench"),
            *("--ieee-asserts=disable-at-0", f"--stop-time={run_us + 20}us"),
            *(f"-g{name}={value}" for name, value in generics.items()),
        ],
        cwd=folder,
        capture_output=True,
        text=True,
        check=False,
        timeout=300,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return _read((folder / "results.txt").read_text(encoding="ascii"))


def _read(text: str) -> SensorRun:
    lines = [(line[0], tuple(map(int, line[1:].split()))) for line in text.splitlines()]
    ends = [numbers for kind, numbers in lines if kind == "E"]
    assert len(ends) == 1
    return SensorRun(
        announced_us=tuple(numbers[0] for kind, numbers in lines if kind == "I"),
        samples=tuple(
            Sample(time_us=numbers[0], sequence=numbers[1], counts=numbers[2:])
            for kind, numbers in lines
            if kind == "S"
        ),
        errors=ends[0][1],
        nacks=ends[0][2],
        timeouts=ends[0][3],
        stuck_buses=ends[0][4],
        restarts=ends[0][5],
        lost_samples=ends[0][6],
        running=ends[0][7],
        failed=ends[0][8],
        identity=ends[0][9],
        rows_played=ends[0][10],
    )


def run_counters(folder: Path, source: Path) -> str:
    """Run the bench of the counters; return what it complained of."""
    bench = BENCHES / "hk_event_counters_bench.vhd"
    for command in (["-a", "-O2", str(source), str(bench)], ["-e", "-O2", bench.stem]):
        subprocess.run(["ghdl", command[0], STANDARD, *command[1:]], cwd=folder, check=True)
    done = subprocess.run(
        ["ghdl", "-r", STANDARD, bench.stem, "--ieee-asserts=disable"],
        cwd=folder,
        capture_output=True,
        text=True,
        check=False,
        timeout=300,
    )
    return done.stdout + done.stderr
