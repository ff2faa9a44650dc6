"""Correlation tables: what they cost once, what an evaluation then costs, and when that pays."""

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from benchmarks.problems import problem, repeated, steps, stream_of
from benchmarks.table import Table, figure
from benchmarks.timing import least_seconds
from hostkit.optimisers import OPTIMISERS, SwarmResult
from hostkit.tuning.complementary.correlation import TabulatedProblem, lags_of, tabulate, tabulated
from hostkit.tuning.complementary.problem import Problem

LENGTHS = (10_000, 100_000, 1_000_000)
RATE_HZ = 100.0
PARTICLES, ITERATIONS = 20, 100
EVALUATIONS = PARTICLES * (ITERATIONS + 1)
BUDGET_S = 2.0


def tables() -> Iterator[Table]:
    """Measure the tables."""
    yield Table(
        title="Correlation tables against the compiled kernel: rmse over tau, one thread; "
        "evaluations at 20 points even in log tau, shortest times in turns; whole search: qpso, "
        "20 x 100",
        columns=(
            "samples",
            "tables, ns per sample",
            "one evaluation: tables / kernel",
            "pay from so many evaluations",
            "whole search: tables / kernel",
            "hostkit takes tables",
            "largest relative difference",
        ),
        rows=tuple(_row(samples) for samples in LENGTHS),
        remarks=(
            "An evaluation from tables takes as long as its lags, 40 / (1 - eta), however long the "
            "recording is: long time constants are dear. A swarm soon leaves them, so a whole "
            "search is measured as well, its tables included.",
        ),
    )


def _row(samples: int) -> tuple[str, ...]:
    base = problem(steps(LENGTHS[0], RATE_HZ))
    stream = repeated(stream_of(base), samples)
    one = replace(base, streams=((stream,),))
    grid = np.linspace(one.space.lower, one.space.upper, PARTICLES)
    most = lags_of(float(one.space.candidates("roll", grid).table[0, -1]))
    made = TabulatedProblem(problem=one, tables=((tabulate(stream, most),),))
    build, peer, from_tables = least_seconds(
        (lambda: tabulate(stream, most), lambda: one.cost(grid), lambda: made.cost(grid)),
        budget_s=BUDGET_S,
    )
    gain = (peer - from_tables) / PARTICLES
    return (
        f"{samples}",
        figure(1e9 * build / samples),
        figure(from_tables / peer),
        "never" if gain <= 0.0 else f"{math.ceil(build / gain)}",
        figure(_whole(one, most)),
        "yes" if tabulated(one, EVALUATIONS) else "no",
        f"{np.abs(made.cost(grid) / one.cost(grid) - 1.0).max():.0e}",
    )


def _whole(one: Problem, most: int) -> float:
    """Return the time of a search with tables, over one with the kernel."""
    stream = stream_of(one)

    def with_tables() -> SwarmResult:
        made = TabulatedProblem(problem=one, tables=((tabulate(stream, most),),))
        return OPTIMISERS["qpso"].minimise(
            made.cost, one.space.lower, one.space.upper, rng=np.random.default_rng(1)
        )

    def with_kernel() -> SwarmResult:
        return OPTIMISERS["qpso"].minimise(
            one.cost, one.space.lower, one.space.upper, rng=np.random.default_rng(1)
        )

    tables_s, kernel_s = least_seconds((with_tables, with_kernel), budget_s=0.0, least=2)
    return tables_s / kernel_s
