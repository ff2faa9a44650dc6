"""What is counted is what happened, exactly."""

import random
from dataclasses import fields, replace

import pytest
from designs import design
from device import Device
from disturb import EVERYTHING, DisturbedTransport, Disturber, Harm

from hostkit.dialect import python_module
from hostkit.link.frames.decoder import Decoder, Frame
from hostkit.link.frames.sequence import MOST_SOURCES, OTHERS
from hostkit.link.ports.transport import PortState
from hostkit.link.statistics import LinkStatistics, SourceStatistics

M = python_module()
FRAMES = Device(design()).frames(1500)
SENDERS = [(1, 1), (1, 200), (255, 190)]
ALONE = {
    "none": Harm(),
    "drop": Harm(drop=0.1),
    "burst": Harm(burst=0.02),
    "duplicate": Harm(duplicate=0.1),
    "late": Harm(late=0.1),
    "text": Harm(text=0.1),
    "noise": Harm(noise=0.1),
    "cut": Harm(cut=0.1),
    "flip": Harm(flip=0.1),
    "everything": EVERYTHING,
}


def sent_by(source: tuple[int, int], count: int, first: int = 0, roll: int = 5) -> list[bytes]:
    """Samples, attitudes and scaled readings, in turns."""
    mav = M.MAVLink(None, *source)
    mav.seq = first
    frames = []
    for k in range(count):
        message = (
            M.MAVLink_tilt_sample_message(
                1000 * k, k, roll, -k, [1] * 3, [2] * 3, 0, 0, [3] * 6, 0
            ),
            M.MAVLink_attitude_message(k, roll, 0.2, 0.3, 0.4, 0.5, 0.6),
            M.MAVLink_scaled_imu_message(k, roll, 2, 3, 4, 5, 6, 0, 0, 0, 0),
        )[k % 3]
        frames.append(bytes(message.pack(mav)))
        mav.seq = (mav.seq + 1) % 256
    return frames


def interleaved(seed: int, count: int = 700) -> list[bytes]:
    """Return the frames of three senders, each in its order, mixed."""
    rng = random.Random(seed)
    queues = [sent_by(source, count, rng.randrange(256))[::-1] for source in SENDERS]
    return [queue.pop() for queue in iter(lambda: rng.choice([q for q in queues if q] or [[]]), [])]


def fed(stream: bytes, chunk: int = 256) -> tuple[Decoder, list[Frame]]:
    decoder = Decoder()
    frames = [f for i in range(0, len(stream), chunk) for f in decoder.feed(stream[i : i + chunk])]
    return decoder, frames


def without_sources(statistics: LinkStatistics) -> LinkStatistics:
    return replace(statistics, sources=())


@pytest.mark.parametrize("harm", ALONE.values(), ids=ALONE)
@pytest.mark.parametrize("seed", range(8))
def test_what_was_done_to_the_link_is_counted_exactly(harm: Harm, seed: int) -> None:
    disturber = Disturber(seed, harm)
    decoder, got = fed(disturber.disturb(FRAMES))
    assert without_sources(decoder.statistics()) == disturber.expected()
    assert [frame.raw for frame in got] == disturber.intact
    assert sum(frame.repeated for frame in got) == disturber.expected().duplicated


@pytest.mark.parametrize("seed", range(20))
def test_several_senders_are_counted_exactly(seed: int) -> None:
    disturber = Disturber(seed)
    decoder, got = fed(disturber.disturb(interleaved(seed)), chunk=1 + seed * 37)
    statistics = decoder.statistics()
    assert without_sources(statistics) == disturber.expected()
    assert [frame.raw for frame in got] == disturber.intact
    assert [(s.system, s.component) for s in statistics.sources] == sorted(SENDERS)
    for name in ("frames", "lost", "duplicated", "reordered"):
        total = "lost_frames" if name == "lost" else name
        assert sum(getattr(s, name) for s in statistics.sources) == getattr(statistics, total)
    assert not any(s.restarts for s in statistics.sources)


def test_every_kind_of_harm_has_happened() -> None:
    """The tests above prove nothing where nothing was done."""
    disturber = Disturber(0)
    disturber.disturb(interleaved(0))
    counted = disturber.expected()
    zero = [f.name for f in fields(counted) if not getattr(counted, f.name)]
    assert zero == ["bad_signatures", "overrun_bytes", "sources"]


