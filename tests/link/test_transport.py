"""Real pseudo-terminals and sockets behind a link."""

import os
import socket
import termios
import threading
import time
from pathlib import Path
from types import SimpleNamespace

import pytest
import serial
import serial.rfc2217
from designs import design
from device import Device
from fake_ports import Cable, read_until, wait_until

from hostkit.errors import DeviceError
from hostkit.link.ports import transport
from hostkit.link.ports.baud_scan import BaudScan
from hostkit.link.ports.serial_port import SerialTransport, explain
from hostkit.link.ports.sockets import SocketTransport, connect, listen
from hostkit.link.ports.transport import open_link, open_transport


def free_port(kind: int = socket.SOCK_STREAM, host: str = "127.0.0.1") -> int:
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    with socket.socket(family, kind) as probe:
        probe.bind((host, 0))
        return int(probe.getsockname()[1])


@pytest.fixture
def cable(tmp_path: Path):
    cable = Cable(tmp_path)
    yield cable
    cable.close()


def test_unplugged_and_plugged_in_again_under_the_same_name(cable: Cable) -> None:
    link = open_link(str(cable.path), 500_000)
    cable.send(b"before")
    assert read_until(link, lambda got: len(got) >= 6) == b"before"
    for epoch in (1, 2):
        cable.unplug()
        wait_until(lambda: link.state == "lost")
        assert link.read(0.0) == b""
        link.write(b"nobody hears this")
        cable.plug()
        wait_until(lambda: link.state == "connected")
        cable.send(b"after")
        assert read_until(link, lambda got: len(got) >= 5) == b"after"
        assert link.epoch == epoch
        link.write(b"hello")
        heard = bytearray()
        wait_until(lambda heard=heard: heard.extend(cable.received()) or heard == b"hello")
    link.close()


def test_link_that_points_nowhere_is_waited_for(cable: Cable) -> None:
    link = open_link(str(cable.path), 500_000)
    cable.unplug(keep_name=True)
    wait_until(lambda: "does not exist" in link.reason)
    cable.plug()
    wait_until(lambda: link.state == "connected")
    link.close()


def test_without_reconnection_an_unplugged_port_ends(cable: Cable) -> None:
    link = open_link(str(cable.path), 500_000, reconnect=False)
    cable.send(b"last")
    assert read_until(link, lambda got: len(got) >= 4) == b"last"
    cable.unplug(keep_name=True)
    wait_until(lambda: link.read(0.05) is None)
    assert link.state in ("lost", "ended")
    link.close()
    cable.plug()


def test_second_opening_is_refused_and_possible_after_release(cable: Cable) -> None:
    link = open_link(str(cable.path), 500_000)
    for open_again in (open_transport, open_link):
        with pytest.raises(DeviceError, match=rf"in use by .+ \({os.getpid()}\)"):
            open_again(cable.real, 500_000)
    link.release()
    other = open_transport(cable.real, 500_000)
    link.take()
    assert link.state == "lost"
    wait_until(lambda: "in use" in link.reason)
    other.close()
    wait_until(lambda: link.state == "connected")
    link.close()


def test_first_opening_of_what_is_not_there_is_an_error(tmp_path: Path) -> None:
    (tmp_path / "loop").symlink_to(tmp_path / "loop")
    names = (str(tmp_path / "ttyNONE"), str(tmp_path / "loop"), "/dev/\0", "auto\0")
    addresses = ("127.0.0.1:1", "256.0.0.1:1", "x", "a..b:1", f"{'x' * 99}:1", "h:٣", "h:0", ":1")
    for port in (*names, *(f"tcp:{a}" for a in addresses), *(f"udp:{a}" for a in addresses[1:])):
        with pytest.raises(DeviceError):
            open_link(port, 500_000)


@pytest.mark.parametrize(
    ("error", "says"),
    [
        (PermissionError(13, "denied"), "usermod"),
        (FileNotFoundError(2, "none"), "hostkit ports"),
        (OSError(16, "busy"), "in use"),
        (ValueError("odd"), "cannot be opened: odd"),
    ],
)
def test_every_reason_is_said_with_its_remedy(error: Exception, says: str) -> None:
    assert says in explain("/dev/ttyX", error)


def test_what_is_no_terminal_is_one_clear_error(tmp_path: Path) -> None:
    path = tmp_path / "file"
    path.write_bytes(b"x")
    for port in (str(path), str(tmp_path), "/dev/null", "odd://x", ""):
        with pytest.raises(DeviceError, match=r"cannot be opened|does not exist"):
            open_transport(port, 500_000)


def test_other_urls_of_pyserial_are_refused(tmp_path: Path) -> None:
    for url in (f"spy:///dev/null?file={tmp_path}/x", "loop://", "hwgrep://uno"):
        with pytest.raises(DeviceError, match="hostkit takes socket and rfc2217"):
            open_transport(url, 500_000)
    assert not list(tmp_path.iterdir())


