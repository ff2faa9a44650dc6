"""Remembering every point of a search, so that it can be judged again with other weights.

A problem whose points are dear is not searched anew for each fold of a cross-validation and each
draw of a bootstrap: the sums of every point that the search visited are kept block by block, and
a tuning with other weights takes the best of those points. The search itself saw all recordings, so
for held-out errors each fold searches on from there (:mod:`hostkit.tuning.refinement`).
"""

from collections.abc import Iterator
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from hostkit.records import Objective
from hostkit.tuning.task import Search, SearchPlan, Space, Task, whole_cost

Vector = NDArray[np.float64]

BLOCKS_OF_ONE = 80
"""Blocks of a single recording: as many fifths and sixteenths of it can be put together."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Visited:
    """Points and their sums.

    Attributes
    ----------
    points
        Shape ``(P, D)``.
    sums
        Shape ``(R, Q, B, P)``.
    """

    points: Vector
    sums: Vector

    def in_blocks(self, blocks: int) -> Vector:
        """Return the sums over fewer blocks, of which each holds several; ``(R, Q, blocks, P)``."""
        recordings, quantities, own, points = self.sums.shape
        assert own % blocks == 0
        shape = (recordings, quantities, blocks, own // blocks, points)
        return np.asarray(self.sums.reshape(shape).sum(axis=3))


@dataclass(frozen=True, slots=True, kw_only=True)
class ArchivedTask:
    """A problem that remembers what was asked of it.

    Attributes
    ----------
    task
        The problem itself.
    blocks
        Parts of each recording that sums are kept for.
    """

    task: Task
    blocks: int
    _kept: list[tuple[Vector, Vector]] = field(default_factory=list)

    @property
    def space(self) -> Space:
        """Return the box of the search."""
        return self.task.space

    @property
    def objective(self) -> Objective:
        """Return whether squares or magnitudes count."""
        return self.task.objective

    @property
    def jobs(self) -> int:
        """Return how many threads work over recordings."""
        return self.task.jobs

    @property
    def lengths(self) -> tuple[int, ...]:
        """Return the samples of each recording."""
        return self.task.lengths

    @property
    def is_dear(self) -> bool:
        """Return whether points are too dear for a search of its own for every fold."""
        return True

    def with_jobs(self, jobs: int) -> "ArchivedTask":
        """Return the same with other threads; both remember together."""
        return replace(self, task=self.task.with_jobs(jobs))

    def preference(self, points: Vector) -> Vector:
        """Return the factors, 1 or more, that hold points of shape ``(P, D)`` to what is usual.

        They decide where the recordings do not: shape ``(P,)``.
        """
        return self.task.preference(points)

    def cost(self, points: Vector) -> Vector:
        """Return the cost of points, rad, and remember them."""
        sums = self.task.block_sums(points, self.blocks)
        self._kept.append((points.copy(), sums))
        return whole_cost(self, sums.sum(axis=2), points)

    def quick_search(self, plan: SearchPlan) -> Search | None:
        """Return none: what is searched elsewhere cannot be remembered."""
        return None

    def visited(self) -> Visited:
        """Return all that is remembered."""
        points, sums = zip(*self._kept, strict=True)
        return Visited(points=np.concatenate(points), sums=np.concatenate(sums, axis=3))

    def block_sums(self, points: Vector, blocks: int) -> Vector:
        """Return sums of squares or magnitudes in blocks."""
        return self.task.block_sums(points, blocks)

    def block_counts(self, blocks: int) -> Vector:
        """Return how many samples are scored in each block."""
        return self.task.block_counts(blocks)

    def metric(self, sums: Vector, counts: Vector) -> Vector:
        """Return the RMSE or MAE of sums over so many samples."""
        return self.task.metric(sums, counts)

    def rms_rad(self, x: Vector, recording: int, begin: int = 0, end: int | None = None) -> float:
        """Return the RMSE of one point on one recording."""
        return self.task.rms_rad(x, recording, begin, end)

    def errors(self, x: Vector, recording: int) -> Iterator[tuple[NDArray[np.bool_], Vector]]:
        """Run one point over one recording, part by part."""
        return self.task.errors(x, recording)


def archived(task: Task, least_units: int) -> ArchivedTask:
    """Return a problem that remembers what it is asked, block by block.

    Parameters
    ----------
    least_units
        Blocks of few recordings, all together, that a bootstrap draws from.
    """
    recordings = len(task.lengths)
    return ArchivedTask(
        task=task, blocks=BLOCKS_OF_ONE if recordings == 1 else -(-least_units // recordings)
    )