@pytest.mark.parametrize("chunk", [1, 2, 11, 12, 13, 300])
def test_the_account_does_not_depend_on_the_chunks(chunk: int) -> None:
    stream = Disturber(5).disturb(FRAMES)
    assert fed(stream, chunk)[0].statistics() == fed(stream, len(stream))[0].statistics()


def test_no_byte_goes_uncounted() -> None:
    rng = random.Random(8)
    stream = bytearray(b"".join(FRAMES))
    for _ in range(300):
        stream[rng.randrange(len(stream))] = rng.choice((0xFD, 0, 1, rng.randrange(256)))
    decoder, got = fed(bytes(stream + b"".join(FRAMES[:20])))
    statistics = decoder.statistics()
    unknown_bytes = statistics.received_bytes - statistics.bad_bytes - sum(len(f.raw) for f in got)
    assert (unknown_bytes > 0) == (statistics.unknown > 0)
    assert unknown_bytes <= 280 * statistics.unknown


class Lines:
    """A transport that gives what it is told."""

    live = True
    state: PortState = "connected"
    epoch = 0
    overrun_bytes = 0

    def __init__(self, chunks: list[bytes]) -> None:
        self.chunks, self.written = chunks, b""

    def read(self, timeout_s: float) -> bytes | None:
        return self.chunks.pop(0) if self.chunks else None

    def write(self, data: bytes) -> None:
        self.written += data

    def close(self) -> None:
        self.chunks = []


def test_a_transport_can_be_disturbed() -> None:
    stream = b"".join(FRAMES[:-20])
    line = Lines([stream[i : i + 100] for i in range(0, len(stream), 100)])
    disturber = Disturber(3)
    transport, decoder = DisturbedTransport(line, disturber), Decoder()
    while (data := transport.read(0.1)) is not None:
        decoder.feed(data)
    disturber.calm = True
    decoder.feed(disturber.feed(FRAMES[-20:]))
    assert without_sources(decoder.statistics()) == disturber.expected()


# --- Gaps, copies and starts ------------------------------------------------------------------


def counted(*frames: bytes) -> SourceStatistics:
    decoder = Decoder()
    decoder.feed(b"".join(frames))
    (statistics,) = decoder.statistics().sources
    return statistics


@pytest.mark.parametrize("gap", [1, 2, 126, 127, 128, 129, 200, 254, 255])
@pytest.mark.parametrize("first", [0, 3, 128, 250])
def test_a_gap_of_less_than_256_frames_is_counted_whole(gap: int, first: int) -> None:
    frames = sent_by((1, 1), 900, first)
    got = counted(*frames[:300], *frames[300 + gap :])
    assert (got.lost, got.frames, got.reordered, got.restarts) == (gap, 900 - gap, 0, 0)


@pytest.mark.parametrize("gap", [130, 200, 254])
def test_a_gap_that_ends_where_another_one_was_is_no_late_frame(gap: int) -> None:
    frames = sent_by((1, 1), 900)
    landing = 300 + gap
    missing = landing - 256
    got = counted(*(f for i, f in enumerate(frames) if i != missing and not 300 <= i < landing))
    assert (got.lost, got.reordered, got.restarts) == (gap + 1, 0, 0)


@pytest.mark.parametrize("behind", [1, 2, 50, 126])
def test_a_frame_may_come_late_within_the_window(behind: int) -> None:
    frames = sent_by((1, 1), 600)
    late = frames.pop(300)
    frames.insert(300 + behind, late)
    got = counted(*frames)
    assert (got.lost, got.reordered, got.frames) == (0, 1, 600)


def test_a_copy_of_a_late_frame_is_a_copy() -> None:
    frames = sent_by((1, 1), 40)
    frames[20:23] = [frames[21], frames[20], frames[20], frames[22]]
    got = counted(*frames)
    assert (got.lost, got.reordered, got.duplicated, got.frames) == (0, 1, 1, 40)


def test_the_first_frames_may_be_out_of_order() -> None:
    frames = sent_by((1, 1), 40, first=100)
    got = counted(frames[1], frames[0], *frames[2:])
    assert (got.lost, got.reordered, got.frames) == (0, 1, 40)


