"""The view on a terminal, and the lines where there is none."""

import io
import math
import threading
from dataclasses import replace
from typing import ClassVar, get_args

import numpy as np
import pytest
from rich.console import Console

from hostkit.cli.terminal import PlainView, new_notices, printable, view_for
from hostkit.cli.terminal_table import LEVEL_COLOUR, TableView
from hostkit.filters.filter import Fact
from hostkit.link.statistics import LinkStatistics, Spread, TimingStatistics
from hostkit.monitor.snapshot import (
    Batch,
    CommandState,
    DeviceStatus,
    ForwardState,
    Level,
    Notice,
    RecordingState,
    ReplayState,
    SessionInfo,
    Snapshot,
)
from hostkit.records import ResidualStatistics, RetunedParameter, ValidationReport

INFO = SessionInfo(
    design_digest="0123456789ab",
    axes=("roll", "pitch"),
    rate_hz=200.0,
    filter="complementary filter",
    facts=(
        Fact(name="eta", label="eta", value=0.9965),
        Fact(name="tau_s", label="tau", value=1.4236, unit="s"),
    ),
    port="/dev/ttyUSB0",
    replay=False,
    hostkit_version="0.1",
)
REPORT = ValidationReport(
    samples=2460,
    checked=2459,
    lost=3,
    mismatches=2,
    rms_rad=math.radians(0.25),
    max_rad=math.radians(0.5),
    digest_ok=True,
    verdict="fail",
    residual=(
        ResidualStatistics(
            axis="pitch",
            samples=2459,
            rms_rad=math.radians(0.125),
            max_rad=math.radians(0.5),
            mean_rad=0.0,
            p50_rad=0.0,
            p95_rad=math.radians(0.375),
            p99_rad=0.0,
            lag_s=0.0123,
        ),
    ),
    retuned=(RetunedParameter(name="FILT_TAU", design_value=1.4236, device_value=1.5, unit="s"),),
    reasons=("2 of 2459 steps differ from the integer model",),
)
HOSTILE = "\x1b[2J\x1b]0;owned\x07[red]danger[/red]\u202edrowrof\r\n"
SNAPSHOT = Snapshot(
    time_s=1.7e9,
    elapsed_s=12.3,
    epoch=0,
    port_state="connected",
    reconnects=1,
    frames_per_s=402.0,
    bytes_per_s=24100.0,
    samples_per_s=200.0,
    link=LinkStatistics(
        lost_frames=11, duplicated=12, reordered=13, crc_failures=14, bad=15, unknown=16
    ),
    timing=TimingStatistics(
        latency=Spread(median_ms=3.25, p95_ms=5.5, max_ms=9.0),
        jitter=Spread(median_ms=0.25, p95_ms=0.75, max_ms=2.0),
    ),
    device=DeviceStatus(state="ACTIVE", temperature_deg_c=25.31, load_percent=23.0),
    report=REPORT,
    parameters=(),
    command=CommandState(name="calibrate", state="in progress"),
    recording=RecordingState(name="flight.tlog", active=True, frames=999, written_bytes=56_000),
    replay=ReplayState(position_s=12.0, length_s=60.0, speed=2.0, paused=False, ended=False),
    forwards=(
        ForwardState(
            address="udp:127.0.0.1:14550", sent_frames=1, dropped_frames=2, received_frames=3
        ),
    ),
    notices=tuple(Notice(time_s=1.7e9 + k, level="warning", text=f"notice {k}") for k in range(7)),
)
BATCH = Batch(
    time_s=np.array([1.0]),
    received_s=1.7e9,
    device_rad=np.radians([[12.5, -30.25]]),
    model_rad=np.array([[np.nan, math.radians(-30.5)]]),
    residual_rad=np.array([[np.nan, math.radians(0.25)]]),
    mismatch=np.array([False]),
    begins=np.array([True]),
)


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def drawn(
    snapshot: Snapshot | None, *, width: int = 80, height: int = 24, batch: Batch | None = BATCH
) -> str:
    console = Console(file=io.StringIO(), width=width, height=height, record=True)
    view = TableView(io.StringIO(), INFO, console)
    if batch is not None:
        view.take_batch(batch)
    if snapshot is not None:
        view.take_snapshot(snapshot)
    console.print(view.screen())
    return console.export_text()


