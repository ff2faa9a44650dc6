"""How late the page of the monitor is, and what serving it costs."""

import re
import statistics
import subprocess
from collections.abc import Iterator

from benchmarks.live_device import cpu_seconds, hostkit, live_device, running
from benchmarks.table import MISSING, figure
from hostkit.errors import HostkitError

CHROMIUM = "/usr/bin/chromium"
SETTLED_MS, WATCHED_MS = 3000, 20_000
SEEN = "[window.hostkit.frames, window.hostkit.samples]"
LATE = "Array.from(window.hostkit.latencyMs)"


def page_rows(rate_hz: float) -> Iterator[tuple[str, ...]]:
    """Measure the page at one rate; a row of dashes where there is no browser."""
    try:
        from playwright.sync_api import Error, sync_playwright
    except ImportError:
        yield (f"{rate_hz:g}", *(MISSING,) * 7)
        return
    with live_device(rate_hz) as device, sync_playwright() as playwright:
        command = hostkit("monitor", str(device.design_file), "--port", device.port)
        command += ["--web", "--no-browser"]
        with running(command, stderr=subprocess.PIPE) as child:
            address = _address(child)
            try:
                browser = playwright.chromium.launch(
                    executable_path=CHROMIUM, args=["--no-sandbox"]
                )
            except Error:
                yield (f"{rate_hz:g}", *(MISSING,) * 7)
                return
            page = browser.new_page(viewport={"width": 1280, "height": 800})
            page.goto(address)
            page.wait_for_timeout(SETTLED_MS)
            spent_s, (frames, _) = cpu_seconds(child.pid), page.evaluate(SEEN)
            page.wait_for_timeout(WATCHED_MS)
            share = (cpu_seconds(child.pid) - spent_s) / (WATCHED_MS / 1e3)
            updates = (page.evaluate(SEEN)[0] - frames) / (WATCHED_MS / 1e3)
            late = sorted(found := page.evaluate(LATE))
            missed = page.evaluate("fetch('/api/session').then(r => r.status)")
            browser.close()
    quarter = len(found) // 4
    yield (
        f"{rate_hz:g}",
        figure(statistics.median(late)),
        figure(late[int(0.95 * len(late))]),
        figure(statistics.median(found[:quarter])),
        figure(statistics.median(found[-quarter:])),
        figure(updates),
        figure(100.0 * share),
        f"{missed}",
    )


def _address(child: subprocess.Popen[bytes]) -> str:
    assert child.stderr is not None
    for line in child.stderr:
        if found := re.search(rb"http://\S+", line):
            return found.group().decode()
    raise HostkitError("the monitor did not serve a page")
