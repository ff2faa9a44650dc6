"""Velocity swarms whose inertia weight follows the search: DCWPSO and AWP.

Both compare costs by their ratio. They need costs of 0 or more, and behave differently when a
constant is added to the cost.
"""

import numpy as np
from numpy.typing import NDArray

from hostkit.optimisers.pso import PULL, require_velocity, velocity_move
from hostkit.optimisers.result import Cost, SwarmResult
from hostkit.optimisers.swarm import Move, Rule, Swarm, minimise_one

Vector = NDArray[np.float64]

NAME = "dcwpso"
TITLE = "velocity swarm, one weight that follows the search; cost of 0 or more"
AWP_NAME = "awp"
AWP_TITLE = "velocity swarm, a weight for each particle; cost of 0 or more"
WEIGHT = 0.9
PROGRESS_SHARE = 0.5
GATHERING_SHARE = 0.1


def rule(
    weight: float = WEIGHT,
    progress_share: float = PROGRESS_SHARE,
    gathering_share: float = GATHERING_SHARE,
    pull: float = PULL,
) -> Rule:
    """Return the rule with one weight for the whole swarm.

    Raises
    ------
    HostkitError
        If the first, the lowest or the standstill's weight is outside (-1, 1), or the pull does
        not fit it.
    """
    _check(weight, progress_share, gathering_share, pull)

    def move(swarm: Swarm, rng: np.random.Generator) -> Move:
        now = shared_weight(swarm, weight, progress_share, gathering_share)
        return velocity_move(swarm, now[:, :, np.newaxis], pull, rng)

    return Rule(move=move, starts_moving=True, no_negative_cost=True)


def awp_rule(
    weight: float = WEIGHT,
    progress_share: float = PROGRESS_SHARE,
    gathering_share: float = GATHERING_SHARE,
    pull: float = PULL,
) -> Rule:
    """Return the rule with a weight for each particle.

    Raises
    ------
    HostkitError
        As :func:`rule`.
    """
    _check(weight, progress_share, gathering_share, pull)

    def move(swarm: Swarm, rng: np.random.Generator) -> Move:
        shared = shared_weight(swarm, weight, progress_share, gathering_share)
        now = shared * particle_share(swarm)
        return velocity_move(swarm, now[:, :, np.newaxis], pull, rng)

    return Rule(move=move, starts_moving=True, no_negative_cost=True)


def shared_weight(
    swarm: Swarm, weight: float, progress_share: float, gathering_share: float
) -> Vector:
    """Return ``w - w_e e + w_s s``, shape ``(R, 1)``.

    e is the lower over the higher of the leader's last two costs: 1 where it did not improve. s is
    the lower over the higher of the leader's and the mean best cost: 1 where the swarm has
    gathered. Both are 0 at the first move, and 1 where both costs are 0.
    """
    if swarm.iteration == 1:
        return np.full_like(swarm.leader_cost, weight)
    progress = _ratio(swarm.leader_cost, swarm.former_leader_cost)
    gathering = _ratio(swarm.leader_cost, _mean_cost(swarm))
    return np.asarray(weight - progress_share * progress + gathering_share * gathering)


def particle_share(swarm: Swarm) -> Vector:
    """Return the excess of each best cost over the mean excess, shape ``(R, N)``.

    It is 1 on average, 0 for the leader, at most N, and 0 for all where the swarm has collapsed. A
    particle that had no finite cost yet gets N.
    """
    particles = swarm.best_cost.shape[1]
    with np.errstate(invalid="ignore"):
        mean_excess = _mean_cost(swarm) - swarm.leader_cost
        excess = swarm.best_cost - swarm.leader_cost
    spread = np.isfinite(mean_excess) & (mean_excess > 0.0)
    share = np.divide(excess, mean_excess, out=np.zeros_like(excess), where=spread)
    share = np.where(np.isfinite(swarm.best_cost), share, float(particles))
    return np.minimum(share, float(particles))


