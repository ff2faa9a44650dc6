"""Clock and delay of a device, by TIMESYNC and by when its samples arrive."""

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hostkit.dialect import python_module
from hostkit.link.frames.decoder import Frame, Source
from hostkit.link.statistics import Spread, TimingStatistics

Vector = NDArray[np.float64]

FIRST_REQUESTS, FIRST_PERIOD_NS = 10, 100_000_000
PERIOD_NS = 1_000_000_000
MOST_OPEN = 16
"""Requests that may still be answered; older ones are given up."""
ANSWERS = 600
"""Answers that are kept: ten minutes of them."""
RECENT_NS = 30_000_000_000
"""The shortest round trip of so long tells the offset."""
BLOCK_NS = 5_000_000_000
"""The clock rate is read off the shortest round trip of each block of so long."""
LEAST_BLOCKS = 3
MOST_DOUBT = 20e-6
"""A rate is told when round trips are even enough, or time is long enough, to know it so well."""
LONGEST_ROUND_TRIP_NS = 10_000_000_000
JUMP_NS = 100_000_000
"""A device whose clock jumps further than any delay explains has begun anew."""
SAMPLES = 4096
WRAP_US = 1 << 32
NS_PER_MS, NS_PER_US = 1e6, 1000


@dataclass(frozen=True, slots=True, kw_only=True)
class Answer:
    """One exchange: host time in its middle, device minus host, and its round trip, ns."""

    host_ns: int
    offset_ns: int
    round_trip_ns: int


class Window:
    """The last 4096 of some figures, in milliseconds."""

    def __init__(self) -> None:
        self._values: Vector = np.zeros(SAMPLES)
        self._count = 0

    def add(self, values: ArrayLike) -> None:
        """Append figures; the oldest go."""
        new = np.atleast_1d(np.asarray(values, dtype=np.float64))[-SAMPLES:]
        places = (self._count + np.arange(len(new))) % SAMPLES
        self._values[places] = new
        self._count += len(new)

    def spread(self) -> Spread | None:
        """Return median, 95th percentile and maximum; None without a figure."""
        values = self._values[: min(self._count, SAMPLES)]
        if not len(values):
            return None
        median, p95, most = np.percentile(values, [50.0, 95.0, 100.0])
        return Spread(median_ms=float(median), p95_ms=float(p95), max_ms=float(most))


