"""Quantum-behaved particle swarm optimisation (QPSO)."""

import numpy as np
from numpy.typing import NDArray

from hostkit.optimisers.result import Cost, SwarmResult
from hostkit.optimisers.stability import QPSO_LIMIT, require_schedule
from hostkit.optimisers.swarm import Move, Rule, Swarm, minimise_one

Vector = NDArray[np.float64]

NAME = "qpso"
TITLE = "quantum-behaved swarm, the tilt paper's rule"
CONTRACTION = (0.9, 0.5)
"""First and last contraction of the tilt paper."""


def rule(contraction: tuple[float, float] = CONTRACTION) -> Rule:
    """Return the rule for :func:`hostkit.optimisers.swarm.minimise_many`.

    Raises
    ------
    HostkitError
        If a contraction is negative or not below 1.781, where positions are not bounded (J. Sun,
        W. Fang, X. Wu, V. Palade, W. Xu, Evolutionary Computation 20(3), 2012).
    """
    require_schedule("contraction", contraction, QPSO_LIMIT)

    def move(swarm: Swarm, rng: np.random.Generator) -> Move:
        return _move(swarm, swarm.falling(*contraction), rng)

    return Rule(move=move)


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
    contraction: tuple[float, float] = CONTRACTION,
) -> SwarmResult:
    """Minimise `cost` over a box with quantum-behaved particles.

    With P the personal bests, G the best of them, M their mean per dimension, and u, phi and the
    sign drawn anew for every particle and dimension, a position becomes::

        p = phi P + (1 - phi) G
        X = p +- alpha |M - X| ln(1 / u)

    where alpha falls linearly over the iterations. These are equations 6 to 9 of Shi, He, Luo, He
    (2017) with their misprints mended: the weight phi of P, the schedule of alpha, the mean over
    particles, and the attractor p in place of P.

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
        Source of randomness. The caller seeds it, so a run can be repeated. It is asked for the
        initial swarm, then at every move for phi, u and the sign, each of the shape of the swarm.
    bounce
        Mirror a particle that leaves the box; otherwise put it onto the bound.
    patience
        Stop after so many iterations in a row without a better leader; None for never.
    contraction
        First and last value of alpha, each below 1.781.

    Returns
    -------
    SwarmResult
        Best point and history; ``particles * (iterations + 1)`` evaluations unless stopped early.

    Raises
    ------
    HostkitError
        If the bounds are not finite or reversed, a count is below one, a constant is outside its
        bound, the costs have the wrong shape, or none of the whole search is finite.

    References
    ----------
    J. Sun, B. Feng, W. Xu, "Particle swarm optimization with particles having quantum behavior",
    Proc. CEC 2004, pp. 325-331.
    """
    return minimise_one(
        rule(contraction),
        cost,
        lower,
        upper,
        particles=particles,
        iterations=iterations,
        rng=rng,
        bounce=bounce,
        patience=patience,
    )


def _move(swarm: Swarm, alpha: float, rng: np.random.Generator) -> Move:
    phi = rng.random(swarm.position.shape)
    attractor = phi * swarm.best + (1.0 - phi) * swarm.leader
    reach = alpha * np.abs(swarm.best.mean(axis=1, keepdims=True) - swarm.position)
    step = reach * np.log(1.0 / (1.0 - rng.random(swarm.position.shape)))
    sign = np.where(rng.random(swarm.position.shape) < 0.5, 1.0, -1.0)
    return Move(position=attractor + sign * step, velocity=swarm.velocity)
