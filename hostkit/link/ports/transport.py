"""Where bytes come from: a serial port or pty, TCP, UDP, or a recorded tlog."""

from functools import partial
from pathlib import Path

from hostkit.errors import DeviceError
from hostkit.link.clock import Clock, SystemClock
from hostkit.link.logs.tlog import read_tlog
from hostkit.link.ports.baud_scan import RATES, scan_baud
from hostkit.link.ports.finder import PortFinder
from hostkit.link.ports.lease import offer_port
from hostkit.link.ports.protocol import PortState, Transport
from hostkit.link.ports.pump import Pump
from hostkit.link.ports.reconnect import Reconnecting
from hostkit.link.ports.serial_port import SerialTransport
from hostkit.link.ports.sockets import connect, listen

__all__ = ["FileTransport", "PortState", "Transport", "open_link", "open_transport"]

READ_BYTES = 4096
RECONNECT_TIMEOUT_S = 1.0
"""Of TCP; the first connection may take longer."""


def open_transport(port: str, baud: int) -> Transport:
    """Open a port by its name, once.

    Parameters
    ----------
    port
        ``tcp:HOST:PORT``, ``udp:HOST:PORT`` (listens there), ``file:FLIGHT.tlog``, the name of a
        serial port or pseudo-terminal, ``socket://`` or ``rfc2217://`` of pyserial, ``auto`` for
        the only USB serial port, ``usb:VID:PID``, ``usb:SERIAL``, or a pattern such as
        ``/dev/ttyUSB*`` that one port matches.
    baud
        Bit rate of a serial port.

    Raises
    ------
    DeviceError
        If the port does not exist, is busy, forbidden or not of one of these forms.
    """
    kind, _, rest = port.partition(":")
    if kind == "tcp":
        return connect(rest)
    if kind == "udp":
        return listen(rest)
    if kind == "file":
        return FileTransport(Path(rest))
    return SerialTransport(PortFinder(port).find(), baud)


def open_link(
    port: str, baud: int | None, *, reconnect: bool = True, clock: Clock | None = None
) -> Transport:
    """Open a port for a session: read by a thread, opened again when it was lost.

    Parameters
    ----------
    port
        As for :func:`open_transport`.
    baud
        Bit rate of a serial port; None finds it out.
    reconnect
        Whether to wait for a device that went away; otherwise the stream ends there.

    Raises
    ------
    DeviceError
        If the port cannot be opened, or nothing that is MAVLink comes out of it at any rate.
    """
    kind, _, rest = port.partition(":")
    clock = clock or SystemClock()
    if kind == "file":
        return open_transport(port, 0)
    if kind == "udp":
        return Pump(Reconnecting(lambda: listen(rest), keep=reconnect, clock=clock))
    if kind == "tcp":
        opener = partial(connect, rest, RECONNECT_TIMEOUT_S)
        return Pump(Reconnecting(opener, first=connect(rest), keep=reconnect, clock=clock))
    return _open_serial(port, baud, reconnect, clock)


def _open_serial(port: str, baud: int | None, reconnect: bool, clock: Clock) -> Pump:
    finder = PortFinder(port)
    first = SerialTransport(finder.find(), baud or RATES[0])
    if baud is None:
        try:
            baud = scan_baud(first, clock=clock).required_baud(port)
        except DeviceError:
            first.close()
            raise

    def opener(rate: int = baud) -> Transport:
        return SerialTransport(finder.find(), rate)

    pump = Pump(Reconnecting(opener, first=first, keep=reconnect, clock=clock))
    pump.close_too(offer_port(pump, lambda: finder.device))
    return pump


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
