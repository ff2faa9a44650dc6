"""The page in a browser, on a session without a device."""

import contextlib
import re
import shutil
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import pytest
from fake_session import FakeControls, FakeReports, Feed, report, snapshot

from hostkit.emulation.tools import TOOLS, find
from hostkit.monitor.snapshot import DeviceStatus, Notice
from hostkit.web import files
from hostkit.web.server import Server

playwright = pytest.importorskip("playwright.sync_api")
CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")
HOSTILE = "<img src=x onerror=\"document.title='taken'\"><script>alert(1)</script>"
LIMIT_MS = 20_000


def need_uplot() -> None:
    tool = next(tool for tool in TOOLS if tool.name == "uplot")
    if not find(tool).found:
        pytest.skip(f"uplot is not installed: {tool.hint}")


@pytest.fixture(scope="module")
def browser() -> Iterator:
    if CHROMIUM is None:
        pytest.skip("chromium is not installed")
    with playwright.sync_playwright() as driver:
        opened = driver.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        yield opened
        opened.close()


def until(page, condition: str) -> None:
    """Wait for something in the page, without the eval that its policy forbids."""
    for _ in range(LIMIT_MS // 25):
        if page.evaluate(condition):
            return
        page.wait_for_timeout(25)
    raise AssertionError(f"not within {LIMIT_MS} ms: {condition}")


class Session:
    """A fake session with its page server, and the pages that were opened on it."""

    def __init__(self, browser, folder: Path, **options) -> None:
        self.browser = browser
        self.controls = FakeControls(folder=folder, **options)
        self.server = Server(self.controls, reports=FakeReports(), folder=folder)
        self.feed = Feed(self.controls, self.server)
        self.complaints: list[str] = []
        self.addresses: list[str] = []
        self.url = ""

    def open(self, script: str = "", ready: str = "window.hostkit?.samples > 5", **options):
        context = self.browser.new_context(viewport={"width": 1280, "height": 800}, **options)
        context.set_default_timeout(LIMIT_MS)
        page = context.new_page()
        if script:
            page.add_init_script(script)
        page.on("console", lambda said: self._said(said.type, said.text))
        page.on("pageerror", lambda error: self.complaints.append(str(error)))
        page.on("request", lambda request: self.addresses.append(request.url))
        page.goto(self.url)
        until(page, ready)
        return page

    def _said(self, kind: str, text: str) -> None:
        if kind in ("error", "warning"):
            self.complaints.append(text)

    def called(self, page, *call) -> None:
        """Wait until the session was asked for something."""
        for _ in range(LIMIT_MS // 50):
            if call in self.controls.calls:
                return
            page.wait_for_timeout(50)
        raise AssertionError(f"{call} is not among {self.controls.calls}")


@pytest.fixture
def session(browser, tmp_path: Path) -> Iterator[Callable[..., Session]]:
    """Make sessions; at the end no page may have complained or asked another server."""
    with contextlib.ExitStack() as stack:
        made: list[Session] = []

        def make(**options) -> Session:
            folder = tmp_path / f"session{len(made)}"
            folder.mkdir()
            one = Session(browser, folder, **options)
            one.url = one.server.start()
            stack.callback(one.server.stop)
            one.feed.start()
            stack.callback(one.feed.stop)
            made.append(one)
            return one

        yield make
        for context in browser.contexts:
            context.close()
    for one in made:
        assert one.complaints == []
        base = one.url.partition("?")[0]
        assert one.addresses
        assert [url for url in one.addresses if not url.startswith(base)] == []


def painted(page, box: str) -> int:
    """How many pixels of a chart are not background."""
    return page.evaluate(
        """(box) => {
          const canvas = document.querySelector(`${box} canvas`);
          const { width, height } = canvas;
          const { data } = canvas.getContext("2d").getImageData(0, 0, width, height);
          return data.filter((value, index) => index % 4 === 3 && value > 0).length;
        }""",
        box,
    )


def a_minute(session):
    """A page that has much to scroll back to, after three seconds: a replay at full speed."""
    one = session(replayed=True)
    one.controls.set_speed(None)
    page = one.open()
    until(page, "window.hostkit.samples > 3000")
    return page


def text(page, box: str) -> str:
    return page.locator(box).inner_text()


def said(page, box: str, pattern: str) -> None:
    playwright.expect(page.locator(box)).to_have_text(re.compile(pattern), timeout=LIMIT_MS)


def test_the_charts_draw_and_the_horizon_turns(session) -> None:
    need_uplot()
    page = session(rate_hz=1000.0).open()
    until(page, "window.hostkit.frames > 20")
    before = page.locator("#horizon g").first.get_attribute("transform")
    frames = page.evaluate("window.hostkit.frames")
    until(page, f"window.hostkit.frames > {frames + 10}")
    assert page.locator("#horizon g").first.get_attribute("transform") != before
    assert painted(page, "#angle-chart") > 5000
    assert painted(page, "#residual-chart") > 5000
    assert page.evaluate("window.hostkit.latencyMs.length") > 5
    label = page.locator("#horizon").get_attribute("aria-label")
    assert re.search(r"roll -?\d+ degrees, pitch -?\d+ degrees", label)
    said(page, "#digits", r"Roll.*[+\u2212]\d+\.\d\d°.*Pitch")
    said(page, "#verdict", "^PASS$")
    assert page.title() == "PASS · hostkit monitor"


def test_the_pointer_reads_samples_and_a_drag_scrolls_back(session) -> None:
    need_uplot()
    page = a_minute(session)
    box = page.locator("#angle-chart").bounding_box()
    x, y = box["x"] + box["width"] - 60, box["y"] + 60
    page.mouse.move(x, y)
    said(page, "#readout", r"^\d+\.\d{3} s · roll .*°, residual .*° · pitch .*°, residual .*°$")
    page.mouse.down()
    page.mouse.move(x + 40, y)
    page.mouse.up()
    said(page, "#scroll-said", r"^[\d.]+ s behind$")


def test_it_fits_one_screen_without_scrolling(session) -> None:
    page = session(replayed=True).open()
    size = "(({ scrollWidth, scrollHeight }) => [scrollWidth, scrollHeight])"
    assert page.evaluate(f"{size}(document.documentElement)") == [1280, 800]
    page.set_viewport_size({"width": 400, "height": 800})
    assert page.evaluate("document.documentElement.scrollWidth") <= 400


def test_the_time_constant_is_set_as_tau_or_as_eta(session) -> None:
    one = session()
    page = one.open()
    said(page, "#viewed-used", r"in use τ 0\.49 s · η 0\.98 · 0\.325 Hz$")
    page.fill("#viewed-other", "0.99")
    assert float(page.input_value("#viewed-value")) == pytest.approx(0.99)
    page.press("#viewed-other", "Enter")
    one.called(page, "set_parameter", "FILT_TAU", 0.99)
    said(page, "#viewed-used", r"in use τ 0\.99 s · η 0\.99 · 0\.161 Hz")
    page.focus("#viewed-slide")
    page.keyboard.press("ArrowRight")
    assert float(page.input_value("#viewed-value")) == pytest.approx(1.0, rel=0.02)
    assert page.get_attribute("#viewed-slide", "aria-valuetext").endswith(" s")


def test_a_parameter_is_set_refused_and_reverted(session) -> None:
    one = session()
    page = one.open()
    row = page.locator("form.parameter", has=page.get_by_label("TILT_OFS_ROLL", exact=True))
    row.locator("input").fill("0.125")
    row.locator("input").press("Enter")
    one.called(page, "set_parameter", "TILT_OFS_ROLL", 0.125)
    playwright.expect(row.locator(".used")).to_have_text(re.compile(r"^0\.125.rad"))
    row.locator("input").fill("9")
    row.get_by_role("button").click()
    playwright.expect(row.locator(".said")).to_have_text("refused: outside [-0.5, 0.5]")
    page.click("#revert")
    one.called(page, "revert_parameters")
    playwright.expect(row.locator(".used")).to_have_text(re.compile(r"^0.rad$"))


def test_a_value_that_is_being_typed_is_left_alone(session) -> None:
    one = session()
    page = one.open()
    page.fill("#viewed-value", "0.3")
    seen = text(page, "#elapsed")
    until(page, f"document.getElementById('elapsed').textContent !== '{seen}'")
    assert page.input_value("#viewed-value") == "0.3"


def test_commands_port_and_verdict(session) -> None:
    one = session()
    page = one.open()
    page.click("text=Calibrate")
    one.called(page, "command", "calibrate")
    said(page, "#command-said", "^calibrate done$")
    page.click("text=Reboot…")
    page.click("#reboot >> text=Cancel")
    page.click("text=Reboot…")
    page.click("#reboot >> text=Reboot >> nth=-1")
    one.called(page, "command", "reboot")
    assert one.controls.calls.count(("command", "reboot")) == 1
    page.click("#port-button")
    one.called(page, "release_port")
    said(page, "#port-state", "^released$")
    said(page, "#port-button", "^Take$")
    assert page.locator("[data-command=calibrate]").is_disabled()
    page.click("#port-button")
    one.called(page, "take_port")
    page.click("#judge-anew")
    one.called(page, "restart_verdict")


def test_a_recording_is_made_listed_and_downloaded(session) -> None:
    one = session()
    page = one.open()
    page.fill("#recording-name", "flight")
    page.select_option("#recording-form", ".csv")
    page.click("#recording-go")
    one.called(page, "start_recording", "flight.csv")
    said(page, "#recording-state", "● flight.csv: 1 frames, 8 B")
    page.click("#recording-go")
    one.called(page, "stop_recording")
    with page.expect_download() as waiting:
        page.click("#recordings >> text=flight.csv")
    assert Path(waiting.value.path()).read_bytes() == b"recorded"
    page.fill("#recording-name", "flight.csv")
    page.click("#recording-go")
    said(page, "#recording-said", "exists")
    one.complaints[:] = [said for said in one.complaints if "status of 4" not in said]


def test_reports_are_downloaded(session) -> None:
    page = session().open()
    for form in ("html", "json", "xml"):
        with page.expect_download() as waiting:
            page.click(f"#report-{form}")
        content = Path(waiting.value.path()).read_bytes()
        assert content == getattr(FakeReports(), form)()


def test_pause_scroll_back_zoom_and_live_by_keyboard(session) -> None:
    page = a_minute(session)
    page.keyboard.press("Space")
    said(page, "#hold", "^Resume$")
    said(page, "#scroll-said", "behind$")
    page.keyboard.press("-")
    playwright.expect(page.locator("#span")).to_have_value("30")
    page.keyboard.press("+")
    page.keyboard.press("+")
    playwright.expect(page.locator("#span")).to_have_value("5")
    page.keyboard.press("Home")
    said(page, "#scroll-said", "^live$")
    page.keyboard.press("ArrowLeft")
    said(page, "#scroll-said", r"[\d.]+ s behind")
    page.keyboard.press("ArrowRight")
    page.click("#live")
    said(page, "#scroll-said", "^live$")
    page.focus("#viewed-value")
    page.keyboard.press("Home")
    page.keyboard.press("?")
    assert not page.locator("#keys").is_visible()


CONTROLS = """(wrong) => [...document.querySelectorAll("a[href], button, input, select, .scroll")]
  .filter((node) => !node.disabled && node.checkVisibility()).filter(wrong)
  .map((node) => node.outerHTML)"""


@pytest.mark.parametrize("replayed", [False, True])
def test_every_control_has_a_name_and_the_keyboard_reaches_it(session, replayed: bool) -> None:
    page = session(replayed=replayed).open()
    until(page, "document.querySelector('form.parameter')")  # what snapshots add is there

    def controls(wrong: str) -> list[str]:
        return page.evaluate(f"({CONTROLS})({wrong})")

    for _ in range(len(controls("() => true")) + 5):
        page.keyboard.press("Tab")
        page.evaluate("document.activeElement.dataset.reached = 'yes'")
    assert controls("(node) => !node.dataset.reached") == []
    own_text = "(node.matches('a, button') && node.textContent.trim())"
    name = f"node.labels?.length || node.ariaLabel || node.ariaLabelledByElements || {own_text}"
    assert controls(f"(node) => !({name})") == []
    assert page.get_attribute("html", "lang") == "en"


def test_light_and_dark(session) -> None:
    need_uplot()
    one = session()
    page = one.open(color_scheme="dark")
    background = "getComputedStyle(document.body).backgroundColor"
    dark = page.evaluate(background)
    page.click("#theme")
    light = page.evaluate(background)
    assert light != dark
    page.reload()
    until(page, "window.hostkit?.samples > 5")
    assert page.evaluate(background) == light


def test_texts_have_contrast(session) -> None:
    page = session().open()
    for scheme in ("light", "dark"):
        page.emulate_media(color_scheme=scheme)
        worst = page.evaluate(CONTRAST)
        assert worst["ratio"] >= 4.5, (scheme, worst)


CONTRAST = """() => {
  const probe = document.createElement("i");
  document.body.append(probe);
  const light = (name) => {
    probe.style.color = `var(--${name})`;
    const part = getComputedStyle(probe).color.match(/[\\d.]+/g).slice(0, 3).map((value) => {
      const share = value / 255;
      return share <= 0.04045 ? share / 12.92 : ((share + 0.055) / 1.055) ** 2.4;
    });
    return 0.2126 * part[0] + 0.7152 * part[1] + 0.0722 * part[2];
  };
  const pairs = [["badge-ink", "good"], ["badge-ink", "bad"], ["badge-ink", "soft"]];
  for (const name of ["ink", "soft", "accent", "good", "warn", "bad"]) {
    for (const ground of ["card", "paper", "sunk"]) pairs.push([name, ground]);
  }
  let worst = { ratio: 99 };
  for (const [one, other] of pairs) {
    const [low, high] = [light(one), light(other)].sort((a, b) => a - b);
    const ratio = (high + 0.05) / (low + 0.05);
    if (ratio < worst.ratio) worst = { one, other, ratio };
  }
  return worst;
}"""


def test_nothing_is_drawn_while_nobody_looks(session) -> None:
    need_uplot()
    page = session().open()
    hide = "Object.defineProperty(document, 'hidden', { value: %s, configurable: true })"
    page.evaluate(hide % "true")
    page.evaluate("new Promise((done) => setTimeout(done, 200))")  # one may be under way
    frames, samples = page.evaluate("[window.hostkit.frames, window.hostkit.samples]")
    until(page, f"window.hostkit.samples > {samples + 50}")
    assert page.evaluate("window.hostkit.frames") == frames
    page.evaluate(hide % "false")
    page.evaluate("document.dispatchEvent(new Event('visibilitychange'))")
    until(page, f"window.hostkit.frames > {frames + 2}")


def test_a_lost_or_released_port_is_said_across_the_page(session) -> None:
    one = session()
    page = one.open()
    alert = page.get_by_role("alert")
    playwright.expect(alert).to_have_count(0)
    assert page.locator("#empty").is_hidden()
    for state, words in (
        ("lost", "The port is lost; hostkit tries again."),
        ("released", "The port is released."),
    ):
        one.controls.change(port_state=state)
        playwright.expect(alert).to_have_text(words, timeout=LIMIT_MS)
        size = "[document.documentElement.scrollWidth, document.documentElement.scrollHeight]"
        assert page.evaluate(size) == [1280, 800]
        one.controls.change(port_state="connected")
        playwright.expect(alert).to_have_count(0, timeout=LIMIT_MS)


def test_two_browsers_at_once(session) -> None:
    one = session()
    first, second = one.open(), one.open()
    first.fill("#viewed-value", "0.3")
    first.press("#viewed-value", "Enter")
    said(second, "#viewed-used", r"in use τ 0\.3 s")
    for page in (first, second):
        before = page.evaluate("window.hostkit.frames")
        until(page, f"window.hostkit.frames > {before + 5}")


def test_replay_is_held_sped_up_and_sought(session) -> None:
    one = session(replayed=True)
    page = one.open()
    page.click("#replay-play")
    one.called(page, "pause", True)
    said(page, "#replay-play", "^Play$")
    page.click("#replay-play")
    one.called(page, "pause", False)
    page.select_option("#replay-speed", "5")
    one.called(page, "set_speed", 5.0)
    page.select_option("#replay-speed", "max")
    one.called(page, "set_speed", None)
    page.evaluate(
        """() => {
          const seek = document.getElementById("replay-seek");
          seek.value = 60;
          seek.dispatchEvent(new Event("input"));
          seek.dispatchEvent(new Event("change"));
        }"""
    )
    one.called(page, "seek", 60.0)
    said(page, "#epoch", "^epoch 1$")
    assert page.locator("#port-button").is_hidden()
    assert page.locator("#viewed-apply").is_disabled()


def test_hostile_texts_are_only_texts(session) -> None:
    one = session()
    device = DeviceStatus(system=1, component=1, state=HOSTILE, version=HOSTILE, texts=(HOSTILE,))
    notice = Notice(time_s=1e300, level="error", text=HOSTILE)
    entry = replace(snapshot().parameters[0], name=HOSTILE, unit=HOSTILE)
    one.controls.change(
        device=device, notices=(notice,), parameters=(*one.controls.state.parameters, entry)
    )
    page = one.open()
    said(page, "#messages", re.escape(HOSTILE))
    said(page, "#device-state", re.escape(HOSTILE))
    said(page, "#parameters", re.escape(HOSTILE))
    assert page.locator("img").count() == 1
    assert page.locator("script").count() == 1
    assert page.title() == "PASS · hostkit monitor"


def test_a_failure_shows_its_reasons(session, monkeypatch) -> None:
    reasons = ("12 of 4000 samples differ from the integer model", "RMS 1.2 deg is above 0.1 deg")
    failed = replace(report(4000), verdict="fail", reasons=reasons)
    monkeypatch.setattr("fake_session.report", lambda samples=0: failed)
    page = session().open()
    said(page, "#verdict", "^FAIL$")
    assert page.locator("#reasons li").all_inner_texts() == list(reasons)
    said(page, "#reason", r"^\(1 of 2\) 12 of 4000 .* model$")
    assert page.title() == "FAIL · hostkit monitor"
    box, last = page.locator("#figures").bounding_box(), page.locator("#reasons li").last
    assert last.bounding_box()["y"] < box["y"] < 800
    said(page, "#marks-said", "integer model")
    playwright.expect(page.locator("#marks-said")).to_be_visible(timeout=LIMIT_MS)


def test_without_samples_the_page_says_why(session, monkeypatch) -> None:
    reason = "the device runs design 0123456789ab"
    refused = replace(report(0), verdict="refused", digest_ok=False, reasons=(reason,))
    monkeypatch.setattr("fake_session.report", lambda samples=0: refused)
    page = session(rate_hz=0.01).open(ready="document.title.startsWith('REFUSED')")
    said(page, "#empty", f"^Nothing to draw: {reason}$")
    playwright.expect(page.locator("#empty")).to_be_visible()
    assert page.evaluate("document.body.dataset.samples") == "none"
    facts = page.locator(".facts")
    assert facts.evaluate("(box) => box.scrollWidth <= box.clientWidth")


KEEP_SOURCE = """
  const Usual = window.EventSource;
  window.EventSource = class extends Usual {
    constructor(address) { super(address); window.source = this; }
  };
"""


def test_a_lost_server_is_said_and_its_return_is_noticed(session) -> None:
    one = session()
    page = one.open(script=KEEP_SOURCE)
    assert page.locator("#banner").is_hidden()
    samples = page.evaluate("window.hostkit.samples")
    page.evaluate("window.source.close(); window.source.onerror()")
    said(page, "#banner", "No connection to hostkit")
    until(page, f"window.hostkit.samples > {samples + 200}")
    assert page.locator("#banner").is_hidden()
    # What the server sent again counts once.
    assert page.evaluate("window.hostkit.samples") <= one.feed.samples


STORE = """async (events) => {
  const { Store } = await import("/page/store.js");
  const { Rows } = await import("/page/decimate.js");
  const store = new Store(["roll"], 100);
  for (const event of events) {
    if (event === "rejoin") {
      store.rejoin();
      continue;
    }
    const given = event.roll ?? {};
    event.t ??= Array.from({ length: event.count }, (_, i) => i / 1000);
    const zeros = event.t.map(() => 0);
    const line = Object.assign([...zeros], event.spikes ?? {});
    store.append({
      begins: zeros, mismatch: zeros, ...event,
      roll: { device: line, model: line, residual: line, ...given },
    });
  }
  const seen = { total: store.total, length: store.length, last: store.lastX };
  seen.x = Array.from({ length: Math.min(store.length, 20) }, (_, i) => store.x[store.slot(i)]);
  seen.times = seen.x.map((x) => store.timeAt(x));
  const rows = new Rows(3).fill(store, store.firstX, store.lastX, 100);
  seen.rows = rows.x.length;
  seen.gaps = rows.lines[0].filter((value) => value === null).length;
  seen.others = rows.lines[1].filter((value) => value === null).length;
  seen.most = Math.max(...rows.lines[0].filter((value) => value !== undefined));
  seen.least = Math.min(...rows.lines[0].filter((value) => value !== undefined));
  seen.steps = rows.lines.map((line) => {
    const drawn = line.filter((value) => value !== undefined);
    const up = (i) => drawn[i] === null || drawn[i - 1] === null;
    return Math.max(...drawn.map((value, i) => (!i || up(i) ? 0 : Math.abs(value - drawn[i - 1]))));
  });
  return seen;
}"""


def test_the_store_keeps_time_rising_and_draws_extremes(session) -> None:
    page = session().open()

    def store(*events):
        return page.evaluate(STORE, list(events))

    again = store(
        {"epoch": 0, "t": [1, 1.01, 1.02]}, "rejoin", {"epoch": 0, "t": [1, 1.01, 1.02, 1.03]}
    )
    assert again["x"] == [1, 1.01, 1.02, 1.03]
    assert again["gaps"] == 1
    anew = store({"epoch": 0, "t": [5, 5.01]}, {"epoch": 1, "t": [0, 0.01]})
    assert anew["x"] == [5, 5.01, 6, 6.01]
    assert anew["times"] == pytest.approx([5, 5.01, 0, 0.01])
    assert anew["gaps"] == 2
    wrapped = store({"epoch": 0, "count": 5, "spikes": {"1": 179.0, "2": -179.0}})
    assert wrapped["gaps"] == 2
    back = store({"epoch": 0, "t": [5, 1, 1e300, None, 2, -1e300, 2.01]})
    assert all(b > a for a, b in zip(back["x"], back["x"][1:], strict=False))
    dense = store({"epoch": 0, "count": 70_000, "spikes": {"41234": 7.0, "52345": -9.0}})
    assert (dense["total"], dense["length"]) == (70_000, 60_000)
    assert (dense["most"], dense["least"]) == (7.0, -9.0)
    assert dense["rows"] < 220


def test_no_line_is_drawn_where_an_angle_wraps(session) -> None:
    page = session().open()

    def steps(*angles: float, **lines):
        count = len(angles)
        event = {"epoch": 0, "t": [k / 1000 for k in range(count)]}
        event["roll"] = {"device": angles, "model": angles, "residual": [0.0] * count, **lines}
        return page.evaluate(STORE, [event])

    def wrapped(degrees: float) -> float:
        return (degrees + 180.0) % 360.0 - 180.0

    turning = [wrapped(0.2 * k) for k in range(9000)]
    shaking = [wrapped(180.0 + 5.0 * (-1) ** k + 0.001 * k) for k in range(9000)]
    for angles in (turning, turning[::-1], shaking, turning[:150], shaking[:150]):
        seen = steps(*angles)
        assert max(seen["steps"]) < 60.0
        assert (seen["most"], seen["least"]) == pytest.approx((max(angles), min(angles)), abs=1e-4)
        assert seen["rows"] <= 600
    # The line of an angle that does not wrap goes on beside one that does.
    beside = steps(*turning, model=[0.0] * 9000)
    assert beside["gaps"] > 5
    assert beside["others"] == 1


def test_without_uplot_the_page_says_so_and_works(session, monkeypatch) -> None:
    monkeypatch.setattr(files, "VENDOR_FOLDERS", ("nowhere",))
    one = session()
    page = one.open()
    playwright.expect(page.locator("#missing")).to_be_visible()
    said(page, "#missing", "uPlot, which is not installed")
    said(page, "#digits", r"Roll.*[+\u2212]\d+\.\d\d°")
    assert one.complaints
    assert all("404" in said or "uPlot.min.css" in said for said in one.complaints)
    one.complaints.clear()
