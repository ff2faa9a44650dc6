"""Which serial ports there are, what is behind them, and finding one again."""

import os
import re
from collections.abc import Callable
from dataclasses import dataclass, replace
from glob import glob
from pathlib import Path

from serial.tools.list_ports import comports

from hostkit.errors import DeviceError
from hostkit.link.ports.boards import board_of
from hostkit.link.ports.port_use import Access, access_of, user_of

PTY_FOLDER = "/dev/pts/"
USB_ID = re.compile(r"([0-9a-f]{4}):([0-9a-f]{4})", re.IGNORECASE)


@dataclass(frozen=True, slots=True, kw_only=True)
class PortInfo:
    """A serial port.

    Attributes
    ----------
    device
        Its name, to be given to ``--port``.
    vid, pid
        Ids of vendor and product; None where it is not on USB.
    known_as
        What those ids usually are; empty where they are not known.
    candidate
        Whether ``--port auto`` takes it into account.
    access
        Whether it may be opened, as far as can be told without opening it.
    used_by
        The program that has it open, as far as that can be told; empty otherwise.
    """

    device: str
    description: str = ""
    vid: int | None = None
    pid: int | None = None
    serial_number: str | None = None
    manufacturer: str | None = None
    known_as: str = ""
    candidate: bool = False
    access: Access = "unknown"
    used_by: str = ""

    @property
    def usb_id(self) -> str:
        """``VID:PID`` in hex; empty where it is not on USB."""
        if self.vid is None or self.pid is None:
            return ""
        return f"{self.vid:04x}:{self.pid:04x}"

    def line(self) -> str:
        """Return it in one line."""
        parts = [self.known_as or self.description, self.usb_id]
        if self.serial_number:
            parts.append(f"serial number {self.serial_number}")
        return f"{self.device} ({', '.join(part for part in parts if part)})"


def _is_one(first: str, second: str) -> bool:
    """Tell whether two names are of one port; unlike pathlib's, this never raises at a loop."""
    return os.path.realpath(first) == os.path.realpath(second)


Listing = Callable[[], tuple[PortInfo, ...]]


def list_ports() -> tuple[PortInfo, ...]:
    """Return the serial ports of this machine in the order of their names; none is opened.

    Access and use are not looked up; see :func:`with_use`.
    """
    return tuple(_info(found) for found in sorted(comports()))


def port_info(device: str) -> PortInfo:
    """Return what is known of a port by its name, which may be a link or a pseudo-terminal."""
    for port in list_ports():
        if _is_one(port.device, device):
            return replace(port, device=device)
    is_pty = os.path.realpath(device).startswith(PTY_FOLDER)
    return PortInfo(device=device, description="pseudo-terminal" if is_pty else "")


def with_use(port: PortInfo) -> PortInfo:
    """Return a port with its access and its user."""
    return replace(port, access=access_of(port.device), used_by=user_of(port.device))


def _info(found: object) -> PortInfo:
    """Take over what pyserial found; everything but the name may be missing."""
    device = str(getattr(found, "device", ""))
    vid, pid = getattr(found, "vid", None), getattr(found, "pid", None)
    description = getattr(found, "description", None)
    return PortInfo(
        device=device,
        description="" if description in (None, "n/a") else _printable(description),
        vid=vid,
        pid=pid,
        serial_number=_printable(getattr(found, "serial_number", None)) or None,
        manufacturer=_printable(getattr(found, "manufacturer", None)) or None,
        known_as="" if vid is None or pid is None else board_of(vid, pid),
        candidate=vid is not None and not Path(device).name.startswith("ttyS"),
    )


def _printable(text: object) -> str:
    """Return what a device says of itself without what could disturb a terminal."""
    return "".join(c for c in str(text or "") if c.isprintable())[:80]


