"""The receive path: our counting decoder against pymavlink's own parser, on one mix of frames."""

from collections.abc import Callable, Iterator

from benchmarks.table import Table, figure
from benchmarks.timing import least_seconds
from hostkit.dialect import python_module
from hostkit.link.frames.decoder import Decoder, Frame, trace_of

ROUNDS = 3000
"""A sample, an attitude and a scaled reading each."""
FRAMES = 3 * ROUNDS
CHUNKS_BYTES = (64, 256, 4096)
BUDGET_S = 3.0
LINK_HZ = 3000
"""Three messages at 1 kHz."""


def tables() -> Iterator[Table]:
    """Measure both, with and without the content of every message."""
    stream = mixed_stream()
    yield Table(
        title=f"Decoding {FRAMES} frames: TILT_SAMPLE, ATTITUDE and SCALED_IMU in turns",
        columns=(
            "bytes at a time",
            "pymavlink, frames/s",
            "ours, frames/s",
            "time, ours / pymavlink",
            "with samples as arrays",
            "with every message unpacked",
            "core at 3 x 1 kHz, %",
        ),
        rows=tuple(row(stream, size) for size in CHUNKS_BYTES),
        remarks=(
            "pymavlink: `parse_buffer`, robust, nothing counted. Ours: every frame checked and "
            "counted by its sender; `message` is unpacked by pymavlink when it is asked for.",
        ),
    )


def row(stream: bytes, size: int) -> tuple[str, ...]:
    """Measure both on chunks of so many bytes."""
    chunks = [stream[i : i + size] for i in range(0, len(stream), size)]
    peer, ours, sampled, unpacked = least_seconds(
        (
            lambda: parse(chunks),
            lambda: decode(chunks),
            lambda: decode(chunks, as_arrays),
            lambda: decode(chunks, unpack),
        ),
        budget_s=BUDGET_S,
    )
    return (
        str(size),
        figure(FRAMES / peer),
        figure(FRAMES / ours),
        figure(ours / peer, 2),
        figure(sampled / peer, 2),
        figure(unpacked / peer, 2),
        figure(100 * ours / FRAMES * LINK_HZ, 2),
    )


def parse(chunks: list[bytes]) -> None:
    """Let pymavlink find every frame."""
    parser = python_module().MAVLink(None)
    parser.robust_parsing = True
    assert sum(len(parser.parse_buffer(chunk) or ()) for chunk in chunks) == FRAMES


def decode(chunks: list[bytes], use: Callable[[list[Frame]], None] | None = None) -> None:
    """Find every frame, and look at what was found."""
    decoder = Decoder()
    for chunk in chunks:
        frames = decoder.feed(chunk)
        if use is not None:
            use(frames)
    counted = decoder.statistics()
    assert (counted.frames, counted.lost_frames, counted.bad) == (FRAMES, 0, 0)


def as_arrays(frames: list[Frame]) -> None:
    """Look at the samples as a validator does."""
    trace_of(frames, ("roll", "pitch"))


def unpack(frames: list[Frame]) -> None:
    """Look at the content of every message."""
    for frame in frames:
        assert frame.message is not None


def mixed_stream() -> bytes:
    """Return the frames of one sender, without a gap."""
    module = python_module()
    sender = module.MAVLink(None, 1, 1)
    frames = []
    for k in range(ROUNDS):
        for message in (
            module.MAVLink_tilt_sample_message(
                1000 * k, k, 7919 * k, -k, [k % 300, 2, -3], [4, -5, 6], 7, 0, [1] * 6, 0, [5, 6]
            ),
            module.MAVLink_attitude_message(k, 0.1, 0.2, 0.0, 0.3, 0.4, 0.5),
            module.MAVLink_scaled_imu_message(k, 1, 2, -1000, 4, 5, 6, 0, 0, 0, 2500),
        ):
            frames.append(bytes(message.pack(sender)))
            sender.seq = (sender.seq + 1) % 256
    return b"".join(frames)
