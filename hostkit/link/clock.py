"""Time as an argument, so that a test need not wait."""

import time
from typing import Protocol


class Clock(Protocol):
    """A source of time."""

    def monotonic(self) -> float:
        """Return seconds that only rise."""

    def time(self) -> float:
        """Return seconds since 1970."""

    def sleep(self, duration_s: float) -> None:
        """Let time pass."""


class SystemClock:
    """The clock of the machine."""

    def monotonic(self) -> float:
        """Return seconds that only rise."""
        return time.monotonic()

    def time(self) -> float:
        """Return seconds since 1970."""
        return time.time()

    def sleep(self, duration_s: float) -> None:
        """Let time pass."""
        time.sleep(duration_s)
