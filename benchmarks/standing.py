"""How a search did over several seeds: how often it hit, after how many evaluations, how fast."""

import math
from collections.abc import Callable
from dataclasses import dataclass

from benchmarks.objective import HIT_RAD, Optimum, TauCost
from benchmarks.table import MISSING, figure
from benchmarks.timing import seconds
from hostkit.optimisers import SwarmResult

COLUMNS = (
    "method",
    "version",
    "runs",
    "hit rate",
    "evaluations to hit",
    "evaluations in all",
    "time / hostkit's swarm",
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Search:
    """One search: evaluations, those up to the first hit (infinite if none), and its time."""

    evaluations: int
    hit_after: float
    seconds: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Standing:
    """The searches of one method; none where it is missing.

    Attributes
    ----------
    beside
        As many searches of hostkit's swarm, taken in turns with these.
    scalar
        Whether the method is for one parameter only.
    """

    method: str
    version: str
    searches: tuple[Search, ...]
    beside: tuple[Search, ...]
    scalar: bool = False

    @property
    def hit_rate(self) -> float:
        """Share of the searches that hit."""
        return sum(math.isfinite(s.hit_after) for s in self.searches) / len(self.searches)

    @property
    def time_ratio(self) -> float:
        """Time of the fastest search over that of the fastest beside it."""
        return min(s.seconds for s in self.searches) / min(s.seconds for s in self.beside)

    def row(self) -> tuple[str, ...]:
        """Return its row of the table."""
        if not self.searches:
            return (self.method, "missing", "0", *([MISSING] * 4))
        hit_after = median(tuple(s.hit_after for s in self.searches))
        return (
            self.method,
            self.version,
            f"{len(self.searches)}",
            f"{self.hit_rate:.2f}",
            f"{hit_after:.0f}" if math.isfinite(hit_after) else "never",
            f"{median(tuple(float(s.evaluations) for s in self.searches)):.0f}",
            figure(self.time_ratio),
        )


def median(values: tuple[float, ...]) -> float:
    """Return the upper median: a miss counts as infinite, and is never averaged away."""
    return sorted(values)[len(values) // 2]


def of_cost(cost: TauCost, run: Callable[[], object]) -> Search:
    """Run a search on a cost that counts."""
    cost.restart()
    spent = seconds(run)
    hit_after = math.inf if cost.hit_after is None else float(cost.hit_after)
    return Search(evaluations=cost.evaluations, hit_after=hit_after, seconds=spent)


def of_result(run: Callable[[], SwarmResult], best: Optimum, per_step: int) -> Search:
    """Run one of hostkit's own searches, whose hit is known to the step.

    Parameters
    ----------
    per_step
        Evaluations of each step after the first.
    """
    found: list[SwarmResult] = []
    spent = seconds(lambda: found.append(run()))
    history, evaluations = found[0].history, found[0].evaluations
    return Search(
        evaluations=evaluations,
        hit_after=first_hit(history.tolist(), evaluations, per_step, best.cost_rad + HIT_RAD),
        seconds=spent,
    )


def first_hit(history: list[float], evaluations: int, per_step: int, target_rad: float) -> float:
    """Return the evaluations up to the first step at or below a cost, infinite if there is none."""
    for steps_left, cost in zip(reversed(range(len(history))), history, strict=True):
        if cost <= target_rad:
            return float(evaluations - per_step * steps_left)
    return math.inf
