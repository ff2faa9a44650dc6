"""The receive path of the host under hostile bytes: no exception, bounded memory, linear time."""

import math
import struct
import sys
import time
from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from hostkit.dialect import python_module
from hostkit.link.frames.decoder import Decoder, Frame, digest_of, is_retuned, trace_of
from hostkit.link.frames.framing import LONGEST_FRAME_BYTES, checksum
from hostkit.link.frames.sequence import MOST_SOURCES
from hostkit.link.frames.signing import SigningClock, SigningKey
from hostkit.link.frames.timesync import TimeSync

M = python_module()
QUICK = settings(max_examples=100, deadline=None, suppress_health_check=[HealthCheck.too_slow])
KEY = SigningKey(secret=bytes(range(32)), clock=SigningClock(lambda: 1.8e9))
NUMBERS = sorted(M.mavlink_map)
CHUNKS = st.integers(1, 400)


def framed(
    number: int, payload: bytes, sequence: int = 0, source: tuple[int, int] = (1, 1), flags: int = 0
) -> bytes:
    """Return a frame with a right checksum around any payload."""
    payload = payload[:255]
    head = bytes([len(payload), flags, 0, sequence, *source]) + number.to_bytes(3, "little")
    extra = bytes([M.mavlink_map[number].crc_extra]) if number in M.mavlink_map else b"\0"
    crc = checksum()(head + payload + extra)
    return b"\xfd" + head + payload + crc.to_bytes(2, "little") + bytes(13 * flags)


FRAME = st.builds(
    framed,
    st.sampled_from(NUMBERS),
    st.binary(max_size=255),
    st.integers(0, 255),
    st.tuples(st.integers(0, 255), st.integers(0, 255)),
    st.integers(0, 1),
)
DIRT = st.one_of(
    st.binary(max_size=64),
    st.lists(st.sampled_from([0xFD, 0xFE, 0, 1, 0x1E]), max_size=64).map(bytes),
)


@st.composite
def mutated(draw: st.DrawFn) -> bytes:
    """Return a frame with some bytes changed, or cut, or torn apart by others."""
    frame = bytearray(draw(FRAME))
    for _ in range(draw(st.integers(1, 4))):
        frame[draw(st.integers(0, len(frame) - 1))] = draw(st.integers(0, 255))
    cut = draw(st.integers(0, len(frame)))
    return bytes(frame[:cut]) + draw(DIRT) + bytes(frame[cut if draw(st.booleans()) else 0 :])


STREAM = st.lists(st.one_of(FRAME, FRAME, DIRT, mutated()), max_size=30).map(b"".join)


def read(stream: bytes, chunk: int, key: SigningKey | None = None) -> list[Frame]:
    """Decode a stream as a session does, look at everything, and hold every limit."""
    decoder, sync = Decoder(key), TimeSync(lambda: 5)
    got: list[Frame] = []
    for i in range(0, len(stream), chunk):
        frames = decoder.feed(stream[i : i + chunk])
        assert decoder.pending_bytes < LONGEST_FRAME_BYTES
        for frame in frames:
            look_at(frame, sync)
        trace = trace_of(frames, ("roll", "pitch"), hidden_words=2)
        sync.arrived(trace.time_us, np.full(len(trace), 10**9 + i))
        got += frames
    counted = decoder.statistics()
    assert counted.received_bytes == len(stream)
    taken_bytes = sum(len(frame.raw) for frame in got)
    assert taken_bytes + counted.bad_bytes + decoder.pending_bytes <= len(stream)
    assert counted.frames + counted.duplicated == len(got)
    assert len(counted.sources) <= MOST_SOURCES + 1
    for source in counted.sources:
        assert min(source.frames, source.lost, source.duplicated, source.reordered) >= 0
    sync.statistics()
    return got


def look_at(frame: Frame, sync: TimeSync) -> None:
    message = frame.message
    assert message.get_type() == frame.name
    assert bytes(message.get_msgbuf()) == frame.raw
    message.to_dict()
    repr(frame)
    sync.poll()
    sync.take(frame)
    if frame.name == "TILT_SAMPLE":
        assert len(digest_of(frame)) == 12
        assert digest_of(frame) == bytes(message.digest).hex()
        assert is_retuned(frame) == bool(message.flags & 4)


@QUICK
@given(st.binary(max_size=2000), CHUNKS)
def test_any_bytes(stream: bytes, chunk: int) -> None:
    read(stream, chunk)


@QUICK
@given(STREAM, CHUNKS)
def test_any_mix_of_frames_and_dirt(stream: bytes, chunk: int) -> None:
    frames = [frame.raw for frame in read(stream, chunk)]
    assert frames == [frame.raw for frame in read(stream, len(stream) or 1)]


