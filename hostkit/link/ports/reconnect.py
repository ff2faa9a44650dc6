"""A port that is opened again whenever it was lost."""

from collections.abc import Callable

from hostkit.errors import DeviceError
from hostkit.link.clock import Clock, SystemClock
from hostkit.link.ports.protocol import PortState, Transport

FIRST_WAIT_S = 0.1
LONGEST_WAIT_S = 2.0

Opener = Callable[[], Transport]


class Reconnecting:
    """A live port that outlives its device.

    When the device goes away the port is closed and opened again after 0.1 s, then after waits
    that double up to 2 s. Meanwhile `state` is ``"lost"`` and nothing is read. Not thread-safe but
    for :meth:`write`; see :class:`hostkit.link.ports.pump.Pump`.

    Parameters
    ----------
    opener
        Opens the port, raises DeviceError if it cannot.
    first
        The port, if it is open already.
    keep
        Whether to wait for a lost device; otherwise its loss is the end.

    Attributes
    ----------
    problem
        Why the last opening failed; empty once it is open.

    Raises
    ------
    DeviceError
        If the first opening fails.
    """

    live = True

    def __init__(
        self,
        opener: Opener,
        *,
        first: Transport | None = None,
        keep: bool = True,
        clock: Clock | None = None,
    ) -> None:
        self._opener = opener
        self._keep = keep
        self._waiting = keep
        self._clock = clock or SystemClock()
        self._inner: Transport | None = first or opener()
        self._wait_s = FIRST_WAIT_S
        self._due_s = 0.0
        self.state: PortState = "connected"
        self.epoch = 0
        self.overrun_bytes = 0
        self.problem = ""

    def read(self, timeout_s: float) -> bytes | None:
        """Return what came; nothing while the device is away."""
        if self._inner is not None:
            data = self._inner.read(timeout_s)
            if data is not None:
                return data
            self._lose()
            return b"" if self._keep else None
        if self.state == "lost" and not self._waiting:
            return None
        self._pass_time(timeout_s)
        return b""

    def _lose(self) -> None:
        self._shut()
        self.state = "lost"
        self._waiting = self._keep
        self._wait_s = FIRST_WAIT_S
        self._due_s = self._clock.monotonic() + self._wait_s

    def _pass_time(self, timeout_s: float) -> None:
        """Wait for the next attempt, but no longer than asked; then make it."""
        if self.state != "lost":
            self._clock.sleep(timeout_s)
            return
        left_s = self._due_s - self._clock.monotonic()
        if left_s > 0.0:
            self._clock.sleep(min(timeout_s, left_s))
        if self._clock.monotonic() >= self._due_s:
            self._attempt()

    def _attempt(self) -> None:
        try:
            self._inner = self._opener()
        except DeviceError as error:
            self.problem = str(error)
            self._wait_s = min(2.0 * self._wait_s, LONGEST_WAIT_S)
            self._due_s = self._clock.monotonic() + self._wait_s
            return
        self.problem = ""
        self.epoch += 1
        self.state = "connected"

    def write(self, data: bytes) -> None:
        """Send to the device; while it is away nothing is sent."""
        inner = self._inner
        if inner is not None:
            inner.write(data)

    def release(self) -> None:
        """Close the port, so that another program may have it."""
        self._shut()
        self.state = "released"

    def take(self) -> None:
        """Open a released port again, at once if it can be, else as soon as it can be."""
        if self.state != "released":
            return
        self.state = "lost"
        self._waiting = True
        self._wait_s = FIRST_WAIT_S
        self._attempt()

    def close(self) -> None:
        """Close the port for good."""
        self._shut()
        self.state = "ended"

    def _shut(self) -> None:
        inner, self._inner = self._inner, None
        if inner is not None:
            inner.close()
