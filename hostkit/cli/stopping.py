"""Ctrl-C and SIGTERM as a wish to end, not as an error in the middle of something."""

import contextlib
import signal
import threading
from collections.abc import Callable, Iterator
from types import FrameType


class Wish:
    """Whether somebody wished to end."""

    def __init__(self) -> None:
        self.given = False


@contextlib.contextmanager
def stoppable(stop: Callable[[], None]) -> Iterator[Wish]:
    """Call `stop` at the first SIGINT or SIGTERM; a second SIGINT interrupts at once.

    Outside the main thread signals are left alone.
    """
    wish = Wish()

    def note(number: int, _frame: FrameType | None) -> None:
        if wish.given and number == signal.SIGINT:
            raise KeyboardInterrupt
        wish.given = True
        stop()

    if threading.current_thread() is not threading.main_thread():
        yield wish
        return
    kept = [(number, signal.signal(number, note)) for number in (signal.SIGINT, signal.SIGTERM)]
    try:
        yield wish
    finally:
        for number, handler in kept:
            signal.signal(number, handler)
