"""TCP and UDP as sources of bytes."""

import contextlib
import select
import socket
import threading

from hostkit.errors import DeviceError
from hostkit.link.ports.protocol import WRITE_TIMEOUT_S, PortState

CONNECT_TIMEOUT_S = 5.0
READ_BYTES = 65536
MOST_BYTES = 1 << 18
"""What one read takes at most, so that a flood of datagrams cannot hold it."""
UNREACHABLE = (OSError, ValueError)
"""A host name that cannot be one, such as ``a..b``, is a ValueError."""
RECEIVE_BUFFER_BYTES = 1 << 20
KEEPALIVE_S = 5
"""A TCP peer that vanished without a word is noticed after about three times as long."""


class SocketTransport:
    """A connected TCP socket, or a UDP socket that listens.

    Attributes
    ----------
    peer
        Over UDP, whoever sent last; there goes what is written.
    """

    live = True

    def __init__(self, connection: socket.socket) -> None:
        self.state: PortState = "connected"
        self.epoch = 0
        self.overrun_bytes = 0
        self.peer: tuple[object, ...] | None = None
        self._socket = connection
        self._writing = threading.Lock()
        self._stream = connection.type == socket.SOCK_STREAM
        connection.setblocking(False)

    def read(self, timeout_s: float) -> bytes | None:
        """Return what came, None once the peer has closed the connection."""
        try:
            if not select.select([self._socket], [], [], timeout_s)[0]:
                return b""
            return self._received()
        except (OSError, ValueError):
            self.state = "lost"
            return None

    def _received(self) -> bytes | None:
        """Return everything that waits; a socket gives one datagram at a time."""
        parts: list[bytes] = []
        size = 0
        while size < MOST_BYTES:
            try:
                part, peer = self._socket.recvfrom(READ_BYTES)
            except BlockingIOError:
                break
            except ConnectionError:
                if self._stream:
                    raise
                break  # Windows: an answer of ours met nobody; the others may still talk
            if self._stream:
                if not part and not parts:
                    raise ConnectionResetError("closed by the peer")
                parts.append(part)
                break
            self.peer = peer
            parts.append(part)
            size += len(part) + 1
        return b"".join(parts)

    def write(self, data: bytes) -> None:
        """Send to the peer; over UDP to whoever sent last. Thread-safe."""
        with self._writing, contextlib.suppress(OSError, ValueError):
            if not self._stream:
                if self.peer is not None:
                    self._socket.sendto(data, self.peer)
                return
            while data and select.select([], [self._socket], [], WRITE_TIMEOUT_S)[1]:
                data = data[self._socket.send(data) :]

    def close(self) -> None:
        """Close the socket."""
        with self._writing:
            self._socket.close()


def connect(address: str, timeout_s: float = CONNECT_TIMEOUT_S) -> SocketTransport:
    """Connect to ``HOST:PORT`` by TCP.

    Raises
    ------
    DeviceError
        If the address is none, or nobody answers there within `timeout_s`.
    """
    place = _address(address)
    try:
        connection = socket.create_connection(place, timeout=timeout_s)
    except UNREACHABLE as error:
        raise DeviceError(f"tcp:{address} cannot be reached: {error}") from error
    connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    _keep_alive(connection)
    return SocketTransport(connection)


def _keep_alive(connection: socket.socket) -> None:
    connection.setsockopt(socket.SOL_SOCKET, socket.SO_KEEPALIVE, 1)
    for name, value in (
        ("TCP_KEEPIDLE", KEEPALIVE_S),
        ("TCP_KEEPINTVL", KEEPALIVE_S),
        ("TCP_KEEPCNT", 2),
    ):
        if hasattr(socket, name):
            connection.setsockopt(socket.IPPROTO_TCP, getattr(socket, name), value)


def listen(address: str) -> SocketTransport:
    """Listen on ``HOST:PORT`` by UDP.

    Raises
    ------
    DeviceError
        If the address is none, is not of this machine, or is taken.
    """
    place = _address(address)
    try:
        family, _, _, _, found = socket.getaddrinfo(*place, type=socket.SOCK_DGRAM)[0]
        listener = socket.socket(family, socket.SOCK_DGRAM)
    except UNREACHABLE as error:
        raise DeviceError(f"udp:{address} cannot be listened on: {error}") from error
    try:
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, RECEIVE_BUFFER_BYTES)
        listener.bind(found)
    except OSError as error:
        listener.close()
        raise DeviceError(f"udp:{address} cannot be listened on: {error}") from error
    return SocketTransport(listener)


def _address(text: str) -> tuple[str, int]:
    host, _, number = text.rpartition(":")
    if not host or not (number.isascii() and number.isdigit()) or not 0 < int(number) < 65536:
        raise DeviceError(f"{text!r} is not HOST:PORT with a port from 1 to 65535")
    if host.startswith("[") and host.endswith("]"):
        host = host[1:-1]
    return host, int(number)
