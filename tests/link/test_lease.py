"""Lending a port from one process to another."""

import contextlib
import os
import socket
import stat
import subprocess
import sys
import tempfile
from pathlib import Path

import pytest
from fake_ports import Cable, read_until, wait_until

from hostkit.errors import DeviceError
from hostkit.link.ports import lease
from hostkit.link.ports.lease import borrow_port, lease_folder, offer_port, socket_path
from hostkit.link.ports.transport import open_link, open_transport

BORROWER = """
import sys
from hostkit.link.ports.lease import borrow_port
from hostkit.link.ports.transport import open_transport

with borrow_port(sys.argv[1]) as borrowed:
    port = open_transport(sys.argv[1], 500000)
    port.write(b"flashing")
    print("has it" if borrowed else "was free", flush=True)
    sys.stdin.readline()
    port.close()
"""


@pytest.fixture(autouse=True)
def runtime(monkeypatch: pytest.MonkeyPatch):
    """A folder with a short name: that of a socket is limited."""
    with tempfile.TemporaryDirectory(prefix="hk") as folder:
        monkeypatch.setenv("XDG_RUNTIME_DIR", folder)
        yield Path(folder)


@pytest.fixture
def cable(tmp_path: Path):
    cable = Cable(tmp_path)
    yield cable
    cable.close()


class Holder:
    """A port that only notes what is asked of it."""

    def __init__(self, state: str = "connected", refuses: bool = False) -> None:
        self.state = state
        self.refuses = refuses
        self.asked: list[str] = []

    def release(self) -> None:
        if self.refuses:
            raise DeviceError("no")
        self.asked.append("release")
        self.state = "released"

    def take(self) -> None:
        self.asked.append("take")
        self.state = "connected"


def start_borrower(port: Path) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [sys.executable, "-c", BORROWER, str(port)],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)},
    )


@pytest.mark.parametrize("killed", [False, True])
def test_second_process_has_the_port_while_the_first_runs_on(cable: Cable, killed: bool) -> None:
    link = open_link(str(cable.path), 500_000)
    other = start_borrower(cable.path)
    assert other.stdout is not None
    assert other.stdin is not None
    assert other.stdout.readline() == "has it\n"
    assert link.state == "released"
    assert link.read(0.0) == b""
    heard = bytearray()
    wait_until(lambda: heard.extend(cable.received()) or heard == b"flashing")
    if killed:
        other.kill()
    else:
        other.stdin.write("\n")
        other.stdin.flush()
    other.wait(20)
    other.stdin.close()
    other.stdout.close()
    wait_until(lambda: link.state == "connected")
    cable.send(b"after")
    assert read_until(link, lambda got: len(got) >= 5) == b"after"
    assert link.epoch == 1
    link.close()


def test_port_without_a_holder_is_free(cable: Cable) -> None:
    with borrow_port(str(cable.path)) as borrowed:
        assert not borrowed


def test_holder_that_closed_leaves_nothing(cable: Cable, runtime: Path) -> None:
    link = open_link(str(cable.path), 500_000)
    assert len(list(runtime.glob("hostkit/*.sock"))) == 1
    link.close()
    assert not list(runtime.glob("hostkit/*"))


def test_holder_that_was_killed_is_none(cable: Cable) -> None:
    path = socket_path(str(cable.path))
    assert path is not None
    with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as left_behind:
        left_behind.bind(str(path))
    assert path.exists()
    with borrow_port(str(cable.path)) as borrowed:
        assert not borrowed
    link = open_link(str(cable.path), 500_000)
    with borrow_port(str(cable.real)) as borrowed:
        assert borrowed
        open_transport(cable.real, 500_000).close()
    link.close()


def test_two_borrowers_have_it_one_after_the_other() -> None:
    holder = Holder()
    close = offer_port(holder, lambda: "/dev/ttyX")
    for _ in range(2):
        with borrow_port("/dev/ttyX") as borrowed:
            assert borrowed
            assert holder.state == "released"
        wait_until(lambda: holder.state == "connected")
    close()
    assert holder.asked == ["release", "take"] * 2


def test_port_that_its_user_had_released_stays_so() -> None:
    holder = Holder()
    close = offer_port(holder, lambda: "/dev/ttyX")
    holder.release()
    for _ in range(2):
        with borrow_port("/dev/ttyX") as borrowed:
            assert borrowed
    close()
    assert holder.asked == ["release"] * 3


def test_holder_that_cannot_let_go_says_so() -> None:
    close = offer_port(Holder(refuses=True), lambda: "/dev/ttyX")
    with pytest.raises(DeviceError, match="does not let go"), borrow_port("/dev/ttyX"):
        pass
    close()


def test_holder_that_does_not_answer_is_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(lease, "ANSWER_S", 0.2)
    path = socket_path("/dev/ttyX")
    with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as mute:
        mute.bind(str(path))
        mute.listen()
        with pytest.raises(DeviceError, match="does not answer"), borrow_port("/dev/ttyX"):
            pass


@pytest.mark.parametrize("said", [b"", b"x", b"release", b"RELEASE\n", bytes(5000)])
def test_who_asks_for_nothing_gets_nothing(said: bytes) -> None:
    holder = Holder()
    close = offer_port(holder, lambda: "/dev/ttyX")
    with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as odd:
        odd.settimeout(20)
        odd.connect(str(socket_path("/dev/ttyX")))
        odd.sendall(said)
        odd.shutdown(socket.SHUT_WR)
        with contextlib.suppress(ConnectionError):
            assert odd.recv(100) == b""
    assert holder.asked == []
    with borrow_port("/dev/ttyX") as borrowed:
        assert borrowed
    close()


def test_offer_follows_a_port_that_has_another_name_now() -> None:
    holder, names = Holder(), ["/dev/ttyX"]
    close = offer_port(holder, lambda: names[0])
    names[0] = "/dev/ttyY"

    def lent() -> bool:
        with borrow_port("/dev/ttyY") as borrowed:
            return borrowed

    wait_until(lent)
    with borrow_port("/dev/ttyX") as borrowed:
        assert not borrowed
    close()


def test_second_holder_does_not_push_the_first_aside() -> None:
    first, second = Holder(), Holder()
    close_first = offer_port(first, lambda: "/dev/ttyX")
    close_second = offer_port(second, lambda: "/dev/ttyX")
    with borrow_port("/dev/ttyX") as borrowed:
        assert borrowed
    assert (first.asked[0], second.asked) == ("release", [])
    close_second()
    with borrow_port("/dev/ttyX") as borrowed:
        assert borrowed
    close_first()


def test_folder_is_for_its_user_alone(tmp_path: Path, runtime: Path) -> None:
    folder = lease_folder()
    assert folder == runtime / "hostkit"
    assert stat.S_IMODE(folder.stat().st_mode) == 0o700
    folder.chmod(0o755)
    assert lease_folder() is None
    with borrow_port("/dev/ttyX") as borrowed:
        assert not borrowed
    offer_port(Holder(), lambda: "/dev/ttyX")()
    folder.rmdir()
    (tmp_path / "elsewhere").mkdir(mode=0o700)
    folder.symlink_to(tmp_path / "elsewhere")
    assert lease_folder() is None


def test_folder_without_a_runtime_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(lease.tempfile, "gettempdir", lambda: str(tmp_path))
    too_long = tmp_path / ("x" * 80)
    too_long.mkdir()
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(too_long))
    assert lease_folder() == tmp_path / f"hostkit-{os.getuid()}"
    monkeypatch.delenv("XDG_RUNTIME_DIR")
    assert lease_folder() == tmp_path / f"hostkit-{os.getuid()}"