def test_port_that_hangs_up_while_it_is_opened_is_an_error(cable: Cable, monkeypatch) -> None:
    def hang_up(*_: object) -> None:
        raise termios.error(5, "Input/output error")

    monkeypatch.setattr(termios, "tcflush", hang_up)
    with pytest.raises(DeviceError, match="Input/output error"):
        open_transport(str(cable.path), 500_000)


def test_rate_of_an_open_port_can_be_changed(cable: Cable) -> None:
    port = SerialTransport(str(cable.path), 115_200)
    cable.send(b"at the old rate")
    wait_until(lambda: port._port.in_waiting == 15)
    assert port.set_baud(57_600)
    assert port.baud == 57_600
    cable.send(b"new")
    assert read_until(port, lambda got: len(got) >= 3) == b"new"
    cable.unplug(keep_name=True)
    assert not port.set_baud(115_200)
    port.close()
    cable.plug()


def test_flood_that_nobody_reads_stalls_nothing_and_is_counted(cable: Cable) -> None:
    link = open_link(str(cable.path), 500_000)
    link._limit = 100_000
    for _ in range(30):
        cable.send(bytes(10_000))
    wait_until(lambda: link.overrun_bytes == 200_000)
    assert link.read(0.0) == bytes(100_000)
    link.close()


def test_closing_is_quick_whatever_the_port_does(cable: Cable) -> None:
    before = set(threading.enumerate())
    with socket.create_server(("127.0.0.1", 0)) as server:
        silent = f"tcp:127.0.0.1:{server.getsockname()[1]}"
        ports = (str(cable.path), silent, f"udp:127.0.0.1:{free_port(socket.SOCK_DGRAM)}")
        for name in ports:
            link = open_link(name, 500_000)
            before_s = time.monotonic()
            link.close()
            assert time.monotonic() - before_s < 1.0
            assert link.read(0.1) is None
    assert set(threading.enumerate()) <= before


def test_tcp_server_that_goes_away_and_returns() -> None:
    number = free_port()
    with socket.create_server(("127.0.0.1", number)) as server:
        link = open_link(f"tcp:127.0.0.1:{number}", 0)
        peer, _ = server.accept()
        peer.sendall(b"before")
        assert read_until(link, lambda got: len(got) >= 6) == b"before"
    peer.close()
    wait_until(lambda: link.state == "lost")
    wait_until(lambda: "cannot be reached" in link.reason)
    with socket.create_server(("127.0.0.1", number)) as server:
        peer, _ = server.accept()
        with peer:
            peer.sendall(b"after")
            assert read_until(link, lambda got: len(got) >= 5) == b"after"
            assert link.epoch == 1
            link.write(b"hello")
            assert peer.recv(5) == b"hello"
    link.close()


def test_tcp_peer_that_takes_nothing_does_not_hold_a_writer() -> None:
    ours, theirs = socket.socketpair()
    port = SocketTransport(ours)
    before_s = time.monotonic()
    port.write(bytes(10_000_000))
    assert time.monotonic() - before_s < 1.0
    port.close()
    theirs.close()


@pytest.mark.parametrize("host", ["127.0.0.1", "::1"])
def test_udp_of_two_peers_and_the_answer_to_the_last(host: str) -> None:
    number = free_port(socket.SOCK_DGRAM, host)
    name = f"[{host}]" if ":" in host else host
    link = open_link(f"udp:{name}:{number}", 0)
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    with (
        socket.socket(family, socket.SOCK_DGRAM) as a,
        socket.socket(family, socket.SOCK_DGRAM) as b,
    ):
        link.write(b"to nobody yet")
        for _ in range(50):
            a.sendto(b"a", (host, number))
            b.sendto(b"b", (host, number))
        got = read_until(link, lambda got: len(got) >= 100)
        assert (got.count(b"a"), got.count(b"b")) == (50, 50)
        b.settimeout(10)
        link.write(b"hello")
        assert b.recv(100) == b"hello"
        a.close()
        a2 = socket.socket(family, socket.SOCK_DGRAM)
        a2.sendto(b"c", (host, number))
        assert read_until(link, lambda got: len(got) >= 1) == b"c"
        a2.close()
        link.write(b"meets nobody")
        b.sendto(b"d", (host, number))
        assert read_until(link, lambda got: len(got) >= 1) == b"d"
        assert (link.state, link.epoch) == ("connected", 0)
    link.close()


def test_udp_read_takes_all_datagrams_that_wait() -> None:
    number = free_port(socket.SOCK_DGRAM)
    port = listen(f"127.0.0.1:{number}")
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
        for k in range(100):
            sender.sendto(bytes([k]), ("127.0.0.1", number))
        sender.sendto(b"", ("127.0.0.1", number))
    assert port.read(5.0) == bytes(range(100))
    port.close()
    port.write(b"x")
    assert port.read(0.0) is None


