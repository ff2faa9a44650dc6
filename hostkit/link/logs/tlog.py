"""The tlog format: before each frame, eight bytes of big-endian microseconds since 1970."""

import os
import re
import struct
from collections.abc import Generator, Sequence
from pathlib import Path
from typing import BinaryIO

from hostkit.errors import DeviceError
from hostkit.link.frames.decoder import Frame
from hostkit.link.logs.part_file import PartFile, PartialWriteError, Write

STAMP = struct.Struct(">Q")
MAGIC_V2 = 0xFD
MAGIC_V1 = 0xFE
LONGEST_FRAME_BYTES = 280
CHUNK_BYTES = 65536
_MAGIC = re.compile(b"[\xfd\xfe]")


def read_tlog(path: Path) -> Generator[bytes, None, None]:
    """Yield the frames of a tlog, whatever protocol version they are of.

    Where a time stamp is not followed by a frame, bytes are skipped to the next one; the decoder
    counts what was lost by its sequence numbers.

    Raises
    ------
    DeviceError
        If the file cannot be read, or does not begin like a tlog.
    """
    stamped = read_stamped(path)
    return (frame for _, frame in stamped)


def read_stamped(path: Path) -> Generator[tuple[int, bytes], None, None]:
    """Yield the frames of a tlog with their times of arrival, us since 1970.

    Raises
    ------
    DeviceError
        If the file cannot be read, or does not begin like a tlog.
    """
    try:
        file = path.open("rb")
    except OSError as error:
        raise DeviceError(f"{path} cannot be read: {error.strerror}") from error
    return _closing(file, path)


def _closing(file: BinaryIO, path: Path) -> Generator[tuple[int, bytes], None, None]:
    with file:
        yield from stamped_frames(file, path)


def stamped_frames(file: BinaryIO, path: Path) -> Generator[tuple[int, bytes], None, None]:
    """Yield time stamps, us since 1970, and frames, from where a file stands.

    Raises
    ------
    DeviceError
        If no frame follows the first time stamp.
    """
    window, begin = file.read(CHUNK_BYTES), 0
    if _MAGIC.match(window, STAMP.size) is None:
        raise DeviceError(f"{path} is not a tlog: no MAVLink frame follows its first 8 bytes")
    while True:
        if len(window) - begin < STAMP.size + LONGEST_FRAME_BYTES:
            window, begin = window[begin:] + file.read(CHUNK_BYTES), 0
        if len(window) - begin <= STAMP.size:
            return
        frame = frame_at(window, begin + STAMP.size)
        if frame is not None:
            yield STAMP.unpack_from(window, begin)[0], frame
            begin += STAMP.size + len(frame)
        else:
            begin = _next_stamp(window, begin)


def frame_at(window: bytes, begin: int) -> bytes | None:
    """Return the frame that begins there, or None if there is no whole one."""
    head = window[begin : begin + 3]
    if len(head) < 3 or head[0] not in (MAGIC_V1, MAGIC_V2):
        return None
    if head[0] == MAGIC_V1:
        length = 8 + head[1]
    else:
        length = 12 + head[1] + (13 if head[2] & 1 else 0)
    frame = window[begin : begin + length]
    return frame if len(frame) == length else None


def _next_stamp(window: bytes, begin: int) -> int:
    """Return the next place at which a time stamp may stand before a frame."""
    found = _MAGIC.search(window, begin + STAMP.size + 1)
    return len(window) - STAMP.size if found is None else found.start() - STAMP.size


class TlogWriter:
    """Writes frames to a tlog; the file has its name only when it is complete.

    Until :meth:`close` it is called ``NAME.part``, and every frame written so far is in it.

    Attributes
    ----------
    name
        Name of the file, without its folder.
    frames, written_bytes
        What is in it.
    left
        Where an unfinished recording of that name was moved; None if there was none.

    Raises
    ------
    HostkitError
        If the file cannot be written.
    """

    def __init__(self, path: Path, *, write: Write = os.write) -> None:
        self._file = PartFile(path, kind=".tlog", write=write)
        self.name: str = path.name
        self.left = self._file.left
        self.frames = 0

    @property
    def written_bytes(self) -> int:
        """Bytes in the file."""
        return self._file.written_bytes

    def add(self, epoch_us: int, frames: Sequence[Frame]) -> None:
        """Append frames, each with its time.

        Parameters
        ----------
        epoch_us
            The time since 1970, us, at which the clock of their arrivals was 0.
        """
        self._append([(frame.time_us(epoch_us), frame.raw) for frame in frames])

    def write(self, time_us: int, frame: bytes) -> None:
        """Append one frame."""
        self._append([(time_us, frame)])

    def _append(self, frames: list[tuple[int, bytes]]) -> None:
        try:
            self._file.append([STAMP.pack(time_us) + frame for time_us, frame in frames])
        except PartialWriteError as error:
            self.frames += error.kept
            raise
        self.frames += len(frames)

    def close(self) -> None:
        """Finish the file and give it its name."""
        self._file.close()
