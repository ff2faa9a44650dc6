"""Counting the samples that came before a device told the state of its filter."""

import numpy as np
from numpy.typing import NDArray


class Waiting:
    """An account of samples that no model could follow.

    Attributes
    ----------
    samples, longest
        How many there were, and the most of them in a row.
    """

    def __init__(self) -> None:
        self._now = 0
        self.forget_figures()

    def forget_figures(self) -> None:
        """Count anew; a wait that lasts goes on."""
        self.samples = self.longest = 0

    def add(self, judged: NDArray[np.bool_]) -> int:
        """Take which samples were judged; return how many were not."""
        for known in judged.tolist():
            self._now = 0 if known else self._now + 1
            self.longest = max(self.longest, self._now)
        waited = int((~judged).sum())
        self.samples += waited
        return waited
