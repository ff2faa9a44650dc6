"""Where bytes come from: a serial port or pty, TCP, UDP, or a recorded tlog."""

import contextlib
import errno
import socket
from pathlib import Path
from typing import Literal, Protocol

import serial

from hostkit.errors import DeviceError
from hostkit.link.tlog import read_tlog

READ_BYTES = 4096
CONNECT_TIMEOUT_S = 5.0
WRITE_TIMEOUT_S = 0.1


PortState = Literal["connected", "lost", "released", "ended"]
"""A port is lost while it is waited for, released while another program may have it."""


class Transport(Protocol):
    """A source of bytes that always comes back, and a way to the device.

    Attributes
    ----------
    live
        Whether the other end is a device, so that an end of the stream is a loss.
    state
        Whether it is open.
    epoch
        Rises by one whenever it was opened anew: counters and half frames from before are void.
    overrun_bytes
        Bytes that were received and dropped, because nobody took them in time.
    """

    live: bool
    state: PortState
    epoch: int
    overrun_bytes: int

    def read(self, timeout_s: float) -> bytes | None:
        """Return what came within `timeout_s`, nothing if nothing did, None at the end."""

    def write(self, data: bytes) -> None:
        """Send to the device; what cannot be sent at once is lost, and nothing is raised."""

    def close(self) -> None:
        """Release the port."""


def open_transport(port: str, baud: int) -> Transport:
    """Open a port by its name.

    Parameters
    ----------
    port
        ``tcp:HOST:PORT``, ``udp:HOST:PORT`` (listens there), ``file:FLIGHT.tlog``, or the name of
        a serial port or pseudo-terminal.
    baud
        Bit rate of a serial port.

    Raises
    ------
    DeviceError
        If the port does not exist, is busy, forbidden or not of one of these forms.
    """
    kind, _, rest = port.partition(":")
    if kind == "tcp":
        return SocketTransport(_connect(rest))
    if kind == "udp":
        return SocketTransport(_listen(rest))
    if kind == "file":
        return FileTransport(Path(rest))
    return SerialTransport(port, baud)


class SerialTransport:
    """A serial port or a pseudo-terminal, opened for us alone."""

    live = True

    def __init__(self, port: str, baud: int) -> None:
        self.state: PortState = "connected"
        self.epoch = 0
        self.overrun_bytes = 0
        try:
            self._port = serial.Serial(
                port, baud, timeout=0.1, write_timeout=WRITE_TIMEOUT_S, exclusive=True
            )
        except (serial.SerialException, OSError, ValueError) as error:
            raise DeviceError(_explain(port, error)) from error
        self._name = port

    def read(self, timeout_s: float) -> bytes | None:
        """Return what came, None once the device is gone."""
        try:
            self._port.timeout = timeout_s
            first: bytes = self._port.read(1)
            rest: bytes = self._port.read(self._port.in_waiting) if first else b""
        except (serial.SerialException, OSError):
            self.state = "lost"
            return None
        return first + rest

    def write(self, data: bytes) -> None:
        """Send to the device; what it does not take within a moment is lost."""
        with contextlib.suppress(serial.SerialException, OSError):
            self._port.write(data)

    def close(self) -> None:
        """Release the port."""
        with contextlib.suppress(OSError):
            self._port.close()


def _explain(port: str, error: Exception) -> str:
    number = getattr(error, "errno", None)
    if number == errno.ENOENT:
        return (
            f"port {port!r} does not exist; `python -m serial.tools.list_ports` lists those that do"
        )
    if number == errno.EACCES:
        return (
            f"port {port} may not be opened: permission denied; join the group that owns it, "
            "usually `sudo usermod -aG dialout $USER`, then log in again"
        )
    if number in (errno.EBUSY, errno.EAGAIN) or "lock" in str(error).lower():
        return f"port {port} is in use by another program; close it there first"
    return f"port {port} cannot be opened: {error}"


class SocketTransport:
    """A connected TCP socket, or a UDP socket that listens."""

    live = True

    def __init__(self, connection: socket.socket) -> None:
        self.state: PortState = "connected"
        self.epoch = 0
        self.overrun_bytes = 0
        self._socket = connection
        self._stream = connection.type == socket.SOCK_STREAM
        self._peer: tuple[object, ...] | None = None

    def read(self, timeout_s: float) -> bytes | None:
        """Return what came, None once the peer has closed the connection."""
        self._socket.settimeout(timeout_s)
        try:
            received, peer = self._socket.recvfrom(65536)
        except TimeoutError:
            return b""
        except OSError:
            received, peer = b"", None
        if self._stream and not received:
            self.state = "lost"
            return None
        self._peer = peer
        return received

    def write(self, data: bytes) -> None:
        """Send to the peer; over UDP to whoever sent last."""
        with contextlib.suppress(OSError):
            self._socket.settimeout(WRITE_TIMEOUT_S)
            if self._stream:
                self._socket.sendall(data)
            elif self._peer is not None:
                self._socket.sendto(data, self._peer)

    def close(self) -> None:
        """Close the socket."""
        self._socket.close()


def _address(text: str) -> tuple[str, int]:
    host, _, number = text.rpartition(":")
    if not host or not number.isdigit() or not 0 < int(number) < 65536:
        raise DeviceError(f"{text!r} is not HOST:PORT with a port from 1 to 65535")
    return host.strip("[]"), int(number)


def _connect(text: str) -> socket.socket:
    try:
        return socket.create_connection(_address(text), timeout=CONNECT_TIMEOUT_S)
    except OSError as error:
        raise DeviceError(f"tcp:{text} cannot be reached: {error}") from error


def _listen(text: str) -> socket.socket:
    host, number = _address(text)
    try:
        family = socket.getaddrinfo(host, number, type=socket.SOCK_DGRAM)[0][0]
        listener = socket.socket(family, socket.SOCK_DGRAM)
    except OSError as error:
        raise DeviceError(f"udp:{text} cannot be listened on: {error}") from error
    try:
        listener.bind((host, number))
    except OSError as error:
        listener.close()
        raise DeviceError(f"udp:{text} cannot be listened on: {error}") from error
    return listener


class FileTransport:
    """The frames of a tlog, as fast as they are asked for."""

    live = False

    def __init__(self, path: Path) -> None:
        self.state: PortState = "connected"
        self.epoch = 0
        self.overrun_bytes = 0
        self._frames = read_tlog(path)

    def read(self, timeout_s: float) -> bytes | None:
        """Return some frames, None at the end."""
        chunk = b""
        for frame in self._frames:
            chunk += frame
            if len(chunk) >= READ_BYTES:
                break
        if not chunk:
            self.state = "ended"
        return chunk or None

    def write(self, data: bytes) -> None:
        """Do nothing: a file listens to nobody."""

    def close(self) -> None:
        """Close the file."""
        self._frames.close()
