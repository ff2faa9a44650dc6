"""Where in a tlog which moment stands, found by looking at few places of it."""

import bisect
import itertools
import os
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

from hostkit.link.logs.tlog import LONGEST_FRAME_BYTES, STAMP, frame_at, stamped_frames

US_PER_S = 1e6
LEAST_STEP_BYTES = 65536
MOST_MARKS = 16384
"""However long a file is, no more places of it are remembered."""

CHAIN = 3
"""Frames that must follow one another before a place is taken for the begin of one."""

LONGEST_GAP_US = 86_400_000_000
"""Stamps further apart than a day are damage, not time."""

_MAGIC = re.compile(b"[\xfd\xfe]")


@dataclass(frozen=True, slots=True, kw_only=True)
class Mark:
    """A place in a file at which a time stamp with its frame begins."""

    time_us: int
    offset: int


@dataclass(frozen=True, slots=True, kw_only=True)
class TlogIndex:
    """Some places of a tlog, and the times of its first and its last frame.

    Attributes
    ----------
    marks
        Places, in the order of their time.
    """

    marks: tuple[Mark, ...]
    first_us: int
    last_us: int

    @property
    def length_s(self) -> float:
        """Time from the first to the last frame."""
        return (self.last_us - self.first_us) / US_PER_S

    def before(self, position_s: float) -> Mark:
        """Return the last known place that is not behind a position."""
        wanted_us = self.first_us + int(position_s * US_PER_S)
        place = bisect.bisect_right([mark.time_us for mark in self.marks], wanted_us)
        return self.marks[max(0, place - 1)]


def index_tlog(file: BinaryIO, path: Path) -> TlogIndex:
    """Look at a tlog every 64 KiB, or at as many places as are remembered.

    Raises
    ------
    DeviceError
        If it does not begin like a tlog.
    """
    file.seek(0)
    first_us = next(stamped_frames(file, path), (0, b""))[0]
    length = file.seek(0, os.SEEK_END)
    step = max(LEAST_STEP_BYTES, length // MOST_MARKS)
    marks = [Mark(time_us=first_us, offset=0)]
    for offset in range(step, length, step):
        mark = _mark_from(file, offset)
        if mark is not None and 0 <= mark.time_us - marks[-1].time_us < LONGEST_GAP_US:
            marks.append(mark)
    return TlogIndex(marks=tuple(marks), first_us=first_us, last_us=_last_us(file, path, marks[-1]))


def _last_us(file: BinaryIO, path: Path, mark: Mark) -> int:
    file.seek(mark.offset)
    newest = mark.time_us
    for time_us, _ in stamped_frames(file, path):
        if 0 <= time_us - newest < LONGEST_GAP_US:
            newest = time_us
    return newest


def _mark_from(file: BinaryIO, offset: int) -> Mark | None:
    """Return the first place from there on at which a chain of frames begins."""
    file.seek(offset)
    window = file.read((CHAIN + 2) * (STAMP.size + LONGEST_FRAME_BYTES))
    for begin in _candidates(window):
        if _is_chain(window, begin):
            return Mark(time_us=STAMP.unpack_from(window, begin)[0], offset=offset + begin)
    return None


def _candidates(window: bytes) -> Iterator[int]:
    found = _MAGIC.finditer(window, STAMP.size, STAMP.size + 2 * LONGEST_FRAME_BYTES)
    return (match.start() - STAMP.size for match in found)


def _is_chain(window: bytes, begin: int) -> bool:
    stamps = []
    for _ in range(CHAIN):
        frame = frame_at(window, begin + STAMP.size)
        if frame is None:
            return False
        stamps.append(STAMP.unpack_from(window, begin)[0])
        begin += STAMP.size + len(frame)
    return all(0 <= b - a < LONGEST_GAP_US for a, b in itertools.pairwise(stamps))
