"""A peer as a problem that hostkit's own search and cross-validation can work on."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from hostkit.comparison.calibration import Readings
from hostkit.comparison.peer import Peer
from hostkit.mounting import Mounting
from hostkit.records import Objective, Parameter
from hostkit.tuning.dimension import Dimension
from hostkit.tuning.evaluation import Quantity
from hostkit.tuning.kernel.arrays import edges

Vector = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class PeerSpace:
    """The box of a peer's parameters."""

    peer: Peer

    @property
    def dimensions(self) -> tuple[Dimension, ...]:
        """Return what is searched."""
        return tuple(
            Dimension(
                name=p.name,
                axis=None,
                lower=math.log(p.lowest) if p.is_log else p.lowest,
                upper=math.log(p.highest) if p.is_log else p.highest,
                is_log=p.is_log,
                shown_unit=p.unit,
            )
            for p in self.peer.parameters
        )

    @property
    def lower(self) -> Vector:
        """Lower corner of the box, shape ``(D,)``."""
        return np.array([d.lower for d in self.dimensions])

    @property
    def upper(self) -> Vector:
        """Upper corner of the box, shape ``(D,)``."""
        return np.array([d.upper for d in self.dimensions])

    @property
    def start(self) -> Vector:
        """Return the peer's own values as a point, shape ``(D,)``."""
        pairs = zip(self.peer.parameters, self.peer.defaults, strict=True)
        return np.array([math.log(value) if p.is_log else value for p, value in pairs])

    def values(self, x: Vector) -> tuple[float, ...]:
        """Return a point, shape ``(D,)``, as the peer's parameters."""
        return tuple(d.value(float(c)) for d, c in zip(self.dimensions, x, strict=True))

    def design_parameters(self, x: Vector) -> tuple[Parameter, ...]:
        """Return a point as named parameters."""
        pairs = zip(self.peer.parameters, self.values(x), strict=True)
        return tuple(Parameter(name=p.name, value=value, unit=p.unit) for p, value in pairs)


@dataclass(frozen=True, slots=True, kw_only=True)
class PeerProblem:
    """A peer over recordings: a :class:`hostkit.tuning.task.Task`.

    Attributes
    ----------
    lead_s
        How far the directions of up are told ahead, with the measured rate.
    """

    peer: Peer
    readings: tuple[Readings, ...]
    quantity: Quantity
    mounting: Mounting
    lead_s: float
    objective: Objective = "rmse"
    jobs: int = 1

    @property
    def space(self) -> PeerSpace:
        """Return the box of the search."""
        return PeerSpace(peer=self.peer)

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
        """Return the error over one recording, rad, shape ``(N,)``."""
        one = self.readings[recording]
        up = self.peer.run(one.rate_rad_s, one.force_m_s2, one.period_s, values)
        led = one.led(up, self.lead_s)
        return one.track.deviation_rad(led, self.quantity, self.mounting)

    def each_rms_rad(self, values: tuple[float, ...]) -> Vector:
        """Return the RMSE of every recording, shape ``(R,)``."""
        each = []
        for i, one in enumerate(self.readings):
            deviation = self.deviation_rad(values, i)[one.track.scored]
            each.append(math.sqrt(float(np.mean(deviation**2))))
        return np.array(each)

    def cost(self, points: Vector) -> Vector:
        """Return the cost of points of shape ``(P, D)``, rad: shape ``(P,)``."""
        sums, counts = self.block_sums(points, 1), self.block_counts(1)
        return np.asarray(self.metric(sums[:, :, 0], counts[:, :, 0, None]).mean(axis=(0, 1)))

    def metric(self, sums: Vector, counts: Vector) -> Vector:
        """Return the RMSE of sums over so many samples."""
        with np.errstate(invalid="ignore", divide="ignore"):
            return np.asarray(np.sqrt(sums / counts))

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
        counts = [
            [int(one.track.scored[a:b].sum()) for a, b in pairwise(edges(len(one.track), blocks))]
            for one in self.readings
        ]
        return np.array(counts, dtype=np.float64)[:, np.newaxis]

    def rms_rad(self, x: Vector, recording: int, begin: int = 0, end: int | None = None) -> float:
        """Return the RMSE of one point on one recording, or on a part of it."""
        counted = np.zeros(self.lengths[recording], dtype=np.bool_)
        counted[begin:end] = True
        scored = self.readings[recording].track.scored & counted
        deviation = self.deviation_rad(self.space.values(x), recording)[scored]
        return math.sqrt(float(np.mean(deviation**2))) if len(deviation) else math.nan

    def errors(self, x: Vector, recording: int) -> Iterator[tuple[NDArray[np.bool_], Vector]]:
        """Run one point over one recording: scored samples, and the error, shape ``(1, N)``."""
        track = self.readings[recording].track
        yield track.scored, self.deviation_rad(self.space.values(x), recording)[np.newaxis]
