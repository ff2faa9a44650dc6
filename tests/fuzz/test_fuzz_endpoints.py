"""Every endpoint of the page's server under generated requests, well-formed or not."""

import json
import math
import socket
from pathlib import Path

import pytest
from fake_session import FakeControls
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st
from served import HOST, PORT, App, make_app, running

from hostkit.web.actions import COMMANDS
from hostkit.web.files import is_recording_name

FUZZ = settings(
    max_examples=300,
    deadline=None,
    derandomize=True,
    database=None,
    suppress_health_check=list(HealthCheck),
)
POSTS = ("parameters", "parameters/revert", "command", "recording", "port", "verdict", "replay")
PATHS = (
    "/",
    "/page/index.html",
    "/vendor/uPlot.esm.js",
    "/api/session",
    "/api/recordings",
    "/recordings/a.tlog",
    "/stream",
    "/report.html",
    *(f"/api/{name}" for name in POSTS),
)
METHODS = ("GET", "HEAD", "POST", "PUT", "DELETE", "OPTIONS", "PATCH", "TRACE", "X", "get")
LATIN = st.text(st.characters(max_codepoint=255, exclude_characters="\r\n\0"), max_size=60)

names = st.one_of(
    st.sampled_from(
        ["FILT_TAU", "calibrate", "a.tlog", "../a.tlog", "a.csv", "\ud800", "", "SYS_ID"]
    ),
    st.text(max_size=100),
)
numbers = st.one_of(
    st.floats(), st.integers(), st.integers(min_value=10**300, max_value=10**400), st.booleans()
)
scalars = st.one_of(st.none(), names, numbers)
values = st.recursive(
    scalars,
    lambda inner: st.one_of(st.lists(inner), st.dictionaries(names, inner)),
    max_leaves=6,
)
actions = st.sampled_from(
    ["start", "stop", "release", "take", "restart", "pause", "resume", "seek", "speed"]
)
near_bodies = st.fixed_dictionaries(
    {},
    optional={
        "name": st.one_of(names, values),
        "value": st.one_of(numbers, values),
        "action": st.one_of(actions, values),
        "more": values,
    },
)
bodies = st.one_of(
    st.binary(max_size=5000),
    values.map(lambda value: json.dumps(value).encode()),
    near_bodies.map(lambda value: json.dumps(value).encode()),
)


class Controls(FakeControls):
    """Asserts of every call that it could make sense."""

    def set_parameter(self, name: str, value: float) -> None:
        assert name.isascii()
        assert 1 <= len(name) <= 16
        assert name.replace("_", "a").isalnum()
        assert type(value) is float
        assert math.isfinite(value)
        assert abs(value) <= 3.4028235e38
        self._called("set_parameter", name, value)

    def command(self, name: str) -> None:
        assert name in COMMANDS
        self._called("command", name)

    def start_recording(self, name: str) -> None:
        assert is_recording_name(name)
        assert (self.folder / name).resolve().parent == self.folder.resolve()
        self._called("start_recording", name)

    def pause(self, paused: bool) -> None:
        assert type(paused) is bool
        self._called("pause", paused)

    def seek(self, position_s: float) -> None:
        assert type(position_s) is float
        assert 0.0 <= position_s <= 1e9
        self._called("seek", position_s)

    def set_speed(self, speed: float | None) -> None:
        assert speed is None or (type(speed) is float and 0.0 < speed <= 1000.0)
        self._called("set_speed", speed)


@pytest.fixture(scope="module")
def app(tmp_path_factory: pytest.TempPathFactory) -> App:
    folder = tmp_path_factory.mktemp("fuzzed")
    return make_app(folder, controls=Controls(folder=folder, replayed=True))


def fine(app: App, reply) -> None:
    """Assert that an answer neither failed nor tells what it should not."""
    assert reply.status < 500
    assert b"Traceback" not in reply.body
    assert app.access.token.encode() not in reply.body
    assert app.access.cookie.encode() not in reply.body
    assert reply.headers["x-content-type-options"] == "nosniff"
    if reply.status >= 400:
        assert set(reply.json()) == {"error"}


