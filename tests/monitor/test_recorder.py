"""Files that a session writes: whole at the end, readable after a kill or on a full disk."""

import errno
import os
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from designs import design
from device import Device

from hostkit.errors import HostkitError
from hostkit.link.frames.decoder import Decoder, Frame
from hostkit.link.logs.tlog import STAMP, TlogWriter, read_tlog
from hostkit.monitor.notices import Notices
from hostkit.monitor.recording.recordings import Recordings, require_name
from hostkit.monitor.recording.sample_files import open_recorder
from hostkit.recordings import load
from hostkit.sensors import SENSORS

D = design()
SAMPLES = 200
HOST_US = 1_700_000_000_000_000


def decoded(frames: list[bytes]) -> list[Frame]:
    return Decoder().feed(b"".join(frames))


FRAMES = decoded(Device(D).frames(SAMPLES))


class Clock:
    def monotonic(self) -> float:
        return 0.0

    def time(self) -> float:
        return 1.7e9

    def sleep(self, duration_s: float) -> None:
        pass


class FullDisk:
    """Takes so many bytes, then none."""

    def __init__(self, room: int) -> None:
        self.room = room

    def __call__(self, file: int, data: bytes) -> int:
        if not self.room:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        done = os.write(file, data[: self.room])
        self.room -= done
        return done


