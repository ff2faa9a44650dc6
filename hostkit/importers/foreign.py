"""Reading with other people's libraries: what is missing, and what they raise on damaged files."""

import contextlib
import importlib
import os
from collections.abc import Generator
from pathlib import Path
from typing import Any

from hostkit.errors import HostkitError, RecordingError, ToolMissingError

HEAD_BYTES = 4096
EXTRA = "import"


def need(module: str, title: str) -> Any:
    """Import a library of the extra ``import``.

    Raises
    ------
    ToolMissingError
        If it is not installed.
    """
    try:
        return importlib.import_module(module)
    except ImportError as error:
        raise ToolMissingError(
            f"{title} needs the Python package {module.partition('.')[0]}, which is not "
            f"installed: pip install 'hostkit[{EXTRA}]'"
        ) from error


@contextlib.contextmanager
def reading(title: str) -> Generator[None, None, None]:
    """Turn whatever a library raises on a damaged file into one line, and keep it quiet.

    Parsers of binary formats raise nearly anything on bytes that were not written for them, and
    some print; only calls into such libraries stand inside.

    Raises
    ------
    RecordingError
        Instead of any exception that is not a `HostkitError`.
    """
    try:
        with (
            Path(os.devnull).open("w") as nowhere,
            contextlib.redirect_stdout(nowhere),
            contextlib.redirect_stderr(nowhere),
        ):
            yield
    except HostkitError:
        raise
    except Exception as error:
        reason = printable(str(error))[:160] or "no reason given"
        raise RecordingError(
            f"it is damaged, or no {title}: {type(error).__name__}: {reason}"
        ) from error


def printable(text: str) -> str:
    """Return text from a file on one line, with what no terminal should see as ``?``."""
    return "".join(c if c.isprintable() else "?" for c in " ".join(text.split()))


def head(path: Path) -> bytes:
    """Return the first bytes of a file, nothing if it cannot be read or is a folder."""
    try:
        with path.open("rb") as stream:
            return stream.read(HEAD_BYTES)
    except OSError:
        return b""
