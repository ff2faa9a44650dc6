"""Lending a port to another hostkit process, so that a board can be flashed while it is watched.

Who has a port open listens on a Unix-domain socket in a folder that only its user may enter. Who
wants the port sends ``release`` there, gets ``released`` once it is closed, and keeps the
connection as long as it has the port. When the connection ends, however that comes about, the
port is taken again.
"""

import contextlib
import hashlib
import os
import socket
import stat
import tempfile
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Protocol, runtime_checkable

from hostkit.errors import DeviceError
from hostkit.link.ports.protocol import PortState

ASK, GRANTED, REFUSED = b"release\n", b"released\n", b"refused\n"
POLL_S = 0.2
ANSWER_S = 10.0
JOIN_S = 2.0
FOLDER_BYTES = 70
"""The path of a socket may have about 100 bytes; a longer folder is not used."""


@runtime_checkable
class LeasablePort(Protocol):
    """A port that can be closed for a while."""

    @property
    def state(self) -> PortState:
        """Whether it is open."""

    def release(self) -> None:
        """Close it; it is closed when this returns."""

    def take(self) -> None:
        """Open it again, now or as soon as it can be."""


def lease_folder() -> Path | None:
    """Return the folder of the sockets, made if it is not there; None if there is no safe one."""
    if not hasattr(socket, "AF_UNIX") or not hasattr(os, "getuid"):
        return None
    folder = Path(tempfile.gettempdir()) / f"hostkit-{os.getuid()}"
    runtime = Path(os.environ.get("XDG_RUNTIME_DIR") or "/nonexistent")
    if runtime.is_dir() and len(os.fsencode(runtime)) < FOLDER_BYTES:
        folder = runtime / "hostkit"
    try:
        with contextlib.suppress(FileExistsError):
            folder.mkdir(mode=0o700)
        found = folder.lstat()
    except OSError:
        return None
    private = found.st_uid == os.getuid() and not found.st_mode & 0o077
    return folder if stat.S_ISDIR(found.st_mode) and private else None


def socket_path(device: str) -> Path | None:
    """Return where the holder of a port listens; a hash, as the name of a socket must be short."""
    folder = lease_folder()
    if folder is None:
        return None
    real = os.path.realpath(device)
    return folder / f"{hashlib.sha256(real.encode()).hexdigest()[:16]}.sock"


def offer_port(port: LeasablePort, device: Callable[[], str]) -> Callable[[], None]:
    """Lend a port to whoever asks, until the function that is returned is called.

    Where the system has no private folder or no such sockets, nothing is offered.

    Parameters
    ----------
    device
        The name of the port, which may change when it is plugged in again.
    """
    offer = _Offer(port, device)
    return offer.close


class _Offer:
    """The thread of a holder."""

    def __init__(self, port: LeasablePort, device: Callable[[], str]) -> None:
        self._port = port
        self._device = device
        self._stop = threading.Event()
        self._path: Path | None = None
        self._listener: socket.socket | None = None
        self._follow()
        self._thread = threading.Thread(target=self._run, name="hostkit lease", daemon=True)
        self._thread.start()

    def close(self) -> None:
        self._stop.set()
        if threading.current_thread() is not self._thread:
            self._thread.join(JOIN_S)

    def _run(self) -> None:
        try:
            while not self._stop.is_set():
                self._follow()
                connection = self._accept()
                if connection is not None:
                    with connection, contextlib.suppress(OSError):
                        self._lend(connection)
        finally:
            self._withdraw()

    def _follow(self) -> None:
        """Listen under the name that the port has now."""
        path = socket_path(self._device()) if self._port.state == "connected" else self._path
        if path == self._path and self._listener is not None:
            return
        self._withdraw()
        if path is not None and not _answers(path):
            self._listen(path)

    def _listen(self, path: Path) -> None:
        listener = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        try:
            path.unlink(missing_ok=True)
            listener.bind(str(path))
            listener.listen(2)
        except OSError:
            listener.close()
            return
        listener.settimeout(POLL_S)
        self._path, self._listener = path, listener

    def _accept(self) -> socket.socket | None:
        if self._listener is None:
            self._stop.wait(POLL_S)
            return None
        try:
            return self._listener.accept()[0]
        except OSError:
            return None

    def _lend(self, connection: socket.socket) -> None:
        connection.settimeout(POLL_S)
        if connection.recv(len(ASK)) != ASK:
            return
        was_released = self._port.state == "released"
        try:
            self._port.release()
        except DeviceError:
            connection.sendall(REFUSED)
            return
        try:
            connection.sendall(GRANTED)
            self._wait_for_end(connection)
        finally:
            if not was_released and not self._stop.is_set():
                with contextlib.suppress(DeviceError):
                    self._port.take()

    def _wait_for_end(self, connection: socket.socket) -> None:
        while not self._stop.is_set():
            try:
                if not connection.recv(64):
                    return
            except TimeoutError:
                continue
            except OSError:
                return

    def _withdraw(self) -> None:
        listener, self._listener = self._listener, None
        if listener is not None and self._path is not None:
            listener.close()
            with contextlib.suppress(OSError):
                self._path.unlink(missing_ok=True)
        self._path = None


def _answers(path: Path) -> bool:
    """Tell whether somebody listens there; a socket that was left behind refuses."""
    with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as probe:
        probe.settimeout(POLL_S)
        try:
            probe.connect(str(path))
        except (ConnectionError, FileNotFoundError):
            return False
        except OSError:
            return True
    return True


@contextlib.contextmanager
def borrow_port(device: str) -> Iterator[bool]:
    """Have a port to oneself; yield whether another hostkit process released it for that.

    Raises
    ------
    DeviceError
        If the process that has it does not let go.
    """
    path = socket_path(device)
    if path is None:
        yield False
        return
    with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as connection:
        connection.settimeout(ANSWER_S)
        try:
            connection.connect(str(path))
        except OSError:
            yield False
            return
        _ask(connection, device)
        yield True


def _ask(connection: socket.socket, device: str) -> None:
    try:
        connection.sendall(ASK)
        answer = connection.recv(len(GRANTED))
    except OSError as error:
        raise DeviceError(
            f"port {device} is held by another hostkit process that does not answer within "
            f"{ANSWER_S:g} s; end that one first"
        ) from error
    if answer != GRANTED:
        raise DeviceError(f"port {device} is held by another hostkit process that does not let go")
