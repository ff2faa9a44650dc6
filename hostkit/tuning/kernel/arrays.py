"""What the kernel works on: streams, candidates, and the state that is carried over."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import Any, Protocol

import numpy as np
from numpy.typing import DTypeLike, NDArray

from hostkit.records import read_only

Vector = NDArray[np.float64]
Samples = NDArray[np.floating[Any]]

COLUMNS = (
    "drive",
    "start",
    "rate_step",
    "reference_step",
    "force_deviation",
    "reference",
)
"""Arrays of an `ErrorStream` with one value a sample."""

ETA, SCALE, OFFSET, GATE, INTEGRAL = range(5)
"""Rows of the table of candidates, as in ``kernel.c``."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ErrorStream:
    """One axis of a recording, or of a part of it, in error form.

    With w the rate, m the measured tilt, r the reference, f the specific force, dt the period:

    Attributes
    ----------
    drive, start
        ``w_k dt - (r_k - r_(k-1)) - (m_k - r_k)`` and ``m_k - r_k``, rad, shape ``(N,)``, float64
        or float32.
    rate_step, reference_step, force_deviation
        ``w_k dt`` and ``r_k - r_(k-1)``, rad, and ``| |f| - 1 g |`` in g, shape ``(N,)``; None
        where only eta is tuned.
    reference
        r, rad, shape ``(N,)``; None where it was not kept.
    runs
        Begin and end of each stretch that is scored, shape ``(R, 2)``.
    bias_limit_rad
        Largest bias times dt.
    """

    drive: Samples
    start: Samples
    runs: NDArray[np.int64]
    bias_limit_rad: float
    rate_step: Samples | None = None
    reference_step: Samples | None = None
    force_deviation: Samples | None = None
    reference: Samples | None = None
    handle: list[Any] = field(default_factory=list, init=False, repr=False, compare=False)
    """What the compiled kernel keeps of the stream between calls."""

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        for array in (self.runs, *self.columns):
            if array is not None:
                read_only(array)

    def __len__(self) -> int:
        return len(self.drive)

    @property
    def columns(self) -> tuple[Samples | None, ...]:
        """The arrays with one value a sample, in the order of `COLUMNS`."""
        return tuple(getattr(self, name) for name in COLUMNS)

    @property
    def dtype(self) -> np.dtype[Any]:
        """float64 or float32."""
        return self.drive.dtype

    @property
    def first_start(self) -> float:
        """First value of `start`."""
        return float(self.start[0])

    @property
    def scored(self) -> int:
        """Number of samples that are scored."""
        return count(self.runs)

    def blocks(self, number: int) -> Iterator[tuple["ErrorStream", ...]]:
        """Cut the stream into blocks of equal length, each in parts; here each is one part."""
        for begin, end in pairwise(edges(len(self), number)):
            yield (self if number == 1 else self.part(begin, end),)

    def scored_in_blocks(self, number: int) -> tuple[int, ...]:
        """Return how many samples of each block are scored."""
        return tuple(
            count(within(self.runs, begin, end))
            for begin, end in pairwise(edges(len(self), number))
        )

    def widened(self) -> "ErrorStream":
        """Return the stream in float64."""
        if self.dtype == np.float64:
            return self
        found = {
            name: None if array is None else array.astype(np.float64)
            for name, array in zip(COLUMNS, self.columns, strict=True)
        }
        return replace(self, **found)  # type: ignore[arg-type]

    def part(self, begin: int, end: int) -> "ErrorStream":
        """Return the samples of ``[begin, end)``, without a copy."""
        found = {
            name: None if array is None else array[begin:end]
            for name, array in zip(COLUMNS, self.columns, strict=True)
        }
        runs = within(self.runs, begin, end) - begin
        return replace(self, runs=runs, **found)  # type: ignore[arg-type]


class StreamSource(Protocol):
    """One axis of a recording, in memory or on disk."""

    def __len__(self) -> int:
        """Number of samples."""

    @property
    def dtype(self) -> np.dtype[Any]:
        """float64 or float32."""

    @property
    def first_start(self) -> float:
        """First value of `ErrorStream.start`."""

    @property
    def scored(self) -> int:
        """Number of samples that are scored."""

    def blocks(self, number: int) -> Iterator[Iterable[ErrorStream]]:
        """Cut the stream into blocks of equal length, each in parts that fit the memory."""

    def scored_in_blocks(self, number: int) -> tuple[int, ...]:
        """Return how many samples of each block are scored."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Candidates:
    """P sets of parameters for one axis.

    Attributes
    ----------
    table
        eta, 1 + gyro scale, tilt offset (rad), gate (g, infinite for none), ki dt^2: shape
        ``(5, P)``.
    bias_step_rad
        Gyroscope bias at the start times dt, shape ``(P,)``.
    plain
        Whether eta is the only parameter that is not neutral, so that the short recursion does.
    """

    table: Vector
    bias_step_rad: Vector
    plain: bool

    def __len__(self) -> int:
        return len(self.bias_step_rad)

    def one(self, index: int) -> "Candidates":
        """Return a single candidate."""
        part = slice(index, index + 1)
        return Candidates(
            table=np.ascontiguousarray(self.table[:, part]),
            bias_step_rad=self.bias_step_rad[part].copy(),
            plain=self.plain,
        )


@dataclass(slots=True, kw_only=True)
class Carry:
    """The state of every candidate between two parts of a recording, and its sums.

    Attributes
    ----------
    error, bias
        The state, each of shape ``(P,)``. The type of `error` is that of the arithmetic; it may be
        wider than that of the stream.
    sums
        Sums of squares or magnitudes, a row for each block, shape ``(blocks, P)``.
    """

    error: Samples
    bias: Samples
    sums: Vector

    @classmethod
    def before(
        cls,
        stream: StreamSource,
        candidates: Candidates,
        kind: DTypeLike = np.float64,
        blocks: int = 1,
    ) -> "Carry":
        """Return the state before the first sample, which loads the measured tilt."""
        bias = candidates.bias_step_rad.astype(kind)
        error = np.zeros(len(candidates), dtype=kind)
        if not candidates.plain:
            error = (stream.first_start - candidates.table[OFFSET] + bias).astype(kind)
        return cls(error=error, bias=bias, sums=np.zeros((blocks, len(candidates))))


def edges(samples: int, blocks: int) -> list[int]:
    """Return where blocks of equal length begin, and where the last one ends."""
    return [samples * i // blocks for i in range(blocks + 1)]


def count(runs: NDArray[np.int64]) -> int:
    """Return how many samples are in runs."""
    return int((runs[:, 1] - runs[:, 0]).sum())


def runs_of(scored: NDArray[np.bool_]) -> NDArray[np.int64]:
    """Return begin and end of the stretches that are true, shape ``(R, 2)``."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], scored, [False]])))
    return edges.reshape(-1, 2).astype(np.int64)


def within(runs: NDArray[np.int64], begin: int, end: int) -> NDArray[np.int64]:
    """Return the part of runs inside ``[begin, end)``, with the same origin."""
    cut = np.clip(runs, begin, end)
    return np.ascontiguousarray(cut[cut[:, 1] > cut[:, 0]])
