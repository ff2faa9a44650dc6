"""An exact account of the 8-bit counter that each sender puts into its frames.

What cannot be seen in such a counter: a gap of a whole multiple of 256 frames, and who of two
senders with the same ids has sent what.
"""

from dataclasses import dataclass, field

from hostkit.link.frames.framing import HEADER_BYTES, ID_AT
from hostkit.link.statistics import SourceStatistics

Source = tuple[int, int]
"""System and component id of a sender."""

NUMBERS = 256
WINDOW = 128
"""How far behind the latest frame another one may come and still be told from a gap."""
NEAR_ZERO = 8
"""Up to here a counter may be that of a sender that has just begun."""
BOOT_DISTANCE = 32
"""The same first heartbeat again, so many frames later, is a start and no copy."""
MOST_SOURCES = 64
OTHERS: Source = (0, 0)
"""Where senders beyond the limit are counted together; 0 is nobody's id."""

_HEARTBEAT, _BOOT, _STATUS_AT = 0, 1, HEADER_BYTES + 7
_TIME_BYTES = {30: 4, 26: 4, 27: 8, 105: 8, 52050: 8}
"""Messages whose first field is the sender's time, and its size: ms of 32 bits, us of 64."""
_WRAP = 1 << 32
_WRAP_SLACK = 60_000_000


@dataclass(slots=True)
class SequenceCounter:
    """The frames of one sender: arrived, lost, repeated, late, and begun anew.

    A number that is passed over is lost until it comes after all; a number that comes again is a
    copy if all bytes are the same. Anything else behind the latest number is a gap of nearly 256
    frames or a sender that began anew; its own time tells which.
    """

    frames: int = 0
    lost: int = 0
    duplicated: int = 0
    reordered: int = 0
    restarts: int = 0
    _expected: int = -1
    _last: int = -1
    _slots: list[bytes | None] = field(default_factory=lambda: [None] * NUMBERS)
    """The frame of each number; empty for one that is missing, None for one that is not known."""
    _doubtful: int = 0
    """Losses that a frame without a time has told of; they are none if time went back there."""
    _doubt_frames: int = 0
    _times: dict[bytes, int] = field(default_factory=dict)
    """The latest time of each kind of message before the gap in doubt."""

    def take(self, sequence: int, raw: bytes) -> bool:
        """Count a frame; tell whether it is a copy of one that was counted already."""
        if sequence == self._expected and sequence >= NEAR_ZERO:
            self._slots[sequence] = raw
            self._last = sequence
            self._expected = (sequence + 1) % NUMBERS
            self.frames += 1
            return False
        return self._take_other(sequence, raw)

    def forget(self) -> None:
        """Let the next frame be the first; the counts stay."""
        self._expected = self._last = -1
        self._slots = [None] * NUMBERS
        self._doubtful = 0

    def _take_other(self, sequence: int, raw: bytes) -> bool:
        if self._last < 0:
            return self._go_on(sequence, raw, 0)
        ahead = (sequence - self._last) % NUMBERS
        if ahead == 0 or ahead >= WINDOW:
            return self._take_behind(sequence, raw, ahead)
        if self._begins_anew(sequence, raw, ahead):
            return self._begin(sequence, raw)
        return self._go_on(sequence, raw, ahead - 1)

    def _take_behind(self, sequence: int, raw: bytes, ahead: int) -> bool:
        slot, distance = self._slots[sequence], -ahead % NUMBERS
        boots, far = sequence < NEAR_ZERO and _boots(raw), distance >= BOOT_DISTANCE
        if slot == raw and not (boots and far):
            self.duplicated += 1
            return True
        if boots and (slot or far):
            return self._begin(sequence, raw)
        if not slot and self._fits(sequence, raw, distance):
            return self._take_late(sequence, raw, slot)
        order = self._compare(raw, self._last, WINDOW)
        if order is not None and order <= 0:
            return self._begin(sequence, raw)
        return self._go_on(sequence, raw, (ahead - 1) % NUMBERS)

    def _fits(self, sequence: int, raw: bytes, distance: int) -> bool:
        """Tell whether the time of a frame fits between those around its number."""
        after = self._compare(raw, self._last, distance) or 0
        before = self._compare(raw, sequence, WINDOW) or 0
        return after <= 0 <= before

    def _take_late(self, sequence: int, raw: bytes, slot: bytes | None) -> bool:
        """Count a frame behind its turn; it was counted as lost if its number was passed over."""
        self.lost -= slot is not None
        self.reordered += 1
        self.frames += 1
        self._slots[sequence] = raw
        return False

    def _go_on(self, sequence: int, raw: bytes, missing: int) -> bool:
        self._weigh_doubt(raw, missing)
        begin = sequence - missing
        self._slots[max(begin, 0) : sequence] = [b""] * (sequence - max(begin, 0))
        if begin < 0:
            self._slots[begin:] = [b""] * -begin
        self.lost += missing
        self.frames += 1
        self._slots[sequence] = raw
        self._last = sequence
        # While a gap is in doubt, every frame is looked at.
        self._expected = -1 if self._doubtful else (sequence + 1) % NUMBERS
        return False

    def _weigh_doubt(self, raw: bytes, missing: int) -> None:
        """Keep in mind a gap that may be a start; drop an old doubt when time has gone on."""
        self._doubt_frames += 1
        if self._doubt_frames > BOOT_DISTANCE or raw[ID_AT:HEADER_BYTES] in self._times:
            self._doubtful = 0
        if missing and _time(raw) is None:
            if not self._doubtful:
                self._times = self._latest_times()
            self._doubtful, self._doubt_frames = missing, 0

    def _latest_times(self) -> dict[bytes, int]:
        times: dict[bytes, int] = {}
        for number in range(self._last - WINDOW + 1, self._last + 1):
            slot = self._slots[number % NUMBERS]
            time = _time(slot) if slot else None
            if slot and time is not None:
                times[slot[ID_AT:HEADER_BYTES]] = time
        return times

    def _begin(self, sequence: int, raw: bytes) -> bool:
        self.lost -= self._doubtful
        self.forget()
        self.restarts += 1
        return self._go_on(sequence, raw, 0)

    def _begins_anew(self, sequence: int, raw: bytes, ahead: int) -> bool:
        if _boots(raw) and sequence < NEAR_ZERO and ahead > sequence + 1:
            return True
        return self._compare(raw, self._last, WINDOW) == -1

    def _compare(self, raw: bytes, number: int, reach: int) -> int | None:
        """Tell whether a frame's time is behind (1) or before (-1) that of another one, or it (0).

        That is the latest of the same message among `reach` numbers up to `number`; None if there
        is none.
        """
        time, kind = _time(raw), raw[ID_AT:HEADER_BYTES]
        if time is None:
            return None
        if self._doubtful and kind in self._times:
            return _order(time, self._times[kind])
        for back in range(reach):
            slot = self._slots[(number - back) % NUMBERS]
            if slot and slot[ID_AT:HEADER_BYTES] == kind:
                return _order(time, _time(slot) or 0)
        return None


