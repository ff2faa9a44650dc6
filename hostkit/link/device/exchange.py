"""What asks a device and waits for its answer: how it sends, and what time it goes by."""

from collections.abc import Callable
from typing import Any, Protocol

Send = Callable[[Any], None]
"""Takes a message of the dialect that is to go to the device."""

EVERYBODY = 0
"""System or component id that means all of them."""

STATION = (255, 190)
"""System and component id that hostkit speaks as: a ground station's."""


class MonotonicClock(Protocol):
    """A source of time that only rises."""

    def monotonic(self) -> float:
        """Return seconds since some moment."""
