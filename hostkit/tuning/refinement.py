"""An honest optimum for every fold where each cannot have a whole search of its own.

The points of an archive come from a search that saw all recordings. The best of them for a fold is
good on what it leaves out as well, by that choice alone: on public recordings its held-out error
was 1 to 3 % too small. A short search around it sees the fold's own recordings only. It ends near
the same cost there, and tells of other recordings what a whole search of its own would.
"""

from concurrent.futures import ThreadPoolExecutor

import numpy as np
from numpy.typing import NDArray

from hostkit.optimisers import OPTIMISERS
from hostkit.tuning.archive import ArchivedTask
from hostkit.tuning.options import TuningOptions
from hostkit.tuning.task import Task
from hostkit.tuning.weighting import weighted_cost

Vector = NDArray[np.float64]

PARTICLES = 8
"""As many as a compiled kernel takes at once."""

LEAST_MOVES, MOST_MOVES = 8, 20

NEAR = 0.03
"""How far an optimum is looked for, as a share of each range; in so small a box the few moves reach
the cost that they start from."""


def refined(problem: Task, weights: Vector, x: Vector, options: TuningOptions) -> Vector:
    """Search on around points of an archive, each on the recordings of its weights alone.

    It takes as long as the search itself at most, and nothing is done where that would be too few
    moves, or where the points come from searches of their own.

    Parameters
    ----------
    weights
        Weight of each block of each recording, shape ``(W, R, B)``.
    x
        Where to start, shape ``(W, D)``.

    Returns
    -------
    numpy.ndarray
        What was found, shape ``(W, D)``.
    """
    planned = options.particles * (options.iterations + 1)
    moves = min(planned // (len(weights) * PARTICLES) - 1, MOST_MOVES)
    if not isinstance(problem, ArchivedTask) or moves < LEAST_MOVES:
        return x
    alone = problem.task.with_jobs(1)

    def near(one: Vector, start: Vector) -> Vector:
        if not np.isfinite(start).all():
            return start
        return _near(alone, one, start, moves, np.random.default_rng(options.seed))

    with ThreadPoolExecutor(problem.jobs) as pool:
        return np.array(list(pool.map(near, weights, x)))


def _near(
    problem: Task, weights: Vector, start: Vector, moves: int, rng: np.random.Generator
) -> Vector:
    space, blocks = problem.space, weights.shape[1]
    counts, reach = problem.block_counts(blocks), NEAR * (space.upper - space.lower)

    def cost(points: Vector) -> Vector:
        error = weighted_cost(problem, problem.block_sums(points, blocks), counts, weights)
        return np.asarray(error * problem.preference(points))

    return (
        OPTIMISERS["qpso"]
        .minimise(
            cost,
            np.maximum(space.lower, start - reach),
            np.minimum(space.upper, start + reach),
            particles=PARTICLES,
            iterations=moves,
            rng=rng,
        )
        .x
    )
