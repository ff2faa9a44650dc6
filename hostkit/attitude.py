"""The axis convention of hostkit, stated and tested here only.

Body axes as printed on the MPU-6050: right-handed, z up, the accelerometer reads +1 g on z at
rest. Body to world is ``Rz(yaw) Ry(pitch) Rx(roll)`` with world z up, hence the direction of the
specific force at rest, called *up* below, is in body axes::

    up = (-sin(pitch), sin(roll) cos(pitch), cos(roll) cos(pitch))

A positive rate about x raises roll; a positive rate about y raises pitch.
"""

import numpy as np
from numpy.typing import NDArray

from hostkit.mounting import Mounting

Vector = NDArray[np.float64]


def wrap_rad(angle_rad: Vector) -> Vector:
    """Return the angle in [-pi, pi)."""
    return (angle_rad + np.pi) % (2.0 * np.pi) - np.pi


def up_from_tilt(roll_rad: Vector, pitch_rad: Vector) -> Vector:
    """Return the up direction in body axes.

    Parameters
    ----------
    roll_rad, pitch_rad
        Angles, each of shape ``(N,)``.

    Returns
    -------
    numpy.ndarray
        Unit vectors, shape ``(N, 3)``.
    """
    cos_pitch = np.cos(pitch_rad)
    return np.stack(
        (-np.sin(pitch_rad), np.sin(roll_rad) * cos_pitch, np.cos(roll_rad) * cos_pitch), axis=-1
    )


def up_from_quaternion(quaternion_wxyz: Vector) -> Vector:
    """Return the world's up direction in sensor axes.

    Parameters
    ----------
    quaternion_wxyz
        Orientation, sensor to world with world z up, shape ``(N, 4)``, need not be of unit norm.

    Returns
    -------
    numpy.ndarray
        Unit vectors, shape ``(N, 3)``; NaN where the quaternion is NaN or zero.
    """
    with np.errstate(invalid="ignore", divide="ignore"):
        unit = quaternion_wxyz / np.linalg.norm(quaternion_wxyz, axis=1, keepdims=True)
    w, x, y, z = unit.T
    return np.stack(
        (2.0 * (x * z - w * y), 2.0 * (y * z + w * x), w * w - x * x - y * y + z * z), axis=-1
    )


def roll_from_up(up: Vector) -> Vector:
    """Return roll, rad, shape ``(N,)``, from up directions or specific forces ``(N, 3)``."""
    return np.arctan2(up[..., 1], up[..., 2])


def pitch_from_up(up: Vector) -> Vector:
    """Return pitch, rad, shape ``(N,)``, from up directions or specific forces ``(N, 3)``."""
    return np.arctan2(-up[..., 0], np.hypot(up[..., 1], up[..., 2]))


def to_body(mounting: Mounting, vectors: Vector) -> Vector:
    """Express sensor-axis vectors, shape ``(N, 3)``, in body axes."""
    sign = np.asarray(mounting.sign, dtype=np.float64)
    return np.multiply(vectors[..., list(mounting.source)], sign)


def inclination_rad(up_a: Vector, up_b: Vector) -> Vector:
    """Return the angle between two up directions, shape ``(N,)``, exact near zero.

    The two-argument form ``atan2(|a x b|, a . b)`` keeps its digits at small angles, where the
    arc cosine of the dot product loses them.
    """
    sine = np.linalg.norm(np.cross(up_a, up_b), axis=-1)
    return np.asarray(np.arctan2(sine, np.sum(up_a * up_b, axis=-1)))


def apart_rad(angle: Vector, other: Vector) -> Vector:
    """Return how far angles are apart, shape ``(N,)``; the angle between the up directions of two.

    Near a pitch of 90 deg roll says little: it is off by what the up direction is off, divided by
    the cosine of the pitch.

    Parameters
    ----------
    angle, other
        One angle, or roll and pitch, rad, shape ``(N, A)``.
    """
    if angle.shape[1] == 1:
        return np.abs(wrap_rad(angle - other))[:, 0]
    return inclination_rad(up_from_tilt(*angle.T), up_from_tilt(*other.T))
