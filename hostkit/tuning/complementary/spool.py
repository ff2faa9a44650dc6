"""Streams of recordings that do not fit the memory: laid out once, then read part by part."""

from collections.abc import Iterator
from contextlib import ExitStack
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from hostkit.errors import HostkitError, RecordingError
from hostkit.filters.complementary.parameters import BIAS_LIMIT_RAD_S
from hostkit.recordings import LargeRecording
from hostkit.records import AXES
from hostkit.tuning.complementary.objective import Layout, lay_out
from hostkit.tuning.kernel import ErrorStream, within
from hostkit.tuning.kernel.arrays import COLUMNS, count, edges

PART_SAMPLES = 1 << 18
"""Samples of a part that is in memory."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SpooledStream:
    """One axis of a recording, its columns in files of one folder; see `ErrorStream`."""

    folder: Path
    samples: int
    columns: tuple[str, ...]
    dtype: np.dtype[Any]
    runs: NDArray[np.int64]
    bias_limit_rad: float
    first_start: float

    def __len__(self) -> int:
        return self.samples

    @property
    def scored(self) -> int:
        """Number of samples that are scored."""
        return count(self.runs)

    def blocks(self, number: int) -> Iterator[Iterator[ErrorStream]]:
        """Cut the stream into blocks of equal length, each in parts that fit the memory."""
        for begin, end in pairwise(edges(self.samples, number)):
            yield self._parts(begin, end)

    def scored_in_blocks(self, number: int) -> tuple[int, ...]:
        """Return how many samples of each block are scored."""
        cuts = pairwise(edges(self.samples, number))
        return tuple(count(within(self.runs, begin, end)) for begin, end in cuts)

    def _parts(self, begin: int, end: int) -> Iterator[ErrorStream]:
        for at in range(begin, end, PART_SAMPLES):
            to = min(at + PART_SAMPLES, end)
            found = {
                name: np.fromfile(
                    self.folder / name,
                    dtype=self.dtype,
                    count=to - at,
                    offset=at * self.dtype.itemsize,
                )
                for name in self.columns
            }
            yield ErrorStream(
                runs=within(self.runs, at, to) - at, bias_limit_rad=self.bias_limit_rad, **found
            )


def spool(recording: LargeRecording, layout: Layout, folder: Path) -> tuple[SpooledStream, ...]:
    """Lay a recording out in files, a stream for each axis.

    It takes 8 bytes a sample and axis in float32 where only eta is tuned, 20 where more is, and 4
    more for two axes.

    Parameters
    ----------
    folder
        An empty folder with room for that.

    Raises
    ------
    RecordingError
        If the recording is damaged, has no reference, or no sample of it can be scored.
    HostkitError
        If the disk is full.
    """
    axes = AXES[layout.axes]
    columns = tuple(name for name in COLUMNS if name != "reference" or len(axes) == 2)
    with ExitStack() as stack:
        writers = tuple(
            stack.enter_context(_Writer(folder / axis, columns, layout)) for axis in axes
        )
        try:
            for part in recording.parts():
                for axis, writer in zip(axes, writers, strict=True):
                    writer.add(lay_out(part, axis, layout, writer.before_rad))
        except OSError as error:
            raise HostkitError(f"{folder} cannot be written: {error.strerror or error}") from error
    if not all(writer.runs for writer in writers):
        raise RecordingError(
            f"{recording.name}: none of its {len(recording)} samples is valid with a reference"
        )
    return tuple(writer.stream() for writer in writers)


class _Writer(ExitStack):
    """The files of one axis while they are written."""

    def __init__(self, folder: Path, columns: tuple[str, ...], layout: Layout) -> None:
        super().__init__()
        folder.mkdir()
        self._folder = folder
        self._wanted = columns
        self._layout = layout
        self._files: dict[str, BinaryIO] = {}
        self.samples = 0
        self.runs: list[NDArray[np.int64]] = []
        self.first_start = 0.0
        self.before_rad: float | None = None

    def add(self, part: ErrorStream) -> None:
        if self.samples == 0:
            self.first_start = part.first_start
        for name, column in zip(COLUMNS, part.columns, strict=True):
            if column is not None and name in self._wanted:
                if name not in self._files:
                    file = (self._folder / name).open("wb")
                    self._files[name] = self.enter_context(file)
                column.tofile(self._files[name])
        if len(part.runs):
            self.runs.append(part.runs + self.samples)
        assert part.reference is not None
        self.before_rad = float(part.reference[-1])
        self.samples += len(part)

    def stream(self) -> SpooledStream:
        return SpooledStream(
            folder=self._folder,
            samples=self.samples,
            columns=tuple(self._files),
            dtype=np.dtype(self._layout.dtype),
            runs=_joined(np.concatenate(self.runs)),
            bias_limit_rad=BIAS_LIMIT_RAD_S * self._layout.period_s,
            first_start=self.first_start,
        )


def _joined(runs: NDArray[np.int64]) -> NDArray[np.int64]:
    """Join runs that follow each other without a gap."""
    opens = np.concatenate([[True], runs[1:, 0] > runs[:-1, 1]])
    closes = np.concatenate([opens[1:], [True]])
    return np.column_stack([runs[opens, 0], runs[closes, 1]])
