"""For which constants the particles of a rule settle: bounds, and errors that state them.

Each bound is for one particle in one dimension whose attractors stand still. Order one is about the
mean of its position, order two about the variance.
"""

import math

import numpy as np

from hostkit.errors import HostkitError

QPSO_LIMIT = math.exp(np.euler_gamma)
"""Contraction from which on a quantum-behaved particle's position is not bounded, 1.781."""


def velocity_order_one(weight: float) -> float:
    """Return the limit on c1 + c2 below which the mean settles: ``4 (1 + w) / 1`` for abs(w) < 1.

    References
    ----------
    I. C. Trelea, "The particle swarm optimization algorithm: convergence analysis and parameter
    selection", Information Processing Letters 85 (2003): with the mean pull (c1 + c2) / 2.
    """
    return 4.0 * (1.0 + weight)


def velocity_order_two(weight: float) -> float:
    """Return the limit on c1 + c2, with c1 = c2, below which the variance settles.

    References
    ----------
    R. Poli, "Mean and variance of the sampling distribution of particle swarm optimizers during
    stagnation", IEEE Trans. Evolutionary Computation 13(4), 2009.
    """
    return 24.0 * (1.0 - weight * weight) / (7.0 - 5.0 * weight)


def drift_spread(contraction: float, drift: float) -> float:
    """Return the factor on the mean square distance per move of a random-drift particle.

    With the mean best and the attractor at 0, ``X' = (1 - beta) X + alpha |X| Z``, hence
    ``E X'^2 = ((1 - beta)^2 + alpha^2) X^2``; it settles below 1.
    """
    return (1.0 - drift) ** 2 + contraction**2


def pull_spread(contraction: float, pull: float) -> float:
    """Return the same factor for the drift of the article form, with both pulls equal to c.

    With all attractors at 0, ``X' = (1 - c (r1 + r2)) X + alpha |X| Z``. The sum of the two even
    draws has the mean 1 and the variance 1/6, hence ``(1 - c)^2 + c^2 / 6 + alpha^2``.
    """
    return (1.0 - pull) ** 2 + pull**2 / 6.0 + contraction**2


def require_schedule(name: str, schedule: tuple[float, float], limit: float) -> None:
    """Refuse a schedule of contractions that is negative or reaches a limit.

    Raises
    ------
    HostkitError
        With the schedule and the limit.
    """
    if not all(0.0 <= value < limit for value in schedule):
        raise HostkitError(
            f"{name} = {schedule[0]:g} to {schedule[1]:g}: both ends must be in [0, {limit:.4g}), "
            "beyond which the swarm does not settle"
        )
