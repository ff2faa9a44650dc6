"""A peer as a problem that hostkit's own search and cross-validation can work on."""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from hostkit.attitude import up_from_quaternion
from hostkit.comparison.calibration import Readings
from hostkit.comparison.peer import Peer
from hostkit.comparison.peer_space import PeerSpace
from hostkit.mounting import Mounting
from hostkit.records import Objective
from hostkit.tuning.evaluation import Quantity
from hostkit.tuning.kernel.arrays import edges
from hostkit.tuning.task import Search, SearchPlan, mean_error, whole_cost
from hostkit.tuning.track import scored_in_blocks, scored_rms_rad

Vector = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class PeerProblem:
    """A peer over recordings: a :class:`hostkit.tuning.task.Task`.

    Attributes
    ----------
    lead_s
        How far the directions of up are told ahead, with the measured rate.
    is_scaled
        Whether the scale of the gyroscope is searched with the peer's own parameters.
    """

    peer: Peer
    readings: tuple[Readings, ...]
    quantity: Quantity
    mounting: Mounting
    lead_s: float
    is_scaled: bool = False
    objective: Objective = "rmse"
    jobs: int = 1

    @property
    def space(self) -> PeerSpace:
        """Return the box of the search."""
        return PeerSpace(peer=self.peer, is_scaled=self.is_scaled)

    @property
    def lengths(self) -> tuple[int, ...]:
        """Return the samples of each recording."""
        return tuple(len(one.track) for one in self.readings)

    @property
    def is_dear(self) -> bool:
        """Return that a search of its own for every fold would take too long."""
        return True

    def with_jobs(self, jobs: int) -> "PeerProblem":
        """Return the same: packages hold the interpreter while they compute."""
        return self

    def deviation_rad(self, values: tuple[float, ...], recording: int) -> Vector:
        """Return the error over one recording, rad, shape ``(N,)``.

        Parameters
        ----------
        values
            The peer's own parameters, then the scale of the gyroscope if there is more.
        """
        count = len(self.peer.parameters)
        own, scales = values[:count], values[count:]
        one = self.readings[recording]
        if scales:
            one = one.scaled(np.array(scales))
        orientation = self.peer.run(one.rate_rad_s, one.force_m_s2, one.period_s, own)
        led = one.led(up_from_quaternion(orientation), self.lead_s)
        return one.track.deviation_rad(led, self.quantity, self.mounting)

    def each_rms_rad(self, values: tuple[float, ...]) -> Vector:
        """Return the RMSE of every recording, shape ``(R,)``."""
        each = [
            scored_rms_rad(one.track, self.deviation_rad(values, i), 0, None)
            for i, one in enumerate(self.readings)
        ]
        return np.array(each)

    def cost(self, points: Vector) -> Vector:
        """Return the cost of points of shape ``(P, D)``, rad: shape ``(P,)``."""
        return whole_cost(self, self.block_sums(points, 1)[:, :, 0], points)

    def preference(self, points: Vector) -> Vector:
        """Return the factors, 1 or more, that hold points of shape ``(P, D)`` to what is usual."""
        return self.space.preference(points)

    def quick_search(self, plan: SearchPlan) -> Search | None:
        """Return none: a peer is only run."""
        return None

    def metric(self, sums: Vector, counts: Vector) -> Vector:
        """Return the RMSE of sums over so many samples."""
        return mean_error(self.objective, sums, counts)

    def block_sums(self, points: Vector, blocks: int) -> Vector:
        """Return sums of squares in blocks, shape ``(R, 1, blocks, P)``."""
        sums = np.zeros((len(self.readings), 1, blocks, len(points)))
        for p, x in enumerate(points):
            values = self.space.values(x)
            for r, one in enumerate(self.readings):
                square = np.where(one.track.scored, self.deviation_rad(values, r) ** 2, 0.0)
                cuts = pairwise(edges(len(one.track), blocks))
                sums[r, 0, :, p] = [square[a:b].sum() for a, b in cuts]
        return sums

    def block_counts(self, blocks: int) -> Vector:
        """Return how many samples are scored in each block, shape ``(R, 1, blocks)``."""
        return scored_in_blocks(tuple(one.track for one in self.readings), blocks)

    def rms_rad(self, x: Vector, recording: int, begin: int = 0, end: int | None = None) -> float:
        """Return the RMSE of one point on one recording, or on a part of it."""
        deviation = self.deviation_rad(self.space.values(x), recording)
        return scored_rms_rad(self.readings[recording].track, deviation, begin, end)

    def errors(self, x: Vector, recording: int) -> Iterator[tuple[NDArray[np.bool_], Vector]]:
        """Run one point over one recording: scored samples, and the error, shape ``(1, N)``."""
        track = self.readings[recording].track
        yield track.scored, self.deviation_rad(self.space.values(x), recording)[np.newaxis]
