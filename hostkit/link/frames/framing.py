"""Frames of MAVLink 2 found in any bytes at all; what is not a frame is counted.

pymavlink's own parser drops everything that a false start of a frame claims, intact frames within
included, and keeps all bytes for as long as its buffer never runs empty. Here a claim that fails
costs one byte, and the scan goes on behind it.
"""

import re
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

from hostkit.dialect import FRAME_OVERHEAD_BYTES, SIGNATURE_BYTES, python_module

HEADER_BYTES = 10
FLAGS_AT, SEQUENCE_AT, SYSTEM_AT, COMPONENT_AT, ID_AT = 2, 4, 5, 6, 7

SIGNED = 0x01
"""The only flag a receiver may meet; a frame with another one cannot be understood."""
LONGEST_FRAME_BYTES = 255 + FRAME_OVERHEAD_BYTES + SIGNATURE_BYTES

_START = re.compile(rb"\xfd(?:.(?:[\x00\x01]|\Z)|\Z)", re.DOTALL)
"""Where a frame may begin: its flags are bearable, or are still to come."""

Found = tuple[str, bytes]
"""Name of a message and its whole frame."""


@lru_cache(maxsize=1)
def _names() -> dict[bytes, tuple[str, bytes]]:
    """Return name and extra byte of the checksum for each message id of the dialect."""
    return {
        number.to_bytes(3, "little"): (kind.msgname, bytes([kind.crc_extra]))
        for number, kind in python_module().mavlink_map.items()
    }


@lru_cache(maxsize=1)
def checksum() -> Callable[[bytes], int]:
    """Return MAVLink's checksum, CRC-16/MCRF4XX, in its fastest form that is installed."""
    module = python_module()
    if module.mcrf4xx is not None:
        fast: Callable[[bytes], int] = module.mcrf4xx
        return fast
    return lambda data: int(module.x25crc(data).crc)


def signed_bytes(raw: bytes) -> int:
    """Return how many bytes of a frame are its signature."""
    return SIGNATURE_BYTES if raw[FLAGS_AT] & SIGNED else 0


@dataclass(slots=True)
class Framer:
    """Finds intact frames of the dialect.

    A frame of an id that the dialect does not have cannot be checked: it is believed only where
    a frame is due, directly behind another one, and only if no intact frame begins inside of it.
    MAVLink 1 is not heard; its bytes are bad ones.

    Attributes
    ----------
    received_bytes
        All that came.
    bad, bad_bytes
        Runs of bytes that belong to no frame, and their bytes.
    crc_failures
        Frames of the dialect whose checksum is wrong, where a frame is due: behind another one,
        be it intact or one of these. What looks like a frame within noise is not counted here.
    unknown
        Frames of an id that the dialect does not have.
    resyncs
        How often an intact frame followed bad bytes.
    """

    received_bytes: int = 0
    bad: int = 0
    bad_bytes: int = 0
    crc_failures: int = 0
    unknown: int = 0
    resyncs: int = 0
    _rest: bytes = b""
    _lost: bool = False
    """Whether the bytes before are bad, so that a frame is not due here."""
    _claimed: int = 0
    """Bytes passed over so far of a frame whose id is unknown."""
    _claim_left: int = 0
    _due_in: int = -1
    """Bytes to where a frame with a wrong checksum ends by its own account."""

    @property
    def pending_bytes(self) -> int:
        """Bytes that are not decided on yet: the beginning of a frame, or what may be one."""
        return len(self._rest) + self._claimed

    def feed(self, data: bytes) -> list[Found]:
        """Return the frames that `data` completes, in their order."""
        self.received_bytes += len(data)
        buffer = self._rest + data if self._rest else data
        names, crc = _names(), checksum()
        found: list[Found] = []
        at, size = 0, len(buffer)
        while at < size:
            if not _START.match(buffer, at):
                at = self._skip_to_start(buffer, at)
                continue
            if size - at < HEADER_BYTES:
                break
            known = names.get(buffer[at + ID_AT : at + HEADER_BYTES])
            flags = buffer[at + FLAGS_AT]
            if known is None:
                self._claim(buffer, at)
                at = self._skip(at, 1)
                continue
            ends = at + HEADER_BYTES + buffer[at + 1]
            whole = ends + 2 + SIGNATURE_BYTES * flags
            if whole > size:
                break
            if crc(buffer[at + 1 : ends] + known[1]) != buffer[ends] | buffer[ends + 1] << 8:
                self._count_failure(whole - at)
                at = self._skip(at, 1)
                continue
            if self._lost or self._claimed:
                self._found_again()
            found.append((known[0], buffer[at:whole]))
            at = whole
        self._rest = buffer[at:]
        return found

    def drop(self) -> None:
        """Give up what is not decided on: what comes next has nothing to do with it."""
        rest, self._rest = len(self._rest), b""
        self._disbelieve()
        if rest:
            self._count_bad(rest)
        self._lost, self._due_in = False, -1

    def _skip_to_start(self, buffer: bytes, at: int) -> int:
        start = _START.search(buffer, at)
        return self._skip(at, (len(buffer) if start is None else start.start()) - at)

    def _skip(self, at: int, count: int) -> int:
        """Pass over bytes: they belong to an unknown frame, or to none."""
        ends = at + count
        self._due_in -= count
        if self._claim_left:
            within = min(count, self._claim_left)
            self._claimed += within
            self._claim_left -= within
            count -= within
            if not self._claim_left:
                self._claimed = 0
                self.unknown += 1
        if count:
            self._count_bad(count)
        return ends

    def _claim(self, buffer: bytes, at: int) -> None:
        """Take what begins here for an unknown frame, if one is due."""
        if not self._lost and not self._claim_left:
            signed = SIGNATURE_BYTES * buffer[at + FLAGS_AT]
            self._claim_left = FRAME_OVERHEAD_BYTES + buffer[at + 1] + signed

    def _count_failure(self, length: int) -> None:
        if self._due_in == 0 or not (self._lost or self._claim_left):
            self.crc_failures += 1
            self._due_in = length

    def _count_bad(self, count: int) -> None:
        self.bad += not self._lost
        self.bad_bytes += count
        self._lost = True

    def _disbelieve(self) -> None:
        """Count what was taken for an unknown frame as bad."""
        claimed, self._claimed, self._claim_left = self._claimed, 0, 0
        if claimed:
            self._count_bad(claimed)

    def _found_again(self) -> None:
        self._disbelieve()
        self._lost, self._due_in = False, -1
        self.resyncs += 1
