"""Whether the recordings determine what was tuned: bounds, flat directions, look-alikes."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hostkit.records import read_only
from hostkit.tuning.dimension import Dimension
from hostkit.tuning.task import Task

Vector = NDArray[np.float64]

PROFILE_POINTS = 41
FLAT_COST = 1.01
"""A cost within one per cent of the least is as good."""

FLAT_SHARE = 0.5
"""A parameter that is as good over half its range is not determined."""

EDGE_SHARE = 1e-3
"""Share of its range within which an optimum lies on a bound."""

ALIKE = 0.98
"""Correlation of two estimates from which on the parameters stand for each other."""

STEP = 0.02
"""Step of the differences as a share of the range, wide enough for the gate."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Interval:
    """A tuned parameter with the middle 95 % of its bootstrap, in the unit of a design."""

    dimension: Dimension
    value: float
    low: float | None = None
    high: float | None = None


def intervals(dimensions: tuple[Dimension, ...], x: Vector, again: Vector) -> tuple[Interval, ...]:
    """Return each parameter with its interval.

    Parameters
    ----------
    x
        Coordinates of the optimum, shape ``(D,)``.
    again
        Coordinates of the bootstrap's optima, shape ``(W, D)``; without any there is no interval.
    """
    found = []
    again = again[np.isfinite(again).all(axis=1)]
    for i, dimension in enumerate(dimensions):
        ends: tuple[float | None, float | None] = (None, None)
        if len(again):
            low, high = np.percentile(again[:, i], (2.5, 97.5))
            ends = dimension.value(float(low)), dimension.value(float(high))
        found.append(
            Interval(
                dimension=dimension, value=dimension.value(float(x[i])), low=ends[0], high=ends[1]
            )
        )
    return tuple(found)


@dataclass(frozen=True, slots=True, kw_only=True)
class Profile:
    """The cost along one parameter with the others held.

    Attributes
    ----------
    values
        The parameter over its range, in the unit of a design, shape ``(N,)``.
    cost_rad
        Cost there, shape ``(N,)``.
    """

    dimension: Dimension
    values: Vector
    cost_rad: Vector

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        read_only(self.values)
        read_only(self.cost_rad)


def profiles(problem: Task, x: Vector) -> tuple[Profile, ...]:
    """Walk along each parameter from an optimum, over its whole range.

    Parameters
    ----------
    x
        Coordinates of the optimum, shape ``(D,)``.
    """
    dimensions = problem.space.dimensions
    points = np.tile(x, (len(dimensions), PROFILE_POINTS, 1))
    for i, dimension in enumerate(dimensions):
        points[i, :, i] = np.linspace(dimension.lower, dimension.upper, PROFILE_POINTS)
    cost = problem.cost(points.reshape(-1, len(x))).reshape(len(dimensions), PROFILE_POINTS)
    return tuple(
        Profile(
            dimension=dimension,
            values=np.array([dimension.value(float(v)) for v in points[i, :, i]]),
            cost_rad=cost[i],
        )
        for i, dimension in enumerate(dimensions)
    )


def remarks(
    problem: Task, x: Vector, least_rad: float, walked: tuple[Profile, ...]
) -> tuple[str, ...]:
    """Say in sentences what about an optimum the recordings do not determine.

    Parameters
    ----------
    x, least_rad
        Coordinates of the optimum, shape ``(D,)``, and its cost.
    walked
        What :func:`profiles` gave.
    """
    flat = {profile.dimension.label: _flat_share(least_rad, profile) for profile in walked}
    open_ = {label for label, share in flat.items() if share > FLAT_SHARE}
    return (
        *_at_edge(problem, x),
        *(_flat(label, share) for label, share in flat.items() if label in open_),
        *_alike(problem, x, open_),
    )


def _at_edge(problem: Task, x: Vector) -> tuple[str, ...]:
    found = []
    for dimension, here in zip(problem.space.dimensions, x, strict=True):
        width = dimension.upper - dimension.lower
        for end, name in ((dimension.lower, "lower"), (dimension.upper, "upper")):
            if abs(here - end) <= EDGE_SHARE * width:
                found.append(
                    f"{dimension.label} lies on the {name} end of its range, "
                    f"{shown(dimension, end)}: the recordings ask for more than the range allows, "
                    "or do not determine it"
                )
    return tuple(found)


def _flat_share(least_rad: float, profile: Profile) -> float:
    """Return over which share of its range a parameter is as good as at the optimum."""
    return float(np.mean(profile.cost_rad <= FLAT_COST * least_rad))


def _flat(label: str, share: float) -> str:
    return (
        f"the recordings do not determine {label}: over {100 * share:.0f} % of its range the cost "
        f"stays within {100 * (FLAT_COST - 1):.0f} % of the least"
    )


def _alike(problem: Task, x: Vector, open_: set[str]) -> tuple[str, ...]:
    """Name the pairs whose estimates are nearly one: the correlation of the Gauss-Newton step.

    What the recordings do not determine has been named already, and goes along with anything.
    """
    dimensions = problem.space.dimensions
    inverse = np.linalg.pinv(_information(problem, x), rcond=1e-12, hermitian=True)
    spread = np.sqrt(np.clip(np.diag(inverse), 0.0, None))
    if len(dimensions) < 2 or not (np.isfinite(inverse).all() and (spread > 0.0).all()):
        return ()
    correlation = inverse / np.outer(spread, spread)
    return tuple(
        f"{dimensions[i].label} and {dimensions[j].label} stand for each other (correlation "
        f"{correlation[i, j]:+.2f}): fix one, or record more kinds of motion"
        for i in range(len(dimensions))
        for j in range(i)
        if abs(correlation[i, j]) > ALIKE and not open_ & {dimensions[i].label, dimensions[j].label}
    )


def _information(problem: Task, x: Vector) -> Vector:
    """Return the mean of J^T J, with J how the error follows each parameter, shape ``(D, D)``.

    Parameters are in shares of their range.
    """
    lower, upper = problem.space.lower, problem.space.upper
    step = STEP * (upper - lower)
    centre = np.clip(x, lower + step, upper - step)
    points = [centre + sign * row for row in np.diag(step) for sign in (1.0, -1.0)]
    total = np.zeros((len(x), len(x)))
    for recording in range(len(problem.lengths)):
        product, scored = np.zeros_like(total), 0
        for runs in zip(*(problem.errors(point, recording) for point in points), strict=True):
            mask = runs[0][0]
            error = np.array([errors[:, mask].ravel() for _, errors in runs])
            slope = (error[0::2] - error[1::2]) / (2.0 * STEP)
            product += slope @ slope.T
            scored += int(mask.sum())
        total += product / max(scored, 1)
    return total


def shown(dimension: Dimension, coordinate: float) -> str:
    """Return a coordinate as a value with its unit, as on the screen."""
    value, unit = dimension.shown(dimension.value(coordinate))
    return f"{value:.4g} {unit}".rstrip()
