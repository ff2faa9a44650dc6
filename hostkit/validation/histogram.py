"""Counting sizes in classes of equal ratio: percentiles in bounded memory."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hostkit.records import read_only

Vector = NDArray[np.float64]
IntArray = NDArray[np.int64]

RATIO = 1.02
"""Upper by lower end of a class: a percentile is right within 1 %."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Histogram:
    """Counts of sizes, for a figure.

    Attributes
    ----------
    edges
        Ends of the classes, rising, shape ``(N + 1,)``; the first class holds all that is smaller
        and the last all that is larger.
    counts
        Shape ``(N,)``.
    """

    edges: Vector
    counts: IntArray

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        read_only(self.edges)
        read_only(self.counts)


class LogHistogram:
    """Counts sizes in classes whose ends have a ratio of 1.02.

    Parameters
    ----------
    lowest, highest
        Sizes below and above are counted in the first and the last class.
    """

    def __init__(self, lowest: float, highest: float) -> None:
        self._lowest = math.log(lowest)
        self._step = math.log(RATIO)
        classes = math.ceil((math.log(highest) - self._lowest) / self._step) + 1
        self._counts = np.zeros(classes, dtype=np.int64)

    def add(self, sizes: Vector) -> None:
        """Count finite sizes, 0 or more."""
        with np.errstate(divide="ignore"):
            place = np.floor((np.log(sizes) - self._lowest) / self._step)
        np.add.at(self._counts, np.clip(place, -1, len(self._counts) - 2).astype(np.int64) + 1, 1)

    def percentile(self, share: float) -> float:
        """Return the size that a share of the counted ones does not exceed, within 1 %.

        A size below the lowest counts as 0; so does the percentile of nothing.
        """
        total = int(self._counts.sum())
        place = int(np.searchsorted(np.cumsum(self._counts), max(1.0, share * total)))
        if total == 0 or place == 0:
            return 0.0
        return math.exp(self._lowest + self._step * (place - 0.5))

    def histogram(self, classes_together: int = 8) -> Histogram:
        """Return the part that is not empty, with so many classes made one."""
        counts = np.append(self._counts, np.zeros(-len(self._counts) % classes_together, np.int64))
        counts = counts.reshape(-1, classes_together).sum(axis=1)
        used = np.flatnonzero(counts)
        first, last = (int(used[0]), int(used[-1])) if len(used) else (0, 0)
        places = np.arange(first, last + 2) * classes_together - 1
        return Histogram(
            edges=np.exp(self._lowest + self._step * places),
            counts=counts[first : last + 1].astype(np.int64),
        )
