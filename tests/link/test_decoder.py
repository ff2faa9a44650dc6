import random

import numpy as np
import pytest
from designs import all_parameters, design
from device import Device

from hostkit.dialect import python_module, sample_bytes
from hostkit.link.frames.decoder import Decoder, digest_of, trace_of
from hostkit.records import AXES

DEVICE = Device(design())
FRAMES = DEVICE.frames(300)


def test_clean_stream_is_decoded_whole_whatever_the_chunks() -> None:
    stream = b"".join(FRAMES)
    for size in (1, 7, 64, 4096):
        decoder = Decoder()
        got = [f for i in range(0, len(stream), size) for f in decoder.feed(stream[i : i + size])]
        assert len(got) == len(FRAMES)
        assert [f.raw for f in got] == FRAMES
        statistics = decoder.statistics()
        assert (statistics.lost_frames, statistics.bad, statistics.unknown) == (0, 0, 0)


def test_trace_holds_what_was_sent() -> None:
    frames = Decoder().feed(b"".join(FRAMES))
    trace = trace_of(frames, ("roll", "pitch"))
    samples = [f for f in frames if f.name == "TILT_SAMPLE"]
    assert len(trace) == len(samples)
    assert trace.sequence.tolist() == list(range(len(samples)))
    assert trace.restarted.tolist() == [True] + [False] * (len(samples) - 1)
    assert {digest_of(f) for f in samples} == {DEVICE.digest}


@pytest.mark.parametrize(("axes", "words"), [("roll", 1), ("pitch", 1), ("both", 2)])
def test_trace_holds_the_hidden_state(axes: str, words: int) -> None:
    device = Device(all_parameters(axes))
    frames = Decoder().feed(b"".join(device.frames(100)))
    trace = trace_of(frames, AXES[axes], hidden_words=words)
    sent = device.states(100)
    angles = sent[:, [{"roll": 0, "pitch": 1}[axis] for axis in AXES[axes]]]
    np.testing.assert_array_equal(trace.state_raw, np.hstack([angles, sent[:, 2 : 2 + words]]))


def test_a_device_without_hidden_state_sends_no_byte_of_it() -> None:
    """MAVLink 2 cuts trailing zeros: the second byte of a frame is the size of its payload."""
    sizes = [
        max(frame[1] for frame in Device(d).frames(300)[1:])
        for d in (design(), all_parameters("roll"), all_parameters())
    ]
    assert sizes == [sample_bytes(words) for words in (0, 1, 2)] == [43, 47, 51]


@pytest.mark.parametrize("dropped", [[5], [5, 6, 7], [10, 20, 30, 40], list(range(50, 150))])
def test_lost_frames_are_counted_exactly(dropped: list[int]) -> None:
    decoder = Decoder()
    decoder.feed(b"".join(f for i, f in enumerate(FRAMES) if i not in dropped))
    assert decoder.statistics().lost_frames == len(dropped)


def test_flipped_bits_lose_frames_but_never_alter_one() -> None:
    rng = random.Random(4)
    decoder, stream = Decoder(), bytearray(b"".join(FRAMES))
    for _ in range(20):
        stream[rng.randrange(len(stream))] ^= 1 << rng.randrange(8)
    got = decoder.feed(bytes(stream))
    originals = set(FRAMES)
    assert all(frame.raw in originals for frame in got)
    assert len(got) < len(FRAMES)
    assert decoder.statistics().bad > 0


def test_noise_never_raises() -> None:
    rng = random.Random(9)
    for seed in range(60):
        decoder = Decoder()
        rng.seed(seed)
        noise = bytes(rng.choice((0xFD, 0xFE, rng.randrange(256))) for _ in range(2000))
        for i in range(0, len(noise), 100):
            for frame in decoder.feed(noise[i : i + 100]):
                trace_of([frame], ("roll",))
        recovered = decoder.feed(bytes(600) + b"".join(FRAMES))
        assert len(recovered) >= len(FRAMES) - 10


def test_frame_of_an_unknown_message_is_counted_and_its_sequence_ignored() -> None:
    module = python_module()
    unknown = bytearray(module.MAVLink_heartbeat_message(0, 0, 0, 0, 4, 3).pack(DEVICE.mav))
    unknown[7:10] = (60000).to_bytes(3, "little")
    decoder = Decoder()
    decoder.feed(FRAMES[0] + bytes(unknown) + FRAMES[1])
    statistics = decoder.statistics()
    assert statistics.unknown + statistics.bad == 1
    assert statistics.lost_frames == 0


