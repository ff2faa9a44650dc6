"""Clipping: an axis that stays at its extreme, as a sensor does beyond its range."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hostkit.recordings.recording import Vector
from hostkit.units import RAD_PER_DEG, STANDARD_GRAVITY_M_S2

NARROWEST_GYRO_RAD_S = 30.0 * RAD_PER_DEG
NARROWEST_ACCEL_M_S2 = 1.2 * STANDARD_GRAVITY_M_S2
"""Extremes below these are within every sensor's range and are not clipping."""
MIN_RUN = 3
LONG_RUN = 6
MIN_PILE = 4.0
"""How many times more values are at the extreme than in a band twice as wide below it."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Wall:
    """How near to the extreme counts as being at it, and what makes a clip there.

    Attributes
    ----------
    width
        Relative distance from the extreme.
    runs
        Number of runs that are needed.
    factor
        The extreme must be this many times the narrowest range.
    """

    width: float
    runs: int
    factor: float


SHARP = Wall(width=2e-3, runs=2, factor=1.0)
"""Raw counts, or counts times a weight."""
BLURRED = Wall(width=1e-2, runs=5, factor=4.0)
"""After a calibration that mixes axes or follows temperature, the wall is no longer one value."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Clip:
    """One axis at one end of its range: the value it stays at, and for how much of the time."""

    axis: int
    value: float
    share: float
    row: int
    """First row, counted from 1, of the first run."""


def clips(values: Vector, narrowest: float) -> tuple[Clip, ...]:
    """Return where the columns of `values`, shape ``(N, 3)``, are clipped.

    An axis is clipped at an extreme of at least `narrowest` if it piles up there, as the peaks of
    a smooth motion do not, and stays there in runs of three samples: two runs (or one of six)
    within 0.2 % of the extreme, or five runs within 1 % of an extreme of four times `narrowest`.
    Where the recording repeats its values (it was written faster than the sensor measured), runs
    must be that many times longer.
    """
    found = (
        _clip(values[:, axis], axis, sign, narrowest) for axis in range(3) for sign in (1.0, -1.0)
    )
    return tuple(clip for clip in found if clip is not None)


def _clip(values: Vector, axis: int, sign: float, narrowest: float) -> Clip | None:
    outward = sign * values
    extreme = float(outward.max())
    held = _typical_hold(values)
    for wall in (SHARP, BLURRED):
        if extreme < wall.factor * narrowest:
            continue
        first = _first_stay(outward / extreme, wall, held)
        if first is not None:
            share = float(np.mean(outward >= (1.0 - wall.width) * extreme))
            return Clip(axis=axis, value=sign * extreme, share=share, row=first + 1)
    return None


def _first_stay(relative: Vector, wall: Wall, held: float) -> int | None:
    """Return where the first run at the wall starts, None if there is no clipping."""
    at_wall = relative >= 1.0 - wall.width
    below = (relative >= 1.0 - 3.0 * wall.width) & ~at_wall
    starts, lengths = runs(at_wall)
    stays = lengths >= MIN_RUN * held
    long = wall is SHARP and bool((lengths >= LONG_RUN * held).any())
    if np.count_nonzero(stays) < wall.runs and not long:
        return None
    if np.count_nonzero(at_wall) < MIN_PILE * np.count_nonzero(below):
        return None
    return int(starts[stays][0])


def runs(flags: NDArray[np.bool_]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return the first index and the length of each run of True."""
    edges = np.diff(np.concatenate(([0], flags.astype(np.int64), [0])))
    starts, ends = np.flatnonzero(edges == 1), np.flatnonzero(edges == -1)
    return starts, ends - starts


def _typical_hold(values: Vector) -> float:
    """Return how many rows, on average, a value is repeated."""
    return len(values) / (1.0 + np.count_nonzero(np.diff(values)))
