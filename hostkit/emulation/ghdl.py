"""The VHDL core in GHDL: analyse the generated sources, run their bench, read what it wrote."""

import re
import subprocess
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from hostkit.emulation.tools import require
from hostkit.errors import BuildError, EmulationError
from hostkit.fixedpoint import wrap32
from hostkit.records import Axis, read_only
from hostkit.spec import FixedPointSpec

BENCH = "hk_complementary_tb"
BUILD = "build"
"""Folder below the generated one that holds GHDL's library and the elaborated bench."""

STANDARD = "--std=93c"
OPTIMISE = "-O2"
TOOL_TIMEOUT_S = 120.0
RUN_TIMEOUT_S = 60.0
SAMPLE_TIMEOUT_S = 0.1
"""Added to the run's limit for every sample; GHDL takes about a millisecond."""
POLL_S = 0.1

_UNIT = re.compile(r"^(?:entity|package) (\w+)$", re.MULTILINE)
_DIGEST = re.compile(r"[0-9a-f]{12}")
_RESULT = re.compile(r"((?:[0-9a-f]{8} ){4})([01]) (\d+)")

COLUMN: dict[Axis, int] = {"roll": 0, "pitch": 1}

IntArray = NDArray[np.int64]


@dataclass(frozen=True, slots=True, kw_only=True)
class HdlRun:
    """What the simulated core answered.

    Attributes
    ----------
    design_digest
        The design that is compiled into the core.
    angle_raw
        Roll and pitch in half turns, shape ``(N, 2)``; an axis that the design lacks is 0.
    hidden_raw
        The hidden word of each of them, shape ``(N, 2)``; 0 where the design has none.
    restarted
        True where the core loaded the measured tilt instead of stepping, shape ``(N,)``.
    latency_cycles
        Clocks from taking a sample to offering its angles, shape ``(N,)``.
    """

    design_digest: str
    angle_raw: IntArray
    hidden_raw: IntArray
    restarted: NDArray[np.bool_]
    latency_cycles: IntArray

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        for array in (self.angle_raw, self.hidden_raw, self.restarted, self.latency_cycles):
            read_only(array)

    def state_raw(self, spec: FixedPointSpec) -> IntArray:
        """Return the states as the integer model of a design has them, shape ``(N, S)``."""
        columns = [COLUMN[axis] for axis in spec.axes]
        words = (self.angle_raw[:, columns], self.hidden_raw[:, columns])
        return np.hstack(words)[:, : len(spec.axes) + len(spec.hidden)]


def analyse(folder: Path) -> tuple[str, ...]:
    """Analyse the VHDL sources of a generated folder and elaborate their bench.

    GHDL itself finds the order in which the sources need each other. What it makes goes to
    ``folder/build``.

    Parameters
    ----------
    folder
        Folder that `hostkit generate` wrote for an FPGA target.

    Returns
    -------
    tuple of str
        Names of the packages and entities analysed, sorted.

    Raises
    ------
    BuildError
        If there is no source, or GHDL refuses one; its first error is the message.
    ToolMissingError
        If GHDL is not installed.
    """
    require("ghdl")
    folder = folder.resolve()
    build = folder / BUILD
    sources = sorted(p for p in folder.rglob("*.vhd") if build not in p.parents)
    if not sources:
        raise BuildError(f"{folder} holds no VHDL source; generate it for an FPGA target first")
    build.mkdir(exist_ok=True)
    for library in build.glob("*.cf"):
        library.unlink()
    names = [source.relative_to(folder).as_posix() for source in sources]
    library_option = f"--workdir={BUILD}"
    _ghdl(folder, "-i", STANDARD, library_option, *names)
    order = _ghdl(folder, "--elab-order", STANDARD, library_option, BENCH).splitlines()
    _ghdl(folder, "-a", STANDARD, OPTIMISE, library_option, *order)
    _ghdl(build, "-e", STANDARD, OPTIMISE, BENCH)
    return tuple(sorted(_UNIT.findall(_ghdl(folder, "--dir", STANDARD, library_option))))


