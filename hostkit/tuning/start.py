"""Where a search starts: at the parameters of a design that was not tuned."""

import math
from collections.abc import Iterable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from hostkit.optimisers import SwarmResult
from hostkit.records import Parameter
from hostkit.tuning.dimension import Dimension
from hostkit.tuning.options import TuningOptions
from hostkit.tuning.search import on_bound, search
from hostkit.tuning.task import Space, Task

Vector = NDArray[np.float64]


def default_point(space: Space, parameters: Iterable[Parameter]) -> Vector:
    """Return parameters as a point of the search, shape ``(D,)``.

    What they have not is zero, or in the middle where logarithms are searched; what lies outside
    the box is moved onto it.
    """
    known = tuple(parameters)

    def coordinate(dimension: Dimension) -> float:
        value = next((p.value for p in known if p.name.startswith(f"{dimension.name}_")), 0.0)
        if not dimension.is_log:
            return value
        return math.log(value) if value > 0.0 else 0.5 * (dimension.lower + dimension.upper)

    points = np.array([coordinate(dimension) for dimension in space.dimensions])
    return np.asarray(np.clip(points, space.lower, space.upper))


def search_default(
    problem: Task, options: TuningOptions, optimiser: str, default: Iterable[Parameter]
) -> SwarmResult:
    """Find the least cost; where points are dear the default is the first of them.

    Searches over dear points may be short, and are then at least not worse than no search.

    Parameters
    ----------
    default
        The parameters of a design that was not tuned.

    Raises
    ------
    HostkitError
        If the cost is finite nowhere.
    """
    if not problem.is_dear:
        return search(problem, options, optimiser)
    start = default_point(problem.space, default)
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
        at_bound=on_bound(problem.space, start),
    )
