"""What a session shows without a page: a live table on a terminal, else plain lines."""

import contextlib
import math
import os
import queue
import threading
import time
from collections.abc import Mapping
from types import TracebackType
from typing import Protocol, TextIO

from hostkit.monitor.snapshot import Batch, Notice, SessionInfo, Snapshot, View

EVERY_S, FIRST_S, LATER_EVERY_S = 1.0, 10.0, 10.0
"""A plain line comes this often for the first seconds, and later."""

NOTICES_AT_ONCE = 5
"""A device that talks without end shall not fill a log file."""

WAITING_LINES = 64
CLOSING_S = 1.0
TEXT_LENGTH = 120


class ScreenView(View, Protocol):
    """A view that occupies a stream while it is entered."""

    def __enter__(self) -> "ScreenView":
        """Begin to show."""

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        """Give the stream back."""


def view_for(
    stream: TextIO,
    info: SessionInfo,
    *,
    interactive: bool,
    environment: Mapping[str, str] = os.environ,
) -> ScreenView:
    """Return the view that fits a stream.

    Parameters
    ----------
    stream
        Where to show; usually standard error, so that results stay alone on standard output.
    interactive
        Whether a table may be drawn at all; without it there are plain lines on terminals, too.
    environment
        Looked at for ``TERM``; a dumb terminal cannot move its cursor.
    """
    dumb = environment.get("TERM", "").lower() in ("dumb", "unknown")
    if not interactive or dumb or not stream.isatty():
        return PlainView(stream, info)
    # Loading it costs as much as the rest of the view; a log file does not need it.
    from hostkit.cli.terminal_table import TableView

    return TableView(stream, info)


class PlainView:
    """One line every second, later every ten, and what happens as it happens.

    Lines are written by a thread of their own: a stream that nobody reads stalls no session.
    """

    def __init__(self, stream: TextIO, info: SessionInfo) -> None:
        self._stream = stream
        self._info = info
        self._angles = ""
        self._next_s = 0.0
        self._judging = False
        self._last_notice: Notice | None = None
        self._lines: queue.Queue[str | None] = queue.Queue(WAITING_LINES)
        self._writer = threading.Thread(target=self._write, daemon=True)

    def __enter__(self) -> "PlainView":
        """Begin to show."""
        self._writer.start()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        """Write what still waits, for a moment at most."""
        with contextlib.suppress(queue.Full):
            self._lines.put(None, timeout=CLOSING_S)
        self._writer.join(CLOSING_S)

    def take_batch(self, batch: Batch) -> None:
        """Remember the latest angles."""
        if len(batch):
            shown = zip(self._info.axes, batch.device_rad[-1], strict=True)
            self._angles = ", ".join(f"{axis} {degrees(value)} deg" for axis, value in shown)

    def take_snapshot(self, snapshot: Snapshot) -> None:
        """Say what is new, and now and then how it goes."""
        new = new_notices(snapshot.notices, self._last_notice)
        for notice in new[-NOTICES_AT_ONCE:]:
            self._say(notice_line(notice))
        if len(new) > NOTICES_AT_ONCE:
            self._say(f"{len(new) - NOTICES_AT_ONCE} more notices are not shown")
        if new:
            self._last_notice = new[-1]
        first = not self._judging and snapshot.report.samples > 0
        self._judging |= first
        if (first or snapshot.elapsed_s >= self._next_s) and not snapshot.ended:
            every_s = EVERY_S if snapshot.elapsed_s < FIRST_S else LATER_EVERY_S
            self._next_s = (snapshot.elapsed_s // every_s + 1.0) * every_s
            self._say(progress_line(snapshot, self._angles))

    def _say(self, line: str) -> None:
        with contextlib.suppress(queue.Full):
            self._lines.put_nowait(line)

    def _write(self) -> None:
        while (line := self._lines.get()) is not None:
            # A stream that was closed by its reader is no reason to end a measurement.
            with contextlib.suppress(OSError, ValueError):
                self._stream.write(line + "\n")
                self._stream.flush()


def new_notices(notices: tuple[Notice, ...], last: Notice | None) -> tuple[Notice, ...]:
    """Return the notices behind the last one that was seen; all if it is not among them."""
    if last is None or last not in notices:
        return notices
    behind = len(notices) - 1 - notices[::-1].index(last)
    return notices[behind + 1 :]


def progress_line(snapshot: Snapshot, angles: str) -> str:
    """Return a session's state in one line."""
    report, link = snapshot.report, snapshot.link
    parts = [verdict_text(snapshot)]
    if snapshot.port_state != "connected":
        parts.append(f"port {snapshot.port_state}")
    if report.samples:
        parts.append(f"{report.samples} samples, {snapshot.samples_per_s:.0f}/s")
        parts.append(f"{report.lost} lost")
        parts.append(f"{report.mismatches} of {report.checked} steps differ")
    if report.rms_rad is not None:
        parts.append(f"residual {math.degrees(report.rms_rad):.6f} deg rms")
    if angles:
        parts.append(angles)
    parts.append(f"link: {link.lost_frames} lost, {link.bad} bad, {link.unknown} unknown")
    return f"{snapshot.elapsed_s:.0f} s: " + "; ".join(parts)


def verdict_text(snapshot: Snapshot) -> str:
    """Return the verdict, as far as it is known."""
    if snapshot.report.samples == 0 and not snapshot.ended:
        return "no samples yet"
    if snapshot.report.checked == 0 and snapshot.report.verdict == "fail" and not snapshot.ended:
        return "no step checked yet"
    return snapshot.report.verdict + ("" if snapshot.ended else " so far")


def notice_line(notice: Notice) -> str:
    """Return a notice with its local time."""
    clock = time.strftime("%H:%M:%S", time.localtime(notice.time_s))
    return f"{clock} {notice.level}: {printable(notice.text)}"


def degrees(angle_rad: float) -> str:
    """Return an angle for people; a dash where there is none."""
    return "-" if math.isnan(angle_rad) else f"{math.degrees(angle_rad):.3f}"


def printable(text: str) -> str:
    """Return a text that may come from anywhere without what a terminal could obey."""
    shown = "".join(sign if sign.isprintable() else "?" for sign in text[: TEXT_LENGTH + 1])
    return shown if len(shown) <= TEXT_LENGTH else shown[: TEXT_LENGTH - 3] + "..."
