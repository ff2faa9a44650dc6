"""The exact optimum of every group: a dense grid, and finer ones around its lowest valleys.

Optimisers are judged against this and never against each other's best run.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hostkit.records import read_only
from hostkit.reproduction.errors import Groups, eta_of, training_cost_rad

Vector = NDArray[np.float64]

TAU_BOUNDS_S = (0.02, 100.0)
"""The paper's range of a particle, which can only be the time constant in seconds."""

GRID_POINTS = 1501
GRID_BLOCK = 300
VALLEYS = 4
"""Lowest local minima of the grid that are refined."""

ZOOM_POINTS = 41
ZOOMS = 8
ZOOM_FACTOR = 15.0

TauCost = Callable[[Vector], Vector]
"""Training costs of G problems, each at N time constants in seconds: ``(G, N)`` to ``(G, N)``."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Optima:
    """The lowest training cost of G groups.

    Attributes
    ----------
    tau_s, cost_rad
        Where it lies, and its value, each of shape ``(G,)``.
    valleys
        Local minima of the grid, shape ``(G,)``.
    """

    tau_s: Vector
    cost_rad: Vector
    valleys: NDArray[np.int64]

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        for array in (self.tau_s, self.cost_rad, self.valleys):
            read_only(array)

    def repeated(self, times: int) -> "Optima":
        """Return every optimum so many times, the copies side by side."""
        return Optima(
            tau_s=np.repeat(self.tau_s, times),
            cost_rad=np.repeat(self.cost_rad, times),
            valleys=np.repeat(self.valleys, times),
        )


def tau_cost(groups: Groups) -> TauCost:
    """Return the training cost as a function of tau, ``(G, N)`` to ``(G, N)``."""

    def cost(tau_s: Vector) -> Vector:
        return training_cost_rad(groups, eta_of(tau_s, groups.period_s))

    return cost


def pooled_cost(groups: Groups, pool: int) -> TauCost:
    """Return the mean training cost of every `pool` groups in a row, ``(G / pool, N)``."""
    cost = tau_cost(groups)

    def mean(tau_s: Vector) -> Vector:
        every = cost(np.repeat(tau_s, pool, axis=0))
        return np.asarray(every.reshape(-1, pool, tau_s.shape[1]).mean(axis=1))

    return mean


def find_optima(cost: TauCost, count: int) -> Optima:
    """Return the lowest cost of `count` problems within the paper's range of tau."""
    low, high = np.log(TAU_BOUNDS_S)
    grid = np.linspace(low, high, GRID_POINTS)
    costs = np.concatenate(
        [
            cost(np.tile(np.exp(grid[first : first + GRID_BLOCK]), (count, 1)))
            for first in range(0, GRID_POINTS, GRID_BLOCK)
        ],
        axis=1,
    )
    padded = np.pad(costs, ((0, 0), (1, 1)), constant_values=np.inf)
    is_valley = (costs < padded[:, :-2]) & (costs <= padded[:, 2:])
    lowest = np.argsort(np.where(is_valley, costs, np.inf), axis=1)[:, :VALLEYS]
    found = [_refined(cost, grid[lowest[:, i]], grid[1] - grid[0]) for i in range(VALLEYS)]
    log_tau, value = (np.stack([f[i] for f in found], axis=1) for i in (0, 1))
    winner = np.argmin(value, axis=1)[:, np.newaxis]
    return Optima(
        tau_s=np.exp(np.take_along_axis(log_tau, winner, axis=1)[:, 0]),
        cost_rad=np.take_along_axis(value, winner, axis=1)[:, 0],
        valleys=is_valley.sum(axis=1),
    )


def _refined(cost: TauCost, centre: Vector, reach: float) -> tuple[Vector, Vector]:
    """Return the lowest point near each centre, and its cost, by grids that close in."""
    rows = np.arange(len(centre))
    low, high = np.log(TAU_BOUNDS_S)
    for _ in range(ZOOMS):
        points = np.clip(
            centre[:, np.newaxis] + reach * np.linspace(-1.0, 1.0, ZOOM_POINTS), low, high
        )
        costs = cost(np.exp(points))
        best = np.argmin(costs, axis=1)
        centre, reach = points[rows, best], reach / ZOOM_FACTOR
    return centre, costs[rows, best]
