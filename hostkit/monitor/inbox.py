"""Requests from other threads, carried out between two batches of samples."""

import queue
from collections.abc import Callable

from hostkit.errors import HostkitError

MOST_WAITING = 64
"""Requests that may wait; a session takes them ten times a second."""

Request = Callable[[], None]


class Inbox:
    """A bounded queue of requests; put in from any thread, carried out in one."""

    def __init__(self) -> None:
        self._waiting: queue.Queue[Request] = queue.Queue(MOST_WAITING)

    def put(self, request: Request) -> None:
        """Leave a request and return at once.

        Raises
        ------
        HostkitError
            If too many are waiting.
        """
        try:
            self._waiting.put_nowait(request)
        except queue.Full:
            raise HostkitError(
                f"{MOST_WAITING} requests are waiting already; try again in a moment"
            ) from None

    def serve(self, wait_s: float = 0.0) -> None:
        """Carry out what is there; wait at most so long for the first."""
        try:
            request = self._waiting.get(timeout=wait_s) if wait_s > 0.0 else None
            while True:
                if request is not None:
                    request()
                request = self._waiting.get_nowait()
        except queue.Empty:
            return
