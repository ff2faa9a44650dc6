"""The page of the monitor, driven by a browser, against the emulated ATmega328P."""

import re
import socket
from html.parser import HTMLParser
from pathlib import Path

import pytest
from boards import TARGET_TOOLS, require_or_skip
from live import DESIGN, browser, program, until, watched_page, write_inputs
from relay import Relay, relay
from station import GroundStation, require_station

from hostkit.filters.complementary import tau_from_eta

NEW_ETA = 0.99
LOST = "The port is lost; hostkit tries again."
SWING_DEG = 3.0
"""The played motion swings by more."""


def free_udp_port() -> int:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


class Text(HTMLParser):
    """The words of a page."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.words = ""
        self.feed(page)

    def handle_data(self, data: str) -> None:
        self.words += data


@pytest.fixture
def cable(tmp_path: Path):
    """An emulated AVR that moves, behind a cable."""
    require_or_skip(*TARGET_TOOLS["atmega328p"])
    require_station()
    write_inputs(tmp_path)
    arguments = ["emulate", "design.json", "--target", "atmega328p", "--pty"]
    with program(tmp_path, *arguments, "--recording", "sweep.csv") as device:
        path = device.see(r"/dev/\S+(?=\r?\n)")
        with relay(path, tmp_path / "link") as cable:
            yield cable


def test_a_device_is_watched_retuned_unplugged_recorded_and_replayed(
    cable: Relay, tmp_path: Path
) -> None:
    udp = free_udp_port()
    arguments = ["monitor", "design.json", "--port", str(cable.path), "--web", "--no-browser"]
    arguments += ["--forward", f"udp:127.0.0.1:{udp}", "--record", "all.tlog"]
    with browser() as chromium:
        with program(tmp_path, *arguments) as monitor:
            url = monitor.see(r"http://\S+")
            with watched_page(chromium, url) as page:
                station = GroundStation(f"udpin:127.0.0.1:{udp}", tmp_path)
                try:
                    sees_the_angle_move(page)
                    sees_the_verdict(page, "PASS")
                    changes_eta(page)
                    unplugs_and_plugs_again(page, cable)
                    records(page, tmp_path)
                    downloads_reports(page)
                    station.see(r"ATTITUDE \{.*roll : (-?[\d.e-]+)", asking="status ATTITUDE")
                    sees_the_verdict(page, "PASS")
                finally:
                    station.close()
            assert monitor.end() == 0, monitor.said
        replays(chromium, tmp_path)


def shown(page, selector: str) -> str:
    return page.locator(selector).inner_text().replace("\N{MINUS SIGN}", "-")


def samples(page) -> int:
    return page.evaluate("window.hostkit.samples")


def sees_more(page, count: int) -> None:
    """New samples are drawn."""
    seen = samples(page)
    until(page, lambda: samples(page) > seen + count, f"{count} samples more than {seen}")


def device_deg(page) -> list[float]:
    """Return the angles of the device as they are written on the page."""
    texts = page.locator("#digits tr td:nth-child(2)").all_inner_texts()
    found = [re.search(r"-?[\d.]+", text.replace("\N{MINUS SIGN}", "-")) for text in texts]
    return [float(one.group()) for one in found if one]


def sees_the_angle_move(page) -> None:
    """The digits follow the motion, and the charts are drawn."""
    seen: list[list[float]] = []

    def has_swung() -> bool:
        if len(now := device_deg(page)) == 2:
            seen.append(now)
        return all(max(one) - min(one) > SWING_DEG for one in zip(*seen, strict=True)) and (
            len(seen) > 5
        )

    until(page, has_swung, f"a swing of both angles by {SWING_DEG} deg")
    until(page, lambda: page.evaluate("window.hostkit.frames") > 10, "ten pictures")


def sees_the_verdict(page, verdict: str) -> None:
    until(page, lambda: shown(page, "#verdict").upper().startswith(verdict), f"verdict {verdict}")


def changes_eta(page) -> None:
    """A value is asked for, told by the device to be in use, and judged with."""
    tau_s, new_tau_s = (
        tau_from_eta(eta, DESIGN.period_s) for eta in (DESIGN.parameter("eta"), NEW_ETA)
    )
    until(page, lambda: uses_tau(page, tau_s), f"tau {tau_s:g} s in use")
    page.locator("#viewed-other").fill(f"{NEW_ETA}")
    page.locator("#viewed").get_by_role("button", name="Apply").click()
    until(page, lambda: uses_tau(page, new_tau_s), f"tau {new_tau_s:g} s in use")
    assert f"\N{GREEK SMALL LETTER ETA} {NEW_ETA}" in shown(page, "#viewed-used")
    page.locator("#retuned").wait_for(state="visible")
    sees_more(page, 100)
    assert mismatches(page) == 0
    page.get_by_role("button", name="Revert all").click()
    page.locator("#retuned").wait_for(state="hidden")
    until(page, lambda: uses_tau(page, tau_s), f"tau {tau_s:g} s in use")


def uses_tau(page, tau_s: float) -> bool:
    """Tell whether the page says that the device uses a time constant, within its rounding."""
    in_use = re.search(r"[\d.]*\d", shown(page, "#viewed-used"))
    return in_use is not None and float(in_use.group()) == pytest.approx(tau_s, rel=2e-3)


def mismatches(page) -> int:
    """Ask the report, as the page's own link does."""
    return page.evaluate("fetch('/report.json').then(r => r.json()).then(d => d.mismatches)")


