"""Findings about time: gaps, jitter, a wrong nominal rate, repeated and unused samples."""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from hostkit.recordings.recording import Recording, Vector
from hostkit.recordings.sanity.findings import Finding

GAP_STEPS = 2.5
MAX_JITTER = 0.05
MAX_RATE_ERROR = 0.01
MAX_HOLD = 1.5
MIN_SPREAD_STEPS = 10.0
"""A signal that spreads over fewer of its smallest steps repeats because it is rounded."""
MIN_VALID = 0.1


def time_findings(recording: Recording) -> Iterator[Finding]:
    """Yield what is unusual about when the samples were taken and which of them count."""
    steps_s = np.diff(recording.time_s)
    median_s = float(np.median(steps_s))
    gaps = np.flatnonzero(steps_s > GAP_STEPS * median_s)
    if gaps.size:
        yield _gap(steps_s, gaps, median_s)
    yield from _jitter(steps_s[steps_s <= GAP_STEPS * median_s], median_s)
    yield from _rate(recording.rate_hz, median_s)
    yield from _held(recording.angular_rate_rad_s, "angular rate")
    yield from _held(recording.specific_force_m_s2, "specific force")
    yield from _valid(recording)


def _gap(steps_s: Vector, gaps: NDArray[np.intp], median_s: float) -> Finding:
    row = int(gaps[0])
    message = (
        f"{gaps.size} gap(s), the first before row {row + 2}: {steps_s[row]:.4g} s without a "
        f"sample, the median step is {median_s:.4g} s (limit {GAP_STEPS:g} steps); cut the "
        "recording there, or set valid = 0 for the seconds after each gap"
    )
    return Finding(kind="gap", message=message)


def _jitter(steps_s: Vector, median_s: float) -> Iterator[Finding]:
    jitter = float(np.std(steps_s)) / median_s
    if jitter > MAX_JITTER:
        message = (
            f"time steps spread by {100.0 * jitter:.3g} % of their median {median_s:.4g} s "
            f"({steps_s.min():.4g} to {steps_s.max():.4g} s; limit {100.0 * MAX_JITTER:g} %); use "
            "the sensor's own time or its data-ready interrupt, not the time of arrival"
        )
        yield Finding(kind="jitter", message=message)


def _rate(nominal_hz: float, median_s: float) -> Iterator[Finding]:
    measured_hz = 1.0 / median_s
    error = nominal_hz / measured_hz - 1.0
    if abs(error) > MAX_RATE_ERROR:
        message = (
            f"rate_hz = {nominal_hz:.6g} but the median time step makes {measured_hz:.6g} Hz, "
            f"{100.0 * error:+.3g} % apart (limit {100.0 * MAX_RATE_ERROR:g} %); correct rate_hz: "
            "a filter tuned for another rate has another time constant"
        )
        yield Finding(kind="rate", message=message)


def _held(values: Vector, name: str) -> Iterator[Finding]:
    steps = np.abs(np.diff(values, axis=0))
    smallest = float(np.min(steps, where=steps > 0.0, initial=np.inf))
    rounded = float(values.std(axis=0).max()) < MIN_SPREAD_STEPS * smallest < np.inf
    hold = len(values) / (1.0 + np.count_nonzero(steps.any(axis=1)))
    if not steps.any():
        message = f"the {name} is the same in all {len(values)} rows; a live sensor shows noise"
        yield Finding(kind="held", message=message)
    elif hold > MAX_HOLD and not rounded:
        message = (
            f"the {name} repeats: each value stands in {hold:.3g} rows on average (limit "
            f"{MAX_HOLD:g}); record at the rate at which the sensor measures"
        )
        yield Finding(kind="held", message=message)


def _valid(recording: Recording) -> Iterator[Finding]:
    share = float(np.mean(recording.valid))
    if share < MIN_VALID:
        message = (
            f"{100.0 * share:.3g} % of the samples are valid (limit {100.0 * MIN_VALID:g} %); "
            "only these are scored: set valid = 1 where the reference can be trusted"
        )
        yield Finding(kind="valid", message=message)
