"""Tuning again with other weights: cross-validation and the bootstrap."""

import math
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from hostkit.optimisers import OPTIMISERS
from hostkit.tuning.archive import ArchivedTask
from hostkit.tuning.kernel.arrays import edges
from hostkit.tuning.options import TuningOptions
from hostkit.tuning.refinement import refined
from hostkit.tuning.task import Task
from hostkit.tuning.weighting import used, weighted_cost

Vector = NDArray[np.float64]

GRID_POINTS = 257
"""Points over one parameter; the optimum is read between them."""

MANY_RECORDINGS = 8
"""From so many on, recordings are what is drawn again; below, blocks of them."""

LEAST_UNITS = 16
"""Blocks that fewer recordings are cut into, all together."""

MOST_FOLDS = 20
"""Recordings beyond this number are left out several at a time."""

SINGLE_FOLDS = 5
"""Parts of a single recording that are left out in turn."""


@dataclass(frozen=True, slots=True, kw_only=True)
class HeldOut:
    """How a tuning does on what it was not tuned on.

    Attributes
    ----------
    unit
        What was left out in turn: whole recordings, or parts of a single one.
    folds
        Number of tunings.
    rms_rad
        Error while left out, RMSE of the axis or of the inclination: mean over recordings; of the
        parts of a single one the RMSE over all of them together, as that of the whole recording.
    each_rad
        That error one by one, in the order of the recordings or parts.
    """

    unit: Literal["recordings", "parts"]
    folds: int
    rms_rad: float
    each_rad: tuple[float, ...]


def cross_validate(problem: Task, options: TuningOptions) -> HeldOut:
    """Leave recordings out in turn, tune on the rest, and score on what was left out.

    With one recording its parts are left out in turn; the filter runs on through them.
    """
    recordings = len(problem.lengths)
    if recordings > 1:
        folds = min(recordings, MOST_FOLDS)
        fold_of = np.arange(recordings) % folds
        weights = (fold_of != np.arange(folds)[:, None]).astype(np.float64)[:, :, None]
        x = refined(problem, weights, retune(problem, weights, options), options)
        each = [problem.rms_rad(x[fold_of[r]], r) for r in range(recordings)]
        return _held_out("recordings", folds, each, np.ones(recordings), power=1)
    weights = 1.0 - np.eye(SINGLE_FOLDS)[:, None, :]
    x = refined(problem, weights, retune(problem, weights, options), options)
    cuts = edges(problem.lengths[0], SINGLE_FOLDS)
    each = [problem.rms_rad(x[i], 0, cuts[i], cuts[i + 1]) for i in range(SINGLE_FOLDS)]
    counts = problem.block_counts(SINGLE_FOLDS)[0].sum(axis=0)
    return _held_out("parts", SINGLE_FOLDS, each, counts, power=2)


def _held_out(
    unit: Literal["recordings", "parts"],
    folds: int,
    each: list[float],
    weights: Vector,
    *,
    power: int,
) -> HeldOut:
    """Average the errors that there are: their mean, or with power 2 the root of their squares'."""
    errors = np.array(each)
    scored = np.isfinite(errors) & (weights > 0.0)
    mean = math.nan
    if scored.any():
        mean = float(np.average(errors[scored] ** power, weights=weights[scored])) ** (1.0 / power)
    return HeldOut(unit=unit, folds=folds, rms_rad=mean, each_rad=tuple(each))


def bootstrap(problem: Task, options: TuningOptions) -> Vector:
    """Tune again on recordings, or blocks of few recordings, drawn with replacement.

    Blocks of one recording follow each other, so intervals from few recordings are rather too
    narrow.

    Returns
    -------
    numpy.ndarray
        Coordinates of each optimum, shape ``(resamples, D)``.

    References
    ----------
    B. Efron, "Bootstrap methods: another look at the jackknife", Annals of Statistics 7(1), 1979,
    pp. 1-26.
    """
    recordings = len(problem.lengths)
    blocks = 1 if recordings >= MANY_RECORDINGS else -(-LEAST_UNITS // recordings)
    units = recordings * blocks
    rng = np.random.default_rng(options.seed)
    drawn = rng.multinomial(units, np.full(units, 1.0 / units), size=options.resamples)
    weights = drawn.reshape(options.resamples, recordings, blocks).astype(np.float64)
    return retune(problem, weights, options)


def retune(problem: Task, weights: Vector, options: TuningOptions) -> Vector:
    """Tune once for each set of weights.

    Parameters
    ----------
    weights
        Weight of each block of each recording, shape ``(W, R, B)``.

    Returns
    -------
    numpy.ndarray
        Coordinates of each optimum, shape ``(W, D)``; NaN where no scored sample has weight.
    """
    space, blocks = problem.space, weights.shape[2]
    counts = problem.block_counts(blocks)
    if isinstance(problem, ArchivedTask):
        return _best_visited(problem, weights, counts)
    if len(space.dimensions) == 1:
        grid = np.linspace(space.lower[0], space.upper[0], GRID_POINTS)
        sums = problem.block_sums(grid[:, None], blocks)
        costs = [weighted_cost(problem, sums, counts, one) for one in weights]
        return np.array([_between(grid, cost) for cost in costs]).reshape(len(weights), 1)
    alone = problem.with_jobs(1)

    def swarm(one: Vector) -> Vector:
        if not used(counts, one).any():
            return np.full(len(space.dimensions), np.nan)

        def cost(points: Vector) -> Vector:
            return weighted_cost(alone, alone.block_sums(points, blocks), counts, one)

        return (
            OPTIMISERS["qpso"]
            .minimise(
                cost,
                space.lower,
                space.upper,
                particles=options.particles,
                iterations=options.iterations,
                rng=np.random.default_rng(options.seed),
            )
            .x
        )

    with ThreadPoolExecutor(problem.jobs) as pool:
        found = list(pool.map(swarm, weights))
    return np.array(found).reshape(len(weights), len(space.dimensions))


def _best_visited(problem: ArchivedTask, weights: Vector, counts: Vector) -> Vector:
    """Return the best of the points that a search visited, for each set of weights."""
    visited = problem.visited()
    sums = visited.in_blocks(weights.shape[2])
    preference = problem.preference(visited.points)
    found = np.full((len(weights), visited.points.shape[1]), np.nan)
    for i, one in enumerate(weights):
        cost = weighted_cost(problem, sums, counts, one) * preference
        if np.isfinite(cost).any():
            found[i] = visited.points[int(np.nanargmin(cost))]
    return found


def _between(grid: Vector, cost: Vector) -> float:
    """Return where the parabola through the least value and its neighbours is least."""
    if not np.isfinite(cost).any():
        return math.nan
    k = int(np.argmin(np.where(np.isfinite(cost), cost, np.inf)))
    if k in (0, len(grid) - 1):
        return float(grid[k])
    before, here, after = cost[k - 1 : k + 2]
    bend = before - 2.0 * here + after
    shift = 0.5 * (before - after) / bend if np.isfinite(bend) and bend > 0.0 else 0.0
    return float(grid[k] + shift * (grid[1] - grid[0]))
