from pathlib import Path

import pytest
from designs import design
from device import Device

from hostkit.errors import DeviceError
from hostkit.link.logs.replay import ReplayTransport
from hostkit.link.logs.tlog import STAMP, TlogWriter
from hostkit.link.logs.tlog_index import MOST_MARKS, index_tlog

SAMPLES = 300
PERIOD_US = 10_000
FRAMES = Device(design()).frames(SAMPLES)
BEGIN_US = 1_700_000_000_000_000


class FakeClock:
    def __init__(self) -> None:
        self.now = 100.0

    def monotonic(self) -> float:
        return self.now

    def time(self) -> float:
        return self.now

    def sleep(self, duration_s: float) -> None:
        self.now += duration_s


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return written(tmp_path / "flight.tlog", FRAMES)


def written(path: Path, frames: list[bytes]) -> Path:
    path.write_bytes(
        b"".join(STAMP.pack(BEGIN_US + k * PERIOD_US) + frame for k, frame in enumerate(frames))
    )
    return path


def rest_of(replay: ReplayTransport) -> bytes:
    pieces = []
    while (piece := replay.read(0.1)) is not None:
        pieces.append(piece)
    return b"".join(pieces)


def test_as_fast_as_it_can_gives_every_frame(path: Path) -> None:
    clock = FakeClock()
    replay = ReplayTransport(path, None, clock)
    assert replay.length_s == pytest.approx(SAMPLES * PERIOD_US / 1e6)
    assert rest_of(replay) == b"".join(FRAMES)
    assert (clock.now, replay.state) == (100.0, "ended")
    assert replay.position_s == pytest.approx(replay.length_s)


@pytest.mark.parametrize("speed", [0.5, 1.0, 8.0])
def test_time_stamps_pace_it(path: Path, speed: float) -> None:
    clock = FakeClock()
    replay = ReplayTransport(path, speed, clock)
    assert rest_of(replay) == b"".join(FRAMES)
    assert clock.now - 100.0 == pytest.approx(replay.length_s / speed, abs=0.05)


def test_a_pause_holds_it_and_costs_nothing(path: Path) -> None:
    clock = FakeClock()
    replay = ReplayTransport(path, 1.0, clock)
    while replay.position_s < 1.0:
        replay.read(0.1)
    replay.pause(True)
    held_s = replay.position_s
    assert [replay.read(0.1) for _ in range(50)] == [b""] * 50
    assert replay.position_s == held_s
    replay.pause(False)
    begun_s = clock.now
    rest_of(replay)
    assert clock.now - begun_s == pytest.approx(replay.length_s - held_s, abs=0.05)


@pytest.mark.parametrize("position_s", [0.0, 0.105, 1.5, 2.99])
def test_seek_goes_both_ways_and_begins_an_epoch(path: Path, position_s: float) -> None:
    replay = ReplayTransport(path)
    rest_of(replay)
    replay.seek(position_s)
    assert (replay.epoch, replay.state) == (1, "connected")
    first = -int(-position_s * 1e6 // PERIOD_US)
    assert rest_of(replay) == b"".join(FRAMES[first:])


def test_seek_past_the_end_goes_to_the_last_frame(path: Path) -> None:
    replay = ReplayTransport(path)
    replay.seek(1e9)
    assert rest_of(replay) == FRAMES[-1]


def test_seek_in_a_long_file_is_exact(tmp_path: Path) -> None:
    frames = FRAMES * 40
    path = written(tmp_path / "long.tlog", frames)
    replay = ReplayTransport(path)
    for number in (0, 1, 6000, 11_000, 4321, len(frames) - 1):
        replay.seek(number * PERIOD_US / 1e6)
        assert replay.read(0.1).startswith(frames[number])
        assert replay.chunk_begin_s == pytest.approx(number * PERIOD_US / 1e6)


def test_the_index_is_bounded_whatever_the_length(tmp_path: Path, monkeypatch) -> None:
    monkeypatch.setattr("hostkit.link.logs.tlog_index.MOST_MARKS", 4)
    path = written(tmp_path / "long.tlog", FRAMES * 40)
    with path.open("rb") as file:
        index = index_tlog(file, path)
    assert len(index.marks) <= 5 < MOST_MARKS
    assert index.length_s == pytest.approx((len(FRAMES) * 40 - 1) * PERIOD_US / 1e6)


def test_a_file_that_was_cut_short_gives_its_whole_frames(path: Path) -> None:
    content = path.read_bytes()
    part = path.with_name("flight.tlog.part")
    part.write_bytes(content[:-7])
    assert rest_of(ReplayTransport(part)) == b"".join(FRAMES[:-1])


def test_a_stamp_that_cannot_be_does_not_hold_it(tmp_path: Path) -> None:
    path = tmp_path / "x.tlog"
    stamps = [BEGIN_US, BEGIN_US + 1000, 2**63, 0, BEGIN_US + 2000]
    pieces = zip(stamps, FRAMES[1:6], strict=True)
    path.write_bytes(b"".join(STAMP.pack(stamp) + frame for stamp, frame in pieces))
    clock = FakeClock()
    assert rest_of(ReplayTransport(path, 1.0, clock)) == b"".join(FRAMES[1:6])
    assert clock.now < 100.1


@pytest.mark.parametrize("content", [b"", bytes(500), b"time_s,gyro\n" * 50])
def test_what_is_no_tlog_is_refused(content: bytes, tmp_path: Path) -> None:
    path = tmp_path / "x.tlog"
    path.write_bytes(content)
    with pytest.raises(DeviceError, match="not a tlog"):
        ReplayTransport(path)
    with pytest.raises(DeviceError, match="cannot be read"):
        ReplayTransport(tmp_path / "missing.tlog")


def test_what_a_recorder_wrote_is_replayed(tmp_path: Path) -> None:
    recorder = TlogWriter(tmp_path / "a.tlog")
    for k, frame in enumerate(FRAMES):
        recorder.write(BEGIN_US + k * PERIOD_US, frame)
    recorder.close()
    assert rest_of(ReplayTransport(tmp_path / "a.tlog")) == b"".join(FRAMES)