def test_udp_answer_that_met_nobody_is_no_loss() -> None:
    class Windows(socket.socket):
        """There an unreachable peer shows as a reset at the next read."""

        resets = 1

        def recvfrom(self, size: int):
            if self.resets:
                self.resets -= 1
                raise ConnectionResetError("10054")
            return super().recvfrom(size)

    with Windows(socket.AF_INET, socket.SOCK_DGRAM) as ours:
        ours.bind(("127.0.0.1", 0))
        port = SocketTransport(ours)
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
            sender.sendto(b"still here", ours.getsockname())
        assert port.read(5.0) == b""
        assert (port.read(5.0), port.state) == (b"still here", "connected")


def test_tcp_over_ip_6() -> None:
    with socket.create_server(("::1", 0), family=socket.AF_INET6) as server:
        port = connect(f"[::1]:{server.getsockname()[1]}")
        peer, _ = server.accept()
        peer.sendall(b"six")
        assert read_until(port, lambda got: len(got) >= 3) == b"six"
        peer.close()
        wait_until(lambda: port.read(0.05) is None)
        port.close()


def test_socket_url_of_pyserial() -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:
        link = open_link(f"socket://127.0.0.1:{server.getsockname()[1]}", 500_000)
        peer, _ = server.accept()
        with peer:
            peer.sendall(b"x" * 10_000)
            assert read_until(link, lambda got: len(got) >= 10_000) == b"x" * 10_000
            link.write(b"hello")
            assert peer.recv(5) == b"hello"
        wait_until(lambda: link.state == "lost")
    link.close()


def test_no_descriptor_is_left_open(cable: Cable) -> None:
    before = len(os.listdir("/proc/self/fd"))  # noqa: PTH208
    for _ in range(5):
        open_link(str(cable.path), 500_000).close()
        with pytest.raises(DeviceError):
            open_link("/dev/null", 500_000)
    assert len(os.listdir("/proc/self/fd")) == before  # noqa: PTH208


def test_rate_that_is_not_given_is_found_out(cable: Cable, monkeypatch) -> None:
    stop = threading.Event()
    frames = b"".join(Device(design()).frames(5))

    def device() -> None:
        while not stop.is_set():
            cable.send(frames)
            stop.wait(0.01)

    thread = threading.Thread(target=device)
    thread.start()
    link = open_link(str(cable.path), None)
    assert read_until(link, lambda got: len(got) > len(frames))
    stop.set()
    thread.join(30)
    link.close()


def test_port_whose_rate_is_not_found_is_closed(cable: Cable, monkeypatch) -> None:
    text = BaudScan(finding="text", baud=9600, sample="hello")
    monkeypatch.setattr(transport, "scan_baud", lambda port, clock: text)
    with pytest.raises(DeviceError, match="gives text at 9600 bit/s, such as 'hello'") as caught:
        open_link(str(cable.path), None)
    open_transport(str(cable.path), 500_000).close()
    assert caught.tb  # keeps what was opened from being collected, and closed so


def serve_rfc2217(
    listener: socket.socket, echo: serial.SerialBase, stop: threading.Event | None = None
) -> None:
    """Serve a loop-back port over the network, as a terminal server does."""
    peer, _ = listener.accept()
    with peer:
        peer.settimeout(0.02)
        manager = serial.rfc2217.PortManager(echo, SimpleNamespace(write=peer.sendall))
        while stop is None or not stop.is_set():
            try:
                got = peer.recv(4096)
            except TimeoutError:
                continue
            except OSError:
                return
            if not got:
                return
            echo.write(b"".join(manager.filter(got)))
            peer.sendall(b"".join(manager.escape(echo.read(echo.in_waiting))))


def test_port_of_a_terminal_server() -> None:
    echo = serial.serial_for_url("loop://", timeout=0)
    with socket.create_server(("127.0.0.1", 0)) as listener:
        server = threading.Thread(target=serve_rfc2217, args=(listener, echo))
        server.start()
        url = f"rfc2217://127.0.0.1:{listener.getsockname()[1]}"
        port = SerialTransport(url, 115_200)
        assert echo.baudrate == 115_200
        assert port.set_baud(500_000)
        assert echo.baudrate == 500_000
        port.write(b"\xff there and back")
        assert read_until(port, lambda got: len(got) >= 16) == b"\xff there and back"
        port.close()
        server.join(30)
        assert not server.is_alive()


def test_terminal_server_that_goes_away_is_a_loss() -> None:
    echo = serial.serial_for_url("loop://", timeout=0)
    with socket.create_server(("127.0.0.1", 0)) as listener:
        stop = threading.Event()
        server = threading.Thread(target=serve_rfc2217, args=(listener, echo, stop))
        server.start()
        port = SerialTransport(f"rfc2217://127.0.0.1:{listener.getsockname()[1]}", 115_200)
        stop.set()
        server.join(30)
        wait_until(lambda: port.read(0.05) is None)
        assert (port.state, port.read(0.0)) == ("lost", None)
        assert not port.set_baud(9600)
        port.write(b"nobody hears this")
        port.close()
