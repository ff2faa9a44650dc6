"""Particle swarm optimisation with velocities: constriction, and a linearly falling weight."""

import math

import numpy as np
from numpy.typing import NDArray

from hostkit.errors import HostkitError
from hostkit.optimisers.result import Cost, SwarmResult
from hostkit.optimisers.stability import velocity_order_one, velocity_order_two
from hostkit.optimisers.swarm import Move, Rule, Swarm, minimise_one

Vector = NDArray[np.float64]

NAME = "pso"
TITLE = "velocity swarm with constriction"
LDW_NAME = "ldwpso"
LDW_TITLE = "velocity swarm, inertia weight falling linearly"
PHI = 4.1
WEIGHT = (0.9, 0.4)
PULL = 2.0


def velocity_move(
    swarm: Swarm, weight: float | Vector, pull: float, rng: np.random.Generator
) -> Move:
    """Move particles with their velocity, a pull to their own best and one to the leader.

    ``V = w V + c r1 (P - X) + c r2 (G - X)``, limited to half the width of the box per dimension,
    then ``X = X + V`` (J. Kennedy, R. C. Eberhart, Proc. ICNN 1995).

    Parameters
    ----------
    weight
        w, a number or of shape ``(R, N, 1)``.
    pull
        c, the same for both attractors.
    """
    own, led = rng.random(swarm.position.shape), rng.random(swarm.position.shape)
    velocity = weight * swarm.velocity + pull * (
        own * (swarm.best - swarm.position) + led * (swarm.leader - swarm.position)
    )
    velocity = np.clip(velocity, -swarm.velocity_limit, swarm.velocity_limit)
    return Move(position=swarm.position + velocity, velocity=velocity)


def constriction(phi: float) -> float:
    """Return ``chi = 2 / |2 - phi - sqrt(phi^2 - 4 phi)|``, 0.7298 for phi 4.1.

    Raises
    ------
    HostkitError
        If phi is not above 4, or so near to it that the variance of a particle does not settle.

    References
    ----------
    M. Clerc, J. Kennedy, IEEE Trans. Evolutionary Computation 6(1), 2002.
    """
    if not 4.0 < phi < math.inf:
        raise HostkitError(f"phi = {phi:g}: constriction needs more than 4; usual is {PHI:g}")
    chi = 2.0 / abs(2.0 - phi - math.sqrt(phi * phi - 4.0 * phi))
    if chi * phi >= velocity_order_two(chi):
        raise HostkitError(
            f"phi = {phi:g} gives c1 + c2 = {chi * phi:.4g} at the weight {chi:.4g}, where the "
            f"variance of a particle settles below {velocity_order_two(chi):.4g} only; usual is "
            f"phi = {PHI:g}"
        )
    return chi


def rule(phi: float = PHI) -> Rule:
    """Return the rule with constriction.

    Raises
    ------
    HostkitError
        As :func:`constriction`.
    """
    chi = constriction(phi)
    pull = chi * phi / 2.0

    def move(swarm: Swarm, rng: np.random.Generator) -> Move:
        return velocity_move(swarm, chi, pull, rng)

    return Rule(move=move, starts_moving=True)


def ldw_rule(weight: tuple[float, float] = WEIGHT, pull: float = PULL) -> Rule:
    """Return the rule with a linearly falling weight.

    Raises
    ------
    HostkitError
        If a weight or the pull is outside the bound below which the mean settles.
    """
    require_velocity(weight, pull)

    def move(swarm: Swarm, rng: np.random.Generator) -> Move:
        return velocity_move(swarm, swarm.falling(*weight), pull, rng)

    return Rule(move=move, starts_moving=True)


def require_velocity(weight: tuple[float, float], pull: float) -> None:
    """Refuse weights of 1 and more, and a pull with which the mean does not settle at the end.

    Raises
    ------
    HostkitError
        With the values and the limit.
    """
    if not all(abs(value) < 1.0 for value in weight):
        raise HostkitError(f"weight = {weight[0]:g} to {weight[1]:g}: both must be in (-1, 1)")
    limit = velocity_order_one(min(weight)) / 2.0
    if not 0.0 < pull < limit:
        raise HostkitError(
            f"pull = {pull:g}: with the weight {min(weight):g} it must be in (0, {limit:.4g}), "
            "beyond which particles do not settle even on average"
        )


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
    phi: float = PHI,
) -> SwarmResult:
    """Minimise `cost` over a box with a constricted velocity swarm.

    The weight is ``chi`` and both pulls are ``chi phi / 2``, see :func:`constriction` and
    :func:`velocity_move`. With phi 4.1 that is 0.7298 and 1.49618, where the variance of a particle
    settles too. First velocities are random, even within the limit.

    Parameters
    ----------
    cost, lower, upper, particles, iterations, rng, bounce, patience
        As in :func:`hostkit.optimisers.qpso.minimise`. A velocity is turned round by a bounce.
    phi
        Sum of both pulls before constriction, above 4.

    Raises
    ------
    HostkitError
        As :func:`hostkit.optimisers.qpso.minimise` and :func:`constriction`.
    """
    return minimise_one(
        rule(phi),
        cost,
        lower,
        upper,
        particles=particles,
        iterations=iterations,
        rng=rng,
        bounce=bounce,
        patience=patience,
    )


def minimise_ldw(
    cost: Cost,
    lower: Vector,
    upper: Vector,
    *,
    particles: int = 20,
    iterations: int = 100,
    rng: np.random.Generator,
    bounce: bool = True,
    patience: int | None = None,
    weight: tuple[float, float] = WEIGHT,
    pull: float = PULL,
) -> SwarmResult:
    """Minimise `cost` over a box with a velocity swarm whose weight falls linearly.

    With the pull 2 the variance settles only for weights between 1/3 and 1/2, so at 0.9 to 0.4 it
    contracts in the last fifth of the planned iterations.

    Parameters
    ----------
    cost, lower, upper, particles, iterations, rng, bounce, patience
        As in :func:`hostkit.optimisers.qpso.minimise`. A velocity is turned round by a bounce.
    weight
        First and last weight of the velocity.
    pull
        c1 = c2, the strength of both attractors.

    Raises
    ------
    HostkitError
        As :func:`hostkit.optimisers.qpso.minimise` and :func:`require_velocity`.

    References
    ----------
    Y. Shi, R. C. Eberhart, "Empirical study of particle swarm optimization", Proc. CEC 1999.
    """
    return minimise_one(
        ldw_rule(weight, pull),
        cost,
        lower,
        upper,
        particles=particles,
        iterations=iterations,
        rng=rng,
        bounce=bounce,
        patience=patience,
    )
