"""The application of the page, asked without a network, and a server with one."""

import asyncio
import contextlib
import json
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import httpx
from fake_session import FakeControls, FakeReports

from hostkit.web.app import Served, application
from hostkit.web.security import Access, access
from hostkit.web.server import Server
from hostkit.web.stream import Hub

PORT = 8123
HOST = f"127.0.0.1:{PORT}"
JSON = {"content-type": "application/json"}


@dataclass(frozen=True, kw_only=True)
class Reply:
    status: int
    headers: dict[str, str]
    body: bytes

    def json(self):
        return json.loads(self.body)


@dataclass(frozen=True, kw_only=True)
class App:
    """An application, what is behind it, and a way to ask it."""

    app: object
    controls: FakeControls
    access: Access
    hub: Hub
    folder: Path

    def signed_in(self, **headers: str) -> dict[str, str]:
        cookie = f"{self.access.cookie_name}={self.access.cookie}"
        return {"host": HOST, "cookie": cookie, **headers}

    def get(self, path: str, **headers: str) -> Reply:
        return self.ask("GET", path, headers=self.signed_in(**headers))

    def post(self, path: str, body: object = b"", headers: dict[str, str] | None = None) -> Reply:
        content = body if isinstance(body, bytes) else json.dumps(body).encode()
        given = self.signed_in(**{"x-hostkit-token": self.access.csrf, **JSON, **(headers or {})})
        return self.ask("POST", path, headers=given, body=content)

    def ask(self, method: str, target: str, *, headers=(), body: bytes = b"") -> Reply:
        """Ask with any headers, also such that no client would send."""
        pairs = headers.items() if isinstance(headers, dict) else headers
        path, _, query = target.partition("?")
        scope = {
            "type": "http",
            "asgi": {"version": "3.0", "spec_version": "2.3"},
            "http_version": "1.1",
            "method": method,
            "scheme": "http",
            "path": path,
            "raw_path": path.encode("utf-8", "surrogatepass"),
            "root_path": "",
            "query_string": query.encode("utf-8", "surrogatepass"),
            "headers": [(name.encode("latin-1"), value.encode("latin-1")) for name, value in pairs],
            "client": ("127.0.0.1", 50000),
            "server": ("127.0.0.1", PORT),
        }
        return asyncio.run(_exchange(self.app, scope, body))


async def _exchange(app, scope, body: bytes) -> Reply:
    requests = [{"type": "http.request", "body": body, "more_body": False}]
    answers = []

    async def receive():
        if requests:
            return requests.pop()
        # A client of a stream leaves at once; any other waits for its answer.
        if scope["path"] != "/stream":
            await asyncio.Event().wait()
        return {"type": "http.disconnect"}

    async def send(message):
        answers.append(message)

    await app(scope, receive, send)
    start = next(m for m in answers if m["type"] == "http.response.start")
    return Reply(
        status=start["status"],
        headers={name.decode().lower(): value.decode() for name, value in start["headers"]},
        body=b"".join(m.get("body", b"") for m in answers if m["type"] == "http.response.body"),
    )


def make_app(
    folder: Path,
    *,
    replayed: bool = False,
    hosts: tuple[str, ...] = (),
    controls: FakeControls | None = None,
) -> App:
    controls = controls or FakeControls(folder=folder, replayed=replayed)
    rights = access(PORT, hosts)
    hub = Hub(controls.info(), controls.snapshot())
    app = application(
        Served(controls=controls, reports=FakeReports(), folder=folder, hub=hub, access=rights)
    )
    return App(app=app, controls=controls, access=rights, hub=hub, folder=folder)


@contextlib.contextmanager
def running(
    folder: Path, *, controls: FakeControls | None = None, **options
) -> Iterator[tuple[Server, httpx.Client]]:
    """Run a server, and give a client that is signed in."""
    controls = controls or FakeControls(folder=folder)
    server = Server(controls, reports=FakeReports(), folder=folder, **options)
    try:
        url = server.start()
        with httpx.Client(base_url=url.partition("?")[0], timeout=30.0) as client:
            assert client.get(url).status_code == 303
            yield server, client
    finally:
        server.stop()
