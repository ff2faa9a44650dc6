"""The cost of points where parts of the recordings have weights: 0 leaves them out."""

import numpy as np
from numpy.typing import NDArray

from hostkit.tuning.task import Task

Vector = NDArray[np.float64]


def weighted_cost(problem: Task, sums: Vector, counts: Vector, weights: Vector) -> Vector:
    """Return the cost of points where blocks have weights.

    Parameters
    ----------
    sums, counts
        From `Task.block_sums` and `Task.block_counts`: shapes ``(R, A, B, P)`` and
        ``(R, A, B)``.
    weights
        Shape ``(R, B)``.

    Returns
    -------
    numpy.ndarray
        Mean over recordings, each weighing as much as its blocks on average, shape ``(P,)``.
    """
    total = np.einsum("rabp,rb->rap", sums, weights)
    scored = np.einsum("rab,rb->ra", counts, weights)
    counted = used(counts, weights)
    if not counted.any():
        return np.full(sums.shape[-1], np.nan)
    share = weights.mean(axis=1)[counted]
    error = problem.metric(total[counted], scored[counted][:, :, None]).mean(axis=1)
    return np.asarray(share @ error / share.sum())


def used(counts: Vector, weights: Vector) -> NDArray[np.bool_]:
    """Return which recordings have scored samples with weight on every axis, shape ``(R,)``."""
    return np.asarray((np.einsum("rab,rb->ra", counts, weights) > 0.0).all(axis=1))