def _order(time: int, before: int) -> int:
    """Compare two times; a clock of 32 bits that starts over has not gone back."""
    if time >= before:
        return int(time > before)
    return 1 if 0 <= time + _WRAP - before < _WRAP_SLACK else -1


def _time(raw: bytes) -> int | None:
    """Return the sender's time in a frame, in the units of its message."""
    size = _TIME_BYTES.get(int.from_bytes(raw[ID_AT:HEADER_BYTES], "little"))
    if size is None:
        return None
    return int.from_bytes(raw[HEADER_BYTES : HEADER_BYTES + min(size, raw[1])], "little")


def _boots(raw: bytes) -> bool:
    """Tell whether a frame is the heartbeat of a sender that is starting."""
    heartbeat = int.from_bytes(raw[ID_AT:HEADER_BYTES], "little") == _HEARTBEAT
    return heartbeat and raw[1] > 7 and raw[_STATUS_AT] == _BOOT


@dataclass(slots=True)
class SequenceAccount:
    """The counters of all senders; beyond 64 the least heard of one makes room."""

    counters: dict[Source, SequenceCounter] = field(default_factory=dict)
    _others: SequenceCounter = field(default_factory=SequenceCounter)

    def take(self, source: Source, sequence: int, raw: bytes) -> bool:
        """Count a frame of a sender; tell whether it is a copy."""
        counter = self.counters.get(source)
        if counter is None:
            counter = self._new(source)
        return counter.take(sequence, raw)

    def forget(self) -> None:
        """Let the next frame of every sender be its first; the counts stay."""
        for counter in self.counters.values():
            counter.forget()

    def statistics(self) -> tuple[SourceStatistics, ...]:
        """Return the counts of each sender, in the order of their ids."""
        every = {**self.counters, OTHERS: self._others} if self._others.frames else self.counters
        return tuple(_counts(source, every[source]) for source in sorted(every))

    def _new(self, source: Source) -> SequenceCounter:
        if len(self.counters) >= MOST_SOURCES:
            least = min(self.counters, key=lambda known: self.counters[known].frames)
            self._join(self.counters.pop(least))
        return self.counters.setdefault(source, SequenceCounter())

    def _join(self, gone: SequenceCounter) -> None:
        self._others.frames += gone.frames
        self._others.lost += gone.lost
        self._others.duplicated += gone.duplicated
        self._others.reordered += gone.reordered
        self._others.restarts += gone.restarts


def _counts(source: Source, counter: SequenceCounter) -> SourceStatistics:
    return SourceStatistics(
        system=source[0],
        component=source[1],
        frames=counter.frames,
        lost=counter.lost,
        duplicated=counter.duplicated,
        reordered=counter.reordered,
        restarts=counter.restarts,
    )
