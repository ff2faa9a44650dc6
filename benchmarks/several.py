"""Six parameters: hostkit's swarm, scipy's differential evolution and cma on simulated logs."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from benchmarks.gusts import RATE_HZ, SAMPLES, gusty
from benchmarks.problems import SIX, problem
from benchmarks.table import MISSING, Table, figure
from benchmarks.timing import seconds
from hostkit.optimisers import OPTIMISERS
from hostkit.tuning.complementary.problem import Problem
from hostkit.units import DEG_PER_RAD

Vector = NDArray[np.float64]

SENSORS, SEEDS = 10, 2
PARTICLES, ITERATIONS = 30, 200
EVALUATIONS = PARTICLES * (ITERATIONS + 1)


class Counted:
    """The cost of a problem, and how many points were asked for."""

    def __init__(self, one: Problem) -> None:
        self.problem, self.evaluations = one, 0

    def __call__(self, points: Vector) -> Vector:
        self.evaluations += len(points)
        return self.problem.cost(points)


@dataclass(frozen=True, slots=True, kw_only=True)
class Tuned:
    """One tuning: cost on its own log and on the other one of its sensor, rad; effort."""

    log: int
    training_rad: float
    held_out_rad: float
    evaluations: int
    seconds: float


Tuner = Callable[[Counted, int], Vector]


def own(name: str) -> Tuner:
    """Return one of hostkit's optimisers as a tuner."""

    def tune(cost: Counted, seed: int) -> Vector:
        space = cost.problem.space
        return (
            OPTIMISERS[name]
            .minimise(
                cost,
                space.lower,
                space.upper,
                particles=PARTICLES,
                iterations=ITERATIONS,
                rng=np.random.default_rng(seed),
            )
            .x
        )

    return tune


def cma_es(cost: Counted, seed: int) -> Vector:
    """Tune with cma's evolution strategy, from the middle of the box, a third of it wide."""
    import cma

    lower, width = cost.problem.space.lower, cost.problem.space.upper - cost.problem.space.lower
    options = {
        "bounds": [0, 1],
        "maxfevals": EVALUATIONS,
        "popsize": PARTICLES,
        "seed": seed + 1,
        "verbose": -9,
    }
    strategy = cma.CMAEvolutionStrategy(np.full(len(lower), 0.5), 1 / 3, options)
    while not strategy.stop():
        points = np.array(strategy.ask())
        strategy.tell(list(points), cost(lower + width * points).tolist())
    return np.asarray(lower + width * strategy.result.xbest)


TUNERS = (
    ("hostkit qpso", own("qpso")),
    ("hostkit differential-evolution (scipy's, with its polish)", own("differential-evolution")),
    ("cma", cma_es),
)


def tables() -> Iterator[Table]:
    """Measure tunings of six parameters."""
    logs = [problem(gusty(k // 2, k % 2), free=SIX) for k in range(2 * SENSORS)]
    found = [(name, _all(logs, tune)) for name, tune in TUNERS]
    known = tuple(
        min(t.training_rad for _, tuned in found for t in tuned if t.log == k)
        for k in range(len(logs))
    )
    swarm_s = _per_run(found[0][1])
    yield Table(
        title=f"Six parameters: {SENSORS} simulated sensors, two logs of {SAMPLES} samples at "
        f"{RATE_HZ:g} Hz each; tuned on one, scored on the other, both ways, {SEEDS} seeds; RMSE "
        "above the best known of the same log",
        columns=(
            "method",
            "evaluations",
            "training, median",
            "worst",
            "within 1 %",
            "held out, median",
            "worst",
            "time / qpso",
        ),
        rows=tuple(_row(name, tuned, known, swarm_s) for name, tuned in found),
        remarks=(_scale(logs, known),),
    )


def _all(logs: list[Problem], tune: Tuner) -> tuple[Tuned, ...]:
    try:
        return tuple(_one(logs, k, tune, seed) for seed in range(SEEDS) for k in range(len(logs)))
    except ImportError:
        return ()


def _one(logs: list[Problem], k: int, tune: Tuner, seed: int) -> Tuned:
    cost, point = Counted(logs[k]), np.empty((1, len(SIX)))

    def run() -> None:
        point[0] = tune(cost, seed)

    spent = seconds(run)
    return Tuned(
        log=k,
        training_rad=float(logs[k].cost(point)[0]),
        held_out_rad=float(logs[k ^ 1].cost(point)[0]),
        evaluations=cost.evaluations,
        seconds=spent,
    )


def _row(
    name: str, tuned: tuple[Tuned, ...], known: tuple[float, ...], swarm_s: float
) -> tuple[str, ...]:
    if not tuned:
        return (f"{name}: missing", *([MISSING] * 7))
    training = np.array([t.training_rad / known[t.log] - 1.0 for t in tuned])
    held_out = np.array([t.held_out_rad / known[t.log ^ 1] - 1.0 for t in tuned])
    return (
        name,
        f"{np.median([t.evaluations for t in tuned]):.0f}",
        *(f"{100.0 * value:.2f} %" for value in (np.median(training), training.max())),
        f"{np.mean(training <= 0.01):.2f}",
        *(f"{100.0 * value:.1f} %" for value in (np.median(held_out), held_out.max())),
        figure(_per_run(tuned) / swarm_s),
    )


def _per_run(tuned: tuple[Tuned, ...]) -> float:
    return float(np.median([t.seconds for t in tuned]))


def _scale(logs: list[Problem], known: tuple[float, ...]) -> str:
    """Say what six parameters are worth: the best known cost beside that of tau alone."""
    alone = [
        _one([problem(gusty(k // 2, 0))] * 2, 0, own("qpso"), 0).training_rad
        for k in range(0, len(logs), 2)
    ]
    ratio = np.median([a / b for a, b in zip(alone, known[::2], strict=True)])
    return (
        f"Best known RMSE, median over logs: {np.median(known) * DEG_PER_RAD:.3f} deg; with tau "
        f"alone it is {ratio:.1f} times as much."
    )
