"""The server with real sockets."""

import ipaddress
import socket
import subprocess
import sys
import threading
import time
from dataclasses import replace
from pathlib import Path

import httpx
import numpy as np
import pytest
from fake_session import FakeControls, FakeReports, Feed, batch, snapshot
from served import running
from sse import Listener, times

from hostkit.errors import DeviceError, HostkitError
from hostkit.web import binding, protocol, stream, streaming
from hostkit.web.server import Server
from hostkit.web.stream import MOST_CLIENTS

WAIT_S = 30.0
STOP_S = 8.0
"""More than the server gives itself, for a busy machine; one that waits for a page needs 30 s."""


def until(condition) -> None:
    end_s = time.monotonic() + WAIT_S
    while not condition():
        assert time.monotonic() < end_s, "it did not come to be"
        time.sleep(0.005)


def make(folder: Path, **options) -> Server:
    return Server(FakeControls(folder=folder), reports=FakeReports(), folder=folder, **options)


def has_samples(count: int):
    return lambda events: len(times(events)) >= count


def test_two_browsers_see_the_same(tmp_path: Path) -> None:
    with (
        running(tmp_path) as (s, first),
        httpx.Client(base_url=first.base_url, cookies=first.cookies) as second,
        Listener(first) as one,
        Listener(second) as two,
    ):
        for listener in (one, two):
            listener.wait(lambda events: len(events) >= 2)
        for start in range(0, 100, 10):
            s.take_batch(batch(start, 10))
        for listener in (one, two):
            listener.wait(has_samples(100))
            assert times(listener.events) == batch(0, 100).time_s.tolist()
            assert [event.kind for event in listener.events[:2]] == ["info", "snapshot"]
        s.stop()
        for listener in (one, two):
            assert listener.ended()
            assert listener.events[-1].kind == "end"


def test_a_page_that_comes_again_gets_the_last_minute(tmp_path: Path) -> None:
    with running(tmp_path) as (s, client):
        for start in range(0, 10_000, 1000):
            s.take_batch(batch(start, 1000))
            until(lambda end=start + 1000: len(s._hub.history) >= min(end, 6000))
        for _ in range(2):
            with Listener(client) as listener:
                listener.wait(has_samples(6000))
                s.take_snapshot(snapshot())
            sent = [event for event in listener.events if event.kind == "samples"]
            assert 6000 <= len(times(sent)) <= 7000
            assert times(sent)[-1] == 99.99
            assert sent[0].data["begins"][0] == 1
            assert len(sent) <= 3


def test_a_fed_session_loses_nothing(tmp_path: Path) -> None:
    controls = FakeControls(folder=tmp_path, rate_hz=1000.0)
    s = Server(controls, reports=FakeReports(), folder=tmp_path)
    url = s.start()
    feed = Feed(controls, s)
    with httpx.Client(base_url=url.partition("?")[0]) as client:
        client.get(url)
        with Listener(client) as listener:
            feed.start()
            listener.wait(has_samples(700))
            feed.stop()
            listener.wait(has_samples(feed.samples))
            arrived = [event for event in listener.events if event.kind == "samples"]
            assert len(times(arrived)) == feed.samples
            assert len(arrived) <= 15 * (feed.samples / 1000.0) + 3
            s.stop()


def stuck(s: Server, client: httpx.Client) -> socket.socket:
    """Return a connection that asks for the stream and never reads it."""
    connection = socket.socket()
    connection.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
    connection.connect(("127.0.0.1", s.port))
    cookie = f"hostkit-{s.port}={client.cookies[f'hostkit-{s.port}']}"
    request = f"GET /stream HTTP/1.1\r\nHost: 127.0.0.1\r\nCookie: {cookie}\r\n\r\n"
    connection.sendall(request.encode())
    until(lambda: s._hub._clients)
    return connection


