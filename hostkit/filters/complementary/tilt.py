"""Tilt from specific force, in float and in integers, and the axes it belongs to."""

import numpy as np
from numpy.typing import NDArray

from hostkit.attitude import pitch_from_up, roll_from_up
from hostkit.filters.arctan import arcsin_count, atan2_count, atan2_length
from hostkit.filters.complementary.spec import ComplementarySpec
from hostkit.records import Axis, TiltMethod

Vector = NDArray[np.float64]
IntArray = NDArray[np.int64]

RATE_AXIS: dict[Axis, int] = {"roll": 0, "pitch": 1}
"""Body axis whose rate raises the angle."""


def measured_tilt_rad(axis: Axis, method: TiltMethod, force_g: Vector) -> Vector:
    """Return the tilt of one axis from specific force.

    Parameters
    ----------
    axis, method
        Which angle, and whether from two components (``atan2``) or one (``arcsin``, equation 1 of
        the paper with its argument clamped).
    force_g
        Specific force in body axes, multiples of standard gravity, shape ``(N, 3)``.

    Returns
    -------
    numpy.ndarray
        Angle in rad, shape ``(N,)``.
    """
    if method == "atan2":
        return roll_from_up(force_g) if axis == "roll" else pitch_from_up(force_g)
    component = force_g[:, 1] if axis == "roll" else -force_g[:, 0]
    return np.arcsin(np.clip(component, -1.0, 1.0))


def measured_tilt_raw(spec: ComplementarySpec, accel_count: IntArray) -> IntArray:
    """Return the tilt from specific force in integers.

    Parameters
    ----------
    accel_count
        Accelerometer counts in sensor axes, shape ``(N, 3)``.

    Returns
    -------
    numpy.ndarray
        Angles in half turns, shape ``(N, A)``.
    """
    x, y, z = body_counts(spec, accel_count).T
    angles: dict[Axis, IntArray] = {}
    if spec.tilt == "arcsin":
        angles["roll"] = arcsin_count(spec.arctan, y, spec.gravity_count)
        angles["pitch"] = arcsin_count(spec.arctan, -x, spec.gravity_count)
    else:
        angles["roll"], length, stretch = atan2_count(spec.arctan, y, z)
        if "pitch" in spec.axes:
            angles["pitch"] = atan2_length(spec.arctan, -x, length, stretch)
    return np.stack([angles[axis] for axis in spec.axes], axis=-1)


def body_counts(spec: ComplementarySpec, count: IntArray) -> IntArray:
    """Express counts in sensor axes, shape ``(N, 3)``, in body axes."""
    return count[:, list(spec.mounting.source)] * np.asarray(spec.mounting.sign, dtype=np.int64)
