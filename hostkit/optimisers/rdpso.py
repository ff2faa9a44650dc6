"""Random-drift particle swarm optimisation (RDPSO), in two forms."""

import math

import numpy as np
from numpy.typing import NDArray

from hostkit.errors import HostkitError
from hostkit.optimisers.result import Cost, SwarmResult
from hostkit.optimisers.stability import drift_spread, pull_spread, require_schedule
from hostkit.optimisers.swarm import Move, Rule, Swarm, minimise_one

Vector = NDArray[np.float64]

NAME = "rdpso"
TITLE = "random-drift swarm"
ARTICLE_NAME = "rdpso-article"
ARTICLE_TITLE = "random-drift swarm with the pulls of the magnetometer article"
CONTRACTION = (0.9, 0.3)
DRIFT = 1.45
ARTICLE_PULL = 1.45
STEEPNESS = 10.0
"""Of the S-curve: how much of the fall lies in the middle of the run."""


def rule(contraction: tuple[float, float] = CONTRACTION, drift: float = DRIFT) -> Rule:
    """Return the rule with a drift to one attractor.

    Raises
    ------
    HostkitError
        If the last contraction and the drift are outside the bound
        ``(1 - beta)^2 + alpha^2 < 1``, so that the swarm would never contract.
    """
    require_schedule("contraction", contraction, math.inf)
    spread = drift_spread(contraction[1], drift)
    if not spread < 1.0:
        raise HostkitError(
            f"drift = {drift:g} with the last contraction {contraction[1]:g}: "
            f"(1 - drift)^2 + contraction^2 = {spread:.4g} must be below 1, or the swarm never "
            f"contracts; {CONTRACTION[1]:g} and {DRIFT:g} give "
            f"{drift_spread(CONTRACTION[1], DRIFT):.4g}"
        )

    def move(swarm: Swarm, rng: np.random.Generator) -> Move:
        random = _random(swarm, swarm.falling(*contraction), rng)
        own, led = _weights(swarm, rng)
        phi = own / (own + led)
        attractor = phi * swarm.best + (1.0 - phi) * swarm.leader
        return _limited(swarm, random + drift * (attractor - swarm.position))

    return Rule(move=move)


def article_rule(
    contraction: tuple[float, float] = CONTRACTION, pull: float = ARTICLE_PULL
) -> Rule:
    """Return the rule with a pull to each attractor.

    Raises
    ------
    HostkitError
        If the last contraction and the pull are outside the bound
        ``(1 - c)^2 + c^2 / 6 + alpha^2 < 1``, so that the swarm would never contract.
    """
    require_schedule("contraction", contraction, math.inf)
    _require_pull(contraction[1], pull)

    def move(swarm: Swarm, rng: np.random.Generator) -> Move:
        random = _random(swarm, s_curve(contraction, swarm.iteration, swarm.iterations), rng)
        own, led = _weights(swarm, rng)
        towards = own * (swarm.best - swarm.position) + led * (swarm.leader - swarm.position)
        return _limited(swarm, random + pull * towards)

    return Rule(move=move)


def s_curve(contraction: tuple[float, float], iteration: int, iterations: int) -> float:
    """Return ``a1 + (a0 - a1) / (1 + exp(10 (t / T - 1/2)))``, the article's falling S-curve."""
    first, last = contraction
    return last + (first - last) / (1.0 + math.exp(STEEPNESS * (iteration / iterations - 0.5)))


def _require_pull(contraction: float, pull: float) -> None:
    still = pull_spread(0.0, pull)
    spread = pull_spread(contraction, pull)
    if still < 1.0 and spread < 1.0:
        return
    fit = (
        f"with this pull a contraction below {math.sqrt(1.0 - still):.4g} would fit"
        if still < 1.0
        else "a pull must be above 0 and below 12/7 = 1.714 even without contraction"
    )
    raise HostkitError(
        f"pull = {pull:g} with the last contraction {contraction:g}: (1 - pull)^2 + pull^2 / 6 + "
        f"contraction^2 = {spread:.4g} must be below 1, or the swarm never contracts; {fit}"
    )


def _random(swarm: Swarm, alpha: float, rng: np.random.Generator) -> Vector:
    reach = np.abs(swarm.best.mean(axis=1, keepdims=True) - swarm.position)
    return np.asarray(alpha * reach * rng.standard_normal(swarm.position.shape))


def _weights(swarm: Swarm, rng: np.random.Generator) -> tuple[Vector, Vector]:
    """Return two draws in (0, 1], whose sum is never 0."""
    return 1.0 - rng.random(swarm.position.shape), 1.0 - rng.random(swarm.position.shape)


def _limited(swarm: Swarm, velocity: Vector) -> Move:
    velocity = np.clip(velocity, -swarm.velocity_limit, swarm.velocity_limit)
    return Move(position=swarm.position + velocity, velocity=velocity)


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
    drift: float = DRIFT,
) -> SwarmResult:
    """Minimise `cost` over a box with randomly drifting particles.

    With P, G and M as in :func:`hostkit.optimisers.qpso.minimise`, Z normal, r1 and r2 even draws::

        p = phi P + (1 - phi) G,   phi = r1 / (r1 + r2)
        X = X + alpha |M - X| Z + beta (p - X)

    where alpha falls linearly. A step is limited to half the width of the box; it is not
    remembered. The mean square distance contracts where ``(1 - beta)^2 + alpha^2 < 1``: for beta
    1.45 below alpha 0.893, nearly the whole schedule.

    Parameters
    ----------
    cost, lower, upper, particles, iterations, rng, bounce, patience
        As in :func:`hostkit.optimisers.qpso.minimise`.
    contraction
        First and last alpha.
    drift
        beta.

    Raises
    ------
    HostkitError
        As :func:`hostkit.optimisers.qpso.minimise`, and if even the last contraction is outside
        the bound.

    References
    ----------
    J. Sun, V. Palade, X. Wu, W. Fang, Z. Wang, IEEE Trans. Industrial Informatics 10(1), 2014.
    """
    return minimise_one(
        rule(contraction, drift),
        cost,
        lower,
        upper,
        particles=particles,
        iterations=iterations,
        rng=rng,
        bounce=bounce,
        patience=patience,
    )


def minimise_article(
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
    pull: float = ARTICLE_PULL,
) -> SwarmResult:
    """Minimise `cost` over a box with the drift that the magnetometer article states.

    The drift is ``c r1 (P - X) + c r2 (G - X)`` in place of ``beta (p - X)``, and alpha follows an
    S-curve. The article's constants did not survive; these are ours. The mean square distance
    contracts where ``(1 - c)^2 + c^2 / 6 + alpha^2 < 1``: c 1.45 needs alpha below 0.669, which the
    schedule passes at 46 % of the run; c 1.5 needs 0.612, and the usual c 2 of velocity swarms
    settles at no alpha.

    Parameters
    ----------
    cost, lower, upper, particles, iterations, rng, bounce, patience
        As in :func:`hostkit.optimisers.qpso.minimise`.
    contraction
        First and last alpha.
    pull
        c, the same for both attractors.

    Raises
    ------
    HostkitError
        As :func:`hostkit.optimisers.qpso.minimise`, and if the constants are outside the bound.

    References
    ----------
    Yuan, Wang, Chen (2018), on the calibration of a magnetometer.
    """
    return minimise_one(
        article_rule(contraction, pull),
        cost,
        lower,
        upper,
        particles=particles,
        iterations=iterations,
        rng=rng,
        bounce=bounce,
        patience=patience,
    )
