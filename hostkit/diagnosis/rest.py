"""Where a recording lies still, and what the sensor reads there."""

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from hostkit.recordings import Recording
from hostkit.recordings.recording import Vector
from hostkit.recordings.sanity.clipping import runs
from hostkit.recordings.sanity.standstill import MIN_WINDOWS, still_windows
from hostkit.units import STANDARD_GRAVITY_M_S2

MAX_STEP_S = 1.0
"""A longer time step ends a stretch; shorter ones are bursts or a few lost samples."""

Triple = tuple[float, float, float]


@dataclass(frozen=True, slots=True, kw_only=True)
class RestStretch:
    """One uninterrupted time at rest, in whole windows of about one second.

    Attributes
    ----------
    first, last
        Rows of its first and its last sample, counted from 0.
    begin_s, end_s
        Times of these samples.
    bias_rad_s
        Mean angular rate per axis.
    force_m_s2
        Magnitude of the mean specific force; 9.80665 for a calibrated sensor.
    """

    first: int
    last: int
    begin_s: float
    end_s: float
    bias_rad_s: Triple
    force_m_s2: float

    @property
    def duration_s(self) -> float:
        """Time from the first to the last sample."""
        return self.end_s - self.begin_s


@dataclass(frozen=True, slots=True, kw_only=True)
class Rest:
    """All stretches at rest.

    Attributes
    ----------
    stretches
        In order of time; empty if the sensor is never at rest.
    share
        Share of the samples that are at rest.
    bias_rad_s
        Mean angular rate per axis over all windows at rest; None without rest.
    bias_uncertainty_rad_s
        Standard error of that mean, from the spread of the windows' means.
    """

    stretches: tuple[RestStretch, ...]
    share: float
    bias_rad_s: Triple | None
    bias_uncertainty_rad_s: Triple | None

    @property
    def force_error(self) -> float | None:
        """Mean of the force at rest against gravity, relative; None without rest."""
        if not self.stretches:
            return None
        weights = [s.last - s.first + 1 for s in self.stretches]
        forces = [s.force_m_s2 for s in self.stretches]
        return float(np.average(forces, weights=weights)) / STANDARD_GRAVITY_M_S2 - 1.0

    @property
    def force_spread(self) -> float:
        """Largest less smallest force of the stretches, relative to gravity; 0 with one or none."""
        forces = [s.force_m_s2 for s in self.stretches]
        return (max(forces) - min(forces)) / STANDARD_GRAVITY_M_S2 if forces else 0.0


def rest(recording: Recording) -> Rest:
    """Return where a recording lies still.

    A window is at rest by the rules of the sanity card. Neighbouring windows form a stretch unless
    a time step of more than a second parts them. A single window in the whole recording is not
    taken for rest.
    """
    still, width = still_windows(recording)
    if np.count_nonzero(still) < MIN_WINDOWS:
        return Rest(stretches=(), share=0.0, bias_rad_s=None, bias_uncertainty_rad_s=None)
    means = _window_means(recording.angular_rate_rad_s, width)[still]
    error = np.std(means, axis=0, ddof=1) / math.sqrt(len(means))
    return Rest(
        stretches=tuple(
            _stretch(recording, first, last) for first, last in _spans(recording, still, width)
        ),
        share=float(np.count_nonzero(still)) * width / len(recording),
        bias_rad_s=_triple(means.mean(axis=0)),
        bias_uncertainty_rad_s=_triple(error),
    )


def _window_means(values: Vector, width: int) -> Vector:
    count = len(values) // width
    means: Vector = values[: count * width].reshape(count, width, 3).mean(axis=1)
    return means


def _spans(recording: Recording, still: NDArray[np.bool_], width: int) -> list[tuple[int, int]]:
    """Return first and last row of each stretch."""
    at_rest = np.repeat(still, width)
    broken = np.flatnonzero(np.diff(recording.time_s) > MAX_STEP_S)
    spans = []
    for start, length in zip(*(array.tolist() for array in runs(at_rest)), strict=True):
        inside = broken[(broken >= start) & (broken < start + length - 1)].tolist()
        edges = [start - 1, *inside, start + length - 1]
        spans += [(a + 1, b) for a, b in pairwise(edges)]
    return spans


def _stretch(recording: Recording, first: int, last: int) -> RestStretch:
    part = slice(first, last + 1)
    force = recording.specific_force_m_s2[part].mean(axis=0)
    return RestStretch(
        first=first,
        last=last,
        begin_s=float(recording.time_s[first]),
        end_s=float(recording.time_s[last]),
        bias_rad_s=_triple(recording.angular_rate_rad_s[part].mean(axis=0)),
        force_m_s2=float(np.linalg.norm(force)),
    )


def _triple(values: Vector) -> Triple:
    x, y, z = values.tolist()
    return x, y, z
