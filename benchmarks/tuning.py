"""A whole tuning of one parameter: hostkit beside other packages, on the same objective in C."""

import contextlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from importlib.metadata import version

import numpy as np

from benchmarks.objective import HIT_RAD, Optimum, TauCost, optimum
from benchmarks.peers import ITERATIONS, PARTICLES, PEERS, Peer
from benchmarks.problems import problem, steps
from benchmarks.standing import COLUMNS, Search, Standing, of_cost, of_result
from benchmarks.table import Table, figure
from hostkit import __version__
from hostkit.optimisers import OPTIMISERS, SwarmResult
from hostkit.records import OBJECTIVES, Objective
from hostkit.tuning import TuningOptions
from hostkit.tuning.complementary.problem import Problem
from hostkit.tuning.search import search

SAMPLES, RATE_HZ = 300, 20.0
OWN_SEEDS, PEER_SEEDS = 100, 10


@dataclass(frozen=True, slots=True, kw_only=True)
class Contest:
    """One objective over one scale of tau."""

    problem: Problem
    best: Optimum
    log: bool

    @classmethod
    def of(cls, objective: Objective, *, log: bool) -> "Contest":
        """Return the contest on the recording of this module."""
        one = problem(steps(SAMPLES, RATE_HZ), objective=objective)
        return cls(problem=one, best=optimum(one), log=log)

    def cost(self) -> TauCost:
        """Return a cost that counts."""
        return TauCost(self.problem, self.best, log=self.log)

    def own(self, name: str, seed: int) -> Search:
        """Run hostkit's own search, which is always over log tau."""
        per_step = 1 if OPTIMISERS[name].one_dimension else PARTICLES
        return of_result(lambda: self._search(name, seed), self.best, per_step)

    def _search(self, name: str, seed: int) -> SwarmResult:
        options = TuningOptions(
            axes="roll", objective=self.problem.objective, optimiser=name, seed=seed
        )
        return search(self.problem, options, name)

    def in_python(self, seed: int) -> Search:
        """Run hostkit's swarm in Python, which takes any scale."""
        cost = self.cost()
        return of_cost(
            cost,
            lambda: OPTIMISERS["qpso"].minimise(
                cost.many,
                cost.lower,
                cost.upper,
                particles=PARTICLES,
                iterations=ITERATIONS,
                rng=np.random.default_rng(seed),
            ),
        )


def tables() -> Iterator[Table]:
    """Measure whole tunings."""
    for objective in OBJECTIVES:
        for log in (True, False):
            yield contest_table(Contest.of(objective, log=log))


def contest_table(contest: Contest) -> Table:
    """Return how everybody does in one contest."""
    ours, peers = tuple(_ours(contest)), tuple(_peer(contest, peer) for peer in PEERS)
    scale = "log tau" if contest.log else "tau (hostkit's search itself: log tau)"
    return Table(
        title=f"Whole tuning, {contest.problem.objective} over {scale}: {SAMPLES} samples at "
        f"{RATE_HZ:g} Hz, {PARTICLES} x {ITERATIONS}; a hit is within {HIT_RAD:g} rad of the "
        "optimum",
        columns=COLUMNS,
        rows=tuple(standing.row() for standing in (*ours, *peers)),
        remarks=verdicts(peers, default=ours[1].time_ratio),
    )


def _ours(contest: Contest) -> Iterator[Standing]:
    ways: tuple[tuple[str, Callable[[int], Search]], ...] = (
        ("hostkit qpso, whole swarm in C", lambda seed: contest.own("qpso", seed)),
        ("hostkit grid-brent (default)", lambda seed: contest.own("grid-brent", seed)),
        ("hostkit qpso, in Python", contest.in_python),
    )
    for method, run in ways:
        searches, beside = _in_turns(contest, run, OWN_SEEDS)
        yield Standing(method=method, version=__version__, searches=searches, beside=beside)


def _peer(contest: Contest, peer: Peer) -> Standing:
    """Run a peer; without a search where the package is missing."""

    def run(seed: int) -> Search:
        cost = contest.cost()
        return of_cost(cost, lambda: peer.run(cost, seed))

    found = ""
    searches: tuple[Search, ...] = ()
    beside: tuple[Search, ...] = ()
    with contextlib.suppress(ImportError):
        found = version(peer.package)
        searches, beside = _in_turns(contest, run, PEER_SEEDS)
    return Standing(
        method=f"{peer.package} {peer.title}",
        version=found,
        searches=searches,
        beside=beside,
        scalar=peer.scalar,
    )


def _in_turns(
    contest: Contest, run: Callable[[int], Search], seeds: int
) -> tuple[tuple[Search, ...], tuple[Search, ...]]:
    """Run a method from each seed, and hostkit's swarm after each; the first run does not count."""
    run(0)
    pairs = [(run(seed), contest.own("qpso", seed)) for seed in range(1, seeds + 1)]
    return tuple(one for one, _ in pairs), tuple(other for _, other in pairs)


def verdicts(peers: tuple[Standing, ...], *, default: float) -> tuple[str, ...]:
    """Say how hostkit stands beside the fastest peers that hit in every run.

    Parameters
    ----------
    default
        Time of hostkit's default over that of its swarm.
    """
    sure = [p for p in peers if p.searches and p.hit_rate == 1.0]
    kinds = (
        ("for several parameters", [p for p in sure if not p.scalar]),
        ("for one parameter only", [p for p in sure if p.scalar]),
    )
    return tuple(
        f"Fastest peer {kind} that hit in every run: {best.method}, "
        f"{figure(best.time_ratio)} times the time of hostkit's swarm, "
        f"{figure(best.time_ratio / default)} times that of its default."
        for kind, found in kinds
        if found
        for best in [min(found, key=lambda p: p.time_ratio)]
    )
