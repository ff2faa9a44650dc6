"""From bytes to MAVLink messages, with an account of what was lost on the way."""

import logging
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from hostkit.dialect import python_module
from hostkit.link.statistics import LinkStatistics
from hostkit.records import AngleTrace, Axis

Source = tuple[int, int]
"""System and component id of a sender."""

logging.getLogger("pymavlink").setLevel(logging.CRITICAL)

COLUMN: dict[Axis, str] = {"roll": "roll", "pitch": "pitch"}


@dataclass(frozen=True, slots=True, kw_only=True)
class Frame:
    """One message that arrived whole: its sender, its content, its bytes."""

    source: Source
    name: str
    message: Any
    raw: bytes


@dataclass(slots=True)
class Decoder:
    """A MAVLink 2 parser that counts.

    pymavlink reports an unknown message id without checking its checksum, so such a frame may be
    noise: it is counted and its sequence number is not used.
    """

    frames: int = 0
    lost_frames: int = 0
    bad: int = 0
    bad_bytes: int = 0
    unknown: int = 0
    _last: dict[Source, int] = field(default_factory=dict)
    _parser: Any = None

    def __post_init__(self) -> None:
        """Make the parser."""
        self._parser = python_module().MAVLink(None)
        self._parser.robust_parsing = True

    def feed(self, data: bytes) -> list[Frame]:
        """Return the messages that `data` completes; it may be any bytes at all."""
        messages = self._parser.parse_buffer(data) or []
        return [frame for message in messages if (frame := self._account(message)) is not None]

    def _account(self, message: Any) -> Frame | None:
        name = message.get_type()
        if name == "BAD_DATA":
            self.bad += 1
            self.bad_bytes += len(message.data)
            return None
        if name.startswith("UNKNOWN_"):
            self.unknown += 1
            return None
        source = (message.get_srcSystem(), message.get_srcComponent())
        sequence = message.get_seq()
        if source in self._last:
            self.lost_frames += (sequence - self._last[source] - 1) % 256
        self._last[source] = sequence
        self.frames += 1
        return Frame(source=source, name=name, message=message, raw=bytes(message.get_msgbuf()))

    def statistics(self) -> LinkStatistics:
        """Return the account so far."""
        return LinkStatistics(
            frames=self.frames,
            lost_frames=self.lost_frames,
            bad=self.bad,
            bad_bytes=self.bad_bytes,
            unknown=self.unknown,
        )


def trace_of(frames: list[Frame], axes: tuple[Axis, ...], *, hidden_words: int = 0) -> AngleTrace:
    """Return the ``TILT_SAMPLE`` messages among `frames` as a trace.

    Parameters
    ----------
    axes
        Axes of the design.
    hidden_words
        Words of its filter's state beside the angles.
    """
    samples = [frame.message for frame in frames if frame.name == "TILT_SAMPLE"]
    restarted_flag = python_module().HOSTKIT_SAMPLE_RESTARTED
    retuned_flag = python_module().HOSTKIT_SAMPLE_RETUNED
    states = [
        [*(getattr(m, COLUMN[axis]) for axis in axes), *m.hidden[:hidden_words]] for m in samples
    ]
    return AngleTrace(
        sequence=np.array([m.sequence for m in samples], dtype=np.int64),
        time_us=np.array([m.time_usec for m in samples], dtype=np.uint64).astype(np.int64),
        accel_count=np.array([m.accel for m in samples], dtype=np.int64).reshape(-1, 3),
        gyro_count=np.array([m.gyro for m in samples], dtype=np.int64).reshape(-1, 3),
        state_raw=np.array(states, dtype=np.int64).reshape(-1, len(axes) + hidden_words),
        restarted=np.array([bool(m.flags & restarted_flag) for m in samples], dtype=np.bool_),
        retuned=np.array([bool(m.flags & retuned_flag) for m in samples], dtype=np.bool_),
    )


def digest_of(frame: Frame) -> str:
    """Return the design digest of a ``TILT_SAMPLE``, 12 hex digits."""
    return bytes(frame.message.digest).hex()


def is_retuned(frame: Frame) -> bool:
    """Tell whether a ``TILT_SAMPLE`` was made with other parameters than those of its design."""
    return bool(frame.message.flags & python_module().HOSTKIT_SAMPLE_RETUNED)
