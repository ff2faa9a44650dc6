"""Where the server listens, and under which names browsers may address it."""

import errno
import ipaddress
import os
import re
import socket
from collections.abc import Iterable

from hostkit.errors import DeviceError, HostkitError
from hostkit.web.security import LOOPBACK_NAMES, host_name

SEND_BUFFER_BYTES = 262144
"""What the kernel holds for a page that does not read: a bound on how far it can fall behind."""

NAME = r"[\w.-]+|\[[0-9a-f:.]+\]"


def listen(host: str, port: int, *, allow_remote: bool = False) -> socket.socket:
    """Return a listening socket.

    Raises
    ------
    HostkitError
        If it would be reachable from elsewhere and that was not asked for.
    DeviceError
        If the name is unknown, or the address or the port cannot be had.
    """
    if not 0 <= port <= 65535:
        raise DeviceError(f"port {port} is outside [0, 65535]")
    try:
        found = socket.getaddrinfo(host.strip("[]"), port, type=socket.SOCK_STREAM)
    except (OSError, UnicodeError) as error:
        raise DeviceError(f"{host!r} is no address of this machine: {error}") from error
    family, _, _, _, address = found[0]
    if not allow_remote and not ipaddress.ip_address(str(address[0])).is_loopback:
        raise HostkitError(
            f"{host} can be reached from other machines, and the page has no encryption; "
            "127.0.0.1 is safe, --web-allow-remote overrides this"
        )
    return _bound(family, address, host, port)


def _bound(
    family: socket.AddressFamily, address: tuple[object, ...], host: str, port: int
) -> socket.socket:
    listener = socket.socket(family, socket.SOCK_STREAM)
    try:
        if os.name == "posix":
            # Elsewhere this would let two programs share a port.
            listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, SEND_BUFFER_BYTES)
        listener.bind(address)
        listener.listen(128)
    except OSError as error:
        listener.close()
        if error.errno == errno.EADDRINUSE:
            raise DeviceError(
                f"port {port} of {host} is in use by another program; --web-port 0 takes a free one"
            ) from error
        raise DeviceError(f"{host}:{port} cannot be listened on: {error}") from error
    return listener


def names(address: str, allowed: Iterable[str]) -> tuple[str, ...]:
    """Return the names of a server at an address, the best to show first, without ports.

    Raises
    ------
    HostkitError
        If one of the allowed is no name.
    """
    further = tuple(_name(host) for host in allowed)
    if is_any(address):
        return (*further, *LOOPBACK_NAMES, _name(socket.gethostname()))
    return (_name(address), *further)


def is_any(address: str) -> bool:
    """Return whether a server at this address is at every address of the machine."""
    return ipaddress.ip_address(address).is_unspecified


def _name(host: str) -> str:
    bare_ipv6 = host.count(":") > 1 and not host.startswith("[")
    name = f"[{host}]".lower() if bare_ipv6 else host_name(host)
    if not re.fullmatch(NAME, name):
        raise HostkitError(f"{host!r} is no host name; such as bench.local would be one")
    return name
