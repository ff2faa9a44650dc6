import importlib.resources
from pathlib import Path

import pytest
from served import App, make_app

import hostkit
from hostkit.web import files
from hostkit.web.actions import BODY_BYTES


@pytest.fixture
def app(tmp_path: Path) -> App:
    return make_app(tmp_path, replayed=True)


def test_session_says_what_it_is(app: App) -> None:
    reply = app.get("/api/session").json()
    assert set(reply) == {"csrf", "info", "version"}
    assert reply["version"] == hostkit.__version__
    assert reply["info"]["design_digest"] == "0123456789ab"
    assert reply["info"]["axes"] == ["roll", "pitch"]
    facts = {fact["name"]: fact["value"] for fact in reply["info"]["facts"]}
    assert facts["tau_s"] == pytest.approx(0.49)


@pytest.mark.parametrize(
    ("path", "body", "call"),
    [
        ("parameters", {"name": "FILT_TAU", "value": 0.97}, ("set_parameter", "FILT_TAU", 0.97)),
        ("parameters", {"name": "CAL_START", "value": 1}, ("set_parameter", "CAL_START", 1.0)),
        ("parameters/revert", {}, ("revert_parameters",)),
        ("command", {"name": "self-test"}, ("command", "self-test")),
        ("recording", {"action": "start", "name": "f.csv"}, ("start_recording", "f.csv")),
        ("port", {"action": "release"}, ("release_port",)),
        ("port", {"action": "take"}, ("take_port",)),
        ("verdict", {"action": "restart"}, ("restart_verdict",)),
        ("replay", {"action": "pause"}, ("pause", True)),
        ("replay", {"action": "resume", "value": None}, ("pause", False)),
        ("replay", {"action": "seek", "value": 1.5}, ("seek", 1.5)),
        ("replay", {"action": "speed", "value": 4}, ("set_speed", 4.0)),
        ("replay", {"action": "speed", "value": None}, ("set_speed", None)),
    ],
)
def test_post_calls_the_session(app: App, path: str, body: object, call: tuple) -> None:
    reply = app.post(f"/api/{path}", body)
    assert (reply.status, reply.json()) == (202, {"ok": True})
    assert app.controls.calls == [call]
    assert all(type(value) is not int for value in app.controls.calls[0])


def test_recording_is_stopped(app: App) -> None:
    app.post("/api/recording", {"action": "start", "name": "f.csv"})
    assert app.post("/api/recording", {"action": "stop"}).status == 202
    assert app.controls.calls[-1] == ("stop_recording",)


@pytest.mark.parametrize(
    ("path", "body"),
    [
        ("parameters", b""),
        ("parameters", b"[]"),
        ("parameters", b"null"),
        ("parameters", b"\xff\xfe"),
        ("parameters", b"[" * 4000),
        ("parameters", b'{"a":' * 800),
        ("parameters", b'{"name": "FILT_TAU", "value": NaN}'),
        ("parameters", b'{"name": "FILT_TAU", "value": Infinity}'),
        ("parameters", b'{"name": "FILT_TAU", "value": 1e999}'),
        ("parameters", b'{"name": "FILT_TAU", "value": 1%s}' % (b"0" * 4000)),
        ("parameters", b'{"name": "FILT_TAU", "value": 1, "value": 2}'),
        ("parameters", {"name": "FILT_TAU"}),
        ("parameters", {"name": "FILT_TAU", "value": True}),
        ("parameters", {"name": "FILT_TAU", "value": "0.5"}),
        ("parameters", {"name": "FILT_TAU", "value": None}),
        ("parameters", {"name": "FILT_TAU", "value": [0.5]}),
        ("parameters", {"name": "FILT_TAU", "value": 1e39}),
        ("parameters", {"name": "FILT_TAU", "value": 0.5, "more": 1}),
        ("parameters", {"name": "", "value": 0.5}),
        ("parameters", {"name": "FILT_TAU\n", "value": 0.5}),
        ("parameters", {"name": "A" * 17, "value": 0.5}),
        ("parameters", {"name": "\ud800", "value": 0.5}),
        ("parameters", {"name": 5, "value": 0.5}),
        ("parameters/revert", {"name": "FILT_TAU"}),
        ("command", {"name": "format-disk"}),
        ("command", {"name": ["calibrate"]}),
        ("command", {"name": None}),
        ("recording", {"action": "start"}),
        ("recording", {"action": "start", "name": None}),
        ("recording", {"action": "delete", "name": "a.csv"}),
        ("port", {"action": "open"}),
        ("verdict", {"action": "pass"}),
        ("replay", {"action": "seek"}),
        ("replay", {"action": "seek", "value": None}),
        ("replay", {"action": "seek", "value": -1}),
        ("replay", {"action": "speed"}),
        ("replay", {"action": "speed", "value": 0}),
        ("replay", {"action": "speed", "value": 1e9}),
        ("replay", {"action": "\ud800", "\ud800": 1}),
    ],
)
def test_what_makes_no_sense_is_refused(app: App, path: str, body: object) -> None:
    reply = app.post(f"/api/{path}", body)
    assert reply.status == 400
    assert reply.json()["error"]
    assert app.controls.calls == []


