"""What a search needs of a filter's problem, whichever filter it is."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from hostkit.optimisers import SwarmResult
from hostkit.records import Objective, Parameter
from hostkit.tuning.dimension import Dimension

Vector = NDArray[np.float64]

Search = Callable[[np.random.Generator], SwarmResult]
"""A search that is ready to run, with its source of randomness."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SearchPlan:
    """Which rule searches, with how large a swarm, for how long and how often."""

    optimiser: str
    particles: int
    iterations: int
    restarts: int

    @property
    def evaluations(self) -> int:
        """Evaluations of all restarts."""
        return self.restarts * self.particles * (self.iterations + 1)


def mean_error(objective: Objective, sums: Vector, counts: Vector) -> Vector:
    """Return the RMSE or MAE of sums of squares or magnitudes; NaN where nothing was counted."""
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        mean = sums / counts
        return np.asarray(np.sqrt(mean) if objective == "rmse" else mean)


class Space(Protocol):
    """The box of a search."""

    @property
    def dimensions(self) -> tuple[Dimension, ...]:
        """Return what is searched."""

    @property
    def lower(self) -> Vector:
        """Lower corner of the box, shape ``(D,)``."""

    @property
    def upper(self) -> Vector:
        """Upper corner of the box, shape ``(D,)``."""

    def design_parameters(self, x: Vector) -> tuple[Parameter, ...]:
        """Return a point, shape ``(D,)``, as the parameters of a design."""


def whole_cost(task: "Task", sums: Vector, points: Vector) -> Vector:
    """Return the cost of points: mean error of recordings and quantities, times preference.

    Parameters
    ----------
    sums
        Sums over whole recordings, shape ``(R, Q, P)``.
    points
        Shape ``(P, D)``.
    """
    error = task.metric(sums, task.block_counts(1)[:, :, 0, None])
    return np.asarray(error.mean(axis=(0, 1)) * task.preference(points))


class Task(Protocol):
    """The cost of points over recordings; each filter has a class of its own.

    Errors are of Q quantities: the angles of the axes, or the inclination alone.
    """

    @property
    def space(self) -> Space:
        """Return the box of the search."""

    @property
    def objective(self) -> Objective:
        """Return whether squares or magnitudes count."""

    @property
    def jobs(self) -> int:
        """Return how many threads work over recordings."""

    @property
    def lengths(self) -> tuple[int, ...]:
        """Return the samples of each recording."""

    @property
    def is_dear(self) -> bool:
        """Return whether points are too dear for a search of its own for every fold."""

    def with_jobs(self, jobs: int) -> "Task":
        """Return the same with other threads."""

    def preference(self, points: Vector) -> Vector:
        """Return the factors, 1 or more, that hold points of shape ``(P, D)`` to what is usual.

        They decide where the recordings do not: shape ``(P,)``.
        """

    def cost(self, points: Vector) -> Vector:
        """Return the cost of points of shape ``(P, D)``, rad: shape ``(P,)``."""

    def quick_search(self, plan: SearchPlan) -> Search | None:
        """Return a quicker way to the same optimum than asking for costs; None without one."""

    def block_sums(self, points: Vector, blocks: int) -> Vector:
        """Return sums of squares or magnitudes in blocks, shape ``(R, Q, blocks, P)``."""

    def block_counts(self, blocks: int) -> Vector:
        """Return how many samples are scored in each block, shape ``(R, Q, blocks)``."""

    def metric(self, sums: Vector, counts: Vector) -> Vector:
        """Return the RMSE or MAE of sums over so many samples."""

    def rms_rad(self, x: Vector, recording: int, begin: int = 0, end: int | None = None) -> float:
        """Return the RMSE of one point on one recording: its axis, or the inclination."""

    def errors(self, x: Vector, recording: int) -> Iterator[tuple[NDArray[np.bool_], Vector]]:
        """Run one point over one recording, part by part.

        Yields
        ------
        scored, errors
            Which samples are scored, shape ``(N,)``, and the errors, rad, shape ``(Q, N)``.
        """
