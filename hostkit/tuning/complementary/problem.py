"""The cost of many points over many recordings, whole or in blocks, with weights or without."""

import math
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import DTypeLike, NDArray

from hostkit.attitude import inclination_rad, up_from_tilt
from hostkit.records import Objective
from hostkit.tuning.complementary.quick_search import quick_search
from hostkit.tuning.complementary.space import SearchSpace
from hostkit.tuning.kernel import (
    Candidates,
    Carry,
    ErrorStream,
    Kernel,
    StreamSource,
    kernel,
    scored_mask,
)
from hostkit.tuning.task import Search, SearchPlan, mean_error

Vector = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class Problem:
    """Recordings laid out for the kernel, and what is asked of them.

    Attributes
    ----------
    streams
        For each recording a stream for each axis.
    jobs
        Threads over recordings.
    dtype
        Of the arithmetic; streams may be float32 where it is float64.
    """

    space: SearchSpace
    streams: tuple[tuple[StreamSource, ...], ...]
    objective: Objective
    jobs: int = 1
    dtype: DTypeLike = np.float64
    kernel: Kernel = field(default_factory=kernel)

    @property
    def lengths(self) -> tuple[int, ...]:
        """Return the samples of each recording."""
        return tuple(len(streams[0]) for streams in self.streams)

    @property
    def is_dear(self) -> bool:
        """Return whether points are too dear for a search of its own for every fold."""
        return False

    def with_jobs(self, jobs: int) -> "Problem":
        """Return the same with other threads."""
        return replace(self, jobs=jobs)

    def preference(self, points: Vector) -> Vector:
        """Return the factors, 1 or more, that hold points of shape ``(P, D)`` to what is usual.

        They decide where the recordings do not: shape ``(P,)``.
        """
        return np.ones(len(points))

    def quick_search(self, plan: SearchPlan) -> Search | None:
        """Return a search in tables or in compiled code, where it holds and pays."""
        return quick_search(self, plan)

    def cost(self, points: Vector) -> Vector:
        """Return the cost of points, rad: the mean over recordings and axes of RMSE or MAE.

        Every recording counts the same, however long it is.

        Parameters
        ----------
        points
            Coordinates of the search space, shape ``(P, D)``.

        Returns
        -------
        numpy.ndarray
            Costs, shape ``(P,)``; NaN where the error is not finite.
        """
        return np.asarray(self.error(points).mean(axis=(0, 1)))

    def error(self, points: Vector) -> Vector:
        """Return the RMSE or MAE, rad, of each recording and axis: shape ``(R, A, P)``."""
        return self.metric(self.block_sums(points, 1)[:, :, 0], self.block_counts(1)[:, :, 0, None])

    def metric(self, sums: Vector, counts: Vector) -> Vector:
        """Return the RMSE or MAE of sums over so many samples."""
        return mean_error(self.objective, sums, counts)

    def block_sums(self, points: Vector, blocks: int) -> Vector:
        """Return what the kernel sums up, block by block.

        Parameters
        ----------
        points
            Coordinates, shape ``(P, D)``.
        blocks
            Parts of equal length into which every recording is cut; the filter runs on through
            them.

        Returns
        -------
        numpy.ndarray
            Sums of squares or magnitudes, shape ``(R, A, blocks, P)``.
        """
        candidates = tuple(self.space.candidates(axis, points) for axis in self.space.axes)

        def of_recording(streams: tuple[StreamSource, ...]) -> Vector:
            pairs = zip(streams, candidates, strict=True)
            return np.stack([self._stream_sums(s, c, blocks) for s, c in pairs])

        if self.jobs == 1 or len(self.streams) == 1:
            return np.stack([of_recording(streams) for streams in self.streams])
        with ThreadPoolExecutor(self.jobs) as pool:
            return np.stack(list(pool.map(of_recording, self.streams)))

    def block_counts(self, blocks: int) -> Vector:
        """Return how many samples are scored in each block, shape ``(R, A, blocks)``."""
        return np.array(
            [[stream.scored_in_blocks(blocks) for stream in streams] for streams in self.streams],
            dtype=np.float64,
        )

    def _stream_sums(self, stream: StreamSource, candidates: Candidates, blocks: int) -> Vector:
        carry = Carry.before(stream, candidates, self.dtype, blocks)
        if isinstance(stream, ErrorStream):
            self.kernel.add_sums(stream, candidates, self.objective, carry)
            return carry.sums
        for row, block in enumerate(stream.blocks(blocks)):
            of_block = replace(carry, sums=carry.sums[row : row + 1])
            for part in block:
                self.kernel.add_sums(part, candidates, self.objective, of_block)
            carry.error, carry.bias = of_block.error, of_block.bias
        return carry.sums

    def rms_rad(self, x: Vector, recording: int, begin: int = 0, end: int | None = None) -> float:
        """Return the RMSE of one point on one recording: its axis, or the inclination of both.

        Parameters
        ----------
        x
            Coordinates, shape ``(D,)``.
        begin, end
            Samples that count; the filter runs on through the others.
        """
        squares, scored, at = 0.0, 0, 0
        for parts, error in self._traces(x, recording):
            mask = scored_of(parts, begin - at, None if end is None else end - at)
            deviation = _deviation(parts, error)[mask]
            squares += float(np.square(deviation).sum())
            scored += len(deviation)
            at += len(parts[0])
        return math.sqrt(squares / scored) if scored else math.nan

    def errors(self, x: Vector, recording: int) -> Iterator[tuple[NDArray[np.bool_], Vector]]:
        """Run one point over one recording, part by part.

        Yields
        ------
        scored, errors
            Which samples are scored on all axes, shape ``(N,)``, and the error of each axis, rad,
            shape ``(A, N)``.
        """
        for parts, errors in self._traces(x, recording):
            yield scored_of(parts), np.stack(errors)

    def _traces(
        self, x: Vector, recording: int
    ) -> Iterator[tuple[tuple[ErrorStream, ...], tuple[Vector, ...]]]:
        """Run one point over one recording, part by part.

        Yields
        ------
        parts, errors
            For each axis the part of its stream, and the error of the filter on it, rad, shape
            ``(N,)``.
        """
        streams = self.streams[recording]
        candidates = [self.space.candidates(axis, x[np.newaxis]) for axis in self.space.axes]
        carries = [Carry.before(s, c) for s, c in zip(streams, candidates, strict=True)]
        for blocks in zip(*(stream.blocks(1) for stream in streams), strict=True):
            for parts in zip(*blocks, strict=True):
                lanes = zip(parts, candidates, carries, strict=True)
                yield parts, tuple(self.kernel.trace(part, c, carry) for part, c, carry in lanes)


def scored_of(
    parts: tuple[ErrorStream, ...], begin: int = 0, end: int | None = None
) -> NDArray[np.bool_]:
    """Return which samples from `begin` to `end` are scored on all axes, shape ``(N,)``."""
    samples = len(parts[0])
    mask = np.zeros(samples, dtype=np.bool_)
    mask[max(begin, 0) : samples if end is None else max(end, 0)] = True
    for part in parts:
        mask &= scored_mask(part)
    return mask


def _deviation(parts: tuple[ErrorStream, ...], error: tuple[Vector, ...]) -> Vector:
    """Return the error of the one axis, or the angle between the up directions of both."""
    if len(parts) == 1:
        return error[0]
    roll, pitch = (np.asarray(part.reference, dtype=np.float64) for part in parts)
    estimated = up_from_tilt(roll + error[0], pitch + error[1])
    return np.asarray(inclination_rad(estimated, up_from_tilt(roll, pitch)))