class TimeSync:
    """Asks a device for its time, and tells how late and how evenly its samples come.

    Parameters
    ----------
    now_ns
        Host time, ns, that only rises. `received_ns` of :meth:`take` and :meth:`arrived` is of
        the same clock.

    Attributes
    ----------
    source
        Whose answers count; None until the first answer comes, then its sender.

    Notes
    -----
    The offset of a clock is known to half the difference of the delays there and back; of several
    exchanges the one with the shortest round trip is the best (D. L. Mills, RFC 5905, section 10).
    """

    def __init__(self, now_ns: Callable[[], int], source: Source | None = None) -> None:
        self.source = source
        self._now_ns = now_ns
        self._latency, self._jitter = Window(), Window()
        self._shortest_ns: int | None = None
        self._clock_ppm: float | None = None
        self.begin_epoch()

    def begin_epoch(self) -> None:
        """Forget the device's clock: it may have begun anew. The figures stay."""
        self._answers: deque[Answer] = deque(maxlen=ANSWERS)
        self._best: Answer | None = None
        self._open: deque[int] = deque(maxlen=MOST_OPEN)
        self._asked = 0
        self._due_ns = self._now_ns()
        self._last_arrival: tuple[int, int] | None = None

    def poll(self) -> Any:
        """Return the next request if it is due, else None.

        Ten requests go out in the first second, then one a second.
        """
        now_ns = self._now_ns()
        if now_ns < self._due_ns:
            return None
        period_ns = FIRST_PERIOD_NS if self._asked < FIRST_REQUESTS else PERIOD_NS
        self._due_ns = now_ns + period_ns
        self._asked += 1
        self._open.append(now_ns)
        return python_module().MAVLink_timesync_message(0, now_ns)

    def take(self, frame: Frame, received_ns: int | None = None) -> None:
        """Take an answer; anything else, and what answers another's request, is passed over.

        Parameters
        ----------
        received_ns
            When its bytes came; now if not given.
        """
        if frame.name != "TIMESYNC" or frame.repeated:
            return
        if self.source is not None and frame.source != self.source:
            return
        sent_ns, device_ns = int(frame.message.ts1), int(frame.message.tc1)
        if device_ns <= 0 or sent_ns not in self._open:
            return
        self._open.remove(sent_ns)
        back_ns = self._now_ns() if received_ns is None else received_ns
        if 0 <= back_ns - sent_ns <= LONGEST_ROUND_TRIP_NS:
            self.source = frame.source
            self._keep(sent_ns, back_ns, device_ns)

    def _keep(self, sent_ns: int, back_ns: int, device_ns: int) -> None:
        middle_ns = (sent_ns + back_ns) // 2
        answer = Answer(
            host_ns=middle_ns,
            offset_ns=self._unwrapped(device_ns - middle_ns),
            round_trip_ns=back_ns - sent_ns,
        )
        if self._answers and self._has_jumped(answer):
            self._answers.clear()
        self._answers.append(answer)
        trip_ns = answer.round_trip_ns
        self._shortest_ns = (
            trip_ns if self._shortest_ns is None else min(self._shortest_ns, trip_ns)
        )
        self._clock_ppm = _clock_ppm(list(self._answers))
        self._best = self._best_recent()

    def _unwrapped(self, offset_ns: int) -> int:
        """Return the offset that is nearest to the last, if a 32-bit clock of us has wrapped."""
        if not self._answers:
            return offset_ns
        last_ns = self._answers[-1].offset_ns
        turns = round((last_ns - offset_ns) / (WRAP_US * NS_PER_US))
        near_ns = offset_ns + turns * WRAP_US * NS_PER_US
        return near_ns if abs(near_ns - last_ns) < JUMP_NS else offset_ns

    def _has_jumped(self, answer: Answer) -> bool:
        last = self._answers[-1]
        explained_ns = (answer.round_trip_ns + last.round_trip_ns) / 2 + JUMP_NS
        return abs(answer.offset_ns - last.offset_ns) > explained_ns

    def _best_recent(self) -> Answer:
        newest_ns = self._answers[-1].host_ns
        recent = (a for a in self._answers if newest_ns - a.host_ns <= RECENT_NS)
        return min(recent, key=lambda a: a.round_trip_ns)

    def _offset_ns(self, host_ns: int) -> int | None:
        """Return the device's time minus the host's at a moment."""
        if self._best is None:
            return None
        drift = 0.0 if self._clock_ppm is None else self._clock_ppm * 1e-6
        return self._best.offset_ns + round(drift * (host_ns - self._best.host_ns))

    def arrived(self, time_us: NDArray[np.int64], received_ns: NDArray[np.int64]) -> None:
        """Take the times of samples and of their arrivals, both rising.

        Of samples that came together the newest counts for the jitter: it is held against the
        newest of those that came together before.

        Parameters
        ----------
        time_us
            Device time of each, shape ``(N,)``; a counter of 32 bits may wrap.
        received_ns
            Host time of each, same shape.
        """
        if not len(time_us):
            return
        offset_ns = self._offset_ns(int(received_ns[-1]))
        if offset_ns is not None:
            device_us = (received_ns + offset_ns % (WRAP_US * NS_PER_US)) // NS_PER_US
            self._latency.add(_behind_us(device_us, time_us) / 1e3)
        newest = newest_of_each(received_ns)
        device_us, host_ns = time_us[newest] % WRAP_US, received_ns[newest]
        if self._last_arrival is not None:
            device_us = np.append(self._last_arrival[0], device_us)
            host_ns = np.append(self._last_arrival[1], host_ns)
        step_ns = _behind_us(device_us[1:], device_us[:-1]) * NS_PER_US
        self._jitter.add(np.abs(np.diff(host_ns) - step_ns) / NS_PER_MS)
        self._last_arrival = (int(device_us[-1]), int(host_ns[-1]))

    def statistics(self) -> TimingStatistics:
        """Return the figures so far."""
        shortest = self._shortest_ns
        return TimingStatistics(
            round_trip_ms=None if shortest is None else shortest / NS_PER_MS,
            clock_ppm=self._clock_ppm,
            latency=self._latency.spread(),
            jitter=self._jitter.spread(),
        )


def newest_of_each(received_ns: NDArray[np.int64]) -> NDArray[np.intp]:
    """Return the places of the last of those that came together."""
    return np.flatnonzero(np.append(np.diff(received_ns) != 0, True))


def _behind_us(now_us: NDArray[np.int64], time_us: NDArray[np.int64]) -> Vector:
    """Return how far times are behind others, as if all were counters of 32 bits."""
    low = np.asarray(time_us, dtype=np.int64) % WRAP_US
    behind: Vector = ((now_us % WRAP_US - low + WRAP_US // 2) % WRAP_US - WRAP_US // 2).astype(
        np.float64
    )
    return behind


def _clock_ppm(answers: list[Answer]) -> float | None:
    """Return how much faster the device's clock is, by a line through the best of each block."""
    best: dict[int, Answer] = {}
    for answer in answers:
        block = answer.host_ns // BLOCK_NS
        if block not in best or answer.round_trip_ns < best[block].round_trip_ns:
            best[block] = answer
    begin, trips_ns = answers[0], [a.round_trip_ns for a in best.values()]
    doubt_ns = (max(trips_ns) - min(trips_ns)) / 2
    if len(best) < LEAST_BLOCKS or doubt_ns > MOST_DOUBT * (answers[-1].host_ns - begin.host_ns):
        return None
    time_s = np.array([a.host_ns - begin.host_ns for a in best.values()]) * 1e-9
    offset_s = np.array([a.offset_ns - begin.offset_ns for a in best.values()]) * 1e-9
    time_s -= time_s.mean()
    return float(time_s @ offset_s / (time_s @ time_s) * 1e6)
