"""A board's serial port as a pseudo-terminal that other programs open like a real one."""

import contextlib
import os
import select
import signal
import threading
import time
from collections.abc import Callable, Iterator
from functools import partial
from types import FrameType

from hostkit.emulation.board import Receive, Send, Stop
from hostkit.errors import DeviceError

POLL_S = 0.05
CHUNK_BYTES = 4096
SLOW_READER_S = 1.0
"""How long the port waits for a reader that does not keep up; then bytes are lost, as on a wire."""

REFRESHES = 2
"""How often the port is emptied after a reader: a busy kernel may deliver bytes after the first."""

Serve = Callable[[Send, Stop, Receive], None]


class PtyPort:
    """The server's end of a pseudo-terminal in raw mode.

    Attributes
    ----------
    path
        What a reader opens.
    """

    def __init__(self) -> None:
        try:
            import termios
            import tty
        except ImportError as error:
            raise DeviceError("this system has no pseudo-terminals; use a POSIX system") from error
        self._set_raw = partial(tty.setraw, when=termios.TCSAFLUSH)
        try:
            self._master, slave = os.openpty()
        except OSError as error:
            raise DeviceError(f"no pseudo-terminal can be opened: {error.strerror}") from error
        self.path = os.ttyname(slave)
        os.close(slave)  # opened and closed once, the port reports whether a reader is there
        self._refresh()
        os.set_blocking(self._master, False)
        self._poll = select.poll()
        self._poll.register(self._master, select.POLLIN)
        self._refreshes_due = 0

    def close(self) -> None:
        """Give the pseudo-terminal back."""
        os.close(self._master)

    def listening(self) -> bool:
        """Tell whether a reader has the port open; what one that left did not read is dropped."""
        events = dict(self._poll.poll(0)).get(self._master, 0)
        there = not events & select.POLLHUP
        if there:
            self._refreshes_due = REFRESHES
        elif self._refreshes_due > 0:
            self._refreshes_due -= 1
            self._refresh()
        return there

    def _refresh(self) -> None:
        """Make the port raw and empty; unread bytes can only be dropped at the reader's end."""
        reader = os.open(self.path, os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)
        try:
            self._set_raw(reader)
        finally:
            os.close(reader)

    def receive(self) -> bytes:
        """Return what has been written into the port since it was last asked."""
        try:
            return os.read(self._master, CHUNK_BYTES)
        except OSError:
            return b""

    def send(self, data: bytes) -> None:
        """Write to the reader; without one, or past one that does not read, bytes are lost."""
        deadline = time.monotonic() + SLOW_READER_S
        while data and self.listening():
            try:
                data = data[os.write(self._master, data) :]
            except BlockingIOError:
                left_s = deadline - time.monotonic()
                if left_s <= 0.0:
                    return
                select.select([], [self._master], [], min(left_s, POLL_S))
            except OSError:
                return


def serve_pty(serve: Serve, announce: Callable[[str], None], stop: Stop | None = None) -> None:
    """Serve a device on a pseudo-terminal until Ctrl-C, SIGTERM or `stop`.

    The device starts when a reader first opens the port and then runs on. While nobody reads, what
    it says is lost, so a later reader sees nothing stale.

    Parameters
    ----------
    serve
        Runs the device: takes where to send bytes, a question whether to stop, and one for the
        bytes that have come.
    announce
        Called once with the path of the port.
    stop
        Asked now and then whether to end.

    Raises
    ------
    DeviceError
        If the system has no pseudo-terminals.
    EmulationError
        If the device ends by itself.
    """
    with _signals() as signalled, contextlib.closing(PtyPort()) as port:

        def finished() -> bool:
            port.listening()
            return signalled.is_set() or (stop is not None and stop())

        announce(port.path)
        while not port.listening():
            if finished():
                return
            time.sleep(POLL_S)
        serve(port.send, finished, port.receive)


@contextlib.contextmanager
def _signals() -> Iterator[threading.Event]:
    """Turn SIGINT and SIGTERM into an event; outside the main thread leave them alone."""
    event = threading.Event()

    def note(_number: int, _frame: FrameType | None) -> None:
        event.set()

    if threading.current_thread() is not threading.main_thread():
        yield event
        return
    kept = [(number, signal.signal(number, note)) for number in (signal.SIGINT, signal.SIGTERM)]
    try:
        yield event
    finally:
        for number, handler in kept:
            signal.signal(number, handler)
