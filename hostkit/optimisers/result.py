"""What every optimiser returns, and the cost function it takes."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hostkit.records import read_only

Vector = NDArray[np.float64]
Cost = Callable[[Vector], Vector]
"""Batch cost: points of shape ``(N, D)`` to costs of shape ``(N,)``."""


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
    """

    x: Vector
    cost: float
    history: Vector
    evaluations: int
    at_bound: NDArray[np.bool_]

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        for array in (self.x, self.history, self.at_bound):
            read_only(array)
