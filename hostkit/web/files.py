"""The files the server gives out: those of the page, of its chart library, and recordings."""

import os
import re
import stat
from collections.abc import Iterator
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path
from typing import BinaryIO

from hostkit.errors import RecordingError

MEDIA_TYPES = {
    ".html": "text/html",
    ".css": "text/css",
    ".js": "text/javascript",
    ".svg": "image/svg+xml",
    ".png": "image/png",
    ".ico": "image/x-icon",
}
VENDOR_FILES = ("uPlot.esm.js", "uPlot.min.css")
VENDOR_FOLDERS = ("node_modules/uplot/dist", "vendor")
"""In a checkout, after npm; in a wheel."""

NAME = re.compile(r"[A-Za-z0-9_-][A-Za-z0-9._-]{0,79}")
RECORDING_SUFFIXES = (".tlog", ".csv", ".npz")
MOST_LISTED = 1000
CHUNK_BYTES = 65536


@dataclass(frozen=True, slots=True, kw_only=True)
class RecordingFile:
    """A recording in the folder of the session."""

    name: str
    bytes: int


def page_file(name: str) -> bytes | None:
    """Return a file of the page, None if it has none of that name."""
    if not NAME.fullmatch(name) or Path(name).suffix not in MEDIA_TYPES:
        return None
    return _packaged(name)


def vendor_file(name: str) -> bytes | None:
    """Return a file of uPlot, None where it is not installed."""
    if name not in VENDOR_FILES:
        return None
    found = (_packaged(f"{folder}/{name}") for folder in VENDOR_FOLDERS)
    return next((content for content in found if content is not None), None)


def _packaged(path: str) -> bytes | None:
    entry = files("hostkit.web").joinpath("page", *path.split("/"))
    return entry.read_bytes() if entry.is_file() else None


def is_recording_name(name: str) -> bool:
    """Return whether a name is one plain component with the suffix of a recording."""
    return bool(NAME.fullmatch(name)) and name.endswith(RECORDING_SUFFIXES)


def new_recording(folder: Path, name: str) -> str:
    """Return the checked name of a recording if it may be written.

    Raises
    ------
    RecordingError
        If the file exists.
    """
    if os.path.lexists(folder / name):
        raise RecordingError(f"{name} exists; choose another name")
    return name


def recordings(folder: Path) -> list[RecordingFile]:
    """Return the recordings of a folder by name: plain files only, no links."""
    found = []
    try:
        with os.scandir(folder) as entries:
            for entry in entries:
                if is_recording_name(entry.name) and entry.is_file(follow_symlinks=False):
                    size = entry.stat(follow_symlinks=False).st_size
                    found.append(RecordingFile(name=entry.name, bytes=size))
    except OSError:
        return []
    return sorted(found, key=lambda file: file.name)[:MOST_LISTED]


def open_recording(folder: Path, name: str) -> BinaryIO | None:
    """Open a recording of a folder; None if there is no such plain file."""
    if not is_recording_name(name):
        return None
    # A pipe would block on opening, and a link could lead out of the folder.
    flags = os.O_RDONLY | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0)
    try:
        number = os.open(folder / name, flags | getattr(os, "O_BINARY", 0))
    except OSError:
        return None
    if stat.S_ISREG(os.fstat(number).st_mode) and not (folder / name).is_symlink():
        return os.fdopen(number, "rb")
    os.close(number)
    return None


def chunks(opened: BinaryIO) -> Iterator[bytes]:
    """Give the content of a file up to the size it has now, then close it."""
    with opened:
        rest = os.fstat(opened.fileno()).st_size
        while rest > 0 and (chunk := opened.read(min(CHUNK_BYTES, rest))):
            rest -= len(chunk)
            yield chunk
