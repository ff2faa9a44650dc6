"""The evaluation kernel: ns per particle-sample, beside SciPy and the best loop by hand."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import DTypeLike, NDArray
from scipy.signal import lfilter

from benchmarks.compiled import LANES, best_loop
from benchmarks.problems import SIX, TAU, problem, repeated, steps, stream_of
from benchmarks.table import MISSING, Table, figure
from benchmarks.timing import Action, least_seconds
from hostkit.errors import ToolMissingError
from hostkit.records import OBJECTIVES, Objective
from hostkit.tuning import FreeName
from hostkit.tuning.kernel import Candidates, Carry, ErrorStream, PortableKernel, kernel

Vector = NDArray[np.float64]

SAMPLES, RATE_HZ = 10_000, 100.0
HEADLINE_SAMPLES = (SAMPLES, 100_000)
HEADLINE_BUDGET_S, SWEEP_BUDGET_S = 3.0, 8.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Case:
    """One way to run the kernel: how long, how many, which arithmetic, which recursion."""

    samples: int = SAMPLES
    particles: int = LANES
    objective: Objective = "rmse"
    stream: DTypeLike = np.float64
    arithmetic: DTypeLike = np.float64
    free: tuple[FreeName, ...] = TAU
    portable: bool = False

    @property
    def work(self) -> int:
        """Particle-samples of one call."""
        return self.samples * self.particles

    @property
    def label(self) -> str:
        """What the table says of it."""
        kind = np.dtype(self.arithmetic).name
        mixed = np.dtype(self.stream) != np.dtype(self.arithmetic)
        number = f"{np.dtype(self.stream).name} streams, {kind}" if mixed else kind
        means = "NumPy fallback" if self.portable else "compiled"
        recursion = "eta" if self.free == TAU else f"{len(SIX)} parameters"
        return f"{means}, {recursion}, {self.objective}, {number}"

    def laid_out(self) -> tuple[ErrorStream, Candidates]:
        """Return what the kernel is given: particles over the whole box."""
        one = problem(
            steps(SAMPLES, RATE_HZ),
            objective=self.objective,
            free=self.free,
            stream=self.stream,
        )
        share = np.random.default_rng(1).random((self.particles, len(self.free)))
        points = one.space.lower + (one.space.upper - one.space.lower) * share
        return repeated(stream_of(one), self.samples), one.space.candidates("roll", points)

    def action(self) -> Action:
        """Return a call of the kernel."""
        stream, candidates = self.laid_out()
        by = PortableKernel() if self.portable else kernel()
        carry = Carry.before(stream, candidates, self.arithmetic)
        return lambda: by.add_sums(stream, candidates, self.objective, carry)


NUMBERS = ((np.float64, np.float64), (np.float32, np.float64), (np.float32, np.float32))
"""Types of streams and arithmetic."""

CASES = (
    *(Case(objective=o, stream=s, arithmetic=a) for o in OBJECTIVES for s, a in NUMBERS),
    *(Case(samples=n, particles=p) for n in (300, SAMPLES, 1_000_000) for p in (20, 480)),
    *(Case(particles=p, free=SIX, objective=o) for p in (20, LANES) for o in OBJECTIVES),
    Case(portable=True),
    Case(portable=True, particles=20, samples=300, free=SIX),
)


def tables() -> Iterator[Table]:
    """Measure the kernel."""
    yield headline()
    yield sweep()


def headline() -> Table:
    """Return the kernel beside SciPy's filter and the best loop, in turns."""
    found = [_headline_row(o, n) for o in OBJECTIVES for n in HEADLINE_SAMPLES]
    return Table(
        title=f"Kernel against its peers: {LANES} particles, float64, one thread; shortest times "
        "in turns",
        columns=(
            "objective",
            "samples",
            "hostkit, ns per particle-sample",
            "best loop, ns",
            "hostkit / best loop",
            "SciPy lfilter / hostkit",
        ),
        rows=tuple(found),
    )


def _headline_row(objective: Objective, samples: int) -> tuple[str, ...]:
    case = Case(objective=objective, samples=samples)
    stream, candidates = case.laid_out()
    eta = np.ascontiguousarray(candidates.table[0])
    loops = _loops(stream, eta, objective)
    contenders = (case.action(), scipy_filter(stream, eta, objective), *loops)
    ours, peer, *best = least_seconds(contenders, budget_s=HEADLINE_BUDGET_S)
    ns = 1e9 / case.work
    return (
        objective,
        f"{samples}",
        figure(ours * ns),
        figure(min(best) * ns) if best else MISSING,
        figure(ours / min(best)) if best else MISSING,
        figure(peer / ours),
    )


def _loops(stream: ErrorStream, eta: Vector, objective: Objective) -> tuple[Action, ...]:
    try:
        return best_loop().ways(stream, eta, objective)
    except ToolMissingError:
        return ()


def scipy_filter(stream: ErrorStream, eta: Vector, objective: Objective) -> Callable[[], Vector]:
    """Return the same sums by `scipy.signal.lfilter`, called for each particle."""

    def total(one: float) -> float:
        error = lfilter([1.0], [1.0, -one], one * stream.drive + stream.start)
        return float((np.square(error) if objective == "rmse" else np.abs(error)).sum())

    return lambda: np.array([total(float(one)) for one in eta])


def sweep() -> Table:
    """Return the other lengths, swarms, numbers and recursions, as ratios to the first case."""
    reference = Case(objective="rmse")
    cases = tuple(case for case in CASES if case != reference)
    times = least_seconds([c.action() for c in (reference, *cases)], budget_s=SWEEP_BUDGET_S)
    per = [t / c.work for t, c in zip(times, (reference, *cases), strict=True)]
    rows = [
        (c.label, f"{c.samples}", f"{c.particles}", figure(p * 1e9), figure(p / per[0]))
        for c, p in zip((reference, *cases), per, strict=True)
    ]
    return Table(
        title="Kernel, all its kinds: one thread; shortest times in turns",
        columns=("kind", "samples", "particles", "ns per particle-sample", "ratio to the first"),
        rows=tuple(rows),
        remarks=(
            "Of 300 samples, most is the way from Python into C; a whole swarm stays in C.",
            "Streams longer than 10000 samples repeat the recording.",
        ),
    )
