"""Benchmark functions of ten dimensions, their optimum off the centre: final costs."""

import logging
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from benchmarks.table import MISSING, Table
from hostkit.optimisers import Rule, minimise_many, pso, qpso, rdpso
from hostkit.optimisers import adaptive_pso as adaptive

Vector = NDArray[np.float64]

DIMENSIONS = 10
PARTICLES, ITERATIONS = 40, 500
OWN_RUNS, PEER_RUNS = 25, 5
SHIFT = 0.6
"""The optimum lies within this share of the half width from the centre."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Function:
    """A function whose least value is 0, at `shift`.

    Attributes
    ----------
    half_width
        The box reaches so far from 0.
    at_origin
        The function with its least value 0 at 0: points ``(..., D)`` to values ``(...,)``.
    """

    name: str
    half_width: float
    at_origin: Callable[[Vector], Vector]
    shift: Vector

    def __call__(self, points: Vector) -> Vector:
        return self.at_origin(points - self.shift)

    def one(self, point: Vector) -> float:
        """Return the value at one point, shape ``(D,)``."""
        return float(self(np.asarray(point)))

    @property
    def upper(self) -> Vector:
        """Upper corner; the lower one is opposite."""
        return np.full(DIMENSIONS, self.half_width)


def rastrigin(z: Vector) -> Vector:
    return np.asarray((z**2 - 10.0 * np.cos(2.0 * np.pi * z) + 10.0).sum(axis=-1))


def rosenbrock(z: Vector) -> Vector:
    x = z + 1.0
    valley, slope = x[..., 1:] - x[..., :-1] ** 2, z[..., :-1]
    return np.asarray((100.0 * valley**2 + slope**2).sum(axis=-1))


def ackley(z: Vector) -> Vector:
    bowl = -20.0 * np.exp(-0.2 * np.sqrt((z**2).mean(axis=-1)))
    return np.asarray(bowl - np.exp(np.cos(2.0 * np.pi * z).mean(axis=-1)) + 20.0 + np.e)


def griewank(z: Vector) -> Vector:
    waves = np.cos(z / np.sqrt(np.arange(1, z.shape[-1] + 1))).prod(axis=-1)
    return np.asarray((z**2).sum(axis=-1) / 4000.0 - waves + 1.0)


KINDS = (
    ("Rastrigin", 5.12, rastrigin),
    ("Rosenbrock", 10.0, rosenbrock),
    ("Ackley", 32.0, ackley),
    ("Griewank", 600.0, griewank),
)


def functions(rng: np.random.Generator) -> tuple[Function, ...]:
    """Return the functions, each shifted by a draw."""
    return tuple(
        Function(
            name=name,
            half_width=half,
            at_origin=at_origin,
            shift=SHIFT * half * rng.uniform(-1.0, 1.0, DIMENSIONS),
        )
        for name, half, at_origin in KINDS
    )


RULES: tuple[tuple[str, Rule], ...] = (
    ("qpso", qpso.rule()),
    ("rdpso", rdpso.rule()),
    ("rdpso-article", rdpso.article_rule()),
    ("pso", pso.rule()),
    ("ldwpso", pso.ldw_rule()),
    ("dcwpso", adaptive.rule()),
    ("awp", adaptive.awp_rule()),
)


def _own(rule: Rule, function: Function) -> float:
    batch = minimise_many(
        rule,
        function,
        -function.upper,
        function.upper,
        runs=OWN_RUNS,
        particles=PARTICLES,
        iterations=ITERATIONS,
        rng=np.random.default_rng(1),
    )
    return float(np.median(batch.cost))


def _pygmo(name: str, function: Function, seed: int) -> float:
    import pygmo

    class Fitness:
        def fitness(self, x: Vector) -> list[float]:
            return [function.one(x)]

        def get_bounds(self) -> tuple[list[float], list[float]]:
            return (-function.upper).tolist(), function.upper.tolist()

    population = pygmo.population(pygmo.problem(Fitness()), size=PARTICLES, seed=seed)
    rule = getattr(pygmo, name)(gen=ITERATIONS, seed=seed)
    return float(pygmo.algorithm(rule).evolve(population).champion_f[0])


def _pyswarms(function: Function, seed: int) -> float:
    logging.disable(logging.CRITICAL)
    from pyswarms.single import GlobalBestPSO

    np.random.seed(seed)  # noqa: NPY002  it has no other source
    swarm = GlobalBestPSO(
        n_particles=PARTICLES,
        dimensions=DIMENSIONS,
        options={"c1": 1.49618, "c2": 1.49618, "w": 0.7298},
        bounds=(-function.upper, function.upper),
    )
    return float(swarm.optimize(function, iters=ITERATIONS + 1, verbose=False)[0])


def _evolution(function: Function, seed: int) -> float:
    from scipy.optimize import Bounds, differential_evolution

    found = differential_evolution(
        lambda columns: function(columns.T),
        Bounds(-function.upper, function.upper),
        maxiter=ITERATIONS,
        popsize=PARTICLES // DIMENSIONS,
        vectorized=True,
        updating="deferred",
        rng=seed,
    )
    return float(found.fun)


PEERS: tuple[tuple[str, Callable[[Function, int], float]], ...] = (
    ("pygmo pso", lambda function, seed: _pygmo("pso", function, seed)),
    ("pygmo sade", lambda function, seed: _pygmo("sade", function, seed)),
    ("pygmo cmaes", lambda function, seed: _pygmo("cmaes", function, seed)),
    ("pyswarms gbest", _pyswarms),
    ("scipy differential evolution, polished", _evolution),
)


def tables() -> Iterator[Table]:
    """Measure the final costs."""
    shifted = functions(np.random.default_rng(7))
    rows = [
        (f"hostkit {name}", f"{OWN_RUNS}", *(f"{_own(rule, f):.2g}" for f in shifted))
        for name, rule in RULES
    ]
    rows += [(name, f"{PEER_RUNS}", *(_median(run, f) for f in shifted)) for name, run in PEERS]
    yield Table(
        title=f"Benchmark functions, {DIMENSIONS} dimensions, optimum off the centre, "
        f"{PARTICLES} x {ITERATIONS}: median of the final cost, 0 is best",
        columns=("method", "runs", *(f.name for f in shifted)),
        rows=tuple(rows),
    )


def _median(run: Callable[[Function, int], float], function: Function) -> str:
    try:
        return f"{np.median([run(function, seed) for seed in range(1, PEER_RUNS + 1)]):.2g}"
    except ImportError:
        return MISSING
