"""The cost of many observers over many recordings."""

from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from hostkit.attitude import up_from_tilt
from hostkit.filters.observer.float_model import run_float
from hostkit.mounting import Mounting
from hostkit.records import FilterDesign, Objective, SensorConfig
from hostkit.tuning.evaluation import Quantity
from hostkit.tuning.kernel.arrays import edges
from hostkit.tuning.observer.kernel import Kernel, Terms, candidate_table
from hostkit.tuning.observer.space import ObserverSpace
from hostkit.tuning.task import Search, SearchPlan, mean_error, whole_cost
from hostkit.tuning.track import Track, scored_in_blocks, scored_rms_rad
from hostkit.units import STANDARD_GRAVITY_M_S2

Vector = NDArray[np.float64]

ANY_SENSOR = SensorConfig(
    part="mpu6050", gyro_full_scale_deg_s=2000, accel_full_scale_g=16, low_pass_setting=1
)
"""The float model reads SI units, so the ranges do not matter to it."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ObserverProblem:
    """Recordings and what is asked of them; errors are of one quantity.

    Attributes
    ----------
    quantity
        The inclination, or the angle of the one axis of the design.
    kernel
        The observer in C; None where there is no compiler, then the float model runs.
    jobs
        Threads over recordings.
    """

    space: ObserverSpace
    tracks: tuple[Track, ...]
    rate_hz: float
    mounting: Mounting
    quantity: Quantity
    objective: Objective
    kernel: Kernel | None
    jobs: int = 1

    @property
    def lengths(self) -> tuple[int, ...]:
        """Return the samples of each recording."""
        return tuple(len(track) for track in self.tracks)

    @property
    def is_dear(self) -> bool:
        """Return whether points are too dear for a search of its own for every fold."""
        return True

    def with_jobs(self, jobs: int) -> "ObserverProblem":
        """Return the same with other threads."""
        return replace(self, jobs=jobs)

    def preference(self, points: Vector) -> Vector:
        """Return the factors, 1 or more, that hold points of shape ``(P, D)`` to what is usual.

        They decide where the recordings do not: shape ``(P,)``.
        """
        return self.space.preference(points)

    def cost(self, points: Vector) -> Vector:
        """Return the cost of points, rad: mean RMSE or MAE of the recordings, times preference.

        Parameters
        ----------
        points
            Coordinates of the search space, shape ``(P, D)``.

        Returns
        -------
        numpy.ndarray
            Costs, shape ``(P,)``.
        """
        return whole_cost(self, self.block_sums(points, 1)[:, :, 0], points)

    def quick_search(self, plan: SearchPlan) -> Search | None:
        """Return none: points are run one beside the other, and that is all."""
        return None

    def metric(self, sums: Vector, counts: Vector) -> Vector:
        """Return the RMSE or MAE of sums over so many samples."""
        return mean_error(self.objective, sums, counts)

    def block_sums(self, points: Vector, blocks: int) -> Vector:
        """Return sums of squares or magnitudes in blocks, shape ``(R, 1, blocks, P)``."""

        def of_track(track: Track) -> Vector:
            return self._sums(track, points, blocks)

        if self.jobs == 1 or len(self.tracks) == 1:
            found = [of_track(track) for track in self.tracks]
        else:
            with ThreadPoolExecutor(self.jobs) as pool:
                found = list(pool.map(of_track, self.tracks))
        return np.stack(found)[:, np.newaxis]

    def block_counts(self, blocks: int) -> Vector:
        """Return how many samples are scored in each block, shape ``(R, 1, blocks)``."""
        return scored_in_blocks(self.tracks, blocks)

    def rms_rad(self, x: Vector, recording: int, begin: int = 0, end: int | None = None) -> float:
        """Return the RMSE of one point on one recording.

        Parameters
        ----------
        begin, end
            Samples that count; the filter runs on through the others.
        """
        track = self.tracks[recording]
        return scored_rms_rad(track, self._deviation(x, track), begin, end)

    def errors(self, x: Vector, recording: int) -> Iterator[tuple[NDArray[np.bool_], Vector]]:
        """Run one point over one recording: scored samples, and the error, shape ``(1, N)``."""
        track = self.tracks[recording]
        yield track.scored, self._deviation(x, track)[np.newaxis]

    @property
    def _terms(self) -> Terms:
        return Terms(
            period_s=1.0 / self.rate_hz,
            mounting=self.mounting,
            quantity=self.quantity,
            objective=self.objective,
        )

    def _table(self, points: Vector) -> Vector:
        return candidate_table(self.space.values(points), len(points), 1.0 / self.rate_hz)

    def _sums(self, track: Track, points: Vector, blocks: int) -> Vector:
        if self.kernel is not None:
            return self.kernel.sums(track, self._terms, self._table(points), blocks)
        sums = np.zeros((blocks, len(points)))
        for i, x in enumerate(points):
            size = np.abs(np.where(track.scored, self._deviation(x, track), 0.0))
            each = size**2 if self.objective == "rmse" else size
            sums[:, i] = [each[a:b].sum() for a, b in pairwise(edges(len(track), blocks))]
        return sums

    def _deviation(self, x: Vector, track: Track) -> Vector:
        """Return the error of one point over one recording, rad, shape ``(N,)``."""
        if self.kernel is not None:
            up = self.kernel.ups(track, self._terms, self._table(x[np.newaxis])[:, 0])
        else:
            up = self._modelled(x, track)
        return track.deviation_rad(up, self.quantity, self.mounting)

    def _modelled(self, x: Vector, track: Track) -> Vector:
        """Return the directions of up that the float model gives, sensor axes."""
        design = FilterDesign(
            filter="observer",
            axes="both",
            tilt="atan2",
            mounting=Mounting(),
            rate_hz=self.rate_hz,
            sensor=ANY_SENSOR,
            parameters=self.space.design_parameters(x),
        )
        angle = run_float(design, track.rate_rad_s, track.force_m_s2 / STANDARD_GRAVITY_M_S2)
        return up_from_tilt(angle[:, 0], angle[:, 1])
