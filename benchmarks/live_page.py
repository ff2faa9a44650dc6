"""How late the page of the monitor is, and what serving it costs."""

import re
import statistics
import subprocess
from typing import TYPE_CHECKING

from benchmarks.live_device import MESSAGES, LiveDevice, cpu_seconds, hostkit, live_device, running
from benchmarks.table import MISSING, Table, figure
from hostkit.errors import HostkitError

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

CHROMIUM = "/usr/bin/chromium"
LOADS = ((200.0, MESSAGES), (1000.0, MESSAGES[:1]), (1000.0, MESSAGES))
"""Sample rate, Hz, and what goes out with every sample."""

SETTLED_MS, WATCHED_MS = 3000, 30_000
SEEN = "[window.hostkit.frames, window.hostkit.samples]"
LATE = "Array.from(window.hostkit.latencyMs)"
LATENCY = "fetch('/report.json').then(r => r.json()).then(d => d.timing.latency?.median_ms ?? NaN)"
COLUMNS = (
    "samples/s x messages",
    "sample to session, median, ms",
    "session to drawn, median, ms",
    "95 %, ms",
    "in the first quarter, ms",
    "in the last, ms",
    "pictures/s",
    "samples drawn, %",
    "server, % of one core",
)


def page_table() -> Table:
    """Measure the page at some rates."""
    return Table(
        title=f"Page: {WATCHED_MS / 1e3:g} s, headless Chromium that draws without a GPU",
        columns=COLUMNS,
        rows=tuple(_row(rate_hz, messages) for rate_hz, messages in LOADS),
        remarks=(
            "Late is the newest sample of a picture; the server process also receives, judges "
            "and counts. Samples drawn are those of the time over those the rate asks for.",
        ),
    )


def _row(rate_hz: float, messages: tuple[str, ...]) -> tuple[str, ...]:
    """Measure the page at one rate; a row of dashes where there is no browser."""
    name = f"{rate_hz:g} x {len(messages)}"
    missing = (name, *(MISSING,) * (len(COLUMNS) - 1))
    try:
        from playwright.sync_api import Error, sync_playwright
    except ImportError:
        return missing
    with sync_playwright() as playwright:
        try:
            browser = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        except Error:
            return missing
        with live_device(rate_hz, messages) as device:
            return (name, *_figures(browser, device, rate_hz))


def _figures(browser: "Browser", device: LiveDevice, rate_hz: float) -> tuple[str, ...]:
    command = hostkit("monitor", str(device.design_file), "--port", device.port)
    with running([*command, "--web", "--no-browser"], stderr=subprocess.PIPE) as child:
        page = browser.new_page(viewport={"width": 1280, "height": 800})
        page.goto(address_of(child))
        page.wait_for_timeout(SETTLED_MS)
        return _watched(page, child.pid, rate_hz)


def _watched(page: "Page", pid: int, rate_hz: float) -> tuple[str, ...]:
    seconds = WATCHED_MS / 1e3
    before, spent_s = page.evaluate(SEEN), cpu_seconds(pid)
    page.wait_for_timeout(WATCHED_MS)
    after, taken_s = page.evaluate(SEEN), cpu_seconds(pid) - spent_s
    found = page.evaluate(LATE)
    quarter, ordered = len(found) // 4, sorted(found)
    return tuple(
        map(
            figure,
            (
                page.evaluate(LATENCY),
                statistics.median(found),
                ordered[int(0.95 * len(ordered))],
                statistics.median(found[:quarter]),
                statistics.median(found[-quarter:]),
                (after[0] - before[0]) / seconds,
                100.0 * (after[1] - before[1]) / (rate_hz * seconds),
                100.0 * taken_s / seconds,
            ),
        )
    )


def address_of(child: subprocess.Popen[bytes]) -> str:
    assert child.stderr is not None
    for line in child.stderr:
        if found := re.search(rb"http://\S+", line):
            return found.group().decode()
    raise HostkitError("the monitor did not serve a page")
