"""The table that a session shows on a terminal."""

import math
import threading
from types import TracebackType
from typing import TextIO

import numpy as np
from rich.console import Console, ConsoleOptions, RenderResult
from rich.live import Live
from rich.text import Text

from hostkit.cli.terminal import notice_line, printable, verdict_text
from hostkit.link.statistics import Spread
from hostkit.monitor.snapshot import Batch, SessionInfo, Snapshot, Vector
from hostkit.records import Axis, ResidualStatistics

REFRESH_PER_S = 4
NOTICES = 5
TEXTS = 2
FORWARDS = 2
FACTS = 3
RETUNED = 3
REASONS = 3
COLOUR = {"pass": "bold green", "fail": "bold red", "refused": "bold red"}
LEVEL_COLOUR = {"info": "", "warning": "yellow", "error": "red"}


class TableView:
    """A table that is drawn anew four times a second by a thread of its own."""

    def __init__(self, stream: TextIO, info: SessionInfo, console: Console | None = None) -> None:
        self._info = info
        self._lock = threading.Lock()
        self._angles: tuple[Vector, Vector, Vector] | None = None
        self._snapshot: Snapshot | None = None
        self._live = Live(
            console=console or Console(file=stream, highlight=False, markup=False, emoji=False),
            get_renderable=self.screen,
            refresh_per_second=REFRESH_PER_S,
            redirect_stdout=False,  # results may go to a pipe
        )

    def __enter__(self) -> "TableView":
        """Begin to draw."""
        self._live.start()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        """Draw once more, and show the cursor again."""
        self._live.stop()

    def take_batch(self, batch: Batch) -> None:
        """Remember the latest angles."""
        if len(batch):
            latest = (batch.device_rad[-1], batch.model_rad[-1], batch.residual_rad[-1])
            with self._lock:
                self._angles = latest

    def take_snapshot(self, snapshot: Snapshot) -> None:
        """Remember the state."""
        with self._lock:
            self._snapshot = snapshot

    def screen(self) -> "Screen":
        """Return what is to be drawn now."""
        with self._lock:
            return Screen(self._info, self._snapshot, self._angles)


class Screen:
    """One picture of the table; cut at the height of the terminal, notices first."""

    def __init__(
        self,
        info: SessionInfo,
        snapshot: Snapshot | None,
        angles: tuple[Vector, Vector, Vector] | None,
    ) -> None:
        self._info = info
        self._snapshot = snapshot
        self._angles = angles

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> RenderResult:
        """Yield the lines."""
        lines = self.lines(console.height - 1)
        for line in lines:
            line.no_wrap, line.overflow = True, "ellipsis"
        yield from lines

    def lines(self, most: int) -> list[Text]:
        """Return at most so many lines."""
        head = [_head(self._info)]
        if self._snapshot is None:
            return [*head, Text("waiting for the device")]
        shown = self._snapshot
        head += [*_verdict(shown), *self._table(shown), *_link(shown), *_device(shown)]
        head += _extras(shown)
        room = min(NOTICES, most - len(head))
        notices = shown.notices[-room:] if room > 0 else ()
        return [*head, *(Text(notice_line(n), LEVEL_COLOUR[n.level]) for n in notices)][:most]

    def _table(self, shown: Snapshot) -> list[Text]:
        residual = {entry.axis: entry for entry in shown.report.residual}
        names = ("deg", "device", "model", "residual", "rms", "p95", "max", "lag ms")
        lines = [Text("".join(_cells(names)), "bold")]
        for column, axis in enumerate(self._info.axes):
            lines.append(Text("".join(_cells(self._row(column, axis, residual.get(axis))))))
        return lines

    def _row(self, column: int, axis: Axis, entry: ResidualStatistics | None) -> tuple[str, ...]:
        device = model = residual = math.nan
        if self._angles is not None:
            device, model, residual = (float(vector[column]) for vector in self._angles)
        figures = (math.nan,) * 4
        if entry is not None:
            lag_s = math.nan if entry.lag_s is None else entry.lag_s
            figures = (entry.rms_rad, entry.p95_rad, entry.max_rad, lag_s)
        rms, p95, most, lag_s = figures
        return (
            axis,
            _degrees(device, 3),
            _degrees(model, 3),
            *(_degrees(value, 6) for value in (residual, rms, p95, most)),
            "-" if math.isnan(lag_s) else f"{lag_s * 1e3:.1f}",
        )


def _cells(texts: tuple[str, ...]) -> list[str]:
    return [texts[0].ljust(6), *(text.rjust(10) for text in texts[1:7]), texts[7].rjust(8)]


