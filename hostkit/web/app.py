"""What the server answers, path by path; who may ask is settled before."""

import asyncio
from collections.abc import Awaitable, Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

from starlette.applications import Starlette
from starlette.concurrency import run_in_threadpool
from starlette.exceptions import HTTPException
from starlette.requests import ClientDisconnect, Request
from starlette.responses import Response, StreamingResponse
from starlette.routing import Route
from starlette.types import ASGIApp

import hostkit
from hostkit.errors import HostkitError
from hostkit.monitor.snapshot import Controls
from hostkit.web.actions import BODY_BYTES, Actions, BadRequestError, Body, parse
from hostkit.web.answers import answer, attachment, download, failure
from hostkit.web.files import (
    MEDIA_TYPES,
    chunks,
    open_recording,
    page_file,
    recordings,
    vendor_file,
)
from hostkit.web.security import Access, Guard
from hostkit.web.stream import Hub
from hostkit.web.streaming import Streaming

BODY_TIMEOUT_S = 10.0


class TooLargeError(Exception):
    """A body is larger than any request needs."""


class Reports(Protocol):
    """Reports of the session so far; called from any thread."""

    def html(self) -> bytes:
        """Return one self-contained page."""

    def json(self) -> bytes:
        """Return the document of ``hostkit monitor --json``."""

    def xml(self) -> bytes:
        """Return a JUnit file."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Served:
    """All that the paths need."""

    controls: Controls
    reports: Reports
    folder: Path
    hub: Hub
    access: Access


def application(served: Served) -> ASGIApp:
    """Return the application with its guard before it."""
    turn = asyncio.Lock()
    routes = [
        Route("/", _index, methods=["GET"]),
        Route("/page/{name}", _page, methods=["GET"]),
        Route("/vendor/{name}", _vendor, methods=["GET"]),
        Route("/api/session", _session, methods=["GET"]),
        Route("/api/recordings", _recordings, methods=["GET"]),
        Route("/recordings/{name}", _recording, methods=["GET"]),
        Route("/stream", Streaming(served.hub), methods=["GET"]),
        _report("html", "text/html", served.reports.html, turn),
        _report("json", "application/json", served.reports.json, turn),
        _report("xml", "application/xml", served.reports.xml, turn),
    ]
    actions = Actions(served.controls, served.folder).by_path
    routes += [
        Route(f"/api/{path}", _action(act), methods=["POST"]) for path, act in actions.items()
    ]
    app = Starlette(routes=routes, exception_handlers={HTTPException: _no_route})
    app.router.redirect_slashes = False
    app.state.served = served
    return Guard(app, served.access)


def _served(request: Request) -> Served:
    served = request.app.state.served
    assert isinstance(served, Served)
    return served


def _no_route(request: Request, error: Exception) -> Response:
    assert isinstance(error, HTTPException)
    response = failure(error.status_code, error.detail)
    for name, value in (error.headers or {}).items():
        response.headers[name] = value
    return response


def _static(name: str, content: bytes | None) -> Response:
    if content is None:
        return failure(404, "there is no such file")
    kind = MEDIA_TYPES[Path(name).suffix]
    return Response(content, media_type=kind, headers={"Cache-Control": "no-cache"})


def _index(request: Request) -> Response:
    return _static("index.html", page_file("index.html"))


def _page(request: Request) -> Response:
    name = request.path_params["name"]
    return _static(name, page_file(name))


def _vendor(request: Request) -> Response:
    name = request.path_params["name"]
    return _static(name, vendor_file(name))


def _session(request: Request) -> Response:
    served = _served(request)
    return answer(
        {
            "csrf": served.access.csrf,
            "info": served.controls.info(),
            "version": hostkit.__version__,
        }
    )


def _recordings(request: Request) -> Response:
    return answer(recordings(_served(request).folder))


def _recording(request: Request) -> Response:
    name = request.path_params["name"]
    opened = open_recording(_served(request).folder, name)
    if opened is None:
        return failure(404, "there is no such recording")
    return StreamingResponse(
        chunks(opened), media_type="application/octet-stream", headers=attachment(name)
    )


def _report(kind: str, media_type: str, make: Callable[[], bytes], turn: asyncio.Lock) -> Route:
    async def report(request: Request) -> Response:
        try:
            # One at a time: drawing takes a while, and not every library of it is for threads.
            async with turn:
                content = await run_in_threadpool(make)
        except HostkitError as error:
            return failure(409, str(error))
        return download(content, f"hostkit-report.{kind}", media_type)

    return Route(f"/report.{kind}", report, methods=["GET"])


def _action(act: Callable[[Body], None]) -> Callable[[Request], Awaitable[Response]]:
    async def endpoint(request: Request) -> Response:
        kind = request.headers.get("content-type", "").partition(";")[0].strip().lower()
        if kind != "application/json":
            return failure(415, "the body must be application/json")
        try:
            body = await asyncio.wait_for(_body(request), BODY_TIMEOUT_S)
            await run_in_threadpool(act, parse(body))
        except asyncio.TimeoutError:
            return failure(408, f"the body did not come within {BODY_TIMEOUT_S:g} s")
        except TooLargeError:
            return failure(413, f"the body is larger than {BODY_BYTES} bytes")
        except ClientDisconnect:
            return failure(400, "the body ended early")
        except BadRequestError as error:
            return failure(400, str(error))
        except HostkitError as error:
            return failure(409, str(error))
        return answer({"ok": True}, 202)

    return endpoint


async def _body(request: Request) -> bytes:
    body = b""
    async for chunk in request.stream():
        body += chunk
        if len(body) > BODY_BYTES:
            raise TooLargeError
    return body
