"""A reference brought to the times of the sensor's samples."""

import numpy as np
from numpy.typing import NDArray

from hostkit.attitude import up_from_quaternion
from hostkit.errors import RecordingError
from hostkit.importers.log import ReferenceTrack, Vector

GAP_STEPS = 2.5
"""Between two reference samples further apart than this many median steps nothing is said."""
MIN_NORM = 0.5
"""A quaternion shorter than this says nothing: trackers write zeros where they lost the object."""


def up_at(track: ReferenceTrack, time_s: Vector) -> Vector:
    """Return the up direction in sensor axes at given times, shape ``(N, 3)``.

    Between two samples of the reference the attitude is turned at constant rate about one axis
    (spherical linear interpolation, K. Shoemake, "Animating rotation with quaternion curves",
    SIGGRAPH 1985). It is NaN outside the reference, in gaps of it, and where it was lost.

    Raises
    ------
    RecordingError
        If the times of the reference do not rise.
    """
    _require_rising(track.time_s)
    quaternion = _unit(track.quaternion_wxyz)
    before, share, known = _places(track.time_s, time_s)
    after = np.minimum(before + 1, track.time_s.size - 1)
    attitude = slerp(quaternion[before], quaternion[after], share)
    attitude[np.logical_not(known)] = np.nan
    return up_from_quaternion(attitude)


def _require_rising(time_s: Vector) -> None:
    wrong = np.flatnonzero(np.diff(time_s) <= 0.0)
    if wrong.size:
        row = int(wrong[0]) + 1
        raise RecordingError(
            f"row {row + 1} of the reference: time {time_s[row]:.6f} s is not after "
            f"{time_s[row - 1]:.6f} s ({wrong.size} such row(s)); --no-reference leaves it out"
        )


def _unit(quaternion: Vector) -> Vector:
    norm = np.linalg.norm(quaternion, axis=1, keepdims=True)
    with np.errstate(invalid="ignore", divide="ignore"):
        unit: Vector = np.where(norm > MIN_NORM, quaternion / norm, np.nan)
    return unit


def _places(track_s: Vector, time_s: Vector) -> tuple[NDArray[np.intp], Vector, NDArray[np.bool_]]:
    """Return the sample before each time, the share of the step after it, and where both are."""
    if track_s.size < 2:
        raise RecordingError(
            f"the reference has {track_s.size} sample(s); it needs at least 2: --no-reference "
            "leaves it out"
        )
    inside = (time_s >= track_s[0]) & (time_s <= track_s[-1])
    before = np.clip(np.searchsorted(track_s, time_s, side="right") - 1, 0, track_s.size - 2)
    step_s = np.diff(track_s)
    share = np.clip((time_s - track_s[before]) / step_s[before], 0.0, 1.0)
    whole = step_s[before] <= GAP_STEPS * float(np.median(step_s))
    return before, share, inside & (whole | (share == 0.0) | (share == 1.0))


def slerp(first: Vector, second: Vector, share: Vector) -> Vector:
    """Return the attitude a share of the shorter way from `first` to `second`.

    Parameters
    ----------
    first, second
        Unit quaternions, shape ``(N, 4)``.
    share
        From 0 to 1, shape ``(N,)``; at the ends the other quaternion may be NaN.
    """
    with np.errstate(invalid="ignore"):
        turned = np.where(np.sum(first * second, axis=1, keepdims=True) < 0.0, -second, second)
    half = np.arctan2(
        np.linalg.norm(turned - first, axis=1), np.linalg.norm(turned + first, axis=1)
    )
    angle = 2.0 * half
    sine = np.sin(angle)
    near = ~(sine > 1e-8)
    safe = np.where(near, 1.0, sine)
    weight_first = np.where(near, 1.0 - share, np.sin((1.0 - share) * angle) / safe)
    weight_second = np.where(near, share, np.sin(share * angle) / safe)
    between: Vector = weight_first[:, None] * first + weight_second[:, None] * turned
    between[share == 0.0] = first[share == 0.0]
    between[share == 1.0] = second[share == 1.0]
    return between
