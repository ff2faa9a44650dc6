"""A cable between two pseudo-terminals that can be pulled out, put back and disturbed."""

import contextlib
import os
import select
import threading
from collections.abc import Callable, Iterator
from pathlib import Path

from hostkit.emulation.pty_server import PtyPort

POLL_S = 0.05
CHUNK_BYTES = 4096


class Relay:
    """Carries bytes between a device's port and one with a name of our own.

    The device's port stays open while the cable is out, so the device runs on, as one with its own
    supply does.
    """

    def __init__(
        self,
        device_path: str,
        path: Path,
        disturb: Callable[[bytes], bytes] = lambda data: data,
    ) -> None:
        self.path = path
        self.disturb = disturb
        self.lost_bytes = 0
        self._device = os.open(device_path, os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)
        self._port: PtyPort | None = None
        self._lock = threading.Lock()
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)
        self.plug()
        self._thread.start()

    def plug(self) -> None:
        """Make a port under the same name, as a new device of the system."""
        with self._lock:
            self._port = PtyPort()
            self.path.symlink_to(self._port.path)

    def unplug(self) -> None:
        """Take the port away under its reader."""
        with self._lock:
            self.path.unlink()
            if self._port is not None:
                self._port.close()
            self._port = None

    def close(self) -> None:
        """Take both ports away."""
        self._stop.set()
        self._thread.join()
        if self._port is not None:
            self.unplug()
        os.close(self._device)

    def _run(self) -> None:
        while not self._stop.is_set():
            ready, _, _ = select.select([self._device], [], [], POLL_S / 10)
            data = b""
            if ready:
                with contextlib.suppress(OSError):
                    data = os.read(self._device, CHUNK_BYTES)
            with self._lock:
                self._carry(data)

    def _carry(self, data: bytes) -> None:
        if self._port is None:
            self.lost_bytes += len(data)
            return
        if data:
            self._port.send(self.disturb(data))
        if self._port.listening() and (back := self._port.receive()):
            with contextlib.suppress(OSError):
                os.write(self._device, back)


@contextlib.contextmanager
def relay(device_path: str, path: Path) -> Iterator[Relay]:
    """Put a cable in for a while."""
    cable = Relay(device_path, path)
    try:
        yield cable
    finally:
        cable.close()
