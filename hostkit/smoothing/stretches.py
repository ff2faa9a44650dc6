"""The even stretches of a recording: where its gaps are, and readings at even times."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from hostkit.smoothing.rotation import Array

LONGEST_GAP_S = 0.25
"""A longer step cuts the recording; in a shorter one the readings are interpolated and doubted."""
LONGEST_GAP_STEPS = 25
"""So is one of more periods: no file may ask for many more samples than it holds."""
MISSING = 1.5
"""A step of so many periods lacks samples."""
ROUNDING = 1e-3
"""Share of a period within which a point of the grid is a row."""
EVEN = 0.5
"""How far, in periods, the times of a stretch may be from a straight line to count as even."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Stretch:
    """Rows of a recording without a long gap, and the even times to smooth them at.

    Attributes
    ----------
    rows
        The rows.
    time_s
        Their times, shape ``(n,)``.
    grid_s
        Even times, shape ``(N,)``; the times of the rows themselves where those are even.
    period_s
        Step of the grid.
    doubted
        Grid points within a short gap, shape ``(N,)``.
    """

    rows: slice
    time_s: Array
    grid_s: Array
    period_s: float
    doubted: NDArray[np.bool_]

    @property
    def is_even(self) -> bool:
        """Return whether the grid is that of the rows."""
        return self.grid_s is self.time_s

    def at_grid(self, values: Array) -> Array:
        """Return values of the rows, shape ``(n, 3)``, at the even times."""
        return values if self.is_even else _interpolated(self.grid_s, self.time_s, values)

    def any_at_grid(self, flags: NDArray[np.bool_]) -> NDArray[np.bool_]:
        """Return which even times rest on a row that is flagged, flags of shape ``(n,)``."""
        if self.is_even:
            return flags
        return np.interp(self.grid_s, self.time_s, flags.astype(np.float64)) > 0.0

    def at_rows(self, up: Array) -> Array:
        """Return directions at the even times, shape ``(N, 3)``, at the times of the rows."""
        if self.is_even:
            return up
        between = _interpolated(self.time_s, self.grid_s, up)
        return np.asarray(between / np.linalg.norm(between, axis=1, keepdims=True))


def _interpolated(at_s: Array, time_s: Array, values: Array) -> Array:
    return np.stack([np.interp(at_s, time_s, column) for column in values.T], axis=1)


def stretches(time_s: Array) -> tuple[Stretch, ...]:
    """Cut a recording at its long gaps.

    Parameters
    ----------
    time_s
        Rising times, shape ``(N,)``.
    """
    period_s = float(np.median(np.diff(time_s)))
    longest_s = max(MISSING * period_s, min(LONGEST_GAP_S, LONGEST_GAP_STEPS * period_s))
    cuts = np.flatnonzero(np.diff(time_s) > longest_s) + 1
    edges = [0, *cuts.tolist(), len(time_s)]
    return tuple(_stretch(time_s, slice(a, b), period_s) for a, b in pairwise(edges))


def _stretch(time_s: Array, rows: slice, period_s: float) -> Stretch:
    own = time_s[rows]
    if _is_even(own, period_s):
        mean_s = float((own[-1] - own[0]) / (len(own) - 1)) if len(own) > 1 else period_s
        nothing = np.zeros(len(own), dtype=np.bool_)
        return Stretch(rows=rows, time_s=own, grid_s=own, period_s=mean_s, doubted=nothing)
    steps = np.diff(own)
    grid = own[0] + period_s * np.arange(int(np.ceil((own[-1] - own[0]) / period_s)) + 1)
    before = np.clip(np.searchsorted(own, grid, side="right") - 1, 0, len(steps) - 1)
    wide = steps > MISSING * period_s
    near_s = ROUNDING * period_s
    inside = wide[before] & (grid > own[before] + near_s) & (grid < own[before + 1] - near_s)
    return Stretch(rows=rows, time_s=own, grid_s=grid, period_s=period_s, doubted=inside)


def _is_even(time_s: Array, period_s: float) -> bool:
    if len(time_s) < 2:
        return True
    line = np.linspace(time_s[0], time_s[-1], len(time_s))
    near = np.abs(time_s - line).max() < EVEN * period_s
    return bool(near and np.diff(time_s).max() < MISSING * period_s)
