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


def now_ns(clock: Clock) -> int:
    """Return nanoseconds that only rise; those of the machine are :func:`time.monotonic_ns`."""
    return int(clock.monotonic() * 1e9)


def epoch_us(clock: Clock) -> int:
    """Return the time since 1970, us, at which :func:`now_ns` was 0."""
    return int(clock.time() * 1e6) - now_ns(clock) // 1000


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
