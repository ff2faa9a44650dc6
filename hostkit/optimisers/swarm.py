"""The loop that all swarms share: a rule says how particles move, the rest is here.

What holds for every rule: a cost that is not finite counts as infinitely bad and is never
remembered; a particle's best is replaced by something strictly better only; the leader is the
first of the best; schedules run over the planned iterations even when a search stops early; and a
particle that leaves the box is mirrored back.

Notes
-----
*Patience* stops a run after so many iterations in a row without a better leader. It is off unless
asked for. Stopping rules in the literature compare the leader's cost with that of the iteration
before, which fires at the first iteration that brings nothing new, often within the first ten.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hostkit.errors import HostkitError
from hostkit.optimisers.box import Box
from hostkit.optimisers.result import Cost, ManyCost, SwarmBatch, SwarmResult

Vector = NDArray[np.float64]

VELOCITY_LIMIT = 0.5
"""Largest step of a rule with velocities, as a share of the width of the box."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Swarm:
    """What a rule sees before it moves the particles of R runs.

    Attributes
    ----------
    iteration, iterations
        Which move this is, from 1, and how many are planned.
    position, velocity, best
        Where the particles are, how they last moved, and where each was best, ``(R, N, D)``.
    best_cost
        Cost at `best`, shape ``(R, N)``; infinite where a particle had no finite cost yet.
    leader, leader_cost
        The best of `best`, shape ``(R, 1, D)``, and its cost, shape ``(R, 1)``.
    former_leader_cost
        The same one iteration earlier, shape ``(R, 1)``; NaN at the first move.
    velocity_limit
        Largest permitted step per dimension, shape ``(D,)``.
    """

    iteration: int
    iterations: int
    position: Vector
    velocity: Vector
    best: Vector
    best_cost: Vector
    leader: Vector
    leader_cost: Vector
    former_leader_cost: Vector
    velocity_limit: Vector

    def falling(self, first: float, last: float) -> float:
        """Return a value that falls evenly from `first`, before any move, to `last`."""
        return falling(first, last, self.iteration, self.iterations)


@dataclass(frozen=True, slots=True, kw_only=True)
class Move:
    """Where the particles go, box or not, and with what velocity, each of shape ``(R, N, D)``."""

    position: Vector
    velocity: Vector


@dataclass(frozen=True, slots=True, kw_only=True)
class Rule:
    """How one kind of swarm moves.

    Attributes
    ----------
    move
        From the swarm to its next positions. All its random numbers come from the generator.
    starts_moving
        Whether particles begin with random velocities, even within the limit, drawn after the
        initial positions; otherwise they begin at rest.
    no_negative_cost
        Whether the rule compares costs by their ratio, so that none may be below 0.
    """

    move: Callable[[Swarm, np.random.Generator], Move]
    starts_moving: bool = False
    no_negative_cost: bool = False


def falling(first: float, last: float, iteration: int, iterations: int) -> float:
    """Return a value that falls evenly from `first` at iteration 0 to `last` at the end."""
    return (first - last) * (1.0 - iteration / iterations) + last


def minimise_many(
    rule: Rule,
    cost: ManyCost,
    lower: Vector,
    upper: Vector,
    *,
    runs: int,
    particles: int = 20,
    iterations: int = 100,
    rng: np.random.Generator,
    bounce: bool = True,
    patience: int | None = None,
) -> SwarmBatch:
    """Run many independent searches of one rule side by side.

    Parameters
    ----------
    rule
        How the particles move, for example :func:`hostkit.optimisers.qpso.rule`.
    cost
        Points of shape ``(R, N, D)`` to costs of shape ``(R, N)``. Every run may have a cost of
        its own.
    lower, upper
        Box bounds, each of shape ``(D,)``, in the units of the parameters.
    runs, particles, iterations
        R, N and T: ``N (T + 1)`` evaluations for each run.
    rng
        Source of randomness for all runs.
    bounce
        Mirror a particle that leaves the box and turn its velocity round; otherwise put it onto
        the bound and leave the velocity, as the tilt paper's settings do.
    patience
        Stop a run after so many iterations in a row without a better leader; None for never. The
        cost of a stopped run is still asked for until all have stopped, but no longer counts.

    Raises
    ------
    HostkitError
        If the bounds are no box, a count is below one, the costs have the wrong shape, one is
        negative where the rule cannot have that, or a run found no finite cost at all.
    """
    _check(runs=runs, particles=particles, iterations=iterations, patience=patience)
    box = Box(lower=lower, upper=upper)
    position = box.scatter((runs, particles), rng)
    velocity = _first_velocity(rule, position, box, rng)
    memory = _Memory.of(position, _checked_cost(rule, cost, position))
    for iteration in range(1, iterations + 1):
        move = rule.move(memory.swarm(iteration, iterations, position, velocity, box), rng)
        if bounce:
            position, velocity = box.mirror(move.position, move.velocity)
        else:
            position, velocity = box.clip(move.position), move.velocity
        memory.keep(position, _checked_cost(rule, cost, position), patience)
        if not memory.searching.any():
            break
    return memory.batch(box)


