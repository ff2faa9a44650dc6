"""The endpoint that streams to one page."""

import asyncio
import contextlib

from starlette.concurrency import run_in_threadpool
from starlette.types import Receive, Scope, Send

from hostkit.monitor.snapshot import Batch, SessionInfo
from hostkit.web.answers import failure
from hostkit.web.history import portions
from hostkit.web.stream import Client, Hub, event
from hostkit.web.wire import encode_samples

STALL_S = 30.0
"""A client that takes nothing for so long is let go, so that another may have its place."""

PORTION_SAMPLES = 4096
RETRY = b"retry: 1000\n\n"
END = event("end", b"{}")
HEADERS = [
    (b"content-type", b"text/event-stream; charset=utf-8"),
    (b"cache-control", b"no-store"),
    (b"x-accel-buffering", b"no"),
]


class Streaming:
    """Server-sent events: what the session is, the last minute, then what comes."""

    def __init__(self, hub: Hub) -> None:
        self._hub = hub

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Serve one client until it leaves or the session ends."""
        if scope["method"] != "GET":
            await failure(405, "Method Not Allowed")(scope, receive, send)
            return
        client = self._hub.join()
        if client is None:
            await failure(503, "too many pages are open; close one")(scope, receive, send)
            return
        # Nothing may be awaited between joining and this: a sample would be missed or sent twice.
        kept = self._hub.history.batches()
        watcher = asyncio.create_task(_watch(client, receive))
        try:
            await send({"type": "http.response.start", "status": 200, "headers": HEADERS})
            with contextlib.suppress(asyncio.TimeoutError, OSError):
                await self._send_all(client, kept, send)
        finally:
            self._hub.leave(client)
            watcher.cancel()

    async def _send_all(self, client: Client, kept: tuple[Batch, ...], send: Send) -> None:
        await _send(send, RETRY + event("info", self._hub.info_text))
        for portion in portions(kept, PORTION_SAMPLES):
            await _send(send, await run_in_threadpool(_samples, portion, self._hub.info))
        while (text := await client.next()) is not None:
            await _send(send, text)
        await _send(send, END, more=False)


def _samples(batch: Batch, info: SessionInfo) -> bytes:
    return event("samples", encode_samples(batch, info.axes))


async def _send(send: Send, body: bytes, *, more: bool = True) -> None:
    message = {"type": "http.response.body", "body": body, "more_body": more}
    await asyncio.wait_for(send(message), STALL_S)


async def _watch(client: Client, receive: Receive) -> None:
    while (await receive())["type"] != "http.disconnect":
        pass
    client.end()