def plain(*snapshots: Snapshot, batch: Batch | None = None) -> list[str]:
    stream = io.StringIO()
    with PlainView(stream, INFO) as view:
        if batch is not None:
            view.take_batch(batch)
        for snapshot in snapshots:
            view.take_snapshot(snapshot)
    return stream.getvalue().splitlines()


def test_the_table_says_everything_in_80_by_24() -> None:
    text = drawn(SNAPSHOT)
    lines = text.splitlines()
    assert len(lines) <= 23
    assert max(map(len, lines)) <= 80
    for said in (
        "fail so far  12 s, 2460 samples, 3 lost, 2 of 2459 steps differ",
        "  2 of 2459 steps differ from the integer model",
        "200.0 samples/s  402 frames/s  24.1 kB/s  1 reconnects",
        "lost 11  dup 12  reordered 13  CRC 14  bad 15  unknown 16",
        "latency 3.25 ms (p95 5.50)  jitter 0.25 ms (p95 0.75)",
        "ACTIVE  25.3 degC  load 23 %",
        "retuned FILT_TAU 1.5 s (design 1.4236)",
        "command calibrate in progress",
        "recording flight.tlog, 999 frames, 56 kB",
        "replay 12.0 of 60.0 s, 2 x",
        "forward udp:127.0.0.1:14550: 1 sent, 2 dropped, 3 back",
        "warning: notice 6",
    ):
        assert said in text
    assert text.count("notice") == 5
    rows = {line.split()[0]: line.split()[1:] for line in lines}
    assert rows["roll"] == ["12.500", *"------"]
    figures = "-30.250 -30.500 0.250000 0.125000 0.375000 0.500000 12.3"
    assert rows["pitch"] == figures.split()


@pytest.mark.parametrize("height", [4, 10, 16])
def test_a_low_terminal_keeps_the_verdict(height: int) -> None:
    text = drawn(SNAPSHOT, height=height)
    assert len(text.splitlines()) <= height - 1
    assert "fail so far" in text


def test_a_narrow_and_low_terminal_shows_the_newest_notices() -> None:
    lines = drawn(SNAPSHOT, width=40, height=19).splitlines()
    assert max(map(len, lines)) <= 40
    assert len(lines) == 18
    assert lines[-1].endswith("notice 6")


def test_before_the_first_sample_nothing_is_called_failed() -> None:
    assert "waiting for the device" in drawn(None, batch=None)
    report = replace(REPORT, samples=0, checked=0, reasons=("no sample was checked",))
    early = replace(SNAPSHOT, report=report)
    text = drawn(early, batch=None)
    assert "no samples yet" in text
    assert "fail" not in text
    assert "no samples yet" in plain(early)[-1]
    unjudged = replace(SNAPSHOT, report=replace(report, samples=40))
    assert "no step checked yet" in plain(unjudged)[-1]
    assert "fail" in drawn(replace(unjudged, ended=True), batch=None)


def test_a_device_cannot_speak_to_the_terminal() -> None:
    device = DeviceStatus(state=HOSTILE, texts=(HOSTILE,))
    notices = (Notice(time_s=0.0, level="error", text=HOSTILE),)
    parameter = RetunedParameter(name=HOSTILE, design_value=0.0, device_value=1.0, unit="s")
    report = replace(REPORT, retuned=(parameter,), reasons=(HOSTILE,))
    hostile = replace(SNAPSHOT, device=device, notices=notices, report=report)
    text = drawn(hostile, width=200) + "".join(plain(hostile))
    assert text.count("[red]danger[/red]") == 6
    assert not {"\x1b", "\x07", "\r", "\u202e"} & set(text)


def test_a_long_text_is_cut() -> None:
    assert len(printable("x" * 10_000)) == 120
    assert printable("ok") == "ok"


