"""The bench of a whole FPGA system in GHDL: from a table of counts to the bytes of its link."""

import subprocess
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from hostkit.emulation.ghdl import OPTIMISE, STANDARD
from hostkit.emulation.tools import require
from hostkit.errors import BuildError, EmulationError
from hostkit.records import read_only

IntArray = NDArray[np.int64]

BENCH = "hk_system_tb"
BUILD = "build-system"
"""Folder below the generated one that holds GHDL's library and the elaborated bench."""

DRAIN_US = 4000
"""After the last row: reading it, the filter, and a state, a heartbeat and a sample on the line."""

BUILD_TIMEOUT_S = 300.0
RUN_TIMEOUT_S = 120.0
LIMIT_US = 800_000
LIMIT_ROW_US = 4000
"""The bench ends after so long, the first divided, even if the sensor was never read."""
SAMPLE_TIMEOUT_S = 2.0
"""Added to the run's limit for every sample; GHDL takes about a twentieth of it."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SystemTiming:
    """How fast the simulated system runs.

    Attributes
    ----------
    clock_hz, baud
        Its clock and its link; a slow clock and a fast link make few clocks of a sample.
    time_divisor
        So much shorter are the waits of the sensor and of its driver, the time between two samples
        and that between two heartbeats.
    """

    clock_hz: int = 4_000_000
    baud: int = 1_000_000
    time_divisor: int = 1


@dataclass(frozen=True, slots=True, kw_only=True)
class SystemRun:
    """What came over the link.

    Attributes
    ----------
    stream
        Every byte.
    time_us
        When each had come whole, microseconds since the reset.
    """

    stream: bytes
    time_us: IntArray

    def __post_init__(self) -> None:
        """Make the array read-only."""
        read_only(self.time_us)


def build_system(folder: Path) -> None:
    """Analyse a generated folder and elaborate the bench of its system.

    Raises
    ------
    BuildError
        If there is no system in it, or GHDL refuses a source.
    ToolMissingError
        If GHDL is not installed.
    """
    require("ghdl")
    folder = folder.resolve()
    sources = sorted(path.name for path in folder.glob("*.vhd"))
    if f"{BENCH}.vhd" not in sources:
        raise BuildError(f"{folder} holds no {BENCH}.vhd; generate it for an FPGA target first")
    build = folder / BUILD
    build.mkdir(exist_ok=True)
    _ghdl(build, "-i", STANDARD, *(f"../{name}" for name in sources))
    _ghdl(build, "-m", STANDARD, OPTIMISE, BENCH)


def run_system(
    folder: Path,
    table: IntArray,
    timing: SystemTiming,
    generics: tuple[tuple[str, str], ...] = (),
) -> SystemRun:
    """Play a table of counts through the system of a folder.

    Parameters
    ----------
    folder
        Folder on which :func:`build_system` has been called.
    table
        Counts: specific force, angular rate, temperature, shape ``(N, 7)``.
    generics
        Further generics of the bench and their values.

    Raises
    ------
    EmulationError
        If the simulation fails, hangs, or writes anything odd.
    BuildError
        If the folder has not been built.
    ToolMissingError
        If GHDL is not installed.
    """
    require("ghdl")
    build = folder.resolve() / BUILD
    if not build.is_dir():
        raise BuildError(f"the system in {folder} has not been built yet")
    with tempfile.TemporaryDirectory(prefix="hostkit-ghdl-") as name:
        counts, heard = Path(name) / "counts.txt", Path(name) / "bytes.txt"
        counts.write_text(_table_text(table), encoding="ascii")
        wanted = {
            "COUNT_FILE": counts,
            "RESULT_FILE": heard,
            "CLOCK_HZ": timing.clock_hz,
            "BAUD": timing.baud,
            "TIME_DIVISOR": timing.time_divisor,
            "ROWS": len(table),
            "DRAIN_US": DRAIN_US,
            "LIMIT_US": LIMIT_US // timing.time_divisor + LIMIT_ROW_US * len(table),
        } | dict(generics)
        _run(build, [f"-g{key}={value}" for key, value in wanted.items()], len(table))
        return _parsed(heard)


def _table_text(table: IntArray) -> str:
    outside = (table < -(2**15)) | (table >= 2**15)
    if outside.any():
        raise EmulationError(f"count {table[outside][0]} does not fit 16 bits")
    return "".join(" ".join(f"{word:04x}" for word in row) + "\n" for row in (table & 0xFFFF))


def _run(build: Path, generics: list[str], samples: int) -> None:
    limit_s = RUN_TIMEOUT_S + SAMPLE_TIMEOUT_S * samples
    options = ("--ieee-asserts=disable-at-0", "--assert-level=error")
    try:
        done = subprocess.run(
            ["ghdl", "-r", STANDARD, BENCH, *generics, *options],
            cwd=build,
            capture_output=True,
            text=True,
            errors="replace",
            timeout=limit_s,
            check=False,
        )
    except subprocess.TimeoutExpired as error:
        raise EmulationError(f"the simulation did not end within {limit_s:g} s") from error
    if done.returncode != 0:
        raise EmulationError(f"the simulation failed: {_complaint(done.stdout + done.stderr)}")


def _ghdl(build: Path, *arguments: str) -> None:
    try:
        done = subprocess.run(
            ["ghdl", *arguments],
            cwd=build,
            capture_output=True,
            text=True,
            errors="replace",
            timeout=BUILD_TIMEOUT_S,
            check=False,
        )
    except subprocess.TimeoutExpired as error:
        message = f"ghdl {arguments[0]} did not end within {BUILD_TIMEOUT_S:g} s in {build}"
        raise BuildError(message) from error
    if done.returncode != 0:
        raise BuildError(f"ghdl {arguments[0]} failed in {build}: {_complaint(done.stderr)}")


def _complaint(output: str) -> str:
    lines = [line.strip() for line in output.splitlines() if line.strip()]
    telling = [line for line in lines if "failure" in line or ":error:" in line]
    return next(iter(telling + lines), "it gave no reason")


def _parsed(heard: Path) -> SystemRun:
    try:
        rows = [line.split() for line in heard.read_text(encoding="ascii").splitlines()]
        stream = bytes(int(value, 16) for _, value in rows)
        time_us = np.array([int(time) for time, _ in rows], dtype=np.int64)
    except (OSError, ValueError) as error:
        raise EmulationError(f"the simulation wrote no bytes that can be read: {error}") from error
    return SystemRun(stream=stream, time_us=time_us)
