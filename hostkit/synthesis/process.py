"""Runs one of the tools to its end and says in one line why it failed."""

import re
import subprocess
from collections.abc import Sequence
from pathlib import Path

from hostkit.errors import BuildError

_PLACE = re.compile(r"\.\w+:\d+:")
_NOISE = (":warning:", ":note:", "Warning:", "Info:")


def run_tool(command: Sequence[str], cwd: Path, *, timeout_s: float) -> str:
    """Run a tool and return what it printed, errors included.

    Raises
    ------
    BuildError
        If it fails or does not end in time; the message is its first complaint.
    """
    try:
        done = subprocess.run(
            list(command),
            cwd=cwd,
            capture_output=True,
            text=True,
            errors="replace",
            timeout=timeout_s,
            check=False,
        )
    except subprocess.TimeoutExpired as error:
        raise BuildError(f"{command[0]} did not end within {timeout_s:g} s in {cwd}") from error
    if done.returncode != 0:
        complaint = first_complaint(done.stderr) or first_complaint(done.stdout)
        raise BuildError(f"{command[0]} failed: {complaint or 'it gave no reason'}")
    return done.stdout + done.stderr


def first_complaint(output: str) -> str:
    """Return the first line that is an error, names a place, or else is no warning."""
    lines = [line.strip() for line in output.splitlines() if line.strip()]
    lines = [line for line in lines if not any(noise in line for noise in _NOISE)]
    places = [line for line in lines if _PLACE.search(line)]
    errors = [line for line in lines if line.startswith("ERROR")]
    return next(iter(errors + places + lines), "")
