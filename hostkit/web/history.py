"""The last minute of samples, for a page that is opened later or again."""

from collections import deque
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from hostkit.monitor.snapshot import Batch

LENGTH_S = 60.0
MOST_SAMPLES = 120_000
"""A minute at 2 kHz; of a faster device the history is shorter."""


def joined(batches: Sequence[Batch]) -> Batch:
    """Return batches of one epoch as one, with the time of arrival of the last."""
    if len(batches) == 1:
        return batches[0]
    return replace(
        batches[-1],
        time_s=np.concatenate([b.time_s for b in batches]),
        device_rad=np.concatenate([b.device_rad for b in batches]),
        model_rad=np.concatenate([b.model_rad for b in batches]),
        residual_rad=np.concatenate([b.residual_rad for b in batches]),
        mismatch=np.concatenate([b.mismatch for b in batches]),
        begins=np.concatenate([b.begins for b in batches]),
    )


def broken(batch: Batch) -> Batch:
    """Return a batch whose first sample follows nothing: what was before it was left out."""
    begins = batch.begins.copy()
    begins[0] = True
    return replace(batch, begins=begins)


class History:
    """Samples of the present epoch, bounded in time and in number."""

    def __init__(self, length_s: float = LENGTH_S, most_samples: int = MOST_SAMPLES) -> None:
        self._length_s = length_s
        self._most_samples = most_samples
        self._batches: deque[Batch] = deque()
        self._samples = 0

    def __len__(self) -> int:
        return self._samples

    def add(self, batch: Batch) -> None:
        """Keep samples; those of an earlier epoch are void."""
        if self._batches and self._batches[-1].epoch != batch.epoch:
            self._batches.clear()
            self._samples = 0
        self._batches.append(batch)
        self._samples += len(batch)
        while len(self._batches) > 1 and self._too_much(float(batch.time_s[-1])):
            self._samples -= len(self._batches.popleft())

    def _too_much(self, now_s: float) -> bool:
        # Written so that a time that is no number counts as too old.
        recent = now_s - float(self._batches[0].time_s[-1]) <= self._length_s
        return self._samples > self._most_samples or not recent

    def batches(self) -> tuple[Batch, ...]:
        """Return what is kept, oldest first; the first sample begins a line."""
        kept = tuple(self._batches)
        return (broken(kept[0]), *kept[1:]) if kept else ()


def portions(batches: Sequence[Batch], samples: int) -> list[Batch]:
    """Join batches to about `samples` each."""
    result: list[Batch] = []
    group: list[Batch] = []
    for batch in batches:
        group.append(batch)
        if sum(len(b) for b in group) >= samples:
            result.append(joined(group))
            group = []
    return [*result, joined(group)] if group else result
