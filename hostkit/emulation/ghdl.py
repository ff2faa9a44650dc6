"""The VHDL core in GHDL: analyse the generated sources, run their bench, read what it wrote."""

import re
import subprocess
import tempfile
import time
from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np

from hostkit.emulation.hdl_vectors import (
    COLUMN,
    HdlRun,
    HdlSettings,
    IntArray,
    hdl_settings,
    parsed_results,
    vector_text,
)
from hostkit.emulation.tools import require
from hostkit.errors import BuildError, EmulationError

BENCH = "hk_filter_tb"
BUILD = "build"
"""Folder below the generated one that holds GHDL's library and the elaborated bench."""

STANDARD = "--std=93c"
OPTIMISE = "-O2"
TOOL_TIMEOUT_S = 120.0
RUN_TIMEOUT_S = 60.0
SAMPLE_TIMEOUT_S = 0.5
"""Added to the run's limit for every sample; GHDL takes 1 to 50 ms."""
POLL_S = 0.1

_UNIT = re.compile(r"^(?:entity|package) (\w+)$", re.MULTILINE)

__all__ = ["COLUMN", "HdlRun", "HdlSettings", "analyse", "hdl_settings", "simulate"]


def analyse(folder: Path, *, top: str | None = None) -> tuple[str, ...]:
    """Analyse the VHDL sources of a generated folder and elaborate their bench.

    GHDL itself finds the order in which the sources need each other. What it makes goes to
    ``folder/build``.

    Parameters
    ----------
    folder
        Folder that `hostkit generate` wrote for an FPGA target.
    top
        Entity that is analysed and elaborated, too: that of the board, with all it needs.

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
    tops = (BENCH,) if top is None else (BENCH, top)
    orders = [_ghdl(folder, "--elab-order", STANDARD, library_option, unit) for unit in tops]
    order = dict.fromkeys(line for text in orders for line in text.splitlines())
    _ghdl(folder, "-a", STANDARD, OPTIMISE, library_option, *order)
    for unit in tops:
        _ghdl(build, "-e", STANDARD, OPTIMISE, unit)
    return tuple(sorted(_UNIT.findall(_ghdl(folder, "--dir", STANDARD, library_option))))


def simulate(
    folder: Path,
    accel_count: IntArray,
    gyro_count: IntArray,
    *,
    channel: IntArray | None = None,
    channels: int | None = None,
    pipelined: bool | None = None,
    settings: Mapping[int, HdlSettings] | None = None,
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
    channel
        Channel of each sample, shape ``(N,)``; without it all are of channel 0.
    channels
        How many the core has; without it what it was generated for.
    pipelined
        Which core; without it the one that was generated for.
    settings
        Settings by the index of the first sample that they hold for; before the first of them the
        core has the design's.
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
        vectors.write_text(
            vector_text(
                np.zeros(samples, dtype=np.int64) if channel is None else channel,
                accel_count,
                gyro_count,
                settings or {},
            ),
            encoding="ascii",
        )
        command = [
            *("ghdl", "-r", STANDARD, BENCH),
            *(f"-gVECTOR_FILE={vectors}", f"-gRESULT_FILE={results}"),
            *(
                f"-gRANDOM_STALLS={str(random_stalls).lower()}",
                f"-gABANDON_CLOCKS={abandon_clocks}",
            ),
            *([] if channels is None else [f"-gCHANNELS={channels}"]),
            *([] if pipelined is None else [f"-gPIPELINED={str(pipelined).lower()}"]),
            # A pipeline computes with whatever stands at its inputs, unknown values included.
            f"--ieee-asserts={'disable' if pipelined else 'disable-at-0'}",
            "--assert-level=warning",
        ]
        limit_s = RUN_TIMEOUT_S + SAMPLE_TIMEOUT_S * samples
        _run_bench(command, build, results, progress or _ignore, limit_s)
        return parsed_results(results, samples)


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
