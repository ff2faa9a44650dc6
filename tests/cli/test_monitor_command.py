"""The commands `monitor` and `record`: files, live ports, signals and exit codes."""

import contextlib
import json
import os
import signal
import subprocess
import sys
import threading
import time
import tty
import urllib.parse
import urllib.request
from collections.abc import Iterator
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from designs import design
from device import Device

from hostkit.cli.main import run
from hostkit.design_file import save_design
from hostkit.link.logs.tlog import STAMP, read_tlog, stamped_frames
from hostkit.recordings import load

D = design()
FRAMES = Device(D).frames(400)
PATIENCE_S = 60.0


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    save_design(D, tmp_path / "design.json")
    stamped = (STAMP.pack(10**15 + k * 10_000) + frame for k, frame in enumerate(FRAMES))
    (tmp_path / "a.tlog").write_bytes(b"".join(stamped))
    return tmp_path


def document(capsys: pytest.CaptureFixture[str], *arguments: str) -> tuple[int, dict, str]:
    code = run([*arguments, "--json"])
    out, err = capsys.readouterr()
    return code, json.loads(out), err


def test_a_file_is_judged_recorded_and_reported(folder: Path, capsys) -> None:
    arguments = ["monitor", "design.json", "--port", "file:a.tlog", "--record", "b.tlog"]
    arguments += ["--record", "b.csv", "--record", "b.npz", "--report", "r.html"]
    code, found, err = document(capsys, *arguments, "--junit", "r.xml")
    assert (code, found["verdict"], found["samples"]) == (0, "pass", 400)
    assert "report: r.html" in err
    assert list(read_tlog(folder / "b.tlog")) == FRAMES
    csv, npz = load(folder / "b.csv"), load(folder / "b.npz")
    np.testing.assert_array_equal(csv.specific_force_m_s2, npz.specific_force_m_s2)
    assert len(csv) == len(npz) == 400
    assert "pass" in (folder / "r.html").read_text()
    suite = ElementTree.parse(folder / "r.xml").getroot().find("testsuite")
    assert suite is not None
    assert suite.get("failures") == "0"


def test_limits_of_the_command_line_count(folder: Path, capsys) -> None:
    arguments = ["monitor", "design.json", "--port", "file:a.tlog"]
    code, found, err = document(capsys, *arguments, "--max-abs-deg", "1e-9")
    assert (code, found["verdict"]) == (3, "fail")
    assert "verdict fail" in err


def test_a_replay_from_the_middle_at_speed(folder: Path, capsys) -> None:
    begun_s = time.monotonic()
    arguments = ["monitor", "design.json", "--port", "file:a.tlog", "--seek", "3.0"]
    code, found, _ = document(capsys, *arguments, "--speed", "2")
    assert (code, found["samples"]) == (0, 101)
    assert time.monotonic() - begun_s > 0.45


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["--port", "tcp:x:1", "--speed", "2"], "--speed and --seek are for files"),
        (["--port", "file:a.tlog", "--no-browser"], "need --web"),
        (["--port", "file:a.tlog", "--web-allow-host", "pi.local"], "need --web"),
        (["--port", "file:a.tlog", "--baud", "12"], "neither auto nor a number"),
        (["--port", "file:a.tlog", "--max-rms-deg", "nan"], "finite"),
    ],
)
def test_options_that_mean_nothing_are_refused(folder, capsys, arguments, says) -> None:
    assert run(["monitor", "design.json", *arguments]) == 2
    assert says in capsys.readouterr().err


def test_a_recording_that_cannot_be_written_is_said_at_once(folder: Path, capsys) -> None:
    assert run(["monitor", "design.json", "--port", "file:a.tlog", "--record", "no/x.tlog"]) == 1
    assert "no/x.tlog.part cannot be written" in capsys.readouterr().err
    assert run(["record", "--port", "file:a.tlog", "-o", "b.csv"]) == 1
    assert "needs a design" in capsys.readouterr().err


