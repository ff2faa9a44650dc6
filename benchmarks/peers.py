"""Other packages' optimisers, each given the same cost over one parameter.

All with the package's own defaults but for the size of the swarm (20) and the moves (100), where
it has such a thing. A package is imported when it is first used; one that is missing is an
ImportError.
"""

import contextlib
import io
import logging
import random
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from benchmarks.objective import TauCost

Vector = NDArray[np.float64]

PARTICLES, ITERATIONS = 20, 100


@dataclass(frozen=True, slots=True, kw_only=True)
class Peer:
    """One optimiser of another package.

    Attributes
    ----------
    package
        Name of the distribution, whose version is printed.
    title
        What it is.
    run
        Minimises a cost, from a seed.
    scalar
        Whether it is a method for one parameter only, not one for several.
    """

    package: str
    title: str
    run: Callable[[TauCost, int], object]
    scalar: bool = False


def scipy_brent(cost: TauCost, seed: int) -> None:
    from scipy.optimize import minimize_scalar

    bounds = (float(cost.lower[0]), float(cost.upper[0]))
    minimize_scalar(cost.one, bounds=bounds, method="bounded")


def scipy_evolution(cost: TauCost, seed: int) -> None:
    from scipy.optimize import differential_evolution

    bounds = [(float(cost.lower[0]), float(cost.upper[0]))]
    differential_evolution(cost.point, bounds, popsize=PARTICLES, maxiter=ITERATIONS, rng=seed)


def scipy_annealing(cost: TauCost, seed: int) -> None:
    from scipy.optimize import dual_annealing

    bounds = [(float(cost.lower[0]), float(cost.upper[0]))]
    dual_annealing(cost.point, bounds, maxfun=PARTICLES * (ITERATIONS + 1), rng=seed)


def _pygmo(name: str, cost: TauCost, seed: int) -> None:
    import pygmo

    class Tau:  # pygmo copies it; the cost it counts on stays one
        def fitness(self, x: Vector) -> list[float]:
            return [cost.point(x)]

        def get_bounds(self) -> tuple[list[float], list[float]]:
            return cost.lower.tolist(), cost.upper.tolist()

    population = pygmo.population(pygmo.problem(Tau()), size=PARTICLES, seed=seed)
    rule = getattr(pygmo, name)(gen=ITERATIONS, seed=seed)
    pygmo.algorithm(rule).evolve(population)


def pygmo_pso(cost: TauCost, seed: int) -> None:
    _pygmo("pso", cost, seed)


def pygmo_sade(cost: TauCost, seed: int) -> None:
    _pygmo("sade", cost, seed)


def pymoo_pso(cost: TauCost, seed: int) -> None:
    from pymoo.algorithms.soo.nonconvex.pso import PSO
    from pymoo.core.problem import Problem
    from pymoo.optimize import minimize

    class Tau(Problem):
        def __init__(self) -> None:
            super().__init__(n_var=1, n_obj=1, xl=cost.lower, xu=cost.upper)

        def _evaluate(self, x: Vector, out: dict[str, Vector], *_: object, **__: object) -> None:
            out["F"] = cost.many(x)

    minimize(Tau(), PSO(pop_size=PARTICLES), ("n_gen", ITERATIONS + 1), seed=seed, verbose=False)


def mealpy_pso(cost: TauCost, seed: int) -> None:
    from mealpy import PSO, FloatVar

    bounds = FloatVar(lb=cost.lower.tolist(), ub=cost.upper.tolist())
    task = {"obj_func": cost.point, "bounds": bounds, "minmax": "min", "log_to": None}
    PSO.OriginalPSO(epoch=ITERATIONS, pop_size=PARTICLES).solve(task, seed=seed)


def niapy_pso(cost: TauCost, seed: int) -> None:
    from niapy.algorithms.basic import ParticleSwarmAlgorithm
    from niapy.problems import Problem
    from niapy.task import Task

    class Tau(Problem):
        def _evaluate(self, x: Vector) -> float:
            return cost.point(x)

    one = Tau(dimension=1, lower=float(cost.lower[0]), upper=float(cost.upper[0]))
    task = Task(problem=one, max_evals=PARTICLES * (ITERATIONS + 1))
    ParticleSwarmAlgorithm(population_size=PARTICLES, seed=seed).run(task)


def scikit_opt_pso(cost: TauCost, seed: int) -> None:
    from sko.PSO import PSO

    random.seed(seed)
    np.random.seed(seed)  # noqa: NPY002  it has no other source
    with contextlib.redirect_stdout(io.StringIO()):
        PSO(
            func=cost.point,
            n_dim=1,
            pop=PARTICLES,
            max_iter=ITERATIONS,
            lb=cost.lower,
            ub=cost.upper,
        ).run()


def pyswarms_gbest(cost: TauCost, seed: int) -> None:
    logging.disable(logging.CRITICAL)
    from pyswarms.single import GlobalBestPSO

    np.random.seed(seed)  # noqa: NPY002  it has no other source
    swarm = GlobalBestPSO(
        n_particles=PARTICLES,
        dimensions=1,
        options={"c1": 1.49618, "c2": 1.49618, "w": 0.7298},
        bounds=(cost.lower, cost.upper),
    )
    swarm.optimize(cost.many, iters=ITERATIONS + 1, verbose=False)


def _starpso(name: str, cost: TauCost, seed: int) -> None:
    import star_pso.engines.quantum_pso as quantum
    import star_pso.engines.standard_pso as standard
    from star_pso.population.particle import Particle
    from star_pso.population.swarm import Swarm
    from star_pso.utils.auxiliary import RunConfig, cost_function

    rng = np.random.default_rng(seed)
    standard.GenericPSO.rng = rng
    engine = quantum.QuantumPSO if name == "quantum" else standard.StandardPSO
    first = rng.uniform(cost.lower, cost.upper, (PARTICLES, 1))

    def at_iteration(x: Vector, it: int) -> float:
        return cost.point(x)

    swarm = engine(
        initial_swarm=Swarm([Particle(x) for x in first]),
        obj_func=cost_function(at_iteration, minimize=True),
        x_min=cost.lower,
        x_max=cost.upper,
    )
    with contextlib.redirect_stdout(io.StringIO()):
        swarm.run(RunConfig(max_it=ITERATIONS))


def starpso_quantum(cost: TauCost, seed: int) -> None:
    _starpso("quantum", cost, seed)


def starpso_standard(cost: TauCost, seed: int) -> None:
    _starpso("standard", cost, seed)


PEERS = (
    Peer(package="scipy", title="bounded Brent", run=scipy_brent, scalar=True),
    Peer(package="scipy", title="differential evolution", run=scipy_evolution),
    Peer(package="scipy", title="dual annealing", run=scipy_annealing),
    Peer(package="pygmo", title="pso", run=pygmo_pso),
    Peer(package="pygmo", title="sade", run=pygmo_sade),
    Peer(package="pymoo", title="PSO", run=pymoo_pso),
    Peer(package="mealpy", title="OriginalPSO", run=mealpy_pso),
    Peer(package="niapy", title="PSO", run=niapy_pso),
    Peer(package="scikit-opt", title="PSO", run=scikit_opt_pso),
    Peer(package="pyswarms", title="gbest", run=pyswarms_gbest),
    Peer(package="starpso", title="QuantumPSO", run=starpso_quantum),
    Peer(package="starpso", title="StandardPSO", run=starpso_standard),
)
