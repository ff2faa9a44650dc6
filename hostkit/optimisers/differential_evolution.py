"""Differential evolution, scipy's: the peer that swarms of several parameters are held against."""

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import Bounds, minimize
from scipy.optimize import differential_evolution as scipy_evolution

from hostkit.errors import HostkitError
from hostkit.optimisers.box import Box
from hostkit.optimisers.recorder import Recorder
from hostkit.optimisers.result import Cost, SwarmResult

Vector = NDArray[np.float64]

NAME = "differential-evolution"
TITLE = "scipy's differential evolution, then a local polish"
LEAST_PARTICLES = 5
"""Below it scipy has not enough members to take differences of."""


def minimise(
    cost: Cost,
    lower: Vector,
    upper: Vector,
    *,
    particles: int = 20,
    iterations: int = 100,
    rng: np.random.Generator,
    bounce: bool = True,
    patience: int | None = None,
    polish: bool = True,
) -> SwarmResult:
    """Minimise `cost` over a box with scipy's differential evolution.

    Strategy ``best1bin`` with a mutation of 0.5 to 1 and a recombination of 0.7, scipy's own
    choice; the whole population is evaluated in one call per generation. It ends early only where
    all members have one cost. The polish is L-BFGS-B within the box.

    Parameters
    ----------
    cost, lower, upper
        As in :func:`hostkit.optimisers.qpso.minimise`.
    particles, iterations
        Size of the population, at least 5, evenly spread over the box at first, and most
        generations after it.
    rng
        Source of randomness.
    bounce
        Of the shared signature; scipy draws anew where a member leaves the box.
    patience
        Stop after so many generations in a row without a better member; None for never.
    polish
        Whether to end with a local search, which adds its own evaluations.

    Returns
    -------
    SwarmResult
        Its history has one entry for the first population, for each generation and for each
        evaluation of the polish.

    Raises
    ------
    HostkitError
        If the bounds are no box, the population has fewer than five members, a count is below one,
        or no cost is finite.

    References
    ----------
    R. Storn, K. Price, J. Global Optimization 11, 1997.
    """
    box = Box(lower=lower, upper=upper)
    _check(particles, iterations, patience)
    recorder = Recorder(cost=cost, box=box)
    scipy_evolution(
        _by_columns(recorder),
        Bounds(lower, upper),
        maxiter=iterations,
        init=box.scatter((particles,), rng),
        seed=rng,
        tol=0.0,
        polish=False,
        updating="deferred",
        vectorized=True,
        callback=_stop(recorder, patience),
    )
    if polish and np.isfinite(recorder.best_cost):
        minimize(recorder.single, recorder.best, method="L-BFGS-B", bounds=Bounds(lower, upper))
    return recorder.result()


def _by_columns(recorder: Recorder) -> Any:
    """Return the cost as scipy's vectorised call wants it: points ``(D, N)`` to costs ``(N,)``."""

    def cost(columns: Vector) -> Vector:
        return recorder.batch(np.ascontiguousarray(columns.T))

    return cost


def _stop(recorder: Recorder, patience: int | None) -> Any:
    """Return a callback that ends the search when the history has been level for a while."""

    def is_over(x: Vector, convergence: float = 0.0) -> bool:
        history = recorder.history
        if patience is None or len(history) <= patience:
            return False
        return not history[-1] < history[-1 - patience]

    return is_over


def _check(particles: int, iterations: int, patience: int | None) -> None:
    if particles < LEAST_PARTICLES:
        raise HostkitError(
            f"{particles} particles: differential evolution needs at least {LEAST_PARTICLES}"
        )
    if iterations < 1 or (patience is not None and patience < 1):
        raise HostkitError(f"{iterations} iterations, patience {patience}: each must be at least 1")
