"""The server of the page: a thread beside the session, on loopback unless told otherwise."""

import asyncio
import ipaddress
import socket
import threading
from collections.abc import Iterable
from pathlib import Path

import uvicorn

from hostkit.errors import DeviceError
from hostkit.monitor.snapshot import Batch, Controls, Snapshot
from hostkit.web.app import Reports, Served, application
from hostkit.web.binding import is_any, listen, names
from hostkit.web.protocol import BoundedProtocol
from hostkit.web.security import access
from hostkit.web.stream import Hub

START_S = 10.0
STOP_S = 2.0
GRACE_S = 1
HEADER_BYTES = 16384
REMOTE_WARNING = (
    "the page is open to the network at {host} without encryption: whoever listens in can read its "
    "token and command the device; safer is 127.0.0.1 and, from the other machine, "
    "`ssh -L {port}:127.0.0.1:{port} THIS_MACHINE`"
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
        self._names = names(address, allowed_hosts)
        self._access = access(self.port, self._names, any_address=is_any(address))
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
        return f"http://{self._names[0]}:{self.port}/?token={self._access.token}"

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
        serving = asyncio.create_task(self._uvicorn.serve(sockets=[self._socket]))
        flushing = asyncio.create_task(self._hub.run())
        await asyncio.wait((serving, flushing), return_when=asyncio.FIRST_COMPLETED)
        if flushing.done():
            # A page that stands still without a word would be worse than none.
            self._hub.end()
            self._uvicorn.should_exit = True
            await serving
            flushing.result()
        flushing.cancel()
        await serving


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
        app,  # type: ignore[arg-type]  # uvicorn and Starlette name the same interface apart
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