@pytest.mark.parametrize(
    ("path", "body", "text"),
    [
        ("parameters", {"name": "NO_SUCH", "value": 1}, "no parameter NO_SUCH"),
        ("recording", {"action": "stop"}, "nothing is being recorded"),
        ("replay", {"action": "seek", "value": 1e6}, "beyond the end"),
    ],
)
def test_what_the_session_refuses_is_told(app: App, path: str, body: object, text: str) -> None:
    reply = app.post(f"/api/{path}", body)
    assert reply.status == 409
    assert text in reply.json()["error"]


def test_body_is_bounded(app: App) -> None:
    body = b'{"action": "restart"}'
    assert app.post("/api/verdict", body.ljust(BODY_BYTES)).status == 202
    assert app.post("/api/verdict", body.ljust(BODY_BYTES + 1)).status == 413


@pytest.mark.parametrize(
    ("kind", "media_type"),
    [("html", "text/html"), ("json", "application/json"), ("xml", "application/xml")],
)
def test_reports_are_downloads(app: App, kind: str, media_type: str) -> None:
    reply = app.get(f"/report.{kind}")
    assert reply.status == 200
    assert reply.headers["content-type"].startswith(media_type)
    assert reply.headers["content-disposition"] == f'attachment; filename="hostkit-report.{kind}"'
    assert reply.body


@pytest.mark.parametrize("method", ["HEAD", "PUT", "DELETE", "OPTIONS", "TRACE"])
def test_the_stream_is_only_got(app: App, method: str) -> None:
    headers = app.signed_in(**{"x-hostkit-token": app.access.csrf})
    assert app.ask(method, "/stream", headers=headers).status == 405


@pytest.mark.parametrize("path", ["/nowhere", "/api", "/api/", "/page/", "/api/session/", "//"])
def test_other_paths_are_not_found(app: App, path: str) -> None:
    assert app.get(path).status == 404


@pytest.fixture
def pages(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder of packages in place of the real one."""
    monkeypatch.setattr(files, "files", lambda package: tmp_path)
    folder = tmp_path / "page"
    for name in ("node_modules/uplot/dist", "vendor"):
        (folder / name).mkdir(parents=True)
    return folder


@pytest.mark.parametrize(
    ("name", "media_type"),
    [
        ("app.js", "text/javascript; charset=utf-8"),
        ("style.css", "text/css; charset=utf-8"),
        ("icon.svg", "image/svg+xml"),
    ],
)
def test_page_files_have_their_types(app: App, pages: Path, name: str, media_type: str) -> None:
    (pages / name).write_text("x")
    reply = app.get(f"/page/{name}")
    assert (reply.status, reply.body) == (200, b"x")
    assert reply.headers["content-type"] == media_type
    assert reply.headers["cache-control"] == "no-cache"


def test_index_is_the_root(app: App, pages: Path) -> None:
    (pages / "index.html").write_text("<!doctype html>")
    assert app.get("/").body == b"<!doctype html>"


@pytest.mark.parametrize(
    "name",
    ["../snapshot.py", "package.json", ".hidden.js", "a/b.js", "x.py", "node_modules", "%2e"],
)
def test_nothing_but_page_files_is_given(app: App, pages: Path, name: str) -> None:
    (pages / "package.json").write_text("{}")
    (pages / ".hidden.js").write_text("x")
    (pages / "x.py").write_text("x")
    assert app.get(f"/page/{name}").status == 404


def test_chart_library_of_a_checkout_and_of_a_wheel(app: App, pages: Path) -> None:
    assert app.get("/vendor/uPlot.esm.js").status == 404
    (pages / "vendor" / "uPlot.esm.js").write_text("wheel")
    assert app.get("/vendor/uPlot.esm.js").body == b"wheel"
    (pages / "node_modules/uplot/dist/uPlot.esm.js").write_text("checkout")
    assert app.get("/vendor/uPlot.esm.js").body == b"checkout"
    assert app.get("/vendor/uPlot.iife.js").status == 404


def test_files_are_looked_for_in_the_package() -> None:
    assert importlib.resources.files("hostkit.web").joinpath("server.py").is_file()
    assert files.page_file("server.py") is None
