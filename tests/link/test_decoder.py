import random

import numpy as np
import pytest
from designs import all_parameters, design
from device import Device

from hostkit.dialect import sample_bytes
from hostkit.link.decoder import Decoder, digest_of, trace_of
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
    from hostkit.dialect import python_module

    module = python_module()
    unknown = bytearray(module.MAVLink_heartbeat_message(0, 0, 0, 0, 4, 3).pack(DEVICE.mav))
    unknown[7:10] = (60000).to_bytes(3, "little")
    decoder = Decoder()
    decoder.feed(FRAMES[0] + bytes(unknown) + FRAMES[1])
    statistics = decoder.statistics()
    assert statistics.unknown + statistics.bad == 1
    assert statistics.lost_frames == 0
