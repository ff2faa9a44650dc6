"""Building the image of a cross-compiled board, and measuring it."""

import subprocess
from pathlib import Path

from hostkit.emulation.board import BuildResult
from hostkit.emulation.make import make
from hostkit.emulation.tools import require
from hostkit.errors import BuildError

ELF = "firmware.elf"
SIZE_TIMEOUT_S = 20.0


def build_image(folder: Path, *, toolchain: str, image: str) -> BuildResult:
    """Build a generated folder and measure the image.

    Parameters
    ----------
    toolchain
        What the names of the compiler and its tools begin with.
    image
        What the Makefile builds, and what would be flashed.

    Raises
    ------
    BuildError
        If the code does not compile; the message is the compiler's first error.
    ToolMissingError
        If make or the compiler is not installed.
    """
    require("make", f"{toolchain}gcc")
    make(folder)
    flash, ram = _sizes(f"{toolchain}size", folder / ELF)
    return BuildResult(artifact=folder / image, flash_bytes=flash, ram_bytes=ram)


def _sizes(program: str, elf: Path) -> tuple[int, int]:
    """Return flash and static RAM of an image, as the toolchain's size program counts them."""
    done = subprocess.run(
        [program, str(elf)], capture_output=True, text=True, timeout=SIZE_TIMEOUT_S, check=False
    )
    try:
        text, data, bss = (int(word) for word in done.stdout.splitlines()[1].split()[:3])
    except (IndexError, ValueError) as error:
        raise BuildError(f"{program} cannot measure {elf}: {done.stderr.strip()}") from error
    return text + data, data + bss
