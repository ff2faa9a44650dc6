"""The parts of a recording in which the sensor lies still, and what it reads there."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hostkit.attitude import inclination_rad
from hostkit.recordings.recording import Recording, Vector
from hostkit.units import RAD_PER_DEG

WINDOW_S = 1.0
MIN_SAMPLES = 5
MIN_WINDOWS = 2
MAX_RATE_SPREAD_RAD_S = 0.03
MAX_FORCE_SPREAD_M_S2 = 0.3
MAX_FORCE_DRIFT_M_S2 = 0.06
"""Largest change of the mean force between the halves of a window: 0.7 deg/s of tilting."""
MAX_RATE_RAD_S = 25.0 * RAD_PER_DEG
"""Fastest mean rate that can be a bias; the MPU-6050 may have 20 deg/s."""
ALIKE_RAD_S = 0.5 * RAD_PER_DEG
"""Windows at rest agree on the bias; one turning evenly differs by more than this."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Standstill:
    """What a resting sensor reads.

    Attributes
    ----------
    windows
        Number of windows of one second at rest.
    bias_rad_s
        Median of the mean angular rates, shape ``(3,)``.
    force_m_s2
        Median of the magnitudes of the mean specific forces.
    reference_error_rad
        Median angle between specific force and reference, None without a reference there.
    """

    windows: int
    bias_rad_s: Vector
    force_m_s2: float
    reference_error_rad: float | None


def standstill(recording: Recording) -> Standstill | None:
    """Return what the sensor reads at rest, or None if it rests for less than two windows.

    A window of one second counts as rest if no axis of rate or force spreads and the force does
    not drift by more than the limits above, and its mean rate is within `ALIKE_RAD_S` of the
    slowest such window: a steady turn looks like rest otherwise.
    """
    still, width = still_windows(recording)
    if np.count_nonzero(still) < MIN_WINDOWS:
        return None
    rate, force = (
        _windows(values, width).mean(axis=1)[still]
        for values in (recording.angular_rate_rad_s, recording.specific_force_m_s2)
    )
    return Standstill(
        windows=int(np.count_nonzero(still)),
        bias_rad_s=np.median(rate, axis=0),
        force_m_s2=float(np.median(np.linalg.norm(force, axis=1))),
        reference_error_rad=_reference_error(recording, force, still, width),
    )


def still_windows(recording: Recording) -> tuple[NDArray[np.bool_], int]:
    """Return which windows are at rest, shape ``(W,)``, and how many samples a window has.

    Window w begins at sample w times the width; what is left at the end is in no window.
    """
    width = _width(recording)
    rate, force = (
        _windows(values, width)
        for values in (recording.angular_rate_rad_s, recording.specific_force_m_s2)
    )
    still = rate.std(axis=1).max(axis=1, initial=0.0) < MAX_RATE_SPREAD_RAD_S
    still &= force.std(axis=1).max(axis=1, initial=0.0) < MAX_FORCE_SPREAD_M_S2
    still &= _drift(force) < MAX_FORCE_DRIFT_M_S2
    means = rate.mean(axis=1)
    speed = np.where(still, np.linalg.norm(means, axis=1), np.inf)
    if not (speed < MAX_RATE_RAD_S).any():
        return np.zeros(len(still), dtype=np.bool_), width
    still &= np.abs(means - means[np.argmin(speed)]).max(axis=1) < ALIKE_RAD_S
    return still, width


def _width(recording: Recording) -> int:
    step_s = float(np.median(np.diff(recording.time_s)))
    return max(MIN_SAMPLES, round(WINDOW_S / step_s))


def _windows(values: Vector, width: int) -> Vector:
    """Cut rows, shape ``(N, 3)``, into windows, shape ``(W, width, 3)``."""
    count = len(values) // width
    return values[: count * width].reshape(count, width, 3)


def _drift(force: Vector) -> Vector:
    half = force.shape[1] // 2
    change = force[:, :half].mean(axis=1) - force[:, -half:].mean(axis=1)
    drift: Vector = np.linalg.norm(change, axis=1)
    return drift


def _reference_error(
    recording: Recording, force: Vector, still: NDArray[np.bool_], width: int
) -> float | None:
    if recording.up_reference is None:
        return None
    up = _windows(recording.up_reference, width)[still].mean(axis=1)
    known = np.isfinite(up).all(axis=1)
    if not known.any():
        return None
    return float(np.median(inclination_rad(force[known], up[known])))
