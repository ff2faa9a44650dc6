"""A serial port or a pseudo-terminal, opened for one program alone."""

import contextlib
import errno
import threading
import time
from typing import Any

import serial

from hostkit.errors import DeviceError
from hostkit.link.ports.port_use import user_of
from hostkit.link.ports.protocol import WRITE_TIMEOUT_S, PortState

FAILURES: tuple[type[Exception], ...] = (serial.SerialException, OSError, ValueError)
with contextlib.suppress(ImportError):
    import termios

    FAILURES += (termios.error,)
# A port that goes away while pyserial sets it up raises the error of termios, which is no OSError.

READ_BYTES = 65536
READ_TIMEOUT_S = 0.1
URLS = ("socket", "rfc2217")
URL_READ_BYTES = 4096
URL_WAIT_S = 0.02
"""pyserial cannot tell how much waits behind a URL, so its reads are cut by time."""


class SerialTransport:
    """A serial port, a pseudo-terminal, or one of pyserial's ``socket://`` and ``rfc2217://``.

    Opening raises DTR and RTS, which is pyserial's default and what most boards expect: an Arduino
    Uno, Nano or Mega resets then, a Raspberry Pi Pico begins to talk. The 1200 baud that put some
    boards into their boot loader are never set on the way.

    Raises
    ------
    DeviceError
        If the port does not exist, may not be opened, or is in use.
    """

    live = True

    def __init__(self, port: str, baud: int) -> None:
        self.state: PortState = "connected"
        self.epoch = 0
        self.overrun_bytes = 0
        self.baud = baud
        self._is_url = "://" in port
        self._writing = threading.Lock()
        try:
            self._port = _open(port, baud)
        except FAILURES as error:
            raise DeviceError(explain(port, error)) from error

    def read(self, timeout_s: float) -> bytes | None:
        """Return what came, None once the device is gone."""
        try:
            return self._read(timeout_s)
        except FAILURES:
            self.state = "lost"
            return None

    def _read(self, timeout_s: float) -> bytes:
        if self._is_url:
            return self._read_url(timeout_s)
        if self._port.timeout != timeout_s:
            self._port.timeout = timeout_s
        first: bytes = self._port.read(1)
        if not first:
            return b""
        return first + bytes(self._port.read(min(self._port.in_waiting, READ_BYTES)))

    def _read_url(self, timeout_s: float) -> bytes:
        """Read with the one time-out that was set: a new one is negotiated over the network."""
        end_s = time.monotonic() + timeout_s
        while True:
            data = bytes(self._port.read(URL_READ_BYTES))
            if data or time.monotonic() >= end_s:
                return data

    def write(self, data: bytes) -> None:
        """Send to the device; what it does not take within a moment is lost. Thread-safe."""
        with self._writing, contextlib.suppress(*FAILURES):
            self._port.write(data)

    def set_baud(self, baud: int) -> bool:
        """Change the bit rate and drop what came before; tell whether the port can do it."""
        try:
            self._port.baudrate = baud
            self._port.reset_input_buffer()
        except FAILURES:
            return False
        self.baud = baud
        return True

    def close(self) -> None:
        """Release the port."""
        with self._writing, contextlib.suppress(*FAILURES):
            self._port.close()


def _open(port: str, baud: int) -> Any:
    kind, mark, _ = port.partition("://")
    if not mark:
        return serial.Serial(
            port, baud, exclusive=True, timeout=READ_TIMEOUT_S, write_timeout=WRITE_TIMEOUT_S
        )
    if kind not in URLS:
        raise ValueError(f"of pyserial's URLs hostkit takes {' and '.join(URLS)}")
    return serial.serial_for_url(port, baud, timeout=URL_WAIT_S)


def explain(port: str, error: Exception) -> str:
    """Say why a port could not be opened and what would help."""
    number = getattr(error, "errno", None)
    if number in (errno.ENOENT, errno.ENODEV, errno.ENXIO):
        return f"port {port!r} does not exist; `hostkit ports` lists those that do"
    if number == errno.EACCES:
        return (
            f"port {port} may not be opened: permission denied; join the group that owns it, "
            "usually `sudo usermod -aG dialout $USER`, then log in again"
        )
    if number in (errno.EBUSY, errno.EAGAIN) or "lock" in str(error).lower():
        user = user_of(port) or "another program"
        return f"port {port} is in use by {user}; close it there first"
    return f"port {port} cannot be opened: {error}"