def test_a_tlog_becomes_a_recording(folder: Path, capsys) -> None:
    arguments = ["record", "--port", "file:a.tlog", "-o", "c.csv", "--design", "design.json"]
    code, found, _ = document(capsys, *arguments)
    assert (code, found["schema"], found["samples"]) == (0, "hostkit.record/1", 400)
    assert found["files"][0]["frames"] == 400
    assert len(load(folder / "c.csv")) == 400


@pytest.mark.parametrize(
    "command",
    [
        ["record", "-o", "b.tlog"],
        ["monitor", "design.json", "--record", "b.tlog"],
        ["monitor", "design.json", "--record", "b.tlog", "--speed", "20"],
    ],
)
def test_a_replayed_log_keeps_its_time_stamps(folder: Path, command: list[str]) -> None:
    assert run([*command, "--port", "file:a.tlog"]) == 0
    assert (folder / "b.tlog").read_bytes() == (folder / "a.tlog").read_bytes()


def test_damage_in_a_log_moves_no_other_time_stamp(folder: Path) -> None:
    stamped = [STAMP.pack(10**15 + k * 10_007) + frame for k, frame in enumerate(FRAMES)]
    damaged = [*stamped[:50], stamped[50][:20], *stamped[51:60], b"noise" * 9, *stamped[60:]]
    (folder / "d.tlog").write_bytes(b"".join(damaged))
    assert run(["record", "--port", "file:d.tlog", "-o", "b.tlog"]) == 0
    with (folder / "b.tlog").open("rb") as file:
        kept = [STAMP.pack(time_us) + raw for time_us, raw in stamped_frames(file, folder)]
    assert set(kept) <= set(stamped)
    assert len(kept) >= len(stamped) - 3


def test_a_restart_in_a_log_takes_as_long_in_the_recording_of_it(folder: Path) -> None:
    times = [10**15 + k * 10_000 + 3_000_000 * (k >= 200) for k in range(400)]
    twice = [*FRAMES[:200], *FRAMES[:200]]
    stamped = (STAMP.pack(t) + frame for t, frame in zip(times, twice, strict=True))
    (folder / "t.tlog").write_bytes(b"".join(stamped))
    command = ["record", "--port", "file:t.tlog", "-o", "c.csv", "--design", "design.json"]
    assert run(command) == 0
    time_s = load(folder / "c.csv").time_s
    assert np.diff(time_s).max() == pytest.approx(3.01, abs=0.02)


def test_what_was_left_unfinished_is_readable_and_said(folder: Path, capsys) -> None:
    (folder / "b.tlog.part").write_bytes((folder / "a.tlog").read_bytes()[:-5])
    code, found, _ = document(capsys, "monitor", "design.json", "--port", "file:b.tlog.part")
    assert (code, found["samples"]) == (0, 399)
    assert run(["record", "--port", "file:a.tlog", "-o", "b.tlog"]) == 0
    err = capsys.readouterr().err
    assert "b.tlog.part was left of a recording that was not finished" in err
    assert (folder / "b.unfinished-1.tlog").is_file()


class Board:
    """A pseudo-terminal whose other end sends the frames of a device, over and over."""

    def __init__(self) -> None:
        self._master, slave = os.openpty()
        tty.setraw(slave)
        self.path = os.ttyname(slave)
        self._slave = slave
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._send, daemon=True)

    def start(self) -> None:
        self._thread.start()

    def _send(self) -> None:
        os.set_blocking(self._master, False)
        device = Device(D)
        frames = device.frames(20_000)
        for k in range(0, len(frames), 10):
            data = b"".join(frames[k : k + 10])
            while data and not self._stop.is_set():
                with contextlib.suppress(BlockingIOError):
                    data = data[os.write(self._master, data) :]
                with contextlib.suppress(BlockingIOError):
                    os.read(self._master, 4096)
                self._stop.wait(0.01)
            if self._stop.is_set():
                return

    def close(self) -> None:
        self._stop.set()
        self._thread.join()
        os.close(self._master)
        os.close(self._slave)


@pytest.fixture
def board() -> Iterator[Board]:
    made = Board()
    try:
        yield made
    finally:
        made.close()


def wait_for_size(path: Path, size: int, child: subprocess.Popen) -> None:
    deadline_s = time.monotonic() + PATIENCE_S
    while not path.exists() or path.stat().st_size < size:
        assert child.poll() is None, child.communicate()
        assert time.monotonic() < deadline_s, f"{path} stays short"
        time.sleep(0.02)