def simulate(
    folder: Path,
    accel_count: IntArray,
    gyro_count: IntArray,
    *,
    random_stalls: bool = False,
    abandon_clocks: int = 0,
    progress: Callable[[int], None] | None = None,
) -> HdlRun:
    """Run the analysed core on counts.

    Parameters
    ----------
    folder
        Folder on which :func:`analyse` has been called.
    accel_count, gyro_count
        Counts in sensor axes, each of shape ``(N, 3)``, within 16 bits.
    random_stalls
        Offer samples and take results with random gaps; inputs are unknown in the gaps.
    abandon_clocks
        If not 0, start a sample that does not count first, and reset the core this many clocks
        later.
    progress
        Called now and then with the number of samples done.

    Raises
    ------
    EmulationError
        If a count leaves 16 bits, or the simulation fails, hangs, or writes anything odd.
    BuildError
        If the folder has not been analysed.
    ToolMissingError
        If GHDL is not installed.
    """
    require("ghdl")
    build = folder.resolve() / BUILD
    if not build.is_dir():
        raise BuildError(f"{folder} has not been analysed yet")
    samples = len(accel_count)
    with tempfile.TemporaryDirectory(prefix="hostkit-ghdl-") as name:
        vectors, results = Path(name) / "vectors.txt", Path(name) / "results.txt"
        vectors.write_text(_vector_text(accel_count, gyro_count), encoding="ascii")
        command = [
            *("ghdl", "-r", STANDARD, BENCH),
            *(f"-gVECTOR_FILE={vectors}", f"-gRESULT_FILE={results}"),
            *(
                f"-gRANDOM_STALLS={str(random_stalls).lower()}",
                f"-gABANDON_CLOCKS={abandon_clocks}",
            ),
            "--ieee-asserts=disable-at-0",
            "--assert-level=warning",
        ]
        limit_s = RUN_TIMEOUT_S + SAMPLE_TIMEOUT_S * samples
        _run_bench(command, build, results, progress or _ignore, limit_s)
        return _parsed(results, samples)


def _ignore(_done: int) -> None:
    """Take no notice of progress."""


def _ghdl(cwd: Path, *arguments: str) -> str:
    """Run GHDL to its end and return what it printed."""
    try:
        done = subprocess.run(
            ["ghdl", *arguments],
            cwd=cwd,
            capture_output=True,
            text=True,
            errors="replace",
            timeout=TOOL_TIMEOUT_S,
            check=False,
        )
    except subprocess.TimeoutExpired as error:
        message = f"ghdl {arguments[0]} did not end within {TOOL_TIMEOUT_S:g} s in {cwd}"
        raise BuildError(message) from error
    if done.returncode != 0:
        raise BuildError(f"ghdl {arguments[0]} failed in {cwd}: {_first_error(done.stderr)}")
    return done.stdout


def _first_error(output: str) -> str:
    lines = [
        line.strip() for line in output.splitlines() if line.strip() and ":warning:" not in line
    ]
    return lines[0] if lines else "it gave no reason"


def _vector_text(accel_count: IntArray, gyro_count: IntArray) -> str:
    counts = np.concatenate([accel_count, gyro_count], axis=1)
    outside = (counts < -(2**15)) | (counts >= 2**15)
    if outside.any():
        raise EmulationError(f"count {counts[outside][0]} does not fit 16 bits")
    words = (counts & 0xFFFF).tolist()
    return "".join(" ".join(f"{word:04x}" for word in row) + "\n" for row in words)


def _run_bench(
    command: list[str],
    cwd: Path,
    results: Path,
    progress: Callable[[int], None],
    limit_s: float,
) -> None:
    """Run the bench, reporting the lines it has written until it ends."""
    end = time.monotonic() + limit_s
    with (
        tempfile.TemporaryFile("w+", encoding="utf-8", errors="replace") as output,
        subprocess.Popen(command, cwd=cwd, stdout=output, stderr=subprocess.STDOUT) as process,
    ):
        try:
            while _still_runs(process):
                if time.monotonic() > end:
                    raise EmulationError(f"the simulation did not end within {limit_s:g} s")
                progress(_samples_written(results))
        finally:
            process.kill()
        output.seek(0)
        if process.returncode != 0:
            raise EmulationError(f"the simulation failed: {_first_error(output.read())}")


def _still_runs(process: subprocess.Popen[bytes]) -> bool:
    try:
        process.wait(POLL_S)
    except subprocess.TimeoutExpired:
        return True
    return False


def _samples_written(results: Path) -> int:
    try:
        return max(0, results.read_bytes().count(b"\n") - 1)
    except OSError:
        return 0


def _parsed(results: Path, samples: int) -> HdlRun:
    try:
        digest, *lines = results.read_text(encoding="ascii").splitlines()
    except (OSError, ValueError) as error:
        raise EmulationError(
            f"the simulation wrote no results that can be read: {error}"
        ) from error
    if not _DIGEST.fullmatch(digest):
        raise EmulationError(f"the simulation's results begin with {digest[:40]!r}, not a digest")
    if len(lines) != samples:
        raise EmulationError(f"the simulation wrote {len(lines)} results for {samples} samples")
    rows = np.array([_parsed_line(line) for line in lines], dtype=np.int64).reshape(-1, 6)
    return HdlRun(
        design_digest=digest,
        angle_raw=wrap32(rows[:, :2]),
        hidden_raw=wrap32(rows[:, 2:4]),
        restarted=rows[:, 4] == 1,
        latency_cycles=rows[:, 5].copy(),
    )


def _parsed_line(line: str) -> tuple[int, ...]:
    match = _RESULT.fullmatch(line)
    if match is None:
        raise EmulationError(f"the simulation wrote {line[:40]!r}, which is not a result")
    words, restarted, latency = match.groups()
    return (*(int(word, 16) for word in words.split()), int(restarted), int(latency))
