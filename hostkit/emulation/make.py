"""Building a generated folder with its Makefile."""

import os
import re
import subprocess
from pathlib import Path

from hostkit.errors import BuildError

TIMEOUT_S = 300.0
_ERROR = re.compile(r"\berror:|undefined reference|cannot find|overflowed")


def make(folder: Path, *variables: str) -> str:
    """Run make in a folder and return what it printed.

    Raises
    ------
    BuildError
        With the first line in which the compiler names an error.
    """
    if not (folder / "Makefile").is_file():
        raise BuildError(f"{folder} holds no Makefile; generate it for a microcontroller first")
    try:
        done = subprocess.run(
            ["make", "-C", str(folder), "--no-print-directory", *variables],
            capture_output=True,
            text=True,
            errors="replace",
            timeout=TIMEOUT_S,
            check=False,
            env=_environment(),
        )
    except subprocess.TimeoutExpired as error:
        raise BuildError(f"make did not end within {TIMEOUT_S:g} s in {folder}") from error
    if done.returncode != 0:
        raise BuildError(f"make failed in {folder}: {_first_error(done.stderr or done.stdout)}")
    return done.stdout


def _environment() -> dict[str, str]:
    """Return ours without what a make that runs us would pass on to a make below it."""
    inherited = {k: v for k, v in os.environ.items() if not k.startswith(("MAKE", "MFLAGS"))}
    return {**inherited, "LC_ALL": "C"}


def _first_error(output: str) -> str:
    lines = [line.strip() for line in output.splitlines() if line.strip()]
    named = [line for line in lines if _ERROR.search(line)]
    return (named or lines or ["it gave no reason"])[0]
