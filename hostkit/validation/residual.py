"""Statistics of the residual of one axis, as samples come, in bounded memory."""

import math

import numpy as np
from numpy.typing import NDArray

from hostkit.records import Axis, ResidualStatistics
from hostkit.validation.histogram import Histogram, LogHistogram
from hostkit.validation.lag import lag_samples

Vector = NDArray[np.float64]

WINDOW = 4096
"""Samples that the lag is taken from: the latest."""

LEAST_DRIFT_S = 60.0
"""Time below which no drift is told."""

SIZES_RAD = (1e-10, 4.0)
"""Ends of the classes that percentiles are taken from."""


class ResidualTracker:
    """The residual of one axis.

    RMS, maximum, mean and slope are exact; percentiles are right within 1 %; the lag is that of
    the longest stretch without a break among the latest 4096 samples.
    """

    def __init__(self, axis: Axis, period_s: float) -> None:
        self.axis = axis
        self._period_s = period_s
        self._sizes = LogHistogram(*SIZES_RAD)
        self.count = 0
        self.squares = self.max_rad = 0.0
        self._mean = self._mean_time = self._time_squares = self._time_residual = 0.0
        self._span_s = [math.inf, -math.inf]
        self._model = np.full(WINDOW, np.nan)
        self._residual = np.full(WINDOW, np.nan)
        self._at = 0

    def add(self, time_s: Vector, residual_rad: Vector) -> None:
        """Take residuals that are to be judged, each of shape ``(N,)``."""
        count = len(residual_rad)
        if not count:
            return
        sizes = np.abs(residual_rad)
        self._sizes.add(sizes)
        self.squares += float(np.dot(residual_rad, residual_rad))
        self.max_rad = max(self.max_rad, float(sizes.max()))
        self._span_s[0] = min(self._span_s[0], float(time_s[0]))
        self._span_s[1] = max(self._span_s[1], float(time_s[-1]))
        mean, mean_time = float(residual_rad.mean()), float(time_s.mean())
        away = time_s - mean_time
        total = self.count + count
        weight = self.count * count / total
        step, time_step = mean - self._mean, mean_time - self._mean_time
        self._time_squares += float(np.dot(away, away)) + weight * time_step**2
        self._time_residual += float(np.dot(away, residual_rad)) + weight * time_step * step
        self._mean += step * count / total
        self._mean_time += time_step * count / total
        self.count = total

    def follow(self, model_rad: Vector, residual_rad: Vector) -> None:
        """Keep a stretch of samples for the lag; NaN where it is broken."""
        model_rad, residual_rad = model_rad[-WINDOW:], residual_rad[-WINDOW:]
        place = (self._at + np.arange(len(model_rad))) % WINDOW
        self._model[place] = model_rad
        self._residual[place] = residual_rad
        self._at = (self._at + len(model_rad)) % WINDOW

    def statistics(self) -> ResidualStatistics | None:
        """Return the figures so far; None where nothing was judged."""
        if not self.count:
            return None
        p50, p95, p99 = (
            min(self._sizes.percentile(share), self.max_rad) for share in (0.5, 0.95, 0.99)
        )
        lag = self._lag_samples()
        return ResidualStatistics(
            axis=self.axis,
            samples=self.count,
            rms_rad=math.sqrt(self.squares / self.count),
            max_rad=self.max_rad,
            mean_rad=self._mean,
            p50_rad=p50,
            p95_rad=p95,
            p99_rad=p99,
            lag_s=None if lag is None else lag * self._period_s,
            drift_rad_s=self._drift_rad_s(),
        )

    def histogram(self) -> Histogram:
        """Return how the size of the residual is spread."""
        return self._sizes.histogram()

    def _drift_rad_s(self) -> float | None:
        if self._span_s[1] - self._span_s[0] < LEAST_DRIFT_S or not self._time_squares:
            return None
        return self._time_residual / self._time_squares

    def _lag_samples(self) -> float | None:
        model, residual = np.roll(self._model, -self._at), np.roll(self._residual, -self._at)
        stretch = _longest(np.isfinite(residual))
        model = np.unwrap(model[stretch])
        return lag_samples(model, model + residual[stretch])


def _longest(good: NDArray[np.bool_]) -> slice:
    """Return the longest stretch of True."""
    edges = np.flatnonzero(np.diff(good.astype(np.int8), prepend=0, append=0))
    if not len(edges):
        return slice(0, 0)
    begins, ends = edges[::2], edges[1::2]
    k = int(np.argmax(ends - begins))
    return slice(int(begins[k]), int(ends[k]))
