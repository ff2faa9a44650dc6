"""When the samples were taken: steps, jitter and gaps."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hostkit.recordings import Recording
from hostkit.recordings.recording import Vector
from hostkit.recordings.sanity.time_findings import GAP_STEPS
from hostkit.records import read_only

BINS = 51
"""Odd, so that the median step is within a bin, not on an edge."""
MOST_GAPS = 20


@dataclass(frozen=True, slots=True, kw_only=True)
class Gap:
    """A time step that is too long: when it begins and how long it is, s."""

    begin_s: float
    length_s: float


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Timing:
    """The time steps of a recording.

    Attributes
    ----------
    least_s, median_s, most_s
        Shortest, median and longest step.
    jitter_s
        Standard deviation of the steps that are no gaps.
    edges_s, counts
        Histogram of the steps that are no gaps: edges from 0 to 2.5 median steps, shape
        ``(B + 1,)``, and steps per bin, shape ``(B,)``.
    gap_count
        Steps longer than 2.5 median steps.
    gaps
        The longest of them, at most 20, in order of time.
    """

    least_s: float
    median_s: float
    most_s: float
    jitter_s: float
    edges_s: Vector
    counts: NDArray[np.int64]
    gap_count: int
    gaps: tuple[Gap, ...]

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        read_only(self.edges_s)
        read_only(self.counts)


def timing(recording: Recording) -> Timing:
    """Return the time steps of a recording whose time rises."""
    steps_s = np.diff(recording.time_s)
    median_s = float(np.median(steps_s))
    regular = steps_s <= GAP_STEPS * median_s
    gaps = np.flatnonzero(~regular)
    longest = np.sort(gaps[np.argsort(steps_s[gaps])[-MOST_GAPS:]])
    counts, edges_s = np.histogram(steps_s[regular], BINS, (0.0, GAP_STEPS * median_s))
    return Timing(
        least_s=float(steps_s.min()),
        median_s=median_s,
        most_s=float(steps_s.max()),
        jitter_s=float(np.std(steps_s[regular])),
        edges_s=edges_s,
        counts=counts.astype(np.int64),
        gap_count=int(gaps.size),
        gaps=tuple(
            Gap(begin_s=float(recording.time_s[row]), length_s=float(steps_s[row]))
            for row in longest
        ),
    )