def _degrees(angle_rad: float, digits: int) -> str:
    return "-" if np.isnan(angle_rad) else f"{math.degrees(angle_rad):.{digits}f}"


def _head(info: SessionInfo) -> Text:
    head = Text("hostkit ", "bold")
    head.append(printable(info.port), "")
    head.append(
        "  ".join(
            (
                f"  design {info.design_digest}",
                f"{info.rate_hz:g} Hz",
                *(fact.text() for fact in info.facts[:FACTS]),
            )
        ),
        "not bold",
    )
    return head


def _verdict(shown: Snapshot) -> list[Text]:
    report = shown.report
    waiting = report.samples == 0 and not shown.ended
    line = Text(verdict_text(shown), "yellow" if waiting else COLOUR[report.verdict])
    line.append(
        f"  {shown.elapsed_s:.0f} s, {report.samples} samples, {report.lost} lost, "
        f"{report.mismatches} of {report.checked} steps differ",
        "not bold default",
    )
    if report.unjudged:
        line.append(f", {report.unjudged} not judged", "not bold default")
    reasons = () if waiting else report.reasons[:REASONS]
    return [line, *(Text(f"  {printable(reason)}", "red") for reason in reasons)]


def _link(shown: Snapshot) -> list[Text]:
    link, timing = shown.link, shown.timing
    state = Text("link   ")
    state.append(shown.port_state, "" if shown.port_state == "connected" else "yellow")
    state.append(
        f"  {shown.samples_per_s:.1f} samples/s  {shown.frames_per_s:.0f} frames/s  "
        f"{shown.bytes_per_s / 1e3:.1f} kB/s  {shown.reconnects} reconnects"
    )
    counts = Text(
        f"       lost {link.lost_frames}  dup {link.duplicated}  reordered {link.reordered}  "
        f"CRC {link.crc_failures}  bad {link.bad}  unknown {link.unknown}"
    )
    if link.overrun_bytes:
        counts.append(f"  overrun {link.overrun_bytes} B", "red")
    times = Text(f"       latency {_spread(timing.latency)}  jitter {_spread(timing.jitter)}")
    if timing.clock_ppm is not None:
        times.append(f"  clock {timing.clock_ppm:+.0f} ppm")
    return [state, counts, times]


def _spread(spread: Spread | None) -> str:
    if spread is None:
        return "-"
    return f"{spread.median_ms:.2f} ms (p95 {spread.p95_ms:.2f})"


def _device(shown: Snapshot) -> list[Text]:
    device = shown.device
    parts = [printable(device.state) if device.state else "-"]
    if device.temperature_deg_c is not None:
        parts.append(f"{device.temperature_deg_c:.1f} degC")
    if device.load_percent is not None:
        parts.append(f"load {device.load_percent:.0f} %")
    if device.bus_errors is not None:
        parts.append(f"{device.bus_errors} bus errors")
    if device.uptime_s is not None:
        parts.append(f"up {device.uptime_s:.0f} s")
    line = Text("device " + "  ".join(parts))
    if device.healthy is False:
        line.append("  not healthy", "red")
    return [line, *(Text(f"       {printable(text)}") for text in device.texts[-TEXTS:])]


def _extras(shown: Snapshot) -> list[Text]:
    """Return lines that are there only when there is something to say."""
    lines = [
        Text(
            f"retuned {printable(one.name)} {one.device_value:.6g} {one.unit} "
            f"(design {one.design_value:.6g})",
            "yellow",
        )
        for one in shown.report.retuned[:RETUNED]
    ]
    if (command := shown.command) is not None:
        detail = f": {printable(command.detail)}" if command.detail else ""
        lines.append(Text(f"command {command.name} {command.state}{detail}"))
    if (recording := shown.recording) is not None:
        verb = "recording" if recording.active else "recorded"
        size = f"{recording.frames} frames, {recording.written_bytes / 1e3:.0f} kB"
        lines.append(Text(f"{verb} {printable(recording.name)}, {size}"))
        if recording.error:
            lines.append(Text(f"  {printable(recording.error)}", "red"))
    if (replay := shown.replay) is not None:
        speed = "as fast as it goes" if replay.speed is None else f"{replay.speed:g} x"
        how = "ended" if replay.ended else "paused" if replay.paused else speed
        lines.append(Text(f"replay {replay.position_s:.1f} of {replay.length_s:.1f} s, {how}"))
    for one in shown.forwards[:FORWARDS]:
        counts = f"{one.sent_frames} sent, {one.dropped_frames} dropped, {one.received_frames} back"
        lines.append(Text(f"forward {printable(one.address)}: {counts}"))
    return lines
