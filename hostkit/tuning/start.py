"""Where a search over dear points starts: at the parameters of a design that was not tuned."""

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from hostkit.optimisers import SwarmResult
from hostkit.optimisers.box import Box
from hostkit.tuning.dimension import Dimension
from hostkit.tuning.options import TuningOptions
from hostkit.tuning.search import search
from hostkit.tuning.task import Space, Task
from hostkit.tuning.tuner import Tuner

Vector = NDArray[np.float64]


def default_point(space: Space, tuner: Tuner) -> Vector:
    """Return the default as a point of the search, shape ``(D,)``.

    What it has not is zero, or lowest where logarithms are searched; what lies outside the box is
    moved onto it.
    """
    values = {p.name: p.value for p in tuner.default()}

    def coordinate(dimension: Dimension) -> float:
        value = values.get(tuner.key(dimension.name, dimension.axis), 0.0)
        if dimension.is_log:
            return math.log(value) if value > 0.0 else dimension.lower
        return value

    points = np.array([coordinate(dimension) for dimension in space.dimensions])
    return np.asarray(np.clip(points, space.lower, space.upper))


def search_from(
    problem: Task, options: TuningOptions, optimiser: str, start: Vector
) -> SwarmResult:
    """Find the least cost; what was there before counts, so that a short search does no harm.

    Parameters
    ----------
    start
        Point whose cost is computed first, shape ``(D,)``.

    Raises
    ------
    HostkitError
        If the cost is finite nowhere.
    """
    before = float(problem.cost(start[np.newaxis])[0])
    found = search(problem, options, optimiser)
    found = replace(found, evaluations=found.evaluations + 1)
    if not before < found.cost:
        return found
    return replace(
        found,
        x=start,
        cost=before,
        history=np.minimum(found.history, before),
        at_bound=Box(lower=problem.space.lower, upper=problem.space.upper).touches(start),
    )
