"""A recording that does not fit the memory: `hostkit tune` on it, from end to end."""

import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from benchmarks.large_file import write_large
from benchmarks.table import Table, figure
from benchmarks.timing import seconds
from hostkit.cli.inputs import say
from hostkit.errors import HostkitError
from hostkit.recordings import open_large
from hostkit.tuning import TuningOptions
from hostkit.tuning.complementary import tuning_problem

CHOICE = "HOSTKIT_BENCH_SAMPLES"
"""Environment variable: how many samples."""

SAMPLES = 100_000_000
BYTES_PER_SAMPLE, SPOOLED_BYTES = 40, 16
"""Of the file, and of what is laid out beside it."""

SPARE_BYTES = 2 << 30
READ_BYTES = 1 << 20
PARTICLES = 20
LIMIT_BYTES = 1 << 30
"""What a tuning may take."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ChildRun:
    """What a command took."""

    seconds: float
    peak_bytes: int
    exit_code: int


def tables() -> Iterator[Table]:
    """Measure a large recording, where the disk has room for it."""
    samples = wanted_samples(os.environ.get(CHOICE, ""))
    with tempfile.TemporaryDirectory(prefix="hostkit-bench-") as folder:
        missing = missing_bytes(samples, shutil.disk_usage(folder).free)
        if missing > 0:
            say(f"large: skipped; the disk lacks {missing / 1e9:.1f} GB; set {CHOICE} to less")
            return
        size = samples * BYTES_PER_SAMPLE
        say(f"large: writes {samples:.0e} samples, {size / 1e9:.1f} GB, to a temporary folder")
        yield _table(Path(folder), samples)


def wanted_samples(text: str) -> int:
    """Return how many samples the environment asks for.

    Raises
    ------
    HostkitError
        If it is no number, or too small to be read part by part.
    """
    try:
        samples = int(float(text)) if text else SAMPLES
    except ValueError:
        raise HostkitError(f"{CHOICE} = {text!r} is no number of samples, such as 1e7") from None
    if samples < 2_000_000:
        raise HostkitError(f"{CHOICE} = {samples}: below 2e6 samples a recording is read whole")
    return samples


def missing_bytes(samples: int, free_bytes: int) -> int:
    """Return how much room the disk lacks, 0 or less where it has enough."""
    return samples * (BYTES_PER_SAMPLE + SPOOLED_BYTES) + SPARE_BYTES - free_bytes


def _table(folder: Path, samples: int) -> Table:
    path = folder / "large.npz"
    write_large(path, samples)
    reading_s = seconds(lambda: _read(path))
    command = (sys.executable, "-m", "hostkit", "tune", str(path), "--axes", "roll")
    run = measured((*command, "-o", str(folder / "design.json")))
    if run.exit_code != 0:
        raise HostkitError(f"hostkit tune ended with exit code {run.exit_code}")
    pass_s = _pass_s(path, folder)
    rows = (
        ("file, GB", figure(path.stat().st_size / 1e9)),
        ("peak memory of hostkit tune, MiB", figure(run.peak_bytes / 2**20)),
        ("below 1 GiB", "yes" if run.peak_bytes < LIMIT_BYTES else "no"),
        ("time of hostkit tune / reading the file once", figure(run.seconds / reading_s)),
        ("time of hostkit tune, s", figure(run.seconds)),
        (f"one pass of {PARTICLES} particles over the streams on disk, s", figure(pass_s)),
        ("the same, ns per particle-sample", figure(1e9 * pass_s / samples / PARTICLES)),
        ("the same / reading the file once", figure(pass_s / reading_s)),
    )
    return Table(
        title=f"Large recording: {samples:.0e} samples, hostkit tune --axes roll with its defaults",
        columns=("figure", "value"),
        rows=rows,
        remarks=("The file was written just before, so parts of it may come from memory.",),
    )


def measured(command: tuple[str, ...]) -> ChildRun:
    """Run a command in a child of a small process of its own."""
    script = str(Path(__file__).with_name("child.py"))
    text = subprocess.run(
        (sys.executable, script, *command), check=True, stdout=subprocess.PIPE, text=True
    ).stdout
    spent, peak, code = text.split()
    return ChildRun(seconds=float(spent), peak_bytes=int(peak), exit_code=int(code))


def _read(path: Path) -> None:
    with path.open("rb", buffering=0) as stream:
        while stream.read(READ_BYTES):
            pass


def _pass_s(path: Path, folder: Path) -> float:
    """Return the shortest of three passes of the kernel over the streams laid out on disk."""
    recording = open_large(path)
    assert recording is not None
    laid_out = folder / "streams"
    laid_out.mkdir()
    one = tuning_problem((recording,), TuningOptions(axes="roll"), laid_out)
    points = np.linspace(one.space.lower, one.space.upper, PARTICLES)
    return min(seconds(lambda: one.cost(points)) for _ in range(3))