def _ratio(one: Vector, other: Vector) -> Vector:
    """Return the lower over the higher; 1 where both are 0 or both are infinite."""
    low, high = np.minimum(one, other), np.maximum(one, other)
    usable = np.isfinite(low) & (high > 0.0)
    return np.asarray(np.divide(low, high, out=np.ones_like(low), where=usable))


def _mean_cost(swarm: Swarm) -> Vector:
    """Return the mean of the finite best costs, infinity where there is none, ``(R, 1)``."""
    finite = np.isfinite(swarm.best_cost)
    count = finite.sum(axis=1, keepdims=True)
    total = np.where(finite, swarm.best_cost, 0.0).sum(axis=1, keepdims=True)
    return np.asarray(np.divide(total, count, out=np.full_like(total, np.inf), where=count > 0))


def _check(weight: float, progress_share: float, gathering_share: float, pull: float) -> None:
    """Check the first weight, the lowest, and that of a gathered swarm at a standstill."""
    standstill = weight - progress_share + gathering_share
    require_velocity((weight, weight - progress_share), pull)
    require_velocity((weight, standstill), pull)


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
    weight: float = WEIGHT,
    progress_share: float = PROGRESS_SHARE,
    gathering_share: float = GATHERING_SHARE,
    pull: float = PULL,
) -> SwarmResult:
    """Minimise `cost` over a box with a dynamically changing inertia weight (DCWPSO).

    The move is :func:`hostkit.optimisers.pso.velocity_move` with :func:`shared_weight`, which with
    the default constants starts at 0.9 and ends, once the swarm has gathered and stands still, at
    0.5: the edge up to which the variance settles with the pull 2.

    Parameters
    ----------
    cost, lower, upper, particles, iterations, rng, bounce, patience
        As in :func:`hostkit.optimisers.qpso.minimise`; the cost must not be negative.
    weight
        First weight.
    progress_share
        w_e, what the weight loses where the leader stands still; 0.4 to 0.6 is usual.
    gathering_share
        w_s, what it gains where the swarm has gathered; 0.05 to 0.15 is usual.
    pull
        c1 = c2, the strength of both attractors.

    Raises
    ------
    HostkitError
        As :func:`hostkit.optimisers.qpso.minimise` and :func:`rule`, and if a cost is negative.

    References
    ----------
    X. Zhang, Y. Du, G. Qin, Z. Qin, "Adaptive particle swarm algorithm with dynamically changing
    inertia weight", J. Xi'an Jiaotong University, 2005; as restated by the article on AWP.
    """
    return minimise_one(
        rule(weight, progress_share, gathering_share, pull),
        cost,
        lower,
        upper,
        particles=particles,
        iterations=iterations,
        rng=rng,
        bounce=bounce,
        patience=patience,
    )


def minimise_awp(
    cost: Cost,
    lower: Vector,
    upper: Vector,
    *,
    particles: int = 20,
    iterations: int = 100,
    rng: np.random.Generator,
    bounce: bool = True,
    patience: int | None = None,
    weight: float = WEIGHT,
    progress_share: float = PROGRESS_SHARE,
    gathering_share: float = GATHERING_SHARE,
    pull: float = PULL,
) -> SwarmResult:
    """Minimise `cost` over a box with a weight that differs from particle to particle (AWP).

    The weight is :func:`shared_weight` times :func:`particle_share`: the leader moves without
    inertia, and the worst particle can get N times the shared weight, which only the limit on the
    velocity holds. The published stop, a ratio of the leader's last two costs above 0.999999,
    fires at the first iteration that brings nothing new; use `patience` instead.

    Parameters
    ----------
    cost, lower, upper, particles, iterations, rng, bounce, patience
        As in :func:`hostkit.optimisers.qpso.minimise`; the cost must not be negative.
    weight, progress_share, gathering_share, pull
        As in :func:`minimise`.

    Raises
    ------
    HostkitError
        As :func:`minimise`.

    References
    ----------
    An article on DV-Hop localisation, which adds the share of each particle to DCWPSO.
    """
    return minimise_one(
        awp_rule(weight, progress_share, gathering_share, pull),
        cost,
        lower,
        upper,
        particles=particles,
        iterations=iterations,
        rng=rng,
        bounce=bounce,
        patience=patience,
    )
