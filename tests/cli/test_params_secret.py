"""``hostkit params secret`` with the real firmware at a real pty, and with a device in Python."""

import json
import logging
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from answering import AnsweringDevice, ManualClock
from boards import require_or_skip
from live import program, write_inputs

from hostkit.cli.main import run
from hostkit.errors import DeviceError
from hostkit.link.frames.signing import SigningKey, sign_with

Run = Callable[..., tuple[str, str]]


@pytest.fixture
def said(capfd, caplog: pytest.LogCaptureFixture) -> Iterator[Run]:
    """Run a command; whatever was said and logged then holds no secret of a file here."""
    caplog.set_level(logging.DEBUG)
    everything = []

    def command(*words: str, code: int = 0) -> tuple[str, str]:
        assert run(list(words)) == code
        out, err = capfd.readouterr()
        everything.extend((out, err))
        return out, err

    yield command
    text = "".join([*everything, caplog.text]).lower()
    for file in Path().glob("*.key"):
        secret = file.read_bytes() or b"nothing"
        shown = (secret.hex(), repr(secret)[2:22].lower(), str(list(secret))[1:30], str(secret[:9]))
        assert not [form for form in shown if form in text]


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def secret_file(name: str) -> str:
    """Make a key of random bytes."""
    SigningKey.create(Path(name))
    return name


def test_a_secret_is_given_changed_and_taken_away(folder: Path, said: Run) -> None:
    require_or_skip("gcc", "make")
    write_inputs(folder)
    emulate = ["emulate", "design.json", "--pty", "--target", "host", "--signing"]
    with program(folder, *emulate, "--recording", "sweep.csv") as board:
        port = ["--port", board.see(r"/dev/\S+")]
        go_through(port, said)


def go_through(port: list[str], said: Run) -> None:
    out, err = said("params", "secret", "a.key", "--new", *port)
    assert (out, err) == ("device 1/1 signs now with the secret in a.key\n", "")
    file = Path("a.key")
    assert (file.stat().st_mode & 0o777, len(file.read_bytes())) == (0o600, 32)
    out, _ = said("params", "secret", "a.key", *port)
    assert "signs already" in out
    judged("pass", said, port, "--signing-key", "a.key")
    judged("pass", said, port)
    out, _ = said("params", "set", "FILT_TAU=1.5", "--signing-key", "a.key", *port, "--json")
    assert json.loads(out)["results"][0]["error"] is None
    untold = judged("fail", said, port)["untold"]
    assert "FILT_TAU" in untold, "it does not answer without a key"
    secret_file("b.key")
    for words in (["b.key"], ["b.key", "--remove"]):
        _, err = said("params", "secret", *words, *port, code=4)
        assert "has another secret; only whoever has that" in err
    out, _ = said("params", "secret", "b.key", "--signing-key", "a.key", *port, "--json")
    told = json.loads(out)
    assert (told["action"], told["signed"], told["changed"]) == ("secret", True, True)
    out, err = said("params", "secret", "b.key", "--remove", *port)
    assert (out, err) == ("device 1/1 has no secret any more; it hears anybody\n", "")
    out, _ = said("params", "secret", "b.key", "--remove", *port, "--json")
    told = json.loads(out)
    assert (told["signed"], told["changed"]) == (False, False)
    said("params", "get", *port)


def judged(verdict: str, said: Run, port: list[str], *words: str) -> dict:
    monitor = ["monitor", "design.json", *port, "--duration", "0.5", "--json", *words]
    out, _ = said(*monitor, code=0 if verdict == "pass" else 3)
    told = json.loads(out)
    assert told["verdict"] == verdict
    assert told["link"]["bad_signatures"] == 0
    return told


@pytest.fixture
def device(monkeypatch: pytest.MonkeyPatch, folder: Path) -> AnsweringDevice:
    """A device that knows no signatures, behind every port."""
    found = AnsweringDevice(ManualClock())
    found.opened = 0

    def open_link(port: str, baud: int | None, *, reconnect: bool) -> AnsweringDevice:
        found.opened += 1
        return found

    monkeypatch.setattr("hostkit.cli.link_options.open_link", open_link)
    monkeypatch.setattr("hostkit.link.device.device_link.SystemClock", lambda: found.clock)
    return found


def test_firmware_without_signatures_is_told_of(device: AnsweringDevice, said: Run) -> None:
    _, err = said("params", "secret", "a.key", "--new", code=4)
    assert "sent a secret 3 times and does not sign with it" in err
    assert device.asked == ["SETUP_SIGNING"] * 3
    out, _ = said("params", "secret", "a.key", "--remove")
    assert out == "device 1/1 has no secret anyway; it hears anybody\n"
    assert device.asked == ["SETUP_SIGNING"] * 3


def test_a_device_that_keeps_its_secret_is_told_of(device: AnsweringDevice, said: Run) -> None:
    sign_with(device.sender._mav, SigningKey.read(Path(secret_file("a.key"))))
    _, err = said("params", "secret", "a.key", "--remove", code=4)
    assert "told 3 times to forget its secret and signs on" in err


def test_no_key_file_is_written_over_or_made_in_vain(device: AnsweringDevice, said: Run) -> None:
    Path("mine.key").write_bytes(b"x" * 32)
    _, err = said("params", "secret", "mine.key", "--new", code=1)
    assert "mine.key is there already and is not written over" in err
    with pytest.raises(DeviceError, match="is there already"):
        SigningKey.create(Path("mine.key"))
    assert Path("mine.key").read_bytes() == b"x" * 32
    _, err = said("params", "secret", "none.key", code=1)
    assert "none.key is not there; --new makes it" in err
    said("params", "secret", "a.key", "--new", "--remove", code=2)
    assert device.opened == 0
    device.silent = True
    said("params", "secret", "a.key", "--new", code=4)
    assert not Path("a.key").exists(), "there was nobody to give it to"


@pytest.mark.parametrize(
    ("content", "mode", "says"),
    [
        (bytes(32), 0o600, "32 zeros are no signing key"),
        (b"k" * 32, 0o644, "may be read or written by others"),
        (b"", 0o600, "neither 32 bytes nor"),
    ],
)
def test_a_bad_key_is_refused_before_the_port_is_opened(
    device: AnsweringDevice, said: Run, content: bytes, mode: int, says: str
) -> None:
    file = Path("bad.key")
    file.write_bytes(content)
    file.chmod(mode)
    _, err = said("params", "secret", "bad.key", code=4)
    assert says in err
    assert device.opened == 0