@pytest.mark.parametrize("suffix", [".csv", ".npz"])
def test_samples_in_si_units_come_back_to_the_last_bit(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"a{suffix}"
    recorder = open_recorder(path, D)
    for k in range(0, len(FRAMES), 17):
        recorder.add(HOST_US, FRAMES[k : k + 17])
    assert not path.exists()
    recorder.close()
    recorder.close()
    recording = load(path)
    accel, gyro = Device(D).counts(SAMPLES)
    part = SENSORS[D.sensor.part]
    np.testing.assert_allclose(
        recording.specific_force_m_s2, accel * part.m_s2_per_count(D.sensor), rtol=1e-15
    )
    np.testing.assert_array_equal(
        recording.angular_rate_rad_s, gyro * part.rad_s_per_count(D.sensor)
    )
    np.testing.assert_array_equal(recording.time_s, np.arange(SAMPLES) * 10_000 / 1e6)
    assert (recording.rate_hz, recorder.frames) == (100.0, SAMPLES)
    assert recording.temperature_deg_c is not None
    assert [p.name for p in tmp_path.iterdir()] == [path.name]


def test_gaps_stay_late_and_repeated_samples_are_left_out(tmp_path: Path) -> None:
    frames = [*FRAMES[:50], FRAMES[49], FRAMES[47], *FRAMES[80:]]
    recorder = open_recorder(tmp_path / "a.csv", D)
    recorder.add(HOST_US, frames)
    recorder.close()
    recording = load(tmp_path / "a.csv")
    assert len(recording) == SAMPLES - 30
    assert np.diff(recording.time_s).max() == pytest.approx(0.31)


def test_time_goes_on_where_the_device_begins_anew(tmp_path: Path) -> None:
    recorder = open_recorder(tmp_path / "a.csv", D)
    recorder.add(HOST_US, FRAMES)
    recorder.add(HOST_US + 3_000_000, FRAMES)
    recorder.close()
    time_s = load(tmp_path / "a.csv").time_s
    assert len(time_s) == 2 * SAMPLES
    assert time_s[SAMPLES] - time_s[SAMPLES - 1] == pytest.approx(3.0)


def test_another_design_has_other_ranges_and_is_refused(tmp_path: Path) -> None:
    recorder = open_recorder(tmp_path / "a.csv", D)
    other = Device(design(eta=0.99))
    with pytest.raises(HostkitError, match=f"runs design {other.digest}"):
        recorder.add(HOST_US, decoded(other.frames(3)))


@pytest.mark.parametrize(
    ("name", "says"), [("a.csv", "needs a design"), ("a.txt", "ends in .txt"), ("a", "no suffix")]
)
def test_a_form_that_cannot_be_written_is_refused(tmp_path: Path, name: str, says: str) -> None:
    with pytest.raises(HostkitError, match=says):
        open_recorder(tmp_path / name, None)


@pytest.mark.parametrize("room", [0, 7, 1000, 1001, 4321])
def test_a_full_disk_leaves_whole_frames_and_says_so(tmp_path: Path, room: int) -> None:
    path = tmp_path / "a.tlog"
    notices = Notices(Clock())
    recorder = open_recorder(path, None, write=FullDisk(room))
    recordings = Recordings((recorder,), notices)
    for k in range(0, len(FRAMES), 10):
        recordings.add(HOST_US, FRAMES[k : k + 10])
    sizes = np.cumsum([STAMP.size + len(frame.raw) for frame in FRAMES])
    whole = int((sizes <= room).sum())
    state = recordings.state()
    assert state is not None
    assert (state.active, state.frames) == (False, whole)
    assert path.stat().st_size == (sizes[whole - 1] if whole else 0)
    assert state.written_bytes == path.stat().st_size
    assert "No space left" in state.error
    assert f"{whole} frames are kept" in notices.latest()[-1].text
    assert len(recordings.problems) == 1
    if whole:
        assert list(read_tlog(path)) == [frame.raw for frame in FRAMES[:whole]]


def test_a_full_disk_leaves_whole_rows(tmp_path: Path) -> None:
    recorder = open_recorder(tmp_path / "a.csv", D, write=FullDisk(5000))
    with pytest.raises(HostkitError, match="No space left"):
        recorder.add(HOST_US, FRAMES)
    recorder.close()
    assert len(load(tmp_path / "a.csv")) == recorder.frames > 20


def test_what_an_unfinished_recording_left_is_moved_aside(tmp_path: Path) -> None:
    path = tmp_path / "a.tlog"
    (tmp_path / "a.tlog.part").write_bytes(b"earlier")
    (tmp_path / "a.unfinished-1.tlog").write_bytes(b"still earlier")
    recorder = TlogWriter(path)
    recorder.add(HOST_US, FRAMES)
    recorder.close()
    assert recorder.left == tmp_path / "a.unfinished-2.tlog"
    assert recorder.left.read_bytes() == b"earlier"
    assert list(read_tlog(path)) == [frame.raw for frame in FRAMES]


def test_two_recordings_of_one_name_do_not_mix(tmp_path: Path) -> None:
    first = TlogWriter(tmp_path / "a.tlog")
    with pytest.raises(HostkitError, match="another program"):
        TlogWriter(tmp_path / "a.tlog")
    first.close()


KILLED = """
import sys, time
from pathlib import Path
from hostkit.link.logs.tlog import TlogWriter
writer = TlogWriter(Path(sys.argv[1]))
for k in range(500):
    writer.write(k, bytes.fromhex(sys.argv[2]))
print("written", flush=True)
sys.stdin.read()
"""


def test_a_killed_program_loses_nothing_that_it_had_written(tmp_path: Path) -> None:
    path = tmp_path / "a.tlog"
    command = [sys.executable, "-c", KILLED, str(path), FRAMES[1].raw.hex()]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE) as child:
        assert child.stdout is not None
        assert child.stdout.readline().strip() == b"written"
        child.send_signal(signal.SIGKILL)
    assert not path.exists()
    assert len(list(read_tlog(tmp_path / "a.tlog.part"))) == 500


@pytest.mark.parametrize(
    "name",
    [
        *("", ".tlog", "../a.tlog", "a/b.tlog", "a\\b.tlog", "C:a.tlog", "a\n.tlog", "a.exe"),
        *("a", "a" * 100 + ".tlog", "\x1b[2J.tlog", "a\0.tlog", "/etc/a.csv"),
    ],
)
def test_a_name_cannot_leave_the_folder(name: str) -> None:
    with pytest.raises(HostkitError):
        require_name(name)


def test_a_recording_of_the_folder_is_new(tmp_path: Path) -> None:
    notices = Notices(Clock())
    recordings = Recordings((), notices, folder=tmp_path)
    recordings.start("a.tlog")
    recordings.add(HOST_US, FRAMES)
    recordings.stop()
    assert len(list(read_tlog(tmp_path / "a.tlog"))) == len(FRAMES)
    with pytest.raises(HostkitError, match="already"):
        recordings.check("a.tlog")
    recordings.start("a.tlog")
    assert not recordings.active
    assert notices.latest()[-1].level == "error"
