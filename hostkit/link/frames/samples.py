"""``TILT_SAMPLE`` frames as arrays, straight from their bytes."""

from collections.abc import Sequence
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from hostkit.dialect import python_module
from hostkit.link.frames.framing import HEADER_BYTES
from hostkit.records import AngleTrace, Axis

if TYPE_CHECKING:
    from hostkit.link.frames.decoder import Frame

SAMPLE = "TILT_SAMPLE"


@lru_cache(maxsize=1)
def sample_layout() -> np.dtype[np.void]:
    """Return the payload of ``TILT_SAMPLE`` as a structured type; little-endian, no gaps."""
    kind = python_module().MAVLink_tilt_sample_message
    codes = kind.native_format.decode().lstrip("<")
    fields = zip(kind.ordered_fieldnames, codes, kind.array_lengths, strict=True)
    return np.dtype([(name, f"<{code}", (size,) if size else ()) for name, code, size in fields])


def payloads(frames: Sequence["Frame"]) -> np.ndarray[tuple[int], np.dtype[np.void]]:
    """Return the fields of some ``TILT_SAMPLE`` frames; zeros that MAVLink cut off are back."""
    layout = sample_layout()
    size = layout.itemsize
    parts = [
        frame.raw[HEADER_BYTES : HEADER_BYTES + min(frame.raw[1], size)].ljust(size, b"\0")
        for frame in frames
    ]
    return np.frombuffer(b"".join(parts), dtype=layout)


def trace_of(
    frames: Sequence["Frame"], axes: tuple[Axis, ...], *, hidden_words: int = 0
) -> AngleTrace:
    """Return the ``TILT_SAMPLE`` messages among `frames` as a trace.

    Parameters
    ----------
    axes
        Axes of the design.
    hidden_words
        Words of its filter's state beside the angles.
    """
    read = payloads([frame for frame in frames if frame.name == SAMPLE])
    columns = [read[axis][:, None] for axis in axes]
    states = np.hstack([*columns, read["hidden"][:, :hidden_words]])
    return AngleTrace(
        sequence=read["sequence"].astype(np.int64),
        time_us=read["time_usec"].astype(np.int64),
        accel_count=read["accel"].astype(np.int64),
        gyro_count=read["gyro"].astype(np.int64),
        state_raw=states.astype(np.int64),
        restarted=(read["flags"] & python_module().HOSTKIT_SAMPLE_RESTARTED) != 0,
        retuned=(read["flags"] & python_module().HOSTKIT_SAMPLE_RETUNED) != 0,
    )


def digest_of(frame: "Frame") -> str:
    """Return the design digest of a ``TILT_SAMPLE``, 12 hex digits."""
    return bytes(payloads([frame])["digest"][0]).hex()


def is_retuned(frame: "Frame") -> bool:
    """Tell whether a ``TILT_SAMPLE`` was made with other parameters than those of its design."""
    return bool(payloads([frame])["flags"][0] & python_module().HOSTKIT_SAMPLE_RETUNED)
