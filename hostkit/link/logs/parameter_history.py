"""When which parameter was told in a tlog, so that a replay can begin anywhere."""

import mmap
import re
from dataclasses import dataclass
from typing import BinaryIO

from hostkit.link.logs.tlog import STAMP, frame_at

MOST_CHANGES = 65536
"""More changes than these are not remembered; a hostile file may claim any number."""

HEADER_BYTES, PAYLOAD_BYTES = 10, 25
VALUE, NAME = slice(0, 4), slice(8, 24)
SENDER = slice(5, 7)

_PARAM_VALUE = re.compile(rb"\xfd[\x01-\x19].{5}\x16\0\0", re.DOTALL)


@dataclass(frozen=True, slots=True, kw_only=True)
class ToldParameter:
    """A PARAM_VALUE frame that says something new.

    Attributes
    ----------
    key
        Sender and name.
    """

    time_us: int
    key: bytes
    frame: bytes


def parameter_history(file: BinaryIO) -> tuple[ToldParameter, ...]:
    """Return the changes of parameters in a tlog, found by their bytes; nothing is unpacked.

    What looks like such a frame by chance is among them: whoever uses one checks it.
    """
    found: list[ToldParameter] = []
    values: dict[bytes, bytes] = {}
    with mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as content:
        for match in _PARAM_VALUE.finditer(content, STAMP.size):
            begin = match.start()
            frame = frame_at(content[begin : begin + 64], 0)
            if frame is None or len(found) >= MOST_CHANGES:
                continue
            payload = frame[HEADER_BYTES : HEADER_BYTES + frame[1]].ljust(PAYLOAD_BYTES, b"\0")
            key = frame[SENDER] + payload[NAME]
            if values.get(key) != payload[VALUE]:
                values[key] = payload[VALUE]
                time_us = STAMP.unpack_from(content, begin - STAMP.size)[0]
                found.append(ToldParameter(time_us=time_us, key=key, frame=frame))
    return tuple(found)
