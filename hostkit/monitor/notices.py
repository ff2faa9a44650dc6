"""What happened in a session, for people: the latest few events with their times."""

from collections import deque

from hostkit.link.clock import Clock
from hostkit.monitor.snapshot import Level, Notice

KEPT = 50


class Notices:
    """The latest events, newest last."""

    def __init__(self, clock: Clock) -> None:
        self._clock = clock
        self._kept: deque[Notice] = deque(maxlen=KEPT)

    def add(self, level: Level, text: str) -> None:
        """Remember an event; one that is told again at once is kept once."""
        if self._kept and self._kept[-1].text == text:
            self._kept.pop()
        self._kept.append(Notice(time_s=self._clock.time(), level=level, text=text))

    def latest(self) -> tuple[Notice, ...]:
        """Return them, newest last."""
        return tuple(self._kept)
