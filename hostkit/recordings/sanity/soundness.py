"""Hard faults: values with which nothing sensible can be computed."""

import numpy as np

from hostkit.errors import RecordingError
from hostkit.recordings.recording import Recording, Vector
from hostkit.recordings.sanity.units import require_units
from hostkit.records import RATE_LIMITS_HZ

RATE_SLACK = 1.01
MAX_RATE_FACTOR = 10.0
"""Nominal rate and time stamps that differ by more are in different units."""
UNIT_TOLERANCE = 1e-3
WRAPS = ((2**32 * 1e-6, "32-bit microsecond"), (2**32 * 1e-3, "32-bit millisecond"))
WRAP_TOLERANCE = 1e-3


def require_sound(recording: Recording, *, units: bool = True) -> None:
    """Refuse a recording with a hard fault.

    Parameters
    ----------
    units
        Whether the units are checked too, which takes most of the time.

    Raises
    ------
    RecordingError
        If a time, rate or force is not finite, the time does not rise, the sample rate is outside
        what a sensor delivers, the reference is not of unit length, or the values cannot be in
        the units they are said to be in.
    """
    _require_finite(recording.time_s, "time_s")
    _require_finite(recording.angular_rate_rad_s, "angular rate")
    _require_finite(recording.specific_force_m_s2, "specific force")
    _require_rising(recording.time_s)
    _require_rate(recording)
    _require_reference(recording)
    if units:
        require_units(recording)


def _require_finite(values: Vector, name: str) -> None:
    wrong = np.argwhere(~np.isfinite(values))
    if not len(wrong):
        return
    row, axis = int(wrong[0][0]), "xyz"[wrong[0][1]] if values.ndim == 2 else ""
    place = f"{name} {axis}".strip()
    rows = len(np.unique(wrong[:, 0]))
    raise RecordingError(
        f"row {row + 1}: {place} is {values[tuple(wrong[0])]} ({rows} such row(s)); every "
        "sample needs a time, an angular rate and a specific force: leave such rows out"
    )


def _require_rising(time_s: Vector) -> None:
    steps = np.diff(time_s)
    wrong = np.flatnonzero(steps <= 0.0)
    if not wrong.size:
        return
    row, step_s = int(wrong[0]) + 1, float(steps[wrong[0]])
    fault = "repeats the time of the row before" if step_s == 0.0 else "is before the row before it"
    raise RecordingError(
        f"row {row + 1}: time {time_s[row]:.6f} s {fault}, at {time_s[row - 1]:.6f} s "
        f"({wrong.size} such row(s)); {_time_remedy(step_s, float(np.median(steps)))}"
    )


def _time_remedy(step_s: float, usual_s: float) -> str:
    for span_s, counter in WRAPS:
        if abs(step_s + span_s - usual_s) < WRAP_TOLERANCE * span_s:
            return f"a {counter} counter wrapped: add {span_s:.6f} s from there on"
    return "time must rise: sort the rows, or take out the doubled ones"


def _require_rate(recording: Recording) -> None:
    measured_hz = 1.0 / float(np.median(np.diff(recording.time_s)))
    low, high = RATE_LIMITS_HZ
    if not low / RATE_SLACK <= measured_hz <= high * RATE_SLACK:
        raise RecordingError(
            f"the median time step is {1.0 / measured_hz:.6g} s, a rate of {measured_hz:.6g} Hz; "
            f"sensors deliver {low} to {high:g} Hz: is the time in another unit than its name says?"
        )
    nominal_hz = recording.rate_hz
    if not (np.isfinite(nominal_hz) and nominal_hz > 0.0):
        raise RecordingError(f"rate_hz = {nominal_hz}; it must be a rate above 0 Hz")
    if not 1.0 / MAX_RATE_FACTOR < measured_hz / nominal_hz < MAX_RATE_FACTOR:
        raise RecordingError(
            f"rate_hz = {nominal_hz:.6g} but the time stamps make {measured_hz:.6g} Hz; is the "
            "time in another unit than its name says?"
        )


def _require_reference(recording: Recording) -> None:
    if recording.up_reference is None:
        return
    norm = np.linalg.norm(recording.up_reference, axis=1)
    wrong = np.flatnonzero(np.abs(norm - 1.0) > UNIT_TOLERANCE)
    if wrong.size:
        raise RecordingError(
            f"row {wrong[0] + 1}: the reference up direction has length {norm[wrong[0]]:.4g}; "
            "it must be 1, or NaN where the reference was lost"
        )
