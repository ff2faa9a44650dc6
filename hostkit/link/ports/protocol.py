"""What every source of bytes has in common."""

from typing import Literal, Protocol

PortState = Literal["connected", "lost", "released", "ended"]
"""A port is lost while it is waited for, released while another program may have it."""

WRITE_TIMEOUT_S = 0.1
"""How long a write may wait for the device; what has not gone then is lost."""


class Transport(Protocol):
    """A source of bytes that always comes back, and a way to the device.

    Attributes
    ----------
    live
        Whether the other end is a device, so that an end of the stream is a loss.
    epoch
        Rises by one whenever it was opened anew: counters and half frames from before are void.
    overrun_bytes
        Bytes that were received and dropped, because nobody took them in time.
    """

    live: bool
    epoch: int
    overrun_bytes: int

    @property
    def state(self) -> PortState:
        """Whether it is open."""

    def read(self, timeout_s: float) -> bytes | None:
        """Return what came within `timeout_s`, nothing if nothing did, None at the end."""

    def write(self, data: bytes) -> None:
        """Send to the device; what cannot be sent at once is lost, and nothing is raised."""

    def close(self) -> None:
        """Release the port."""
