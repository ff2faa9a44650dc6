"""The server of the page: a thread beside the session, on loopback unless told otherwise."""

import asyncio
import errno
import ipaddress
import socket
import threading
from collections.abc import Iterable
from pathlib import Path

import uvicorn

from hostkit.errors import DeviceError, HostkitError
from hostkit.monitor.snapshot import Batch, Controls, Snapshot
from hostkit.web.app import Reports, Served, application
from hostkit.web.protocol import BoundedProtocol
from hostkit.web.security import access
from hostkit.web.stream import Hub

START_S = 10.0
STOP_S = 2.0
GRACE_S = 1
HEADER_BYTES = 16384
SEND_BUFFER_BYTES = 262144
"""What the kernel holds for a page that does not read: a bound on how far it can fall behind."""

REMOTE_WARNING = (
    "the page is open to the network at {host} without encryption: whoever listens can read its "
    "token; `ssh -L {port}:127.0.0.1:{port} THIS_MACHINE` reaches it safely without this option"
)


class Server:
    """A view of a session that shows it in browsers.

    Parameters
    ----------
    controls
        The session.
    host, port
        Where to listen; port 0 takes a free one.
    reports
        What the download buttons give.
    folder
        The folder of the session's recordings.
    allow_remote
        Whether `host` may be another than this machine's loopback.
    allowed_hosts
        Further names under which browsers may address the server.

    Raises
    ------
    HostkitError
        If `host` is reachable from elsewhere and `allow_remote` was not given.
    DeviceError
        If the address cannot be listened on.
    """

    def __init__(
        self,
        controls: Controls,
        *,
        reports: Reports,
        folder: Path,
        host: str = "127.0.0.1",
        port: int = 0,
        allow_remote: bool = False,
        allowed_hosts: Iterable[str] = (),
    ) -> None:
        self._socket = listen(host, port, allow_remote=allow_remote)
        address, self.port = self._socket.getsockname()[:2]
        self._host = _in_url(address)
        any_address = ipaddress.ip_address(address).is_unspecified
        names = [*allowed_hosts, *([] if any_address else [self._host])]
        self._shown_host = names[0] if names and any_address else self._host
        self._access = access(self.port, names)
        self._hub = Hub(controls.info(), controls.snapshot())
        self._app = application(
            Served(
                controls=controls,
                reports=reports,
                folder=folder,
                hub=self._hub,
                access=self._access,
            )
        )
        self._uvicorn = _Uvicorn(_config(self._app))
        self._thread = threading.Thread(target=self._run, name="hostkit-web", daemon=True)
        self._loop: asyncio.AbstractEventLoop | None = None
        remote = not ipaddress.ip_address(address).is_loopback
        self.warning = REMOTE_WARNING.format(host=host, port=self.port) if remote else ""
        """What the user must be told; empty for a server on loopback."""

    @property
    def url(self) -> str:
        """The address of the page with its token: to be shown to the user, and nowhere kept."""
        host = "127.0.0.1" if self._shown_host == "0.0.0.0" else self._shown_host
        host = "[::1]" if host == "[::]" else host
        return f"http://{host}:{self.port}/?token={self._access.token}"

    def start(self) -> str:
        """Serve in a thread; return `url`."""
        self._thread.start()
        if not self._uvicorn.ready.wait(START_S):
            raise DeviceError(f"the page's server did not start within {START_S:g} s")
        return self.url

    def stop(self) -> None:
        """End every stream and stop serving, within two seconds."""
        if self._loop is not None and self._thread.is_alive():
            self._loop.call_soon_threadsafe(self._finish)
            self._thread.join(STOP_S)
        self._socket.close()

    def take_batch(self, batch: Batch) -> None:
        """Take samples for the pages."""
        self._hub.take_batch(batch)

    def take_snapshot(self, snapshot: Snapshot) -> None:
        """Take the state for the pages."""
        self._hub.take_snapshot(snapshot)

    def _finish(self) -> None:
        self._hub.flush()
        self._hub.end()
        self._uvicorn.should_exit = True

    def _run(self) -> None:
        asyncio.run(self._serve())

    async def _serve(self) -> None:
        self._loop = asyncio.get_running_loop()
        flushing = asyncio.create_task(self._hub.run())
        try:
            await self._uvicorn.serve(sockets=[self._socket])
        finally:
            flushing.cancel()


class _Uvicorn(uvicorn.Server):
    def __init__(self, config: uvicorn.Config) -> None:
        super().__init__(config)
        self.ready = threading.Event()

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        await super().startup(sockets=sockets)
        self.ready.set()


def _config(app: object) -> uvicorn.Config:
    # Addresses hold the token, so nothing of a request may reach a log.
    return uvicorn.Config(
        app,  # type: ignore[arg-type]
        http=BoundedProtocol,
        ws="none",
        lifespan="off",
        loop="asyncio",
        interface="asgi3",
        log_config=None,
        log_level="critical",
        access_log=False,
        server_header=False,
        proxy_headers=False,
        timeout_keep_alive=5,
        timeout_graceful_shutdown=GRACE_S,
        h11_max_incomplete_event_size=HEADER_BYTES,
    )


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


def _in_url(address: str) -> str:
    return f"[{address}]" if ":" in address else address