def unplugs_and_plugs_again(page, cable: Relay) -> None:
    cable.unplug()
    until(page, lambda: shown(page, "#port-state").lower() == "lost", "a lost port")
    banner = page.get_by_role("alert")
    until(page, lambda: banner.all_inner_texts() == [LOST], "a banner that says so")
    cable.plug()
    until(page, lambda: shown(page, "#port-state").lower() == "connected", "the port again")
    until(page, lambda: banner.count() == 0, "the end of the banner")
    sees_more(page, 100)
    assert re.search("[1-9]", shown(page, "#reconnects"))


def records(page, folder: Path) -> None:
    """A recording is begun and ended, listed, and downloaded as it is on disk."""
    page.locator("#recording-go").click()  # ends that of the command line
    page.locator("#recordings").get_by_role("link", name="all.tlog").wait_for()
    page.locator("#recording-name").fill("flight")
    page.locator("#recording-go").click()
    until(page, lambda: "stop" in shown(page, "#recording-go").lower(), "a way to stop")
    sees_more(page, 400)
    page.locator("#recording-go").click()
    until(page, lambda: "stop" not in shown(page, "#recording-go").lower(), "its end")
    with page.expect_download() as downloaded:
        page.locator("#recordings").get_by_role("link", name="flight.tlog").click()
    downloaded.value.save_as(folder / "downloaded.tlog")
    on_disk = next(p for p in folder.rglob("flight.tlog"))
    assert (folder / "downloaded.tlog").read_bytes() == on_disk.read_bytes() != b""


def downloads_reports(page) -> None:
    said = {}
    for name in ("report-html", "report-json", "report-xml"):
        with page.expect_download() as downloaded:
            page.locator(f"#{name}").click()
        said[name] = Path(downloaded.value.path()).read_text("utf-8")
    assert "pass" in Text(said["report-html"]).words.lower()
    assert '"verdict": "pass"' in said["report-json"]
    assert "<testsuite" in said["report-xml"]


def near(seek, place_s: float) -> bool:
    return abs(float(seek.input_value()) - place_s) < 0.3


def replays(chromium, folder: Path) -> None:
    """What was recorded is played on the same page: held, moved, let go on."""
    arguments = ["monitor", "design.json", "--port", "file:downloaded.tlog"]
    with program(folder, *arguments, "--web", "--no-browser", "--speed", "0.5") as monitor:
        with watched_page(chromium, monitor.see(r"http://\S+")) as page:
            page.locator("#replay").wait_for(state="visible")
            play, seek = page.locator("#replay-play"), page.locator("#replay-seek")
            name = play.inner_text()
            play.click()
            until(page, lambda: play.inner_text() != name, "a held replay")
            for place_s in (3.0, 0.5):
                seek.fill(f"{place_s}")
                until(page, lambda to=place_s: near(seek, to), f"the place {place_s} s")
            play.click()
            until(page, lambda: float(seek.input_value()) > 2.0, "what comes behind")
            sees_the_verdict(page, "PASS")
        assert monitor.end() == 0, monitor.said
