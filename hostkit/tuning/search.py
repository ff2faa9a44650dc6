"""The search itself: which optimiser, how often, and on how many threads."""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np

from hostkit.errors import HostkitError
from hostkit.optimisers import OPTIMISERS, SwarmResult, grid_brent, qpso
from hostkit.tuning.options import AUTO, TuningOptions
from hostkit.tuning.task import SearchPlan, Task

ONE_PARAMETER, SEVERAL_PARAMETERS = grid_brent.NAME, qpso.NAME


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
    plan = SearchPlan(
        optimiser=optimiser,
        particles=options.particles,
        iterations=options.iterations,
        restarts=options.restarts,
    )
    quick = alone.quick_search(plan)

    def run(restart: int) -> SwarmResult:
        seed = options.seed if restart == 0 else (options.seed, restart)
        rng = np.random.default_rng(seed)
        return _run(alone, plan, rng) if quick is None else quick(rng)

    if options.restarts == 1:
        return run(0)
    with ThreadPoolExecutor(min(options.jobs, options.restarts)) as pool:
        results = list(pool.map(run, range(options.restarts)))
    best = min(results, key=lambda result: result.cost)
    return replace(best, evaluations=sum(result.evaluations for result in results))


def _run(problem: Task, plan: SearchPlan, rng: np.random.Generator) -> SwarmResult:
    return OPTIMISERS[plan.optimiser].minimise(
        problem.cost,
        problem.space.lower,
        problem.space.upper,
        particles=plan.particles,
        iterations=plan.iterations,
        rng=rng,
    )