@pytest.mark.parametrize("kept", [7, 8, 9, 40, 255, 256, 257, 300, 511])
@pytest.mark.parametrize("skipped", [0, 1, 2, 5])
def test_a_start_is_no_loss(kept: int, skipped: int) -> None:
    """The device says BOOT first; then its time is lower than before."""
    mav = M.MAVLink(None, 1, 1)
    boot = bytes(M.MAVLink_heartbeat_message(0, 0, 0, 0, 1, 3).pack(mav))
    once = [boot, *sent_by((1, 1), 600, first=1)]
    again = [boot, *sent_by((1, 1), 600, first=1, roll=6)]
    got = counted(*once[:kept], *again[skipped:])
    assert (got.restarts, got.lost, got.reordered) == (1, 0, 0)
    assert got.frames + got.duplicated == kept + len(once) - skipped


def test_a_start_that_a_message_without_time_tells_of_is_no_loss() -> None:
    mav = M.MAVLink(None, 1, 1)
    value = bytes(M.MAVLink_param_value_message(b"FILT_TAU", 1.0, 9, 5, 0).pack(mav))
    got = counted(*sent_by((1, 1), 100), value, *sent_by((1, 1), 50, first=1))
    assert (got.restarts, got.lost, got.frames) == (1, 0, 151)


def test_a_gap_that_a_message_without_time_tells_of_is_a_loss() -> None:
    mav = M.MAVLink(None, 1, 1)
    mav.seq = 110
    value = bytes(M.MAVLink_param_value_message(b"FILT_TAU", 1.0, 9, 5, 0).pack(mav))
    frames = sent_by((1, 1), 300)
    got = counted(*frames[:100], value, *frames[111:])
    assert (got.restarts, got.lost) == (0, 10)


def heartbeats(count: int, first: int = 0, *, boot: bool = False) -> list[bytes]:
    """Messages without a time; the first may say that the sender is starting."""
    mav = M.MAVLink(None, 1, 1)
    frames = []
    for k in range(count):
        mav.seq = (first + k) % 256
        state = 1 if boot and k == 0 else 4
        frames.append(bytes(M.MAVLink_heartbeat_message(0, 0, 0, 0, state, 3).pack(mav)))
    return frames


@pytest.mark.parametrize("kept", [40, 100, 200, 255, 300])
def test_a_sender_without_times_says_boot_when_it_starts(kept: int) -> None:
    got = counted(*heartbeats(kept, boot=True), *heartbeats(20, boot=True))
    assert (got.restarts, got.lost) == (1, 0)


def test_an_old_gap_stays_a_loss_when_the_sender_starts_later() -> None:
    got = counted(*heartbeats(50), *heartbeats(60, first=60), *heartbeats(5, boot=True))
    assert (got.restarts, got.lost) == (1, 10)


def test_a_clock_of_32_bits_may_start_over() -> None:
    mav = M.MAVLink(None, 1, 1)
    frames = []
    for k in range(300):
        time_us = (2**32 - 100_000 + 1000 * k) % 2**32
        frames.append(
            bytes(M.MAVLink_raw_imu_message(time_us, 0, 0, 0, 0, 0, 0, 0, 0, 0).pack(mav))
        )
        mav.seq = (mav.seq + 1) % 256
    got = counted(*frames[:90], *frames[105:])
    assert (got.restarts, got.lost) == (0, 15)


def test_after_the_port_was_opened_anew_no_gap_is_seen() -> None:
    decoder = Decoder()
    decoder.feed(b"".join(FRAMES[:100]) + FRAMES[100][:20])
    decoder.begin_epoch()
    decoder.feed(b"".join(FRAMES[150:300]))
    got = decoder.statistics()
    assert (got.frames, got.lost_frames, got.bad, got.bad_bytes) == (250, 0, 1, 20)
    assert got.sources[0].restarts == 0


def test_the_number_of_senders_is_bounded_and_the_device_stays_counted() -> None:
    decoder, rng = Decoder(), random.Random(2)
    ids = [(system, component) for system in range(2, 256) for component in range(1, 10)]
    spam = rng.sample(ids, len(FRAMES))
    for i, frame in enumerate(FRAMES):
        if i % 50 != 7:
            decoder.feed(frame)
        decoder.feed(sent_by(spam[i], 1)[0])
    statistics = decoder.statistics()
    assert len(statistics.sources) == MOST_SOURCES + 1
    by_source = {(s.system, s.component): s for s in statistics.sources}
    assert by_source[1, 1].lost == len(range(7, len(FRAMES), 50))
    assert by_source[OTHERS].frames > len(spam) - 2 * MOST_SOURCES
    assert statistics.frames == len(FRAMES) - by_source[1, 1].lost + len(spam)
