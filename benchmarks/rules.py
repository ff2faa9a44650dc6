"""All swarm rules of hostkit: how often they hit the optimum of one parameter."""

from collections.abc import Iterator

import numpy as np

from benchmarks.objective import HIT_RAD, TauCost, optimum
from benchmarks.peers import ITERATIONS, PARTICLES
from benchmarks.problems import problem, steps
from benchmarks.standing import Search, median, of_cost
from benchmarks.table import Table
from benchmarks.tuning import RATE_HZ, SAMPLES
from hostkit.optimisers import OPTIMISERS, Optimiser

RECORDINGS, SEEDS = 10, 10
SWARMS = tuple(
    rule for rule in OPTIMISERS if not rule.one_dimension and rule.name != "differential-evolution"
)
WAYS = ((True, True), (False, True), (False, False))
"""Over log tau or tau; mirrored at the bounds or put onto them."""


def tables() -> Iterator[Table]:
    """Measure the rules."""
    ways = [[_cost(k, log=log) for k in range(1, RECORDINGS + 1)] for log, _ in WAYS]
    rows = []
    for rule in SWARMS:
        cells = [rule.name]
        for costs, (_, bounce) in zip(ways, WAYS, strict=True):
            cells += _cells(rule, costs, bounce=bounce)
        rows.append(tuple(cells))
    heads = ("log tau, mirrored", "tau, mirrored", "tau, clipped")
    yield Table(
        title=f"Hit rate of hostkit's rules: within {HIT_RAD:g} rad of the optimum, mae, "
        f"{RECORDINGS} recordings of {SAMPLES} samples at {RATE_HZ:g} Hz, {SEEDS} seeds each, "
        f"{PARTICLES} x {ITERATIONS}; evaluations to the hit are medians, misses counted as never",
        columns=("rule", *(head for one in heads for head in (one, "evaluations"))),
        rows=tuple(rows),
    )


def _cost(seed: int, *, log: bool) -> TauCost:
    one = problem(steps(SAMPLES, RATE_HZ, seed), objective="mae")
    return TauCost(one, optimum(one), log=log)


def _cells(rule: Optimiser, costs: list[TauCost], *, bounce: bool) -> list[str]:
    found = [_run(rule, cost, seed, bounce=bounce) for cost in costs for seed in range(SEEDS)]
    after = [search.hit_after for search in found]
    middle = median(tuple(after))
    hits = float(np.mean(np.isfinite(after)))
    return [f"{hits:.2f}", f"{middle:.0f}" if np.isfinite(middle) else "never"]


def _run(rule: Optimiser, cost: TauCost, seed: int, *, bounce: bool) -> Search:
    return of_cost(
        cost,
        lambda: rule.minimise(
            cost.many,
            cost.lower,
            cost.upper,
            particles=PARTICLES,
            iterations=ITERATIONS,
            rng=np.random.default_rng(seed),
            bounce=bounce,
        ),
    )