def pick_port(port: str, listing: Listing = list_ports) -> str:
    """Return the name of the port that is meant.

    Parameters
    ----------
    port
        ``auto``: the only USB serial port. ``usb:VID:PID`` or ``usb:SERIAL``: the only one with
        these ids or this serial number. A pattern with ``*``, ``?`` or ``[``: the only match.
        Anything else is a name already.

    Raises
    ------
    DeviceError
        If no port or more than one is meant; those that come into question are listed.
    """
    if "\0" in port:
        raise DeviceError(f"{port!r} is no name of a port: it has a NUL character")
    if port == "auto":
        return _only(port, tuple(p for p in listing() if p.candidate), listing)
    if port.startswith("usb:"):
        wanted = port.removeprefix("usb:")
        return _only(port, tuple(p for p in listing() if _is(p, wanted)), listing)
    if "://" not in port and any(mark in port for mark in "*?["):
        # Path.glob takes no absolute pattern.
        found = sorted(glob(port))  # noqa: PTH207
        names = {os.path.realpath(name): name for name in found}
        return _only(port, tuple(PortInfo(device=name) for name in names.values()), listing)
    return port


def _is(port: PortInfo, wanted: str) -> bool:
    if USB_ID.fullmatch(wanted):
        return port.usb_id == wanted.lower()
    return (port.serial_number or "").lower() == wanted.lower() != ""


def _only(asked: str, found: tuple[PortInfo, ...], listing: Listing) -> str:
    if len(found) == 1:
        return found[0].device
    if found:
        names = "; ".join(port.line() for port in found)
        raise DeviceError(f"port {asked!r} may be any of {len(found)}: {names}; name one of them")
    here = "; ".join(port.line() for port in listing() if port.candidate)
    raise DeviceError(
        f"port {asked!r} matches nothing; "
        + (f"USB serial ports here: {here}" if here else "no USB serial port is here")
    )


class PortFinder:
    """Finds a port, and finds it again when the device was unplugged and has another name.

    Attributes
    ----------
    device
        Name of the port that was found last.
    """

    def __init__(self, port: str, listing: Listing = list_ports) -> None:
        self._asked = port
        self._listing = listing
        self._known: PortInfo | None = None
        self._pty: tuple[int, int] | None = None
        self.device = ""

    def find(self) -> str:
        """Return the name of the port.

        Again it is the same name, unless another device has it now; else the port with the same
        USB serial number; else the only one with the same VID:PID.

        Raises
        ------
        DeviceError
            If it is not there, or several may be it.
        """
        if self._known is None or self._known.vid is None:
            self.device = pick_port(self._asked, self._listing)
            self._known = None if "://" in self.device else self._info_of(self.device)
            self._require_same_pty()
        else:
            self.device = self._again(self._known)
        return self.device

    def _require_same_pty(self) -> None:
        """Refuse a pseudo-terminal that only has the number of the one that is gone.

        Numbers are given out again at once, so the new one is somebody else's. Behind a link it
        is what its owner has put there.
        """
        if not self.device.startswith(PTY_FOLDER) or Path(self.device).is_symlink():
            return
        try:
            made = Path(self.device).stat()
        except OSError:
            return
        identity = (made.st_rdev, made.st_ctime_ns)
        if self._pty not in (None, identity):
            raise DeviceError(f"{self.device} is gone; the one of its name now is another's")
        self._pty = identity

    def _info_of(self, device: str) -> PortInfo | None:
        return next((p for p in self._listing() if _is_one(p.device, device)), None)

    def _again(self, known: PortInfo) -> str:
        here = self._info_of(self.device)
        if here is not None and _same(here, known):
            return self.device
        others = [port for port in self._listing() if _same(port, known)]
        if len(others) == 1:
            return others[0].device
        raise DeviceError(
            f"{known.line()} is not plugged in"
            if not others
            else f"{known.line()} cannot be told from {len(others)} ports of its kind"
        )


def _same(port: PortInfo, known: PortInfo) -> bool:
    """Tell whether a port may be the one that is known; two serial numbers tell boards apart."""
    if port.serial_number and known.serial_number:
        return port.serial_number == known.serial_number and port.vid == known.vid
    return (port.vid, port.pid) == (known.vid, known.pid)