@contextlib.contextmanager
def started(*arguments: str) -> Iterator[subprocess.Popen]:
    """Run hostkit; a failure inside does not wait for its end."""
    command = [sys.executable, "-m", "hostkit", *arguments]
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
    with subprocess.Popen(command, **pipes) as child:
        try:
            yield child
        finally:
            child.kill()


def test_a_recorder_that_is_killed_leaves_what_it_wrote(folder: Path, board: Board) -> None:
    board.start()
    part = folder / "k.tlog.part"
    with started("record", "--port", board.path, "-o", "k.tlog") as child:
        wait_for_size(part, 20_000, child)
        size = part.stat().st_size
        child.kill()
    assert not (folder / "k.tlog").exists()
    frames = list(read_tlog(part))
    assert sum(len(frame) + STAMP.size for frame in frames) == part.stat().st_size >= size


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_ends_with_a_verdict_and_whole_files(folder, board: Board, number: int) -> None:
    board.start()
    arguments = ("monitor", "design.json", "--port", board.path, "--json", "--record", "s.tlog")
    with started(*arguments) as child:
        wait_for_size(folder / "s.tlog.part", 10_000, child)
        child.send_signal(number)
        out, err = child.communicate(timeout=PATIENCE_S)
    assert child.returncode == 0, err
    found = json.loads(out)
    assert (found["verdict"], found["lost"]) == ("pass", 0)
    frames = list(read_tlog(folder / "s.tlog"))
    assert sum(frame[7:10] == (52050).to_bytes(3, "little") for frame in frames) == found["samples"]


def test_a_page_stays_after_a_replay_until_it_is_told_to_end(folder: Path) -> None:
    arguments = ("monitor", "design.json", "--port", "file:a.tlog", "--web", "--no-browser")
    names = ("--web-allow-host", "pi.local", "--web-allow-host", "bench.local")
    with started(*arguments, *names, "--speed", "1000", "--json") as child:
        assert child.stderr is not None
        url = next(line for line in child.stderr if "?token=" in line).split()[-1]
        opener = urllib.request.build_opener(urllib.request.HTTPCookieProcessor())
        place = urllib.parse.urlsplit(url)
        with opener.open(url, timeout=PATIENCE_S) as page:
            assert page.status == 200
        for name in ("pi.local", "bench.local"):
            named = {"Host": f"{name}:{place.port}"}
            with opener.open(urllib.request.Request(url, headers=named)) as page:
                assert page.status == 200
        report_url = f"{place.scheme}://{place.netloc}/report.json"
        deadline_s = time.monotonic() + PATIENCE_S
        samples = 0
        while samples < 400:
            with opener.open(report_url, timeout=PATIENCE_S) as answer:
                samples = json.load(answer)["samples"]
            assert time.monotonic() < deadline_s
        assert child.poll() is None
        child.send_signal(signal.SIGINT)
        out, err = child.communicate(timeout=PATIENCE_S)
    assert child.returncode == 0, err
    assert (json.loads(out)["verdict"], json.loads(out)["samples"]) == ("pass", 400)


FULL = """
import resource, sys
from hostkit.dialect import python_module
python_module()  # made once, in a file that is larger than the limit
resource.setrlimit(resource.RLIMIT_FSIZE, (6000, 6000))
from hostkit.cli.main import run
sys.exit(run(sys.argv[1:]))
"""


def test_no_room_left_is_a_failure_after_a_verdict(folder: Path) -> None:
    arguments = ["monitor", "design.json", "--port", "file:a.tlog", "--record", "f.tlog"]
    command = [sys.executable, "-c", FULL, *arguments]
    done = subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE_S, check=False)
    assert done.returncode == 1
    assert "verdict: pass" in done.stdout
    frames = list(read_tlog(folder / "f.tlog"))
    assert "recording stopped" in done.stderr
    assert f"{len(frames)} frames are kept in f.tlog" in done.stderr
    assert frames == FRAMES[: len(frames)]
    assert 0 < len(frames) < len(FRAMES)
