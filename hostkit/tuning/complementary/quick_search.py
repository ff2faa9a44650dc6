"""Searching the complementary filter in tables or in compiled code, where both find the same."""

import numpy as np
from numpy.typing import NDArray

from hostkit.errors import HostkitError
from hostkit.optimisers import OPTIMISERS, SwarmResult, grid_brent, qpso
from hostkit.tuning.complementary.correlation import TabulatedProblem, tabulated
from hostkit.tuning.complementary.laid_out import LaidOut
from hostkit.tuning.kernel import ErrorStream, NativeKernel
from hostkit.tuning.kernel.native import LineTask
from hostkit.tuning.task import Search, SearchPlan

Vector = NDArray[np.float64]

EDGE = 1e-6
"""Share of the range within which a point is on its end."""


def quick_search(problem: LaidOut, plan: SearchPlan) -> Search | None:
    """Return the quickest search that finds the same; None where only the cost itself does."""
    tables = None
    if plan.optimiser != grid_brent.NAME:
        tables = tabulated(problem, plan.evaluations)
    return _compiled(problem, plan) if tables is None else _in_tables(tables, plan)


def _in_tables(tables: TabulatedProblem, plan: SearchPlan) -> Search:
    space = tables.problem.space

    def search(rng: np.random.Generator) -> SwarmResult:
        return OPTIMISERS[plan.optimiser].minimise(
            tables.cost,
            space.lower,
            space.upper,
            particles=plan.particles,
            iterations=plan.iterations,
            rng=rng,
        )

    return search


def _compiled(problem: LaidOut, plan: SearchPlan) -> Search | None:
    """Return the search over log tau inside the compiled kernel, where it can be."""
    kernel, task = problem.kernel, _line_task(problem)
    if not isinstance(kernel, NativeKernel) or task is None:
        return None

    def by_swarm(rng: np.random.Generator) -> SwarmResult:
        x, history = kernel.qpso_tau(task, plan.particles, plan.iterations, qpso.CONTRACTION, rng)
        return _result(problem, x, history, plan.particles * (plan.iterations + 1))

    def by_grid(rng: np.random.Generator) -> SwarmResult:
        lower, upper = task.bounds
        tolerance = grid_brent.TOLERANCE * (upper - lower)
        found = kernel.grid_brent_tau(task, grid_brent.POINTS, tolerance, plan.iterations)
        return _result(problem, *found)

    return {qpso.NAME: by_swarm, grid_brent.NAME: by_grid}.get(plan.optimiser)


def _line_task(problem: LaidOut) -> LineTask | None:
    """Return the search over log tau for the kernel; None if it is another one, or not float64."""
    space = problem.space
    if not space.plain or len(space.dimensions) > 1 or not space.dimensions[0].is_log:
        return None
    if np.dtype(problem.dtype) != np.float64:
        return None
    streams = [stream for recording in problem.streams for stream in recording]
    whole = tuple(s for s in streams if isinstance(s, ErrorStream) and s.dtype == np.float64)
    if len(whole) < len(streams):
        return None
    bounds = (float(space.lower[0]), float(space.upper[0]))
    return LineTask(whole, problem.objective, space.period_s, bounds)


def _result(problem: LaidOut, x: float, history: Vector, evaluations: int) -> SwarmResult:
    if not np.isfinite(history[-1]):
        raise HostkitError("the cost is not finite at any point that was visited")
    lower, upper = problem.space.lower, problem.space.upper
    point, edge = np.array([x]), EDGE * (upper - lower)
    return SwarmResult(
        x=point,
        cost=float(history[-1]),
        history=history,
        evaluations=evaluations,
        at_bound=(point - lower <= edge) | (upper - point <= edge),
        stopped_at=len(history) - 1,
    )
