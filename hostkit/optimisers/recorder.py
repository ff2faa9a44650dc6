"""A cost function that remembers: how often it was asked, and what was best."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from hostkit.errors import HostkitError
from hostkit.optimisers.box import Box
from hostkit.optimisers.result import Cost, SwarmResult

Vector = NDArray[np.float64]


@dataclass(slots=True, kw_only=True)
class Recorder:
    """Counts the evaluations of a cost and keeps the best point, whatever the caller keeps.

    A cost that is not finite counts as infinite.
    """

    cost: Cost
    box: Box
    evaluations: int = 0
    history: list[float] = field(default_factory=list)
    best: Vector = field(default_factory=lambda: np.empty(0))
    best_cost: float = np.inf

    def batch(self, points: Vector) -> Vector:
        """Return the costs of points ``(N, D)``: one step of the history."""
        costs = np.asarray(self.cost(points), dtype=np.float64)
        if costs.shape != (len(points),):
            raise HostkitError(
                f"the cost returned the shape {costs.shape} for {len(points)} points; it must "
                "return one number for each"
            )
        costs = np.where(np.isfinite(costs), costs, np.inf)
        self.evaluations += len(points)
        winner = int(np.argmin(costs))
        if costs[winner] < self.best_cost:
            self.best, self.best_cost = points[winner].copy(), float(costs[winner])
        self.history.append(self.best_cost)
        return costs

    def single(self, point: Vector) -> float:
        """Return the cost of one point ``(D,)``: one step of the history."""
        return float(self.batch(point[np.newaxis])[0])

    def result(self) -> SwarmResult:
        """Return what was found.

        Raises
        ------
        HostkitError
            If no cost was finite.
        """
        if not np.isfinite(self.best_cost):
            raise HostkitError("the cost is not finite at any point that was visited")
        return SwarmResult(
            x=self.best,
            cost=self.best_cost,
            history=np.array(self.history),
            evaluations=self.evaluations,
            at_bound=self.box.touches(self.best),
            stopped_at=len(self.history) - 1,
        )
