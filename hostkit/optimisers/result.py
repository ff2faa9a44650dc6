"""What every optimiser returns, and the cost function it takes."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hostkit.records import read_only

Vector = NDArray[np.float64]
Cost = Callable[[Vector], Vector]
"""Batch cost: points of shape ``(N, D)`` to costs of shape ``(N,)``."""
ManyCost = Callable[[Vector], Vector]
"""Cost of many runs at once: points of shape ``(R, N, D)`` to costs of shape ``(R, N)``."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SwarmResult:
    """The best point found and how the search went.

    Attributes
    ----------
    x, cost
        Best point, shape ``(D,)``, and its cost.
    history
        Best cost after the initial swarm and after each iteration, shape ``(T + 1,)``.
    evaluations
        Points at which the cost was computed, the initial swarm included.
    at_bound
        Whether the best point lies on the box, per dimension, shape ``(D,)``.
    stopped_at
        Iterations that were done; less than planned where the search stopped early.
    """

    x: Vector
    cost: float
    history: Vector
    evaluations: int
    at_bound: NDArray[np.bool_]
    stopped_at: int

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        for array in (self.x, self.history, self.at_bound):
            read_only(array)


@dataclass(frozen=True, slots=True, kw_only=True)
class SwarmBatch:
    """The results of R independent runs.

    Attributes
    ----------
    x, cost
        Best point of each run, shape ``(R, D)``, and its cost, shape ``(R,)``.
    history
        Best cost after the initial swarm and after each iteration, shape ``(R, T + 1)``; constant
        from where a run stopped.
    evaluations
        Points of each run that counted, its initial swarm included, shape ``(R,)``.
    at_bound
        Whether the best point lies on the box, shape ``(R, D)``.
    stopped_at
        Iterations that each run did, shape ``(R,)``.
    """

    x: Vector
    cost: Vector
    history: Vector
    evaluations: NDArray[np.int64]
    at_bound: NDArray[np.bool_]
    stopped_at: NDArray[np.int64]

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        for array in (self.x, self.cost, self.history, self.evaluations, self.at_bound):
            read_only(array)
        read_only(self.stopped_at)

    def run(self, index: int) -> SwarmResult:
        """Return the result of one run."""
        stopped_at = int(self.stopped_at[index])
        return SwarmResult(
            x=self.x[index],
            cost=float(self.cost[index]),
            history=self.history[index, : stopped_at + 1],
            evaluations=int(self.evaluations[index]),
            at_bound=self.at_bound[index],
            stopped_at=stopped_at,
        )
