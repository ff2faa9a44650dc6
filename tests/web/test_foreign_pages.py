"""What pages of other origins can do in the browser of a signed-in user: nothing."""

import http.server
import shutil
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest
from fake_ports import wait_until
from fake_session import FakeControls
from served import running

playwright = pytest.importorskip("playwright.sync_api")
CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")
REBOUND = "rebound.example"

ATTACK = """
async (target) => {
  const body = JSON.stringify({action: "restart"});
  const told = {};
  const attempt = async (name, action) => {
    try { told[name] = await action(); } catch (error) { told[name] = "refused"; }
  };
  const simple = {method: "POST", mode: "no-cors", credentials: "include", body};
  await attempt("read", async () =>
    (await fetch(target + "/api/session", {credentials: "include"})).text());
  await attempt("blind post", async () => (await fetch(target + "/api/verdict", simple)).type);
  await attempt("with header", async () => (await fetch(target + "/api/verdict", {
    method: "POST", credentials: "include", body,
    headers: {"Content-Type": "application/json", "X-Hostkit-Token": "x"}})).text());
  await attempt("stream", () => new Promise((resolve) => {
    const source = new EventSource(target + "/stream", {withCredentials: true});
    source.onerror = () => { source.close(); resolve("refused"); };
    source.addEventListener("info", () => resolve("leaked"));
  }));
  await attempt("form", () => new Promise((resolve) => {
    const frame = document.createElement("iframe");
    frame.name = "answer";
    document.body.append(frame);
    frame.onload = () => resolve("sent");
    const form = document.createElement("form");
    form.method = "POST"; form.enctype = "text/plain"; form.target = "answer";
    form.action = target + "/api/verdict";
    const field = document.createElement("input");
    field.name = '{"action": "restart", "more": "'; field.value = '"}';
    form.append(field); document.body.append(form); form.submit();
  }));
  return told;
}
"""


FRAME = """
(address) => new Promise((resolve) => {
  const frame = document.createElement("iframe");
  frame.name = "framed";
  frame.onload = resolve;
  frame.src = address;
  document.body.append(frame);
})
"""


class Quiet(http.server.BaseHTTPRequestHandler):
    def do_GET(self) -> None:
        self.send_response(200)
        self.send_header("Content-Type", "text/html")
        self.end_headers()
        self.wfile.write(b"<!doctype html><title>foreign</title><body></body>")

    def log_message(self, *_: object) -> None:
        pass


@pytest.fixture(scope="module")
def foreign() -> Iterator[int]:
    """The port of a server of somebody else on this machine."""
    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), Quiet) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        yield server.server_port
        server.shutdown()


@pytest.fixture(scope="module")
def browser() -> Iterator:
    if CHROMIUM is None:
        pytest.skip("chromium is not installed")
    arguments = ["--no-sandbox", f"--host-resolver-rules=MAP {REBOUND} 127.0.0.1"]
    with playwright.sync_playwright() as driver:
        opened = driver.chromium.launch(executable_path=CHROMIUM, args=arguments)
        yield opened
        opened.close()


def until_refused(page) -> None:
    """Wait until the browser shows its own error in the frame."""
    for _ in range(400):
        if any(frame.url.startswith("chrome-error:") for frame in page.frames):
            return
        page.wait_for_timeout(25)
    raise AssertionError([frame.url for frame in page.frames])


@pytest.mark.parametrize("name", ["127.0.0.1", "localhost"])
def test_a_foreign_page_is_powerless(browser, foreign: int, tmp_path: Path, name: str) -> None:
    # The first is of the same site, so that its requests do carry the cookie.
    controls = FakeControls(folder=tmp_path)
    with running(tmp_path, controls=controls) as (server, _):
        context = browser.new_context()
        own = context.new_page()
        own.goto(server.url)
        assert own.evaluate("fetch('/api/session').then((r) => r.status)") == 200
        wait_until(lambda: len(server._hub._clients) == 1)
        ours = set(server._hub._clients)
        page = context.new_page()
        page.goto(f"http://{name}:{foreign}/")
        told = page.evaluate(ATTACK, f"http://127.0.0.1:{server.port}")
        assert told == {
            "read": "refused",
            "blind post": told["blind post"],
            "with header": "refused",
            "stream": "refused",
            "form": "sent",
        }
        assert told["blind post"] in ("opaque", "refused")
        page.evaluate(FRAME, f"http://127.0.0.1:{server.port}/")
        until_refused(page)
        assert server._hub._clients == ours
        assert own.evaluate("fetch('/api/session').then((r) => r.status)") == 200
        context.close()
        assert controls.calls == []


def test_a_name_that_was_rebound_is_refused(browser, tmp_path: Path) -> None:
    with running(tmp_path) as (server, _):
        context = browser.new_context()
        page = context.new_page()
        reply = page.goto(server.url.replace("127.0.0.1", REBOUND))
        assert reply.status == 421
        assert context.cookies() == []
        context.close()
