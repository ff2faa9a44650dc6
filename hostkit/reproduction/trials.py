"""Optimisers on every group, over and over, each run judged against the group's exact optimum."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hostkit.optimisers import Cost, Rule, SwarmBatch, grid_brent, minimise_many
from hostkit.records import read_only
from hostkit.reproduction.errors import (
    Groups,
    eta_of,
    groups_of,
    one_training_cost_rad,
    test_rmse_rad,
)
from hostkit.reproduction.optimum import (
    TAU_BOUNDS_S,
    Optima,
    TauCost,
    find_optima,
    tau_cost,
)
from hostkit.reproduction.signals import GROUPS, DataClass, Logs, simulate_logs

Vector = NDArray[np.float64]

PARTICLES, ITERATIONS = 20, 100
HIT_RAD = 1e-6
"""A run misses where its training cost is higher than the optimum by more than this."""

AT_LOWER_BOUND = 1.0 + 1e-9


@dataclass(frozen=True, slots=True, kw_only=True)
class Setting:
    """How an optimiser searches.

    Attributes
    ----------
    name
        Of the rule.
    rule
        How the particles move.
    log_tau
        Whether it searches log tau or, as the paper, tau itself.
    bounce
        Whether particles are mirrored at the bounds or, as in paper mode, put onto them.
    """

    name: str
    rule: Rule
    log_tau: bool
    bounce: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class Material:
    """The groups that the trials of one data class run on: logs, groups and their optima."""

    kind: DataClass
    logs: Logs
    groups: Groups
    optima: Optima


@dataclass(frozen=True, slots=True, kw_only=True)
class Trial:
    """What one optimiser did on L logs of ten groups, S times each.

    Attributes
    ----------
    setting
        Which optimiser, and how it searched.
    tau_s, excess_rad, rmse_rad
        Result of every run, its training cost above the optimum, and its test error, each of shape
        ``(L, 10, S)``.
    excess_history_rad
        Training cost above the optimum over the iterations, ``(L, 10, S, T + 1)``.
    period_s
        Sample interval.
    """

    setting: Setting
    tau_s: Vector
    excess_rad: Vector
    rmse_rad: Vector
    excess_history_rad: Vector
    period_s: float

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        for array in (self.tau_s, self.excess_rad, self.rmse_rad, self.excess_history_rad):
            read_only(array)

    @property
    def missed(self) -> NDArray[np.bool_]:
        """Which runs missed the optimum, shape ``(L, 10, S)``."""
        return np.asarray(self.excess_rad > HIT_RAD)

    @property
    def miss_share(self) -> float:
        """Share of all runs that missed."""
        return float(np.mean(self.missed))

    @property
    def stuck_share(self) -> float:
        """Share of the misses that sit at the lower bound of tau; NaN without a miss."""
        stuck = self.tau_s[self.missed] <= TAU_BOUNDS_S[0] * AT_LOWER_BOUND
        return float(np.mean(stuck)) if stuck.size else float("nan")

    @property
    def eta_median(self) -> float:
        """Median eta of all runs."""
        return float(np.median(eta_of(self.tau_s, self.period_s)))

    def iterations_to_hit(self) -> Vector:
        """Return the iteration at which each run came within the limit; infinity for a miss."""
        inside = self.excess_history_rad <= HIT_RAD
        return np.where(inside.any(axis=-1), inside.argmax(axis=-1), np.inf)

    def row_rad(self) -> tuple[float, float, float]:
        """Return best, worst and mean test error of ten groups: the median over logs and runs."""
        groups = self.rmse_rad
        return (
            float(np.median(groups.min(axis=1))),
            float(np.median(groups.max(axis=1))),
            float(np.median(groups.mean(axis=1))),
        )

    def ratio_to(self, other: "Trial") -> Vector:
        """Return mean test error over that of another trial, per log and run, ``(L, S)``."""
        return np.asarray(self.rmse_rad.mean(axis=1) / other.rmse_rad.mean(axis=1))


def prepare(kind: DataClass, logs: int, rng: np.random.Generator) -> Material:
    """Simulate logs of one class and find the optimum of every group."""
    simulated = simulate_logs(kind, logs, rng)
    groups = groups_of(simulated)
    optima = find_optima(tau_cost(groups), len(groups))
    return Material(kind=kind, logs=simulated, groups=groups, optima=optima)


def run_trial(
    material: Material, setting: Setting, *, repeats: int, rng: np.random.Generator
) -> Trial:
    """Run one optimiser on every group `repeats` times."""
    groups, optima = material.groups.repeated(repeats), material.optima.repeated(repeats)
    swarm = search(tau_cost(groups), setting, runs=len(groups), rng=rng)
    tau_s = np.exp(swarm.x[:, 0]) if setting.log_tau else swarm.x[:, 0]
    shape = (len(material.groups) // GROUPS, GROUPS, repeats)
    history = swarm.history - optima.cost_rad[:, np.newaxis]
    rmse = test_rmse_rad(groups, eta_of(tau_s, groups.period_s))
    return Trial(
        setting=setting,
        tau_s=tau_s.reshape(shape),
        excess_rad=(swarm.cost - optima.cost_rad).reshape(shape),
        rmse_rad=rmse.reshape(shape),
        excess_history_rad=history.reshape((*shape, -1)),
        period_s=groups.period_s,
    )


def search(cost: TauCost, setting: Setting, *, runs: int, rng: np.random.Generator) -> SwarmBatch:
    """Run one swarm for each of `runs` problems, each with its cost of tau."""
    bounds = np.array(TAU_BOUNDS_S)

    def swarm_cost(points: Vector) -> Vector:
        return cost(np.exp(points[..., 0]) if setting.log_tau else points[..., 0])

    lower, upper = np.log(bounds) if setting.log_tau else bounds
    return minimise_many(
        setting.rule,
        swarm_cost,
        np.array([lower]),
        np.array([upper]),
        runs=runs,
        particles=PARTICLES,
        iterations=ITERATIONS,
        rng=rng,
        bounce=setting.bounce,
    )


def grid_brent_excess_rad(material: Material, rng: np.random.Generator) -> tuple[Vector, Vector]:
    """Return what a grid and Brent's search in log tau leave above the optimum.

    Parameters
    ----------
    material
        The groups; each is searched once.
    rng
        Of the shared signature of optimisers; nothing is drawn from it.

    Returns
    -------
    tuple of numpy.ndarray
        Training cost above the optimum, rad, and evaluations, each of shape ``(G,)``.
    """
    low, high = np.log(np.array([TAU_BOUNDS_S])).T
    excess, evaluations = np.empty(len(material.groups)), np.empty(len(material.groups))
    for i, optimum_rad in enumerate(material.optima.cost_rad):
        result = grid_brent.minimise(_log_tau_cost(material.groups, i), low, high, rng=rng)
        excess[i], evaluations[i] = result.cost - optimum_rad, result.evaluations
    return excess, evaluations


def _log_tau_cost(groups: Groups, index: int) -> Cost:
    drive, start = groups.drive[index].tolist(), groups.start[index].tolist()

    def cost(points: Vector) -> Vector:
        etas = eta_of(np.exp(points[:, 0]), groups.period_s).tolist()
        return np.array([one_training_cost_rad(drive, start, eta) for eta in etas])

    return cost
