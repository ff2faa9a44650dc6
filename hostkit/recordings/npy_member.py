"""One array of an ``.npz`` file, whose header is held against the bytes that are there."""

import math
import zipfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import IO

import numpy as np
from numpy.typing import NDArray

from hostkit.errors import RecordingError

MAX_BYTES = 2**31
"""Largest array that is read; 3-axis float64 data of 24 hours at 1 kHz fits."""


def read_member(archive: zipfile.ZipFile, name: str) -> NDArray[np.generic]:
    """Return one array of an archive.

    Parameters
    ----------
    archive
        The open file.
    name
        Name of the array, without ``.npy``.

    Raises
    ------
    RecordingError
        If the array holds Python objects, claims another size than the file holds, or is larger
        than `MAX_BYTES`.
    """
    member = _info(archive, name)
    if member.file_size > MAX_BYTES:
        raise RecordingError(f"{name} has {member.file_size} bytes; the limit is {MAX_BYTES}")
    with archive.open(member) as stream:
        _require_honest(stream, name, member.file_size)
    with archive.open(member) as stream:
        array: NDArray[np.generic] = np.lib.format.read_array(stream, allow_pickle=False)
    return array


@dataclass(frozen=True, slots=True, kw_only=True)
class Member:
    """One array of an archive, to be read row by row from its beginning."""

    name: str
    shape: tuple[int, ...]
    dtype: np.dtype[np.generic]
    stream: IO[bytes]

    def read(self, rows: int) -> NDArray[np.generic]:
        """Return the next rows.

        Raises
        ------
        RecordingError
            If there are not so many.
        """
        inner = self.shape[1:]
        wanted = rows * math.prod(inner) * self.dtype.itemsize
        content = self.stream.read(wanted)
        if len(content) < wanted:
            raise RecordingError(f"{self.name} ends after {len(content)} of {wanted} bytes")
        return np.frombuffer(content, dtype=self.dtype).reshape(rows, *inner)


@contextmanager
def open_member(archive: zipfile.ZipFile, name: str) -> Iterator[Member]:
    """Open one array of an archive for reading in parts, of any size.

    Raises
    ------
    RecordingError
        If the array holds Python objects, is stored column by column, or claims another size than
        the file holds.
    """
    info = _info(archive, name)
    with archive.open(info) as stream:
        _require_honest(stream, name, info.file_size)
    with archive.open(info) as stream:
        shape, in_columns, dtype = _full_header(stream, name)
        if in_columns and len(shape) > 1:
            raise RecordingError(f"{name} is stored column by column; save it in C order")
        yield Member(name=name, shape=shape, dtype=dtype, stream=stream)


def _info(archive: zipfile.ZipFile, name: str) -> zipfile.ZipInfo:
    try:
        return archive.getinfo(f"{name}.npy")
    except KeyError:
        return archive.getinfo(name)


def _require_honest(stream: IO[bytes], name: str, size: int) -> None:
    shape, _, dtype = _full_header(stream, name)
    if dtype.hasobject:
        raise RecordingError(f"{name} holds Python objects; save it as numbers or text")
    claimed = math.prod(shape) * dtype.itemsize
    held = size - stream.tell()
    if claimed != held:
        raise RecordingError(
            f"{name} claims shape {shape} of {dtype}, that is {claimed} bytes, and holds {held}"
        )


def _full_header(
    stream: IO[bytes], name: str
) -> tuple[tuple[int, ...], bool, np.dtype[np.generic]]:
    """Return the shape, whether columns are stored one after the other, and the type."""
    version = np.lib.format.read_magic(stream)
    if version == (1, 0):
        return np.lib.format.read_array_header_1_0(stream)
    if version == (2, 0):
        return np.lib.format.read_array_header_2_0(stream)
    raise RecordingError(f"{name} is in npy version {version}; 1.0 and 2.0 are read")
