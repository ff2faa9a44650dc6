"""What a session keeps for its report, in bounded memory however long it runs."""

import numpy as np
from numpy.typing import NDArray

from hostkit.link.frames.timesync import newest_of_each
from hostkit.monitor.result import Overlay
from hostkit.monitor.snapshot import Batch
from hostkit.validation import Histogram, LogHistogram

Vector = NDArray[np.float64]

MOST_POINTS = 3000
"""Points that are kept; when there are twice as many, two become one."""

JITTER_S = (1e-6, 10.0)
"""Ends of the classes of the jitter."""


class OverlayCollector:
    """Thins out the samples of a session to at most 6000 points."""

    def __init__(self, axes: int) -> None:
        self._axes = axes
        self._per_point = 1
        self._rows = np.empty((0, 2 + 3 * axes))
        self._waiting: list[Vector] = []
        self._waiting_count = 0

    def add(self, batch: Batch) -> None:
        """Take further samples."""
        columns = (batch.device_rad, batch.model_rad, batch.residual_rad)
        self._waiting.append(np.column_stack((batch.time_s, batch.begins, *columns)))
        self._waiting_count += len(batch)
        if self._waiting_count >= max(MOST_POINTS, self._per_point):
            self._thin()

    def overlay(self) -> Overlay:
        """Return the points so far."""
        self._thin()
        rest = np.vstack([self._rows, *self._waiting])
        device, model, residual = (
            rest[:, 2 + i * self._axes : 2 + (i + 1) * self._axes].copy() for i in range(3)
        )
        return Overlay(
            time_s=rest[:, 0].copy(),
            begins=rest[:, 1] != 0.0,
            device_rad=device,
            model_rad=model,
            residual_rad=residual,
            samples_per_point=self._per_point,
        )

    def _thin(self) -> None:
        waiting = np.vstack([*self._waiting, np.empty((0, self._rows.shape[1]))])
        whole = len(waiting) // self._per_point * self._per_point
        self._rows = np.vstack([self._rows, self._merged(waiting[:whole], self._per_point)])
        self._waiting = [waiting[whole:]]
        self._waiting_count = len(waiting) - whole
        while len(self._rows) >= 2 * MOST_POINTS:
            even = len(self._rows) // 2 * 2
            last = self._rows[even:]
            self._rows = np.vstack([self._merged(self._rows[:even], 2), last])
            self._per_point *= 2

    def _merged(self, rows: Vector, together: int) -> Vector:
        """Make one point of so many: its first sample, with the greatest residual of all."""
        groups = rows.reshape(-1, together, rows.shape[1])
        merged = groups[:, 0].copy()
        merged[:, 1] = groups[:, :, 1].max(axis=1, initial=0.0)
        residual = groups[:, :, 2 + 2 * self._axes :]
        sizes = np.where(np.isnan(residual), -1.0, np.abs(residual))
        place = sizes.argmax(axis=1)[:, None, :]
        merged[:, 2 + 2 * self._axes :] = np.take_along_axis(residual, place, axis=1)[:, 0]
        return merged


class JitterCollector:
    """How far the time between two arrivals is from the time between their newest samples."""

    def __init__(self) -> None:
        self._sizes = LogHistogram(*JITTER_S)
        self._last: tuple[int, int] | None = None

    def arrived(self, time_us: NDArray[np.int64], received_ns: NDArray[np.int64]) -> None:
        """Take samples: their times on the device and those of their arrivals, shape ``(N,)``."""
        newest = newest_of_each(received_ns)
        device_us, host_ns = time_us[newest], received_ns[newest]
        if self._last is not None:
            device_us = np.append(self._last[0], device_us)
            host_ns = np.append(self._last[1], host_ns)
        device_s, host_s = np.diff(device_us) * 1e-6, np.diff(host_ns) * 1e-9
        self._sizes.add(np.abs(host_s - device_s)[device_s > 0.0])
        self._last = int(device_us[-1]), int(host_ns[-1])

    def begin_epoch(self) -> None:
        """Take the next arrival as the first."""
        self._last = None

    def histogram(self) -> Histogram:
        """Return how the jitter is spread, s."""
        return self._sizes.histogram()
