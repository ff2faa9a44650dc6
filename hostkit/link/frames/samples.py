"""``TILT_SAMPLE`` and ``TILT_STATE`` frames as arrays, straight from their bytes."""

from collections.abc import Sequence
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from hostkit.dialect import python_module
from hostkit.link.frames.framing import HEADER_BYTES
from hostkit.records import Axis
from hostkit.spec import SAMPLE_HIDDEN_WORDS
from hostkit.trace import AngleTrace, ToldState

if TYPE_CHECKING:
    from hostkit.link.frames.decoder import Frame

SAMPLE = "TILT_SAMPLE"
STATE = "TILT_STATE"

Payloads = np.ndarray[tuple[int], np.dtype[np.void]]


@lru_cache(maxsize=2)
def _layout(name: str) -> np.dtype[np.void]:
    """Return the payload of a message as a structured type; little-endian, no gaps."""
    kind = getattr(python_module(), f"MAVLink_{name.lower()}_message")
    codes = kind.native_format.decode().lstrip("<")
    fields = zip(kind.ordered_fieldnames, codes, kind.array_lengths, strict=True)
    return np.dtype([(name, f"<{code}", (size,) if size else ()) for name, code, size in fields])


def sample_layout() -> np.dtype[np.void]:
    """Return the payload of ``TILT_SAMPLE`` as a structured type."""
    return _layout(SAMPLE)


def payloads(frames: Sequence["Frame"]) -> Payloads:
    """Return the fields of some ``TILT_SAMPLE`` frames; zeros that MAVLink cut off are back."""
    return _payloads(frames, sample_layout())


def _payloads(frames: Sequence["Frame"], layout: np.dtype[np.void]) -> Payloads:
    size = layout.itemsize
    parts = [
        frame.raw[HEADER_BYTES : HEADER_BYTES + min(frame.raw[1], size)].ljust(size, b"\0")
        for frame in frames
    ]
    return np.frombuffer(b"".join(parts), dtype=layout)


def told_states(frames: Sequence["Frame"], hidden_words: int) -> tuple[ToldState, ...]:
    """Return the ``TILT_STATE`` messages among `frames`, so many words of each.

    A state has as many words as the message at most, whatever the filter has. What comes a second
    time is left out.
    """
    behind, samples, found = [], 0, []
    for frame in frames:
        samples += frame.name == SAMPLE
        if frame.name == STATE and not frame.repeated:
            found.append(frame)
            behind.append(samples)
    read = _payloads(found, _layout(STATE))
    words = read["words"][:, :hidden_words].tolist()
    return tuple(
        ToldState(sequence=sequence, words_raw=tuple(own), behind=place)
        for sequence, own, place in zip(read["sequence"].tolist(), words, behind, strict=True)
    )


def trace_of(
    frames: Sequence["Frame"], axes: tuple[Axis, ...], *, hidden_words: int = 0
) -> AngleTrace:
    """Return the ``TILT_SAMPLE`` messages among `frames` as a trace.

    Parameters
    ----------
    axes
        Axes of the design.
    hidden_words
        Words of its filter's state beside the angles; where a sample has no room for them, they
        are taken from the ``TILT_STATE`` messages instead.
    """
    read = payloads([frame for frame in frames if frame.name == SAMPLE])
    columns = [read[axis][:, None] for axis in axes]
    told: tuple[ToldState, ...] = ()
    if hidden_words <= SAMPLE_HIDDEN_WORDS:
        columns.append(read["hidden"][:, :hidden_words])
    else:
        told = told_states(frames, hidden_words)
    return AngleTrace(
        sequence=read["sequence"].astype(np.int64),
        time_us=read["time_usec"].astype(np.int64),
        accel_count=read["accel"].astype(np.int64),
        gyro_count=read["gyro"].astype(np.int64),
        state_raw=np.hstack(columns).astype(np.int64),
        restarted=(read["flags"] & python_module().HOSTKIT_SAMPLE_RESTARTED) != 0,
        retuned=(read["flags"] & python_module().HOSTKIT_SAMPLE_RETUNED) != 0,
        told=told,
    )


def digest_of(frame: "Frame") -> str:
    """Return the design digest of a ``TILT_SAMPLE``, 12 hex digits."""
    return bytes(payloads([frame])["digest"][0]).hex()


def is_retuned(frame: "Frame") -> bool:
    """Tell whether a ``TILT_SAMPLE`` was made with other parameters than those of its design."""
    return bool(payloads([frame])["flags"][0] & python_module().HOSTKIT_SAMPLE_RETUNED)
