"""The search itself: which optimiser, how often, and on how many threads."""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np

from hostkit.errors import HostkitError
from hostkit.optimisers import OPTIMISERS, SwarmResult, qpso
from hostkit.tuning.correlation import TabulatedProblem, tabulated
from hostkit.tuning.kernel import ErrorStream, NativeKernel
from hostkit.tuning.options import AUTO, TuningOptions
from hostkit.tuning.problem import Problem

ONE_PARAMETER, SEVERAL_PARAMETERS = "grid-brent", qpso.NAME


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


def search(problem: Problem, options: TuningOptions, optimiser: str) -> SwarmResult:
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
    alone = replace(problem, jobs=1) if options.restarts > 1 else problem
    planned = options.restarts * options.particles * (options.iterations + 1)
    tables = None if optimiser == ONE_PARAMETER else tabulated(problem, planned)

    def run(restart: int) -> SwarmResult:
        seed = options.seed if restart == 0 else [options.seed, restart]
        return _run(alone, tables, options, optimiser, np.random.default_rng(seed))

    with ThreadPoolExecutor(min(options.jobs, options.restarts)) as pool:
        results = list(pool.map(run, range(options.restarts)))
    best = min(results, key=lambda result: result.cost)
    return replace(best, evaluations=sum(result.evaluations for result in results))


def _run(
    problem: Problem,
    tables: TabulatedProblem | None,
    options: TuningOptions,
    optimiser: str,
    rng: np.random.Generator,
) -> SwarmResult:
    if optimiser == qpso.NAME and problem.space.plain and tables is None:
        compiled = _compiled_swarm(problem, options, rng)
        if compiled is not None:
            return compiled
    return OPTIMISERS[optimiser].minimise(
        problem.cost if tables is None else tables.cost,
        problem.space.lower,
        problem.space.upper,
        particles=options.particles,
        iterations=options.iterations,
        rng=rng,
    )


def _compiled_swarm(
    problem: Problem, options: TuningOptions, rng: np.random.Generator
) -> SwarmResult | None:
    """Run the swarm over tau inside the compiled kernel, where there is one and all is float64."""
    kernel = problem.kernel
    streams = [
        stream
        for recording in problem.streams
        for stream in recording
        if isinstance(stream, ErrorStream) and stream.dtype == np.float64
    ]
    count = len(problem.streams) * len(problem.space.axes)
    if not isinstance(kernel, NativeKernel) or len(streams) < count or problem.jobs > 1:
        return None
    lower, upper = problem.space.lower, problem.space.upper
    x, history = kernel.qpso_tau(
        streams,
        problem.objective,
        problem.space.period_s,
        (float(lower[0]), float(upper[0])),
        options.particles,
        options.iterations,
        qpso.CONTRACTION,
        rng,
    )
    if not np.isfinite(history[-1]):
        raise HostkitError("the cost is not finite at any point that the swarm visited")
    point = np.array([x])
    edge = 1e-6 * (upper - lower)
    return SwarmResult(
        x=point,
        cost=float(history[-1]),
        history=history,
        evaluations=options.particles * (options.iterations + 1),
        at_bound=(point - lower <= edge) | (upper - point <= edge),
        stopped_at=options.iterations,
    )