@QUICK
@given(STREAM, CHUNKS)
def test_without_the_key_nothing_is_believed(stream: bytes, chunk: int) -> None:
    assert read(stream, chunk, KEY) == []


@QUICK
@given(st.lists(st.tuples(DIRT, FRAME), max_size=20))
def test_every_intact_frame_behind_dirt_is_found(parts: list[tuple[bytes, bytes]]) -> None:
    stream = b"".join(dirt + frame for dirt, frame in parts)
    got = [frame.raw for frame in read(stream + bytes(300), 64)]
    hidden = [frame for _, frame in parts if frame not in got]
    # A frame within another one's claim can only be missed if that claim has a right checksum.
    assert len(hidden) <= sum(raw not in [f for _, f in parts] for raw in got)


@pytest.mark.parametrize("number", NUMBERS)
def test_every_message_with_the_worst_of_content(number: int) -> None:
    kind = M.mavlink_map[number]
    size = kind.unpacker.size
    for payload in (
        b"\xff" * size,
        b"\x00",
        b"\x80" * size,
        struct.pack("<f", math.nan) * (size // 4 + 1),
        struct.pack("<f", math.inf) * (size // 4 + 1),
        b"\xc3\x28\xa0\xff" * (size // 4 + 1),
        b"\xff" * 255,
    ):
        (frame,) = read(framed(number, payload), 400)
        assert frame.name == kind.msgname


def test_samples_keep_every_bit_of_their_numbers() -> None:
    (frame,) = read(framed(52050, b"\xff" * 51), 400)
    trace = trace_of([frame], ("roll", "pitch"), hidden_words=2)
    assert trace.state_raw.tolist() == [[-1, -1, -1, -1]]
    assert trace.sequence.tolist() == [2**32 - 1]
    assert trace.time_us.tolist() == [-1]
    assert np.asarray(trace.accel_count).tolist() == [[-1, -1, -1]]


def held_bytes(of: object) -> int:
    """Return the memory of an object and all that it holds."""
    seen: dict[int, object] = {}
    waiting = [of]
    while waiting:
        one = waiting.pop()
        if id(one) in seen or isinstance(one, type):
            continue
        seen[id(one)] = one
        if isinstance(one, dict):
            waiting += [*one, *one.values()]
        elif isinstance(one, list | tuple | set):
            waiting += one
        for slot in getattr(type(one), "__slots__", ()):
            waiting.append(getattr(one, slot, None))
    return sum(sys.getsizeof(one) for one in seen.values())


def parameter_spam(count: int) -> bytes:
    return b"".join(
        framed(
            22, struct.pack("<fHH", k, 65535, k % 65536) + bytes([k % 256] * 16) + b"\x09", k % 256
        )
        for k in range(count)
    )


def many_senders(count: int) -> bytes:
    return b"".join(
        framed(0, bytes(8) + b"\x03", k % 256, (k % 256, k // 256 % 256)) for k in range(count)
    )


FLOODS: dict[str, Callable[[int], bytes]] = {
    "magic": lambda count: b"\xfd" * (20 * count),
    "headers": lambda count: b"\xfd\xff\x00\x00\x00\x01\x01\x00\x00\x00" * (2 * count),
    "signed headers": lambda count: b"\xfd\xff\x01\x00\x00\x01\x01\x00\x00\x00" * (2 * count),
    "unknown": lambda count: framed(60_000, b"\xfd" * 255) * (count // 8),
    "longest": lambda count: framed(30, bytes(range(255)), 3) * (count // 8),
    "parameters": parameter_spam,
    "senders": many_senders,
    "jumps": lambda count: b"".join(
        framed(30, (k * 7 % 5).to_bytes(4, "little"), k * 131 % 256) for k in range(count)
    ),
    "undated jumps": lambda count: b"".join(
        framed(0, bytes([k % 256] * 9), k * 131 % 256) for k in range(count)
    ),
}


@pytest.mark.parametrize("flood", FLOODS.values(), ids=FLOODS)
def test_a_flood_takes_linear_time_and_bounded_memory(flood: Callable[[int], bytes]) -> None:
    """Twice as much may take three times as long, since the machine is shared."""

    def spent_s(stream: bytes, chunk: int) -> float:
        decoder = Decoder()
        begun = time.process_time()
        for i in range(0, len(stream), chunk):
            decoder.feed(stream[i : i + chunk])
        spent = time.process_time() - begun
        assert decoder.pending_bytes < LONGEST_FRAME_BYTES
        assert held_bytes(decoder) < 8_000_000
        return spent

    once, twice = flood(1500), flood(3000)
    for chunk in (97, 65536):
        base = min(spent_s(once, chunk) for _ in range(2))
        assert min(spent_s(twice, chunk) for _ in range(2)) < 3 * base + 0.02
