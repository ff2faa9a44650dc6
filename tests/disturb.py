"""A bad link: frames go in, bytes come out, and what a receiver must count is known exactly.

The account is made from the truth, each frame's place in what its sender has sent, and not from
the 8-bit counter that a receiver sees.
"""

import random
from collections import defaultdict
from dataclasses import dataclass, field

from hostkit.dialect import python_module
from hostkit.link.frames.framing import Framer
from hostkit.link.ports.transport import PortState, Transport
from hostkit.link.statistics import LinkStatistics

MAGIC = 0xFD
TEXT = b"I2C bus recovered, 3 retries.\r\n"
LATE_BY, BURST = 5, 20
"""At most; together they stay within the 128 numbers that a receiver can tell apart."""
KNOWN = frozenset(python_module().mavlink_map)
Source = tuple[int, int]


@dataclass(frozen=True, kw_only=True)
class Harm:
    """How often each thing happens, per frame."""

    drop: float = 0.0
    burst: float = 0.0
    """Up to 20 frames in a row are lost."""
    duplicate: float = 0.0
    late: float = 0.0
    """The frame comes up to five frames behind its turn."""
    text: float = 0.0
    noise: float = 0.0
    cut: float = 0.0
    """The frame breaks off behind its header; two bytes and more are missing, since the first byte
    of the next frame may happen to be the one that is missing."""
    flip: float = 0.0


EVERYTHING = Harm(
    drop=0.02, burst=0.004, duplicate=0.02, late=0.03, text=0.02, noise=0.02, cut=0.02, flip=0.03
)


@dataclass
class Truth:
    """What one sender has sent, and what of it arrived."""

    sent: int = 0
    arrived: set[int] = field(default_factory=set)
    first: int = -1
    highest: int = -1
    duplicated: int = 0
    reordered: int = 0

    def arrive(self, place: int) -> None:
        if place in self.arrived:
            self.duplicated += 1
            return
        self.arrived.add(place)
        if self.first < 0:
            self.first = place
        self.reordered += place < self.highest
        self.highest = max(self.highest, place)

    @property
    def lost(self) -> int:
        return sum(p not in self.arrived for p in range(max(self.first, 0), self.highest))