@FUZZ
@given(st.sampled_from(POSTS), bodies)
@example("parameters", b'{"name":"FILT_TAU","value":1e400}')
@example("parameters", b'{"name":"FILT_TAU","value":1' + b"0" * 4000 + b"}")
@example("parameters", b"[" * 4096)
@example("recording", b'{"action":"start","name":"\\ud800.tlog"}')
def test_bodies(app: App, path: str, body: bytes) -> None:
    app.controls.calls.clear()
    reply = app.post(f"/api/{path}", body)
    fine(app, reply)
    assert reply.status in (202, 400, 409, 413)
    assert len(app.controls.calls) <= 1
    assert bool(app.controls.calls) <= (reply.status in (202, 409))


@FUZZ
@given(st.sampled_from(POSTS), near_bodies)
def test_bodies_that_are_nearly_right(app: App, path: str, body: dict) -> None:
    app.controls.calls.clear()
    fine(app, app.post(f"/api/{path}", json.dumps(body).encode()))


@FUZZ
@given(
    st.sampled_from(METHODS),
    st.one_of(st.sampled_from(PATHS), LATIN.map(lambda text: "/" + text), LATIN),
    st.lists(
        st.tuples(
            st.sampled_from(
                ["host", "cookie", "origin", "x-hostkit-token", "content-type", "sec-fetch-site"]
            ),
            LATIN,
        ),
        max_size=5,
    ),
    st.binary(max_size=100),
)
def test_strangers_get_nothing(
    app: App, method: str, path: str, headers: list[tuple[str, str]], body: bytes
) -> None:
    app.controls.calls.clear()
    given_host = headers if any(name == "host" for name, _ in headers) else [("host", HOST)]
    for sent in (headers, [*headers, *given_host]):
        reply = app.ask(method, path, headers=sent, body=body)
        fine(app, reply)
        assert reply.status in (400, 401, 403, 421)
    assert app.controls.calls == []


@FUZZ
@given(
    st.sampled_from(METHODS),
    st.one_of(st.sampled_from(PATHS), st.text(max_size=60).map(lambda text: "/" + text)),
    st.lists(
        st.tuples(st.sampled_from(["origin", "accept", "content-type", "range", "cookie"]), LATIN),
        max_size=4,
    ),
    bodies,
)
def test_methods_paths_and_headers(
    app: App, method: str, path: str, headers: list[tuple[str, str]], body: bytes
) -> None:
    signed_in = app.signed_in(**{"x-hostkit-token": app.access.csrf}).items()
    fine(app, app.ask(method, path, headers=[*signed_in, *headers], body=body))


@FUZZ
@given(
    st.sampled_from(["/page/", "/vendor/", "/recordings/"]),
    st.one_of(
        st.text(max_size=120),
        st.lists(
            st.sampled_from(["..", "/", "\\", "\0", ".", "a", ".tlog", ".js", "%2e", ":", "~"]),
            max_size=8,
        ).map("".join),
    ),
)
def test_file_names(app: App, folder: str, name: str) -> None:
    reply = app.get(folder + name)
    fine(app, reply)
    assert reply.status == 404


@FUZZ
@given(LATIN)
def test_hosts_origins_and_cookies(app: App, text: str) -> None:
    for name in ("host", "origin", "cookie", "x-hostkit-token"):
        app.controls.calls.clear()
        reply = app.post("/api/verdict", {"action": "restart"}, {name: text})
        fine(app, reply)
        assert reply.status in (401, 403, 421)
        assert app.controls.calls == []


def test_bytes_on_the_socket(tmp_path: Path) -> None:
    start = f"GET /api/session HTTP/1.1\r\nHost: 127.0.0.1:{PORT}\r\n".encode()
    pieces = st.lists(
        st.one_of(
            st.sampled_from([start, b"\r\n", b"\r\n\r\n", b"POST ", b"Content-Length: 5\r\n"]),
            st.sampled_from([b"Transfer-Encoding: chunked\r\n", b"Cookie: ", b"Connection: x\r\n"]),
            st.binary(max_size=200),
        ),
        max_size=8,
    ).map(b"".join)
    with running(tmp_path) as (server, client):

        @settings(FUZZ, max_examples=150)
        @given(pieces)
        def send(data: bytes) -> None:
            with socket.create_connection(("127.0.0.1", server.port), timeout=30.0) as connection:
                connection.sendall(data)
                connection.shutdown(socket.SHUT_WR)
                answer = b""
                try:
                    while received := connection.recv(65536):
                        answer += received
                except ConnectionError:
                    pass
                assert not answer or answer.startswith(b"HTTP/1.1 4")

        send()
        assert client.get("/api/session").status_code == 200
