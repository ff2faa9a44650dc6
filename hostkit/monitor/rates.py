"""How much comes in a second, over the last few."""

from collections import deque
from dataclasses import dataclass

WINDOW_S = 2.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Totals:
    """What had come up to a moment."""

    time_s: float = 0.0
    frames: int = 0
    received_bytes: int = 0
    samples: int = 0


@dataclass(frozen=True, slots=True, kw_only=True)
class PerSecond:
    """What comes in a second."""

    frames: float = 0.0
    received_bytes: float = 0.0
    samples: float = 0.0


class Rates:
    """Means over the last two seconds."""

    def __init__(self) -> None:
        self._marks: deque[Totals] = deque()

    def mark(self, now: Totals) -> PerSecond:
        """Take the totals of now; return the rates since two seconds ago."""
        self._marks.append(now)
        while len(self._marks) > 2 and self._marks[1].time_s <= now.time_s - WINDOW_S:
            self._marks.popleft()
        then = self._marks[0]
        elapsed_s = now.time_s - then.time_s
        if elapsed_s <= 0.0:
            return PerSecond()
        return PerSecond(
            frames=(now.frames - then.frames) / elapsed_s,
            received_bytes=(now.received_bytes - then.received_bytes) / elapsed_s,
            samples=max(0, now.samples - then.samples) / elapsed_s,
        )
