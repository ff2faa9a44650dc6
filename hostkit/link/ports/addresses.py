"""Places that datagrams go to."""

import socket
from dataclasses import dataclass
from typing import Any

from hostkit.errors import DeviceError


@dataclass(frozen=True, slots=True, kw_only=True)
class Place:
    """A resolved ``udp:HOST:PORT``: the family of its address, and what a socket takes."""

    text: str
    family: socket.AddressFamily
    address: tuple[Any, ...]


def resolve_udp(text: str) -> Place:
    """Resolve ``udp:HOST:PORT``, once.

    Raises
    ------
    DeviceError
        If it is not of that form, or the host is not known.
    """
    kind, _, rest = text.partition(":")
    host, _, number = rest.rpartition(":")
    good = number.isascii() and number.isdigit() and len(number) <= 5
    if kind != "udp" or not host or not good or not 0 < int(number) < 65536:
        raise DeviceError(f"{text!r} is not udp:HOST:PORT with a port from 1 to 65535")
    try:
        found = socket.getaddrinfo(host.strip("[]"), int(number), type=socket.SOCK_DGRAM)
    except (OSError, UnicodeError) as error:
        raise DeviceError(f"{text}: the host {host!r} is not known: {error}") from error
    family, _, _, _, address = found[0]
    return Place(text=text, family=socket.AddressFamily(family), address=address)


def open_udp(place: Place) -> socket.socket:
    """Open a socket that sends there, hears from there only, and never waits.

    Raises
    ------
    DeviceError
        If the system does not give one, or has no way there.
    """
    opened = socket.socket(place.family, socket.SOCK_DGRAM)
    try:
        opened.setblocking(False)
        opened.connect(place.address)
    except OSError as error:
        opened.close()
        raise DeviceError(f"{place.text} cannot be reached: {error.strerror}") from error
    return opened