def test_plain_lines_come_every_second_and_later_every_ten() -> None:
    quiet = replace(SNAPSHOT, notices=())
    lines = plain(*(replace(quiet, elapsed_s=k / 4) for k in range(4 * 40)), batch=BATCH)
    times_s = [int(line.split()[0]) for line in lines]
    assert times_s == [*range(11), 20, 30]
    assert lines[0].endswith(
        "fail so far; 2460 samples, 200/s; 3 lost; 2 of 2459 steps differ; "
        "residual 0.250000 deg rms; roll 12.500 deg, pitch -30.250 deg; "
        "link: 11 lost, 15 bad, 16 unknown"
    )


def test_the_first_judgement_is_said_at_once() -> None:
    quiet = replace(SNAPSHOT, notices=(), elapsed_s=0.0)
    early = replace(quiet, report=replace(REPORT, samples=0))
    lines = plain(early, replace(quiet, elapsed_s=0.25), replace(quiet, elapsed_s=0.5))
    assert ["no samples yet" in line for line in lines] == [True, False]


def test_plain_lines_tell_each_notice_once_and_a_flood_in_short() -> None:
    one, *rest = SNAPSHOT.notices
    lines = plain(
        replace(SNAPSHOT, notices=(one,)),
        replace(SNAPSHOT, elapsed_s=12.5, notices=(one, rest[0])),
        replace(SNAPSHOT, elapsed_s=12.7, notices=tuple(rest)),
        replace(SNAPSHOT, elapsed_s=12.9, ended=True),
    )
    told = [line.split("notice ")[1] for line in lines if "notice " in line]
    assert told == list("0123456")
    flood = tuple(Notice(time_s=k, level="info", text=f"notice {k}") for k in range(50))
    lines = plain(replace(SNAPSHOT, notices=flood))
    assert sum("notice " in line for line in lines) == 5
    assert "45 more notices are not shown" in lines


def test_notices_that_were_pushed_out_are_not_told_again() -> None:
    notices = SNAPSHOT.notices
    assert new_notices(notices, notices[3]) == notices[4:]
    assert new_notices(notices[5:], notices[3]) == notices[5:]
    assert new_notices(notices, None) == notices


def test_a_stream_that_nobody_reads_does_not_stall_a_session() -> None:
    free = threading.Event()

    class Stuck(io.StringIO):
        def write(self, text: str) -> int:
            free.wait(30.0)
            return super().write(text)

    view = PlainView(Stuck(), INFO)
    with view:
        for k in range(1000):
            view.take_snapshot(replace(SNAPSHOT, elapsed_s=float(k), notices=()))
        assert not free.is_set()
        free.set()


def test_a_stream_that_fails_does_not_end_the_lines() -> None:
    class Failing(io.StringIO):
        errors: ClassVar[list[Exception]] = [OSError("no space"), ValueError("closed")]

        def write(self, text: str) -> int:
            if self.errors:
                raise self.errors.pop()
            return super().write(text)

    stream = Failing()
    with PlainView(stream, INFO) as view:
        view.take_snapshot(SNAPSHOT)
    assert "notice 6" in stream.getvalue()


def test_the_view_fits_the_stream() -> None:
    xterm = {"TERM": "xterm"}
    assert isinstance(view_for(Terminal(), INFO, interactive=True, environment=xterm), TableView)
    for stream, interactive, term in (
        (io.StringIO(), True, "xterm"),
        (Terminal(), False, "xterm"),
        (Terminal(), True, "dumb"),
    ):
        view = view_for(stream, INFO, interactive=interactive, environment={"TERM": term})
        assert isinstance(view, PlainView)


@pytest.mark.parametrize("no_colour", [False, True])
def test_the_cursor_comes_back_and_colour_can_be_refused(
    no_colour: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("TERM", "xterm-256color")
    monkeypatch.delenv("NO_COLOR", raising=False)
    if no_colour:
        monkeypatch.setenv("NO_COLOR", "1")
    stream = Terminal()

    def interrupted() -> None:
        with view_for(stream, INFO, interactive=True) as view:
            view.take_snapshot(SNAPSHOT)
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        interrupted()
    text = stream.getvalue()
    assert "fail so far" in text
    assert text.rindex("\x1b[?25h") > text.rindex("\x1b[?25l")
    assert ("\x1b[1;31m" in text) is not no_colour
    assert ("\x1b[3" in text) is not no_colour


def test_every_level_has_a_colour() -> None:
    assert set(LEVEL_COLOUR) == set(get_args(Level))
