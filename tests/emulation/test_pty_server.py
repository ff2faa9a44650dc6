import os
import select
import signal
import subprocess
import sys
import termios
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from boards import hear, stimulus

from hostkit.emulation import host_board
from hostkit.emulation.board import Receive, Send, Stop
from hostkit.emulation.pty_server import serve_pty

TIMEOUT_S = 20.0


def wait_for(condition: Callable[[], object]) -> None:
    deadline = time.monotonic() + TIMEOUT_S
    while not condition():
        assert time.monotonic() < deadline, "nothing happened"
        time.sleep(0.01)


class Ticker:
    """A device that says its tick number in a line, 200 times a second."""

    def __init__(self) -> None:
        self.tick = 0
        self.starts = 0
        self.received = b""

    def serve(self, send: Send, stop: Stop, receive: Receive) -> None:
        self.starts += 1
        while not stop():
            self.received += receive()
            send(b"%d\n" % self.tick)
            self.tick += 1
            time.sleep(0.005)


class Server:
    """serve_pty in a thread."""

    def __init__(self, serve: Callable[[Send, Stop, Receive], None]) -> None:
        self.paths: list[str] = []
        self.error: BaseException | None = None
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._run, args=(serve,), daemon=True)
        self._thread.start()
        wait_for(lambda: self.paths)

    def _run(self, serve: Callable[[Send, Stop, Receive], None]) -> None:
        try:
            serve_pty(serve, self.paths.append, self._stop.is_set)
        except BaseException as error:
            self.error = error

    @property
    def path(self) -> str:
        return self.paths[0]

    def close(self) -> None:
        self._stop.set()
        self._thread.join(TIMEOUT_S)
        assert not self._thread.is_alive()


class Reader:
    def __init__(self, path: str) -> None:
        self.fd = os.open(path, os.O_RDWR | os.O_NOCTTY)

    def read(self, enough: int) -> bytes:
        data = b""
        while len(data) < enough:
            assert select.select([self.fd], [], [], TIMEOUT_S)[0], "no data"
            data += os.read(self.fd, 4096)
        return data

    def close(self) -> None:
        os.close(self.fd)


@pytest.fixture
def ticker() -> Ticker:
    return Ticker()


@pytest.fixture
def server(ticker: Ticker) -> Iterator[Server]:
    server = Server(ticker.serve)
    yield server
    server.close()
    assert server.error is None


def test_device_starts_when_a_reader_opens_the_port(server: Server, ticker: Ticker) -> None:
    time.sleep(0.3)
    assert ticker.starts == 0
    reader = Reader(server.path)
    assert reader.read(8).startswith(b"0\n1\n2\n3\n")
    reader.close()
    assert ticker.starts == 1


def test_port_is_raw_for_every_reader(server: Server) -> None:
    for _ in range(2):
        reader = Reader(server.path)
        reader.read(1)
        mode = termios.tcgetattr(reader.fd)
        iflag, oflag, _, lflag, *_ = mode
        assert not lflag & (termios.ECHO | termios.ICANON | termios.ISIG)
        assert not oflag & termios.OPOST
        assert not iflag & (termios.ICRNL | termios.IXON)
        mode[3] |= termios.ECHO | termios.ICANON
        termios.tcsetattr(reader.fd, termios.TCSANOW, mode)
        reader.close()
        time.sleep(0.2)


def test_a_later_reader_sees_nothing_stale(server: Server, ticker: Ticker) -> None:
    first = Reader(server.path)
    first.read(4)
    time.sleep(0.2)  # leave something unread behind
    first.close()
    closed_at = ticker.tick
    wait_for(lambda: ticker.tick > closed_at + 60)
    opened_at = ticker.tick
    second = Reader(server.path)
    lines = second.read(40).split(b"\n")
    second.close()
    assert int(lines[1]) >= opened_at - 2
    assert ticker.starts == 1, "the device runs on"


def test_a_reader_may_come_back_often(server: Server) -> None:
    for _ in range(10):
        reader = Reader(server.path)
        assert reader.read(6)
        reader.close()
        time.sleep(0.02)


def test_a_reader_that_does_not_read_does_not_stop_the_device() -> None:
    told = [0]

    def serve(send: Send, stop: Stop, _receive: Receive) -> None:
        while not stop() and told[0] < 100:
            send(b"x" * 4096)
            told[0] += 1

    server = Server(serve)
    reader = Reader(server.path)
    began = time.monotonic()
    wait_for(lambda: told[0] > 10)
    assert time.monotonic() - began < 10.0
    reader.close()
    server.close()


def test_what_a_reader_sends_reaches_the_device(server: Server, ticker: Ticker) -> None:
    reader = Reader(server.path)
    for _ in range(50):
        os.write(reader.fd, b"y" * 1000)
        reader.read(1)
    assert b"y" not in reader.read(200)
    wait_for(lambda: ticker.received == b"y" * 50_000)
    reader.close()


def test_an_error_of_the_device_gets_out() -> None:
    def serve(_send: Send, _stop: Stop, _receive: Receive) -> None:
        raise RuntimeError("broken")

    server = Server(serve)
    reader = Reader(server.path)
    wait_for(lambda: server.error)
    assert str(server.error) == "broken"
    reader.close()


def test_firmware_over_a_pseudo_terminal(host_folder: Path) -> None:
    server = Server(lambda send, stop, _: host_board.serve(host_folder, stimulus(50), send, stop))
    reader = Reader(server.path)
    heard = hear(reader.read(8000))
    reader.close()
    server.close()
    assert server.error is None
    samples = heard.samples
    assert len(samples) > 80
    assert [s.sequence for s in samples] == list(range(len(samples)))
    assert heard.decoder.bad == 0


PROGRAM = """
import sys
from pathlib import Path
sys.path[:0] = sys.argv[2:]
from boards import stimulus
from hostkit.emulation import host_board
from hostkit.emulation.pty_server import serve_pty
folder = Path(sys.argv[1])
serve_pty(lambda send, stop, _: host_board.serve(folder, stimulus(50), send, stop),
          lambda path: print(path, flush=True))
print("ended", flush=True)
"""


def children_of(pid: int) -> list[str]:
    return Path(f"/proc/{pid}/task/{pid}/children").read_text(encoding="ascii").split()


@pytest.mark.skipif(not Path("/proc/self/task").is_dir(), reason="needs /proc")
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGKILL])
@pytest.mark.parametrize("attached", [True, False])
def test_ends_on_a_signal_and_leaves_no_child(
    host_folder: Path, number: signal.Signals, attached: bool
) -> None:
    paths = [str(Path(__file__).parents[1]), str(Path(__file__).parents[2])]
    server = subprocess.Popen(
        [sys.executable, "-c", PROGRAM, str(host_folder), *paths],
        stdout=subprocess.PIPE,
        text=True,
    )
    assert server.stdout is not None
    path = server.stdout.readline().strip()
    reader = Reader(path) if attached else None
    if reader is not None:
        reader.read(500)
    children = children_of(server.pid)
    assert len(children) == int(attached)
    server.send_signal(number)
    said, _ = server.communicate(timeout=TIMEOUT_S)
    if number != signal.SIGKILL:
        assert server.returncode == 0
        assert said == "ended\n"
    for child in children:
        wait_for(lambda child=child: not Path(f"/proc/{child}/exe").exists())
    if reader is not None:
        reader.close()
