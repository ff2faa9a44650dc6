"""One array of an ``.npz`` file, whose header is held against the bytes that are there."""

import math
import zipfile
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


def _info(archive: zipfile.ZipFile, name: str) -> zipfile.ZipInfo:
    try:
        return archive.getinfo(f"{name}.npy")
    except KeyError:
        return archive.getinfo(name)


def _require_honest(stream: IO[bytes], name: str, size: int) -> None:
    shape, dtype = _header(stream, name)
    if dtype.hasobject:
        raise RecordingError(f"{name} holds Python objects; save it as numbers or text")
    claimed = math.prod(shape) * dtype.itemsize
    held = size - stream.tell()
    if claimed != held:
        raise RecordingError(
            f"{name} claims shape {shape} of {dtype}, that is {claimed} bytes, and holds {held}"
        )


def _header(stream: IO[bytes], name: str) -> tuple[tuple[int, ...], np.dtype[np.generic]]:
    version = np.lib.format.read_magic(stream)
    if version == (1, 0):
        shape, _, dtype = np.lib.format.read_array_header_1_0(stream)
    elif version == (2, 0):
        shape, _, dtype = np.lib.format.read_array_header_2_0(stream)
    else:
        raise RecordingError(f"{name} is in npy version {version}; 1.0 and 2.0 are read")
    return shape, dtype
