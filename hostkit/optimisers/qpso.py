"""Quantum-behaved particle swarm optimisation (QPSO)."""

import numpy as np
from numpy.typing import NDArray

from hostkit.errors import HostkitError
from hostkit.optimisers.result import Cost, SwarmResult

Vector = NDArray[np.float64]

NAME = "qpso"


def minimise(
    cost: Cost,
    lower: Vector,
    upper: Vector,
    *,
    particles: int = 20,
    iterations: int = 100,
    rng: np.random.Generator,
    contraction: tuple[float, float] = (0.9, 0.5),
) -> SwarmResult:
    """Minimise `cost` over a box with quantum-behaved particles.

    With P the personal bests, G the best of them, M their mean per dimension, and u, phi and the
    sign drawn anew for every particle and dimension, a position becomes::

        p = phi P + (1 - phi) G
        X = p +- alpha |M - X| ln(1 / u)

    where alpha falls linearly over the iterations. A position outside the box is mirrored back.
    These are equations 6 to 9 of Shi, He, Luo, He (2017) with their misprints mended: the weight
    phi of P, the schedule of alpha, the mean over particles, and the attractor p in place of P.

    Parameters
    ----------
    cost
        Batch function: points of shape ``(N, D)`` to costs of shape ``(N,)``. A cost that is not
        finite counts as infinitely bad.
    lower, upper
        Box bounds, each of shape ``(D,)``, in the units of the parameters.
    particles, iterations
        Size of the swarm, and number of moves after the initial swarm.
    rng
        Source of randomness. The caller seeds it, so a run can be repeated.
    contraction
        First and last value of alpha.

    Returns
    -------
    SwarmResult
        Best point and history; ``particles * (iterations + 1)`` evaluations.

    Raises
    ------
    HostkitError
        If the bounds are not finite or reversed, a count is below one, or no point of the whole
        search has a finite cost.

    References
    ----------
    J. Sun, B. Feng, W. Xu, "Particle swarm optimization with particles having quantum behavior",
    Proc. CEC 2004, pp. 325-331.
    """
    _check(lower, upper, particles, iterations)
    position = lower + (upper - lower) * rng.random((particles, len(lower)))
    best, best_cost = position.copy(), _finite_or_worst(cost(position))
    history = [float(best_cost.min())]
    for iteration in range(1, iterations + 1):
        alpha = _alpha(contraction, iteration, iterations)
        position = _reflect(_move(position, best, best_cost, alpha, rng), lower, upper)
        now = _finite_or_worst(cost(position))
        better = now < best_cost
        best[better], best_cost[better] = position[better], now[better]
        history.append(float(best_cost.min()))
    winner = int(np.argmin(best_cost))
    if not np.isfinite(best_cost[winner]):
        raise HostkitError("the cost is not finite at any point that the swarm visited")
    return SwarmResult(
        x=best[winner].copy(),
        cost=float(best_cost[winner]),
        history=np.array(history),
        evaluations=particles * (iterations + 1),
        at_bound=np.isclose(best[winner], lower, rtol=0.0, atol=1e-6 * (upper - lower))
        | np.isclose(best[winner], upper, rtol=0.0, atol=1e-6 * (upper - lower)),
    )


def _alpha(contraction: tuple[float, float], iteration: int, iterations: int) -> float:
    first, last = contraction
    return (first - last) * (1.0 - iteration / iterations) + last


def _move(
    position: Vector, best: Vector, best_cost: Vector, alpha: float, rng: np.random.Generator
) -> Vector:
    leader = best[int(np.argmin(best_cost))]
    phi = rng.random(position.shape)
    attractor = phi * best + (1.0 - phi) * leader
    reach = alpha * np.abs(best.mean(axis=0) - position)
    step = reach * np.log(1.0 / (1.0 - rng.random(position.shape)))
    sign = np.where(rng.random(position.shape) < 0.5, 1.0, -1.0)
    return np.asarray(attractor + sign * step)


def _reflect(position: Vector, lower: Vector, upper: Vector) -> Vector:
    """Mirror positions at the bounds until they are inside, in one step."""
    width = upper - lower
    offset = np.mod(position - lower, 2.0 * width)
    return lower + np.minimum(offset, 2.0 * width - offset)


def _finite_or_worst(cost: Vector) -> Vector:
    return np.where(np.isfinite(cost), cost, np.inf)


def _check(lower: Vector, upper: Vector, particles: int, iterations: int) -> None:
    if not (np.isfinite(lower).all() and np.isfinite(upper).all() and (lower < upper).all()):
        raise HostkitError(f"bounds {lower} to {upper}: each lower one must be below its upper one")
    if particles < 1 or iterations < 1:
        raise HostkitError(
            f"{particles} particles and {iterations} iterations: both must be at least 1"
        )