def minimise_one(
    rule: Rule,
    cost: Cost,
    lower: Vector,
    upper: Vector,
    *,
    particles: int,
    iterations: int,
    rng: np.random.Generator,
    bounce: bool,
    patience: int | None,
) -> SwarmResult:
    """Run one search: :func:`minimise_many` with a single run and a cost ``(N, D) -> (N,)``."""

    def many(points: Vector) -> Vector:
        return np.asarray(cost(points[0]), dtype=np.float64)[np.newaxis]

    return minimise_many(
        rule,
        many,
        lower,
        upper,
        runs=1,
        particles=particles,
        iterations=iterations,
        rng=rng,
        bounce=bounce,
        patience=patience,
    ).run(0)


@dataclass(slots=True, kw_only=True)
class _Memory:
    """What the swarms remember: bests, leaders, and how the leaders' costs went."""

    best: Vector
    best_cost: Vector
    history: list[Vector]
    searching: NDArray[np.bool_]
    stopped_at: NDArray[np.int64]
    idle: NDArray[np.int64]

    @classmethod
    def of(cls, position: Vector, cost: Vector) -> "_Memory":
        runs = len(position)
        return cls(
            best=position.copy(),
            best_cost=cost.copy(),
            history=[cost.min(axis=1)],
            searching=np.ones(runs, dtype=np.bool_),
            stopped_at=np.zeros(runs, dtype=np.int64),
            idle=np.zeros(runs, dtype=np.int64),
        )

    def leaders(self) -> NDArray[np.int64]:
        """Return the first particle of lowest cost in every run, shape ``(R,)``."""
        return np.asarray(np.argmin(self.best_cost, axis=1))

    def swarm(
        self, iteration: int, iterations: int, position: Vector, velocity: Vector, box: Box
    ) -> Swarm:
        former = (
            self.history[-2] if len(self.history) > 1 else np.full_like(self.history[0], np.nan)
        )
        leader = self.best[np.arange(len(self.best)), self.leaders()]
        return Swarm(
            iteration=iteration,
            iterations=iterations,
            position=position,
            velocity=velocity,
            best=self.best,
            best_cost=self.best_cost,
            leader=leader[:, np.newaxis],
            leader_cost=self.history[-1][:, np.newaxis],
            former_leader_cost=former[:, np.newaxis],
            velocity_limit=VELOCITY_LIMIT * box.width,
        )

    def keep(self, position: Vector, cost: Vector, patience: int | None) -> None:
        """Remember what became better in the runs that still search."""
        better = (cost < self.best_cost) & self.searching[:, np.newaxis]
        np.copyto(self.best, position, where=better[:, :, np.newaxis])
        np.copyto(self.best_cost, cost, where=better)
        self.history.append(self.best_cost.min(axis=1))
        self.stopped_at += self.searching
        self.idle = np.where(self.history[-1] < self.history[-2], 0, self.idle + 1)
        if patience is not None:
            self.searching &= self.idle < patience

    def batch(self, box: Box) -> SwarmBatch:
        index = np.arange(len(self.best)), self.leaders()
        cost = self.best_cost[index]
        if not np.isfinite(cost).all():
            lost = int(np.sum(~np.isfinite(cost)))
            which = "" if len(cost) == 1 else f" in {lost} of {len(cost)} runs"
            raise HostkitError(f"the cost is not finite at any point that the swarm visited{which}")
        return SwarmBatch(
            x=self.best[index],
            cost=cost,
            history=np.stack(self.history, axis=1),
            evaluations=self.best.shape[1] * (self.stopped_at + 1),
            at_bound=box.touches(self.best[index]),
            stopped_at=self.stopped_at,
        )


def _first_velocity(rule: Rule, position: Vector, box: Box, rng: np.random.Generator) -> Vector:
    if not rule.starts_moving:
        return np.zeros_like(position)
    return VELOCITY_LIMIT * box.width * (2.0 * rng.random(position.shape) - 1.0)


def _checked_cost(rule: Rule, cost: ManyCost, position: Vector) -> Vector:
    """Return the costs, those that are not finite as infinity."""
    found = np.asarray(cost(position), dtype=np.float64)
    if found.shape != position.shape[:2]:
        raise HostkitError(
            f"the cost returned the shape {found.shape} for {position.shape[0]} runs of "
            f"{position.shape[1]} particles; it must return one number for each"
        )
    found = np.where(np.isfinite(found), found, np.inf)
    if rule.no_negative_cost and (found < 0.0).any():
        raise HostkitError(
            f"the cost is {found.min():g}, and this rule compares costs by their ratio: it needs "
            "costs of 0 or more. Add a constant, or take a rule that only compares, such as qpso"
        )
    return found


def _check(*, runs: int, particles: int, iterations: int, patience: int | None) -> None:
    if particles < 1 or iterations < 1 or runs < 1:
        raise HostkitError(
            f"{particles} particles, {iterations} iterations and {runs} runs: each must be at "
            "least 1"
        )
    if patience is not None and patience < 1:
        raise HostkitError(f"patience = {patience} iterations; it must be at least 1, or None")
