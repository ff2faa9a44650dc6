"""The HTTP protocol of the server, with limits on what an idle or slow connection may hold."""

import asyncio

from uvicorn.protocols.http.h11_impl import H11Protocol

REQUEST_S = 10.0
"""A connection that has not made a first request by then is closed."""

MOST_CONNECTIONS = 256


class BoundedProtocol(H11Protocol):
    """Closes connections that make no request, and those beyond a number."""

    _deadline: asyncio.TimerHandle | None = None

    # uvicorn, too, takes the transport for one that writes, which asyncio's base class is not.
    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        """Take a connection, or refuse it where there are too many."""
        super().connection_made(transport)
        if len(self.connections) > MOST_CONNECTIONS:
            transport.abort()
            return
        self._deadline = self.loop.call_later(REQUEST_S, self._give_up)

    def _give_up(self) -> None:
        # A request that began is another's business; without one there is no cycle yet.
        if self.cycle is None:
            self.transport.abort()

    def connection_lost(self, exc: Exception | None) -> None:
        """Forget the connection."""
        if self._deadline is not None:
            self._deadline.cancel()
        super().connection_lost(exc)