class Disturber:
    """Takes frames, gives bytes; `expected` is what an exact receiver counts.

    The account holds once everything is decided, that is after 300 more bytes of frames, which
    `calm` lets through as they are.
    """

    def __init__(self, seed: int, harm: Harm = EVERYTHING) -> None:
        self.calm = False
        self.intact: list[bytes] = []
        """The frames that arrive unharmed, in their order, copies included."""
        self._harm, self._rng = harm, random.Random(seed)
        self._truth: dict[Source, Truth] = defaultdict(Truth)
        self._waiting: list[tuple[int, bytes, int]] = []
        self._dropping = 0
        self._lost, self._due_at = False, 0
        self._bad = self._bad_bytes = self._crc_failures = self._unknown = self._resyncs = 0
        self._bytes = 0

    def disturb(self, frames: list[bytes], calm: int = 20) -> bytes:
        """Disturb all frames but the last few."""
        harmed = self.feed(frames[: len(frames) - calm])
        self.calm = True
        return harmed + self.flush() + self.feed(frames[len(frames) - calm :])

    def feed(self, frames: list[bytes]) -> bytes:
        return b"".join(self._one(frame) for frame in frames)

    def flush(self) -> bytes:
        """Let everything that is late arrive."""
        waiting, self._waiting = self._waiting, []
        return b"".join(self._deliver(frame, place) for _, frame, place in waiting)

    def expected(self) -> LinkStatistics:
        truth = self._truth.values()
        return LinkStatistics(
            received_bytes=self._bytes,
            frames=sum(len(t.arrived) for t in truth),
            lost_frames=sum(t.lost for t in truth),
            duplicated=sum(t.duplicated for t in truth),
            reordered=sum(t.reordered for t in truth),
            bad=self._bad,
            bad_bytes=self._bad_bytes,
            crc_failures=self._crc_failures,
            unknown=self._unknown,
            resyncs=self._resyncs,
        )

    def _happens(self, rate: float) -> bool:
        return not self.calm and self._rng.random() < rate

    def _one(self, frame: bytes) -> bytes:
        truth, harm = self._truth[frame[5], frame[6]], self._harm
        place, truth.sent = truth.sent, truth.sent + 1
        out = self._due()
        if self._dropping or self._happens(harm.drop):
            self._dropping = max(0, self._dropping - 1)
            return out
        if self._happens(harm.burst):
            self._dropping = self._rng.randrange(BURST)
            return out
        if self._happens(harm.late):
            self._waiting.append((self._rng.randint(1, LATE_BY), frame, place))
            return out
        if self._happens(harm.duplicate):
            self._waiting.append((self._rng.randint(0, LATE_BY), frame, place))
        return out + self._deliver(frame, place)

    def _due(self) -> bytes:
        """Return what was late until now."""
        self._waiting = [(left - 1, frame, place) for left, frame, place in self._waiting]
        due = [entry for entry in self._waiting if entry[0] < 0]
        self._waiting = [entry for entry in self._waiting if entry[0] >= 0]
        return b"".join(self._deliver(frame, place) for _, frame, place in due)

    def _deliver(self, frame: bytes, place: int) -> bytes:
        before = self._spoilt(self._between())
        if self._happens(self._harm.cut):
            self._fail(frame)
            return before + self._spoilt(frame[: self._rng.randrange(10, len(frame) - 1)])
        if self._happens(self._harm.flip):
            return before + self._flipped(frame)
        self._truth[frame[5], frame[6]].arrive(place)
        self._resyncs += self._lost
        self._lost = False
        self._bytes += len(frame)
        self.intact.append(frame)
        return before + frame

    def _between(self) -> bytes:
        out = b""
        if self._happens(self._harm.text):
            out += TEXT[: self._rng.randint(1, len(TEXT))]
        if self._happens(self._harm.noise):
            # Not at its head: what begins like a frame where one is due may be an unknown one.
            out += bytes([self._rng.randrange(MAGIC)])
            out += bytes(self._noise_byte() for _ in range(self._rng.randrange(200)))
        return out

    def _noise_byte(self) -> int:
        return self._rng.choice((MAGIC, 0xFE, 0, self._rng.randrange(256)))

    def _spoilt(self, data: bytes) -> bytes:
        """Count bytes that belong to no frame."""
        if data:
            self._bad += not self._lost
            self._lost = True
            self._bad_bytes += len(data)
            self._bytes += len(data)
        return data

    def _flipped(self, frame: bytes) -> bytes:
        spoilt = bytearray(frame)
        at = self._rng.randrange(len(frame))
        spoilt[at] ^= 1 << self._rng.randrange(8)
        known = int.from_bytes(spoilt[7:10], "little") in KNOWN
        if not known and not self._lost:
            self._unknown += 1
            self._bytes += len(spoilt)
            return bytes(spoilt)
        if known and spoilt[0] == MAGIC and spoilt[2] <= 1:
            self._fail(bytes(spoilt))
        return self._spoilt(bytes(spoilt))

    def _fail(self, frame: bytes) -> None:
        """Count a wrong checksum where a frame is due: where the one before says that it ends."""
        if not self._lost or self._bytes == self._due_at:
            self._crc_failures += 1
            self._due_at = self._bytes + 12 + frame[1] + 13 * frame[2]


class DisturbedTransport:
    """A transport whose frames are disturbed on their way to us."""

    def __init__(self, inner: Transport, disturber: Disturber) -> None:
        self.inner, self.disturber = inner, disturber
        self.live = inner.live
        self._framer = Framer()

    @property
    def state(self) -> PortState:
        return self.inner.state

    @property
    def epoch(self) -> int:
        return self.inner.epoch

    @property
    def overrun_bytes(self) -> int:
        return self.inner.overrun_bytes

    def read(self, timeout_s: float) -> bytes | None:
        data = self.inner.read(timeout_s)
        if data is None:
            return self.disturber.flush() or None
        return self.disturber.feed([raw for _, raw in self._framer.feed(data)])

    def write(self, data: bytes) -> None:
        self.inner.write(data)

    def close(self) -> None:
        self.inner.close()
