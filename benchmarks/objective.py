"""The cost of tau as peers see it: one call into compiled C, and a count of the calls."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize_scalar

from benchmarks.compiled import LANES, best_loop
from benchmarks.problems import stream_of
from hostkit.tuning.complementary.problem import Problem
from hostkit.tuning.complementary.space import RANGE_BY_NAME

Vector = NDArray[np.float64]

HIT_RAD = 1e-6
"""A search has hit where its cost is within this of the optimum."""

DENSE_POINTS = 20_001


@dataclass(frozen=True, slots=True, kw_only=True)
class Optimum:
    """The least cost over the whole range of tau."""

    tau_s: float
    cost_rad: float


def optimum(problem: Problem) -> Optimum:
    """Return the optimum: a dense grid in log tau, refined between the neighbours of the best."""
    low, high = problem.space.lower[0], problem.space.upper[0]
    grid = np.linspace(low, high, DENSE_POINTS)
    best = int(np.argmin(problem.cost(grid[:, np.newaxis])))
    fine = minimize_scalar(
        lambda x: float(problem.cost(np.array([[x]]))[0]),
        bounds=(grid[max(best - 1, 0)], grid[min(best + 1, DENSE_POINTS - 1)]),
        method="bounded",
        options={"xatol": 1e-12},
    )
    return Optimum(tau_s=math.exp(fine.x), cost_rad=float(fine.fun))


class TauCost:
    """The cost of one recording over tau, or over its logarithm, and what was asked of it.

    It does no more in Python than any optimiser must: the recursion is one call into compiled C
    with its arguments made once, for one point as for 32.

    Attributes
    ----------
    lower, upper
        The range, s or log s, shape ``(1,)``.
    evaluations
        Points asked for.
    hit_after
        Evaluations up to the first one that hit, or None.
    """

    def __init__(self, problem: Problem, best: Optimum, *, log: bool) -> None:
        stream = stream_of(problem)
        assert stream.scored == len(stream)
        span = RANGE_BY_NAME["tau"]
        ends = np.array([[span.lowest], [span.highest]])
        self.lower, self.upper = np.log(ends) if log else ends
        self.evaluations = 0
        self.hit_after: int | None = None
        self._log, self._target = log, best.cost_rad + HIT_RAD
        self._squared = problem.objective == "rmse"
        self._period_s, self._samples = problem.space.period_s, len(stream)
        self._eta = np.zeros(LANES)
        self._sums = best_loop().ways(stream, self._eta, problem.objective)[-1]

    def restart(self) -> None:
        """Forget what was asked."""
        self.evaluations, self.hit_after = 0, None

    def one(self, point: float) -> float:
        """Return the cost of one point, rad."""
        tau_s = math.exp(point) if self._log else point
        self._eta[0] = tau_s / (tau_s + self._period_s)
        cost = float(self._sums()[0]) / self._samples
        cost = math.sqrt(cost) if self._squared else cost
        self.evaluations += 1
        if self.hit_after is None and cost <= self._target:
            self.hit_after = self.evaluations
        return cost

    def point(self, x: Vector) -> float:
        """Return the cost of one point of shape ``(1,)``, rad."""
        return self.one(float(x[0]))

    def many(self, points: Vector) -> Vector:
        """Return the costs of points of shape ``(N, 1)``, N at most 32, rad, shape ``(N,)``."""
        number = len(points)
        x = points[:, 0]
        tau_s = np.exp(x) if self._log else x
        self._eta[:number] = tau_s / (tau_s + self._period_s)
        mean = self._sums()[:number] / self._samples
        costs = np.sqrt(mean) if self._squared else mean
        if self.hit_after is None and (hits := np.flatnonzero(costs <= self._target)).size:
            self.hit_after = self.evaluations + int(hits[0]) + 1
        self.evaluations += number
        return np.asarray(costs)