# --- False starts -----------------------------------------------------------------------------


@pytest.mark.parametrize("length", range(0, 256, 5))
@pytest.mark.parametrize("flags", [0, 1])
def test_a_false_start_costs_no_frame(length: int, flags: int) -> None:
    """Noise that looks like a header claims up to 280 bytes, frames and all."""
    for number in (60_000, 0, 52_050):
        false = bytes([0xFD, length, flags, 0, 7, 1, 1]) + number.to_bytes(3, "little")
        decoder = Decoder()
        got = decoder.feed(b"".join(FRAMES[:20]) + false + b"".join(FRAMES[20:60]))
        assert [frame.raw for frame in got] == FRAMES[:60]
        counted = decoder.statistics()
        assert (counted.lost_frames, counted.unknown, counted.resyncs) == (0, 0, 1)
        assert (counted.bad, counted.bad_bytes) == (1, len(false))
        assert counted.crc_failures == (number != 60_000)


def test_binary_bursts_lose_only_what_they_hit_and_alter_nothing() -> None:
    rng = random.Random(7)
    stream, intact = b"", []
    for frame in Device(design()).frames(3000):
        burst = rng.randbytes(rng.randrange(1, 200))
        what = rng.randrange(30)
        if what == 0:
            stream += burst + frame
        elif what == 1:
            at = rng.randrange(1, len(frame) - 1)
            stream += frame[:at] + burst + frame[at:]
            continue
        else:
            stream += frame
        intact.append(frame)
    decoder = Decoder()
    got = decoder.feed(stream + b"".join(FRAMES[:10]))
    assert [frame.raw for frame in got] == intact + FRAMES[:10]
    peer = python_module().MAVLink(None)
    peer.robust_parsing = True
    known = [m for m in peer.parse_buffer(stream) if m.get_type() in ("TILT_SAMPLE", "HEARTBEAT")]
    assert len(known) < len(intact) - 50, "pymavlink drops what a false start claims"


def test_a_burst_that_ends_in_a_false_start_does_not_hold_frames_back_for_long() -> None:
    decoder = Decoder()
    decoder.feed(b"\xfd\xff\x01\x00\x00\x01\x01\x00\x00\x00")
    got = [len(decoder.feed(frame)) for frame in FRAMES[:10]]
    assert sum(got) == 10
    assert got.index(max(got)) <= 280 // min(map(len, FRAMES)) + 1


def test_mavlink_1_is_not_heard() -> None:
    module = python_module()
    message = module.MAVLink_attitude_message(1, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6)
    old = bytes(message.pack(DEVICE.mav, force_mavlink1=True))
    assert old[0] == 0xFE
    decoder = Decoder()
    assert len(decoder.feed(FRAMES[0] + old + FRAMES[1])) == 2
    assert (decoder.bad, decoder.bad_bytes, decoder.unknown) == (1, len(old), 0)


def test_a_switched_off_checksum_stays_on(monkeypatch: pytest.MonkeyPatch) -> None:
    """Pymavlink can be told by the environment to take anything."""
    monkeypatch.setattr(python_module(), "MAVLINK_IGNORE_CRC", "1")
    spoilt = bytearray(FRAMES[5])
    spoilt[20] ^= 1
    assert Decoder().feed(bytes(spoilt)) == []


def test_memory_stays_flat_when_chunks_never_end_where_frames_do() -> None:
    stream, decoder = b"".join(FRAMES), Decoder()
    for _ in range(20):
        for i in range(0, len(stream), 101):
            decoder.feed(stream[i : i + 101])
            assert decoder.pending_bytes < 300


def test_a_message_is_what_pymavlink_makes_of_it() -> None:
    parser = python_module().MAVLink(None)
    for frame, message in zip(
        Decoder().feed(b"".join(FRAMES)), parser.parse_buffer(b"".join(FRAMES)), strict=True
    ):
        assert frame.message == message
        assert frame.message is frame.message
        assert frame.name == message.get_type()
        assert frame.source == (message.get_srcSystem(), message.get_srcComponent())
        assert frame.sequence == message.get_seq()
