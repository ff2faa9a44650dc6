"""Files of parameters: a name and a value per line, as MAVProxy writes and reads them."""

import math
import re
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np

from hostkit.errors import HostkitError
from hostkit.files import write_aside
from hostkit.link.device.listing import MOST_PARAMETERS
from hostkit.link.device.parameter_entry import is_name

LARGEST_FILE_BYTES = 1 << 20
_NUMBER: Final = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?\Z", re.ASCII)


@dataclass(frozen=True, slots=True, kw_only=True)
class FileParameter:
    """One line of a file: a name and its value."""

    name: str
    value: float
    line: int


def number_text(value: float) -> str:
    """Return the shortest decimals that give the number of 32 bits back."""
    return np.format_float_positional(np.float32(value), unique=True, trim="-")


def write_parameter_file(
    path: Path, values: Iterable[tuple[str, float]], *, remarks: Iterable[str] = ()
) -> None:
    """Write values to a file, sorted by name; remarks go above them behind ``#``.

    Raises
    ------
    HostkitError
        If the file cannot be written; nothing is left then.
    """
    lines = [f"# {remark}" for remark in remarks]
    lines += [f"{name:<16} {number_text(value)}" for name, value in sorted(values)]
    write_aside(path, "\n".join(lines) + "\n")


def read_parameter_file(path: Path) -> tuple[FileParameter, ...]:
    """Return the parameters of a file in the order of its lines.

    Empty lines count for nothing, nor does what stands behind ``#``; name and value are parted by
    spaces, tabs or a comma.

    Raises
    ------
    HostkitError
        If the file cannot be read, or a line is none of these; the message names the line.
    """
    try:
        with path.open("rb") as file:
            content = file.read(LARGEST_FILE_BYTES + 1)
    except OSError as error:
        raise HostkitError(f"{path} cannot be read: {error.strerror}") from error
    if len(content) > LARGEST_FILE_BYTES:
        raise HostkitError(f"{path} is no file of parameters: it has more than 1 MiB")
    found: dict[str, FileParameter] = {}
    for number, line in enumerate(_lines(path, content), start=1):
        if not (text := line.split("#", 1)[0].strip()):
            continue
        row = _row(f"{path}, line {number}", text, number)
        if row.name in found:
            first = found[row.name].line
            raise HostkitError(f"{path}, line {number}: {row.name} stands in line {first} already")
        found[row.name] = row
        if len(found) > MOST_PARAMETERS:
            raise HostkitError(f"{path} has more than {MOST_PARAMETERS} parameters")
    if not found:
        raise HostkitError(f"{path} has no parameter in it")
    return tuple(found.values())


def _lines(path: Path, content: bytes) -> list[str]:
    try:
        return content.decode("utf-8-sig").splitlines()
    except UnicodeDecodeError as error:
        raise HostkitError(f"{path} is no file of parameters: {error}") from error


def _row(place: str, text: str, line: int) -> FileParameter:
    words = text.replace(",", " ").split()
    if len(words) != 2:
        raise HostkitError(
            f"{place}: {text[:60]!r} is not a name and a value, such as FILT_TAU 1.5"
        )
    name, number = words
    if not is_name(name):
        raise HostkitError(f"{place}: {name[:40]!r} is no name of 1 to 16 characters")
    if _NUMBER.match(number) is None or not math.isfinite(float(number)):
        raise HostkitError(f"{place}: {name} has the value {number[:40]!r}, which is no number")
    return FileParameter(name=name, value=float(number), line=line)
