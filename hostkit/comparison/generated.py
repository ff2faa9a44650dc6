"""The generated C of a design, built for this machine to be timed."""

import ctypes
import shutil
import subprocess
from collections.abc import Callable
from dataclasses import dataclass
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Final

import numpy as np

from hostkit.errors import BuildError, ToolMissingError
from hostkit.records import FilterDesign, GeneratedFile
from hostkit.render import FirmwareOptions, generate
from hostkit.render.options import Arithmetic
from hostkit.sensors.counts import Counts
from hostkit.targets import TARGETS

DRIVER: Final = Path(__file__).with_name("update_cost.c")
COMPILERS: Final = ("cc", "gcc", "clang")
FLAGS: Final = ("-O2", "-std=c99", "-ffp-contract=off", "-fPIC", "-shared")
"""Optimisation and arithmetic as in the Makefile of the host target; no code for this very
processor."""
FILTER_FILES: Final = ("hk_filter*.c", "hk_arctan.c", "hk_fixed.c", "hk_units.c")
BUILD_TIMEOUT_S: Final = 60


@dataclass(frozen=True, slots=True, kw_only=True)
class GeneratedFilter:
    """The compiled filter and the counts that it is run on.

    Attributes
    ----------
    accel_count, gyro_count
        16-bit counts, shape ``(N, 3)``.
    """

    library: ctypes.CDLL
    accel_count: np.ndarray[tuple[int, ...], np.dtype[np.int16]]
    gyro_count: np.ndarray[tuple[int, ...], np.dtype[np.int16]]

    def updates(self) -> Callable[[], object]:
        """Return what runs every update, and no angle but the last."""
        return self._action("hk_run_updates")

    def updates_and_angles(self) -> Callable[[], object]:
        """Return what runs every update and computes the angles of each sample."""
        return self._action("hk_run_angles")

    def _action(self, name: str) -> Callable[[], object]:
        function = getattr(self.library, name)
        arguments = (
            ctypes.c_void_p(self.accel_count.ctypes.data),
            ctypes.c_void_p(self.gyro_count.ctypes.data),
            ctypes.c_long(len(self.accel_count)),
        )
        return lambda: function(*arguments)


def generated_filter(
    design: FilterDesign, arithmetic: Arithmetic, counts: Counts, folder: Path
) -> GeneratedFilter:
    """Render the C of a design for the host and build its filter alone.

    Parameters
    ----------
    folder
        Empty or missing; it must stay as long as the filter is used.

    Raises
    ------
    BuildError
        If it does not compile; the message is the compiler's first error.
    RenderError
        If the filter has no C in that arithmetic.
    ToolMissingError
        If there is no C compiler.
    """
    compiler = next((found for name in COMPILERS if (found := shutil.which(name))), None)
    if compiler is None:
        raise ToolMissingError(
            f"no C compiler to time the generated code with; one of {', '.join(COMPILERS)}: "
            "sudo apt-get install gcc"
        )
    _write(generate(design, TARGETS["host"], FirmwareOptions(arithmetic=arithmetic)), folder)
    return GeneratedFilter(
        library=_build(compiler, folder),
        accel_count=np.ascontiguousarray(counts.accel, dtype=np.int16),
        gyro_count=np.ascontiguousarray(counts.gyro, dtype=np.int16),
    )


def _write(files: tuple[GeneratedFile, ...], folder: Path) -> None:
    """Write what the filter alone is built from."""
    folder.mkdir(parents=True, exist_ok=True)
    for file in files:
        if any(fnmatchcase(file.path, pattern) for pattern in (*FILTER_FILES, "hk_*.h")):
            (folder / file.path).write_text(file.content, encoding="utf-8")


def _build(compiler: str, folder: Path) -> ctypes.CDLL:
    sources = sorted(path for pattern in FILTER_FILES for path in folder.glob(pattern))
    library = folder / "update_cost.so"
    command = [compiler, *FLAGS, "-I", str(folder), "-o", str(library)]
    try:
        done = subprocess.run(
            [*command, str(DRIVER), *map(str, sources), "-lm"],
            capture_output=True,
            text=True,
            errors="replace",
            timeout=BUILD_TIMEOUT_S,
            check=False,
        )
    except subprocess.TimeoutExpired as error:
        raise BuildError(f"{compiler} did not end within {BUILD_TIMEOUT_S} s") from error
    if done.returncode != 0:
        wrong = [line for line in done.stderr.splitlines() if "error" in line]
        raise BuildError(f"the filter does not compile: {(wrong or ['without a reason'])[0]}")
    try:
        return ctypes.CDLL(str(library))
    except OSError as error:
        raise BuildError(f"the filter alone cannot be loaded: {error}") from error
