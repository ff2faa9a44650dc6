"""The search itself: which optimiser, how often, and on how many threads."""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from hostkit.errors import HostkitError
from hostkit.optimisers import OPTIMISERS, SwarmResult, grid_brent, qpso
from hostkit.tuning.complementary.correlation import TabulatedProblem, tabulated
from hostkit.tuning.complementary.problem import Problem
from hostkit.tuning.kernel import ErrorStream, NativeKernel
from hostkit.tuning.kernel.native import LineTask
from hostkit.tuning.options import AUTO, TuningOptions
from hostkit.tuning.task import Space, Task

Vector = NDArray[np.float64]

ONE_PARAMETER, SEVERAL_PARAMETERS = grid_brent.NAME, qpso.NAME

EDGE = 1e-6
"""Share of the range within which a point is on its end."""


def choose_optimiser(name: str, parameters: int) -> str:
    """Return the name of the optimiser for so many parameters.

    Raises
    ------
    HostkitError
        If the optimiser is not known, or takes one parameter only.
    """
    if name == AUTO:
        return ONE_PARAMETER if parameters == 1 else SEVERAL_PARAMETERS
    if OPTIMISERS[name].one_dimension and parameters > 1:
        several = ", ".join(o.name for o in OPTIMISERS if not o.one_dimension)
        raise HostkitError(f"{name} takes one parameter, {parameters} are free; use: {several}")
    return name


def search(problem: Task, options: TuningOptions, optimiser: str) -> SwarmResult:
    """Find the least cost, from several seeds if so wished.

    Returns
    -------
    SwarmResult
        The best of all restarts, with the evaluations of all of them.

    Raises
    ------
    HostkitError
        If the cost is finite nowhere.
    """
    alone = problem.with_jobs(1) if options.restarts > 1 else problem
    planned = options.restarts * options.particles * (options.iterations + 1)
    tables = None
    if isinstance(problem, Problem) and optimiser != ONE_PARAMETER:
        tables = tabulated(problem, planned)

    def run(restart: int) -> SwarmResult:
        seed = (options.seed,) if restart == 0 else (options.seed, restart)
        return _run(alone, tables, options, optimiser, seed)

    if options.restarts == 1:
        return run(0)
    with ThreadPoolExecutor(min(options.jobs, options.restarts)) as pool:
        results = list(pool.map(run, range(options.restarts)))
    best = min(results, key=lambda result: result.cost)
    return replace(best, evaluations=sum(result.evaluations for result in results))


def _run(
    problem: Task,
    tables: TabulatedProblem | None,
    options: TuningOptions,
    optimiser: str,
    seed: tuple[int, ...],
) -> SwarmResult:
    if tables is None and isinstance(problem, Problem):
        compiled = _compiled(problem, options, optimiser, seed)
        if compiled is not None:
            return compiled
    return OPTIMISERS[optimiser].minimise(
        problem.cost if tables is None else tables.cost,
        problem.space.lower,
        problem.space.upper,
        particles=options.particles,
        iterations=options.iterations,
        rng=_generator(seed),
    )


def _generator(seed: tuple[int, ...]) -> np.random.Generator:
    """Return the generator of a seed; a single number gives the one that it names alone."""
    return np.random.default_rng(seed[0] if len(seed) == 1 else seed)


def _compiled(
    problem: Problem, options: TuningOptions, optimiser: str, seed: tuple[int, ...]
) -> SwarmResult | None:
    """Run the search over log tau inside the compiled kernel, where it can be."""
    kernel, task = problem.kernel, _line_task(problem)
    if not isinstance(kernel, NativeKernel) or task is None:
        return None
    if optimiser == qpso.NAME:
        x, history = kernel.qpso_tau(
            task, options.particles, options.iterations, qpso.CONTRACTION, _generator(seed)
        )
        evaluations = options.particles * (options.iterations + 1)
    elif optimiser == grid_brent.NAME:
        lower, upper = task.bounds
        tolerance = grid_brent.TOLERANCE * (upper - lower)
        x, history, evaluations = kernel.grid_brent_tau(
            task, grid_brent.POINTS, tolerance, options.iterations
        )
    else:
        return None
    return _result(problem, x, history, evaluations)


def _line_task(problem: Problem) -> LineTask | None:
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


def _result(problem: Problem, x: float, history: Vector, evaluations: int) -> SwarmResult:
    if not np.isfinite(history[-1]):
        raise HostkitError("the cost is not finite at any point that was visited")
    point = np.array([x])
    return SwarmResult(
        x=point,
        cost=float(history[-1]),
        history=history,
        evaluations=evaluations,
        at_bound=on_bound(problem.space, point),
        stopped_at=len(history) - 1,
    )


def on_bound(space: Space, point: Vector) -> NDArray[np.bool_]:
    """Return where a point lies on an end of its range, shape ``(D,)``."""
    edge = EDGE * (space.upper - space.lower)
    return np.asarray((point - space.lower <= edge) | (space.upper - point <= edge))
