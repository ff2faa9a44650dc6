"""Times of samples: counters that wrap, rows in disorder, and a uniform grid for bursty logs."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from hostkit.errors import RecordingError
from hostkit.importers.log import MAX_SAMPLES, ReferenceTrack, SensorLog, Vector

Ticks = NDArray[np.int64]

COUNTER_SPAN = 2**32
EVEN_ROWS = 50
"""Arrival times are averaged over this many rows on either side."""
SPLIT_S = 1.0
"""A step longer than this is a pause of the sensor, not of the link."""


def seconds(ticks: Ticks, ticks_per_s: float, start: int) -> Vector:
    """Return times in s since `start`; the difference is taken in integers."""
    return (ticks - start).astype(np.float64) / ticks_per_s


def unwrapped(ticks: Vector) -> tuple[Vector, int]:
    """Return a 32-bit counter that goes on where it overflowed, and how often it did.

    A fall by more than half the span is an overflow; any other stays what it is.
    """
    overflows = np.diff(ticks) < -COUNTER_SPAN / 2
    turns = np.concatenate(([0], np.cumsum(overflows)))
    return ticks + float(COUNTER_SPAN) * turns, int(turns[-1])


def median_rate_hz(time_s: Vector) -> float:
    """Return the rate of the median time step to nine digits, NaN if it makes none."""
    step_s = float(np.median(np.diff(time_s))) if time_s.size > 1 else 0.0
    return float(f"{1.0 / step_s:.9g}") if step_s > 0.0 else float("nan")


def require_rising(time_s: Vector) -> None:
    """Refuse times that repeat or fall.

    Raises
    ------
    RecordingError
        Naming the first such row, counted from 1.
    """
    _require_finite(time_s)
    steps = np.diff(time_s)
    wrong = np.flatnonzero(steps <= 0.0)
    if not wrong.size:
        return
    row = int(wrong[0]) + 1
    if steps[row - 1] < 0.0:
        fault = "is before the row before it"
        remedy = "rows out of order, or two runs in one file: cut it there"
    else:
        fault = "repeats the time of the row before"
        remedy = "take out doubled rows, or --resample HZ if they came in bursts"
    raise RecordingError(
        f"row {row + 1}: time {time_s[row]:.6f} s {fault}, at {time_s[row - 1]:.6f} s "
        f"({wrong.size} such row(s)); {remedy}"
    )


def _require_finite(time_s: Vector) -> None:
    wrong = np.flatnonzero(~np.isfinite(time_s))
    if wrong.size:
        raise RecordingError(
            f"row {wrong[0] + 1}: the time is {time_s[wrong[0]]} ({wrong.size} such row(s)); "
            "every sample needs one: leave such rows out"
        )


def resampled(log: SensorLog, rate_hz: float) -> SensorLog:
    """Bring a bursty log to a uniform grid.

    The samples are taken for evenly measured and late by a varying delay. So the time of each row
    becomes the mean of a straight line through all rows plus the deviation from it averaged over
    `EVEN_ROWS` rows on either side, which evens out bursts and follows a clock that drifts; steps
    beyond `SPLIT_S` split the log, and each part is evened by itself. Then rate, force, field and
    temperature are interpolated linearly at the multiples of ``1 / rate_hz``; grid points in a
    pause are left out. A reference that stood in the same rows gets the same new times.

    Raises
    ------
    RecordingError
        If times fall, or the grid has too many points or fewer than two.
    """
    _require_finite(log.time_s)
    if (np.diff(log.time_s) < 0.0).any():
        require_rising(log.time_s)
    even_s = _evened(log.time_s)
    grid_s = _grid(log.time_s, even_s, rate_hz)

    def at_grid(values: Vector) -> Vector:
        columns = values.reshape(len(values), -1).T
        found = np.stack([np.interp(grid_s, even_s, column) for column in columns], axis=1)
        return found.reshape(-1, *values.shape[1:])

    valid = None if log.valid is None else at_grid(log.valid.astype(np.float64)) > 1.0 - 1e-9
    return replace(
        log,
        time_s=grid_s - grid_s[0],
        angular_rate_rad_s=at_grid(log.angular_rate_rad_s),
        specific_force_m_s2=at_grid(log.specific_force_m_s2),
        rate_hz=rate_hz,
        reference=_moved(log, even_s, float(grid_s[0])),
        mag_ut=None if log.mag_ut is None else at_grid(log.mag_ut),
        temperature_deg_c=None if log.temperature_deg_c is None else at_grid(log.temperature_deg_c),
        valid=valid,
        guessed=(*log.guessed, f"times are evened out and brought to a grid of {rate_hz:g} Hz"),
    )


def _parts(time_s: Vector) -> list[slice]:
    edges = np.flatnonzero(np.diff(time_s) > SPLIT_S) + 1
    bounds = [0, *edges.tolist(), time_s.size]
    return [slice(begin, end) for begin, end in pairwise(bounds)]


def _evened(time_s: Vector) -> Vector:
    even_s = time_s.copy()
    for part in _parts(time_s):
        even_s[part] = _evened_part(time_s[part])
    return even_s


def _evened_part(time_s: Vector) -> Vector:
    rows = np.arange(time_s.size, dtype=np.float64)
    if time_s.size < 3 or time_s[-1] == time_s[0]:
        return time_s.copy()
    slope, start = np.polyfit(rows, time_s, 1)
    line = start + slope * rows
    reach = min(EVEN_ROWS, time_s.size // 2)
    padded = np.pad(time_s - line, reach, mode="edge")
    total = np.cumsum(np.concatenate(([0.0], padded)))
    width = 2 * reach + 1
    even: Vector = np.maximum.accumulate(line + (total[width:] - total[:-width]) / width)
    return even


def _grid(time_s: Vector, even_s: Vector, rate_hz: float) -> Vector:
    points = (even_s[-1] - even_s[0]) * rate_hz
    if points > MAX_SAMPLES:
        raise RecordingError(
            f"--resample {rate_hz:g} makes {points:.3g} samples; the limit is {MAX_SAMPLES}"
        )
    grid_s: Vector = even_s[0] + np.arange(int(points + 1e-6) + 1) / rate_hz
    inside = np.zeros(grid_s.size, dtype=np.bool_)
    for part in _parts(time_s):
        inside |= (grid_s >= even_s[part][0]) & (grid_s <= even_s[part][-1])
    grid_s = grid_s[inside]
    if grid_s.size < 2:
        raise RecordingError(
            f"--resample {rate_hz:g} leaves {grid_s.size} sample(s) of "
            f"{even_s[-1] - even_s[0]:.4g} s; take a higher rate"
        )
    return grid_s


def _moved(log: SensorLog, even_s: Vector, start_s: float) -> ReferenceTrack | None:
    """Return the reference on the clock of the grid; rows of one time keep their first attitude."""
    track = log.reference
    if track is None:
        return None
    same = np.array_equal(track.time_s, log.time_s)
    time_s = (even_s if same else track.time_s) - start_s
    first = np.concatenate(([True], np.diff(time_s) > 0.0))
    return ReferenceTrack(time_s=time_s[first], quaternion_wxyz=track.quaternion_wxyz[first])