def test_a_stuck_page_holds_up_nobody(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(stream, "QUEUE_EVENTS", 4)
    with running(tmp_path) as (s, client), stuck(s, client) as connection:
        (held,) = s._hub._clients
        with Listener(client) as listener:
            listener.wait(lambda events: bool(events))
            sent, slowest_s = 0, 0.0
            while not held.missed:
                before_s = time.monotonic()
                s.take_batch(batch(sent, 1000))
                slowest_s = max(slowest_s, time.monotonic() - before_s)
                sent += 1000
                listener.wait(has_samples(sent))
                assert sent < 1_000_000, "what a page does not read piles up"
            assert listener.events[0].kind == "info"
            assert len(times(listener.events)) == sent
            assert slowest_s < STOP_S
            begun_s = time.monotonic()
            s.stop()
            assert time.monotonic() - begun_s < STOP_S
            assert listener.ended()
            until(lambda: not s._thread.is_alive())
        assert connection.fileno() > 0


def test_a_stuck_page_loses_its_place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(streaming, "STALL_S", 0.1)
    with running(tmp_path) as (s, client), stuck(s, client):
        number = 0
        while s._hub._clients:
            s.take_batch(batch(number, 4000))
            number += 4000
            assert number < 10_000_000
            time.sleep(0.02)


def test_a_page_that_leaves_is_forgotten(tmp_path: Path) -> None:
    with running(tmp_path) as (s, client):
        connection = stuck(s, client)
        connection.close()
        until(lambda: not s._hub._clients)


def test_too_many_pages_are_refused(tmp_path: Path) -> None:
    with running(tmp_path) as (s, client):
        held = [stuck(s, client) for _ in range(MOST_CLIENTS)]
        until(lambda: len(s._hub._clients) == MOST_CLIENTS)
        reply = client.get("/stream")
        assert reply.status_code == 503
        assert "close one" in reply.json()["error"]
        held.pop().close()
        until(lambda: len(s._hub._clients) == MOST_CLIENTS - 1)
        with Listener(client) as listener:
            listener.wait(lambda events: bool(events))
            s.take_snapshot(snapshot())
        for connection in held:
            connection.close()


def test_stop_is_quick_and_may_come_twice_or_before_start(tmp_path: Path) -> None:
    idle = make(tmp_path)
    idle.stop()
    with running(tmp_path) as (s, client), Listener(client) as listener:
        listener.wait(lambda events: bool(events))
        s.take_batch(batch(0, 5))
        begun_s = time.monotonic()
        s.stop()
        assert time.monotonic() - begun_s < STOP_S
        assert listener.ended()
        assert len(times(listener.events)) == 5
        with pytest.raises(httpx.ConnectError):
            client.get("/api/session")
        s.stop()


def test_what_was_taken_before_the_end_is_still_sent(tmp_path: Path) -> None:
    with running(tmp_path) as (s, client), Listener(client) as listener:
        listener.wait(lambda events: bool(events))
        s.take_batch(batch(0, 7))
        s.take_snapshot(snapshot(ended=True))
        assert listener.ended()
        assert [event.kind for event in listener.events[-3:]] == ["samples", "snapshot", "end"]
        assert client.get("/report.json").status_code == 200


@pytest.mark.filterwarnings("ignore::pytest.PytestUnhandledThreadExceptionWarning")
def test_a_failure_of_the_stream_is_no_silent_page(tmp_path: Path) -> None:
    with running(tmp_path) as (s, client), Listener(client) as listener:
        listener.wait(lambda events: bool(events))
        s.take_batch(replace(batch(0, 3), device_rad=np.zeros((3, 0))))
        assert listener.ended()
        until(lambda: not s._thread.is_alive())


def test_busy_port_is_told(tmp_path: Path) -> None:
    with running(tmp_path) as (s, _), pytest.raises(DeviceError, match=f"port {s.port} .* in use"):
        make(tmp_path, port=s.port)


@pytest.mark.parametrize("port", [-1, 65536])
def test_port_is_in_range(tmp_path: Path, port: int) -> None:
    with pytest.raises(DeviceError, match=r"outside \[0, 65535\]"):
        make(tmp_path, port=port)


def test_unknown_host_is_told(tmp_path: Path) -> None:
    for host in ("no.such.host.invalid", "a" * 300, "192.0.2.1"):
        with pytest.raises(DeviceError):
            make(tmp_path, host=host, allow_remote=True)


@pytest.mark.parametrize("host", ["0.0.0.0", "::", "192.0.2.1"])
def test_other_machines_are_kept_out(tmp_path: Path, host: str) -> None:
    with pytest.raises(HostkitError, match="reached from other machines"):
        make(tmp_path, host=host)


def test_other_machines_can_be_let_in(tmp_path: Path) -> None:
    s = make(tmp_path, host="0.0.0.0", allow_remote=True, allowed_hosts=["bench.local"])
    try:
        url = s.start()
        assert url.startswith(f"http://bench.local:{s.port}/?token=")
        assert f"ssh -L {s.port}:127.0.0.1:{s.port}" in s.warning
        address = url.replace("bench.local", "127.0.0.1")
        for host in ("bench.local", "127.0.0.1", "192.0.2.7", "[2001:db8::7]"):
            reply = httpx.get(address, headers={"host": f"{host}:{s.port}"})
            assert reply.status_code == 303
        for host in ("evil.example", "192.0.2.7.evil.example", "2001:db8::7", "[192.0.2.7]", "[]"):
            reply = httpx.get(address, headers={"host": f"{host}:{s.port}"})
            assert reply.status_code == 421
            assert "--web-allow-host NAME adds one" in reply.json()["error"]
    finally:
        s.stop()


@pytest.mark.parametrize(
    ("address", "allowed", "expected"),
    [
        ("127.0.0.1", (), ("127.0.0.1",)),
        (
            "::1",
            ("Pi.local:80", "fe80::1", "[FE80::2]:5"),
            ("[::1]", "pi.local", "[fe80::1]", "[fe80::2]"),
        ),
        ("0.0.0.0", (), ("127.0.0.1", "localhost", "[::1]", "bench")),
        ("::", ("pi",), ("pi", "127.0.0.1", "localhost", "[::1]", "bench")),
    ],
)
def test_names(
    address: str,
    allowed: tuple[str, ...],
    expected: tuple[str, ...],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(socket, "gethostname", lambda: "Bench")
    assert binding.names(address, allowed) == expected


@pytest.mark.parametrize("name", ["", "http://bench.local/", "two names", "*.local", "[x]", "a\nb"])
def test_what_is_no_name_is_refused(name: str) -> None:
    with pytest.raises(HostkitError, match="is no host name"):
        binding.names("127.0.0.1", (name,))


def has_ipv6() -> bool:
    try:
        with socket.socket(socket.AF_INET6) as probe:
            probe.bind(("::1", 0))
    except OSError:
        return False
    return True


@pytest.mark.parametrize("host", ["127.0.0.1", "localhost", "::1", "[::1]"])
def test_loopback_by_each_name(tmp_path: Path, host: str) -> None:
    if ":" in host and not has_ipv6():
        with pytest.raises(DeviceError):
            make(tmp_path, host=host)
        return
    with running(tmp_path, host=host) as (s, client):
        assert client.get("/api/session").status_code == 200
        assert s.warning == ""
        bound = s._socket.getsockname()[0]
        assert ipaddress.ip_address(bound).is_loopback


def raw(s: Server, data: bytes) -> bytes:
    """Send bytes, and return the answer up to the end of the connection."""
    with socket.create_connection(("127.0.0.1", s.port), timeout=WAIT_S) as connection:
        connection.sendall(data)
        connection.shutdown(socket.SHUT_WR)
        answer = b""
        while received := connection.recv(65536):
            answer += received
        return answer


def served(s: Server) -> bool:
    try:
        return httpx.get(s.url).status_code == 303
    except httpx.TransportError:
        return False


def closed(connection: socket.socket) -> bool:
    """Wait for the server to close a connection without an answer."""
    with connection:
        connection.settimeout(WAIT_S)
        try:
            return connection.recv(1) == b""
        except ConnectionError:
            return True


MALFORMED = {
    "no HTTP": b"\x00\xff\x16\x03\x01 what\r\n\r\n",
    "TLS": bytes.fromhex("16030100c2010000be0303") + b"\0" * 100,
    "no version": b"GET /\r\n\r\n",
    "odd version": b"GET / HTTP/9.9\r\nHost: localhost\r\n\r\n",
    "no host": b"GET / HTTP/1.1\r\n\r\n",
    "two hosts": b"GET / HTTP/1.1\r\nHost: localhost\r\nHost: evil\r\n\r\n",
    "large header": b"GET / HTTP/1.1\r\nHost: localhost\r\nX: " + b"a" * 100_000 + b"\r\n\r\n",
    "many headers": b"GET / HTTP/1.1\r\n" + b"X: y\r\n" * 20_000 + b"\r\n",
    "long target": b"GET /" + b"a" * 100_000 + b" HTTP/1.1\r\nHost: localhost\r\n\r\n",
    "bad length": b"POST /api/port HTTP/1.1\r\nHost: localhost\r\nContent-Length: -1\r\n\r\n",
    "two lengths": b"POST / HTTP/1.1\r\nHost: a\r\nContent-Length: 1\r\nContent-Length: 2\r\n\r\nx",
    "both framings": b"POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 5\r\n"
    b"Transfer-Encoding: chunked\r\n\r\n0\r\n\r\n",
    "bad chunk": b"POST / HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\n\r\nzz\r\n",
    "folded": b"GET / HTTP/1.1\r\nHost: localhost\r\nCookie: a\r\n b\r\n\r\n",
    "absolute": b"GET http://evil.example/ HTTP/1.1\r\nHost: localhost\r\n\r\n",
    "websocket": b"GET /stream HTTP/1.1\r\nHost: localhost\r\nConnection: Upgrade\r\n"
    b"Upgrade: websocket\r\nSec-WebSocket-Key: AAAA\r\nSec-WebSocket-Version: 13\r\n\r\n",
    "percent": b"GET /recordings/%00%ff%2e%2e%2f HTTP/1.1\r\nHost: localhost\r\n\r\n",
    "connect": b"CONNECT evil.example:443 HTTP/1.1\r\nHost: localhost\r\n\r\n",
    "empty": b"",
}


def test_malformed_requests_are_refused_and_others_served(tmp_path: Path) -> None:
    with running(tmp_path) as (s, client):
        for name, data in MALFORMED.items():
            try:
                answer = raw(s, data)
            except ConnectionError:
                answer = b""
            assert not answer or answer.startswith(b"HTTP/1.1 4"), name
            assert b"Traceback" not in answer
            assert client.get("/api/session").status_code == 200


def test_half_requests_are_let_go_while_others_are_served(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(protocol, "REQUEST_S", 1.0)
    with running(tmp_path) as (s, client), Listener(client) as listener:
        slow = [socket.create_connection(("127.0.0.1", s.port)) for _ in range(30)]
        for connection in slow:
            connection.sendall(b"GET / HTTP/1.1\r\nHost: loc")
        assert httpx.get(s.url).status_code == 303
        for connection in slow:
            assert closed(connection)
        listener.wait(lambda events: bool(events))
        assert not any(event.kind == "end" for event in listener.events)
        assert s._hub._clients
        s.stop()


def test_number_of_connections_is_bounded(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(protocol, "MOST_CONNECTIONS", 5)
    monkeypatch.setattr(protocol, "REQUEST_S", 6.0 * WAIT_S)
    with running(tmp_path) as (s, _):
        opened = [socket.create_connection(("127.0.0.1", s.port)) for _ in range(5)]
        assert closed(opened[-1])
        for connection in opened:
            connection.close()
        until(lambda: served(s))


def test_a_body_that_never_comes_holds_up_nobody(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("hostkit.web.app.BODY_TIMEOUT_S", 0.2)
    with running(tmp_path) as (s, client):
        csrf = client.get("/api/session").json()["csrf"]
        cookie = f"hostkit-{s.port}={client.cookies[f'hostkit-{s.port}']}"
        head = (
            f"POST /api/verdict HTTP/1.1\r\nHost: localhost\r\nCookie: {cookie}\r\n"
            f"X-Hostkit-Token: {csrf}\r\nContent-Type: application/json\r\n"
            "Content-Length: 100\r\n\r\n{"
        )
        with socket.create_connection(("127.0.0.1", s.port), timeout=WAIT_S) as connection:
            connection.sendall(head.encode())
            assert connection.recv(100).startswith(b"HTTP/1.1 408")


PRINTING = """
import logging, pathlib, sys
import httpx
if len(sys.argv) > 3:
    logging.basicConfig(level=logging.DEBUG)
    for name in ("httpx", "httpcore"):
        logging.getLogger(name).setLevel(logging.CRITICAL)
sys.path.insert(0, sys.argv[1])
from served import running
with running(pathlib.Path(sys.argv[2])) as (server, client):
    client.get("/api/session"); client.get(server.url + "x"); client.get("/nowhere")
    secrets = (server._access.token, server._access.cookie, server._access.csrf)
print(*secrets)
"""


@pytest.mark.parametrize("logged", [False, True])
def test_no_secret_is_logged_and_nothing_printed(tmp_path: Path, logged: bool) -> None:
    folder = str(Path(__file__).parent)
    done = subprocess.run(
        [sys.executable, "-c", PRINTING, folder, str(tmp_path), *(["log"] if logged else [])],
        capture_output=True,
        text=True,
        timeout=60,
        check=True,
    )
    secrets = done.stdout.split()
    assert len(secrets) == 3
    assert not any(secret in done.stderr for secret in secrets)
    assert logged or done.stderr == ""


def test_no_thread_is_left(tmp_path: Path) -> None:
    with running(tmp_path):
        pass
    assert not any(thread.name == "hostkit-web" for thread in threading.enumerate())


def test_kernel_holds_little_for_a_page_that_does_not_read(tmp_path: Path) -> None:
    with running(tmp_path) as (s, _):
        held = s._socket.getsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF)
        # Linux doubles what was asked for.
        assert held in (binding.SEND_BUFFER_BYTES, 2 * binding.SEND_BUFFER_BYTES)
