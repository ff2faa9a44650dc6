"""A thread that empties a port, so that whoever looks at the bytes may take its time."""

import contextlib
import threading
import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field

from hostkit.errors import DeviceError
from hostkit.link.ports.protocol import PortState
from hostkit.link.ports.reconnect import Reconnecting

QUEUE_BYTES = 8 << 20
HANDOVER_S = 0.04
"""Judging costs more for each batch than for each sample of it."""
REST_S = 0.004
"""Between two reads; so finely it is known when something came."""
BATCH_BYTES = 2048
"""More than this at once means that more is waiting, where a serial port keeps 4096 bytes."""
READ_S = 0.05
ORDER_S = 5.0
"""How long the thread may take to release or take a port: opening may wait for a network."""
JOIN_S = 2.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Arrival:
    """When some bytes came, ns of the monotonic clock, and where they end in their batch."""

    end: int
    received_ns: int


@dataclass(slots=True)
class _Batch:
    """Bytes of one epoch that nobody has taken yet."""

    epoch: int
    data: bytearray = field(default_factory=bytearray)
    arrivals: list[Arrival] = field(default_factory=list)


class Pump:
    """Reads a port in a thread of its own into a bounded queue.

    The queue holds 8 MiB. When it is full the newest bytes are dropped and counted in
    `overrun_bytes`; those that are in it stay in order. What is in it is handed over once in 40 ms
    at most, and says when each of its pieces came.

    Attributes
    ----------
    state
        Of the port, now.
    epoch
        Of the bytes that were last read: a batch never holds bytes of two epochs.
    arrivals
        When the pieces of the bytes came that were last read.
    reason
        Why the port cannot be opened again; empty while it is open.

    Parameters
    ----------
    port
        What is read; from now on only the thread touches it.
    queue_bytes
        Size of the queue.
    handover_s
        Least time between two batches.
    rest_s
        Time between two reads, while less than 2 KiB comes at once.
    """

    live = True

    def __init__(
        self,
        port: Reconnecting,
        *,
        queue_bytes: int = QUEUE_BYTES,
        handover_s: float = HANDOVER_S,
        rest_s: float = REST_S,
    ) -> None:
        self._port = port
        self._limit = queue_bytes
        self._handover_s, self._rest_s = handover_s, rest_s
        self._due_s = 0.0
        self._queue: deque[_Batch] = deque()
        self._queued_bytes = 0
        self._changed = threading.Condition()
        self._stop = threading.Event()
        self._order: Callable[[], None] | None = None
        self._ended = False
        self._failure: BaseException | None = None
        self._companions = contextlib.ExitStack()
        self.epoch = port.epoch
        self.arrivals: tuple[Arrival, ...] = ()
        self.overrun_bytes = 0
        self._thread = threading.Thread(target=self._run, name="hostkit pump", daemon=True)
        self._thread.start()

    @property
    def state(self) -> PortState:
        """State of the port, now."""
        return self._port.state

    @property
    def reason(self) -> str:
        """Why the port cannot be opened again; empty while it is open."""
        return self._port.problem

    def read(self, timeout_s: float) -> bytes | None:
        """Return everything that came, nothing if nothing did within `timeout_s`, None at the end.

        Raises
        ------
        DeviceError
            If the thread failed; what it had read before has been returned by then.
        """
        self._stop.wait(min(max(self._due_s - time.monotonic(), 0.0), timeout_s))
        with self._changed:
            self._changed.wait_for(lambda: self._queue or self._ended, timeout_s)
            self.arrivals = ()
            if self._queue:
                batch = self._queue.popleft()
                self._queued_bytes -= len(batch.data)
                self._due_s = time.monotonic() + self._handover_s
                self.epoch, self.arrivals = batch.epoch, tuple(batch.arrivals)
                return bytes(batch.data)
            if self._failure is not None:
                raise DeviceError(f"reading the port failed: {self._failure}") from self._failure
            self.epoch = self._port.epoch
            return None if self._ended else b""

    def write(self, data: bytes) -> None:
        """Send to the device, from any thread; what cannot be sent at once is lost."""
        self._port.write(data)

    def release(self) -> None:
        """Close the port so that another program may have it; it is closed when this returns.

        Raises
        ------
        DeviceError
            If the port does not come free.
        """
        self._do(lambda: self._port.release())

    def take(self) -> None:
        """Take a released port again, at once if it can be, else as soon as it can be.

        Raises
        ------
        DeviceError
            If the thread does not answer.
        """
        self._do(lambda: self._port.take())

    def _do(self, order: Callable[[], None]) -> None:
        """Have the thread do something between two reads, and wait until it has."""
        with self._changed:
            free = self._changed.wait_for(lambda: self._order is None or self._ended, ORDER_S)
            if not free or self._ended:
                raise DeviceError("the port is not being read any more")
            self._order = order
            self._changed.wait_for(lambda: self._order is not order or self._ended, ORDER_S)
            if self._order is order:
                raise DeviceError(f"the port did not answer within {ORDER_S:g} s")

    def close_too(self, close: Callable[[], None]) -> None:
        """Call `close` before the port is closed."""
        self._companions.callback(close)

    def close(self) -> None:
        """Close the port and end the thread."""
        self._companions.close()
        self._stop.set()
        if threading.current_thread() is not self._thread:
            self._thread.join(JOIN_S)

    def _run(self) -> None:
        try:
            while not self._stop.is_set():
                self._obey()
                data = self._port.read(READ_S)
                if data is None:
                    break
                self._put(data)
                if 0 < len(data) < BATCH_BYTES:
                    time.sleep(self._rest_s)
        except BaseException as error:  # told to the reader, who would otherwise wait for ever
            self._failure = error
        finally:
            self._finish()

    def _finish(self) -> None:
        with contextlib.suppress(Exception):
            self._port.close()
        with self._changed:
            self._ended = True
            self._changed.notify_all()

    def _obey(self) -> None:
        if self._order is None:
            return
        try:
            self._order()
        finally:
            with self._changed:
                self._order = None
                self._changed.notify_all()

    def _put(self, data: bytes) -> None:
        if not data:
            return
        epoch = self._port.epoch
        with self._changed:
            room = self._limit - self._queued_bytes
            kept = data[:room]
            self.overrun_bytes += len(data) - len(kept)
            if kept:
                self._append(epoch, kept)
                self._changed.notify_all()

    def _append(self, epoch: int, data: bytes) -> None:
        """Put bytes behind those of the same epoch; many small pieces would cost memory."""
        self._queued_bytes += len(data)
        if not self._queue or self._queue[-1].epoch != epoch:
            self._queue.append(_Batch(epoch))
        batch = self._queue[-1]
        batch.data.extend(data)
        batch.arrivals.append(Arrival(end=len(batch.data), received_ns=time.monotonic_ns()))
