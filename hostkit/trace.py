"""The trace of a device: what it said of its samples, and of its filter's state."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from hostkit.records import read_only


@dataclass(frozen=True, slots=True, kw_only=True)
class ToldState:
    """The hidden words that a device told of its state after one sample.

    Attributes
    ----------
    sequence
        Counter of that sample.
    words_raw
        The words, in the order of the spec.
    behind
        How many samples of its trace came before it.
    """

    sequence: int
    words_raw: tuple[int, ...]
    behind: int = 0


@dataclass(frozen=True, slots=True, kw_only=True)
class AngleTrace:
    """What a device said, sample by sample.

    Attributes
    ----------
    sequence
        Sample counter of the device, shape ``(N,)``; a gap is a lost sample.
    time_us
        Device time of the sample, shape ``(N,)``.
    accel_count, gyro_count
        Raw counts in sensor axes, shape ``(N, 3)``.
    state_raw
        State of the filter after the sample, shape ``(N, S)``: the angles of the design's axes in
        half turns, then the hidden words; the angles only, shape ``(N, A)``, of a filter that
        tells its state in messages of their own.
    restarted
        True where the filter loaded the measured tilt instead of stepping, shape ``(N,)``.
    retuned
        True where the device says that a parameter in use is not the design's, shape ``(N,)``;
        None where nothing says so.
    told
        States that the device told beside its samples, in the order in which they came; their
        samples may be others than those of this trace.
    """

    sequence: NDArray[np.int64]
    time_us: NDArray[np.int64]
    accel_count: NDArray[np.int64]
    gyro_count: NDArray[np.int64]
    state_raw: NDArray[np.int64]
    restarted: NDArray[np.bool_]
    retuned: NDArray[np.bool_] | None = None
    told: tuple[ToldState, ...] = ()

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        for array in (self.sequence, self.time_us, self.accel_count, self.gyro_count):
            read_only(array)
        read_only(self.state_raw)
        read_only(self.restarted)
        if self.retuned is not None:
            read_only(self.retuned)

    def __len__(self) -> int:
        return len(self.sequence)

    def part(self, which: slice | NDArray[np.bool_]) -> "AngleTrace":
        """Return some of the samples: a stretch with what was told in it, or a selection."""
        if isinstance(which, slice):
            begin, end, _ = which.indices(len(self))
            first = 0 if begin == 0 else begin + 1
            told = [state for state in self.told if first <= state.behind <= end]
            before = np.maximum(np.arange(len(self) + 1) - begin, 0)
        else:
            told, before = list(self.told), np.concatenate(([0], np.cumsum(which)))
        return AngleTrace(
            sequence=self.sequence[which],
            time_us=self.time_us[which],
            accel_count=self.accel_count[which],
            gyro_count=self.gyro_count[which],
            state_raw=self.state_raw[which],
            restarted=self.restarted[which],
            retuned=None if self.retuned is None else self.retuned[which],
            told=tuple(replace(state, behind=int(before[state.behind])) for state in told),
        )
