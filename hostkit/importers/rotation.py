"""Quaternions, row by row: product, rotation vector, Euler angles, turning vectors.

All are ``(N, 4)`` with the real part first and mean sensor to world, as in `hostkit.attitude`.
"""

import numpy as np

from hostkit.importers.log import Vector

SMALL_RAD = 1e-8
"""Below it ``sin(a)/a`` is 1 to the last bit of a double."""


def multiply(left: Vector, right: Vector) -> Vector:
    """Return the Hamilton product, row by row."""
    a, b, c, d = left.T
    w, x, y, z = right.T
    return np.stack(
        (
            a * w - b * x - c * y - d * z,
            a * x + b * w + c * z - d * y,
            a * y - b * z + c * w + d * x,
            a * z + b * y - c * x + d * w,
        ),
        axis=-1,
    )


def conjugate(quaternion: Vector) -> Vector:
    """Return the inverse of unit quaternions."""
    return np.multiply(quaternion, (1.0, -1.0, -1.0, -1.0))


def from_rotation_vector(vector_rad: Vector) -> Vector:
    """Return the quaternions of rotation vectors, rad, shape ``(N, 3)``."""
    angle = np.linalg.norm(vector_rad, axis=-1, keepdims=True)
    ratio = np.where(angle > SMALL_RAD, np.sin(0.5 * angle) / np.maximum(angle, SMALL_RAD), 0.5)
    return np.concatenate((np.cos(0.5 * angle), ratio * vector_rad), axis=-1)


def to_rotation_vector(quaternion: Vector) -> Vector:
    """Return the shorter rotation vector of unit quaternions, rad, shape ``(N, 3)``."""
    shorter = np.where(quaternion[..., :1] < 0.0, -quaternion, quaternion)
    sine = np.linalg.norm(shorter[..., 1:], axis=-1, keepdims=True)
    angle = 2.0 * np.arctan2(sine, shorter[..., :1])
    ratio = np.where(sine > SMALL_RAD, angle / np.maximum(sine, SMALL_RAD), 2.0)
    vector: Vector = ratio * shorter[..., 1:]
    return vector


def to_world(quaternion: Vector, vectors: Vector) -> Vector:
    """Turn vectors in sensor axes, shape ``(N, 3)``, into the world by unit quaternions."""
    pure = np.concatenate((np.zeros_like(vectors[..., :1]), vectors), axis=-1)
    return multiply(multiply(quaternion, pure), conjugate(quaternion))[..., 1:]


def from_euler(roll_rad: Vector, pitch_rad: Vector, yaw_rad: Vector) -> Vector:
    """Return the quaternions of ``Rz(yaw) Ry(pitch) Rx(roll)``, angles of shape ``(N,)``."""
    x, y, z = np.eye(3)
    about_z = from_rotation_vector(yaw_rad[:, None] * z)
    about_y = from_rotation_vector(pitch_rad[:, None] * y)
    about_x = from_rotation_vector(roll_rad[:, None] * x)
    return multiply(multiply(about_z, about_y), about_x)


def from_frd(vectors: Vector) -> Vector:
    """Bring forward-right-down vectors to hostkit's forward-left-up: half a turn about x."""
    return np.multiply(vectors, (1.0, -1.0, -1.0))


def attitude_from_frd(quaternion: Vector) -> Vector:
    """Bring forward-right-down to north-east-down attitudes to hostkit's axes.

    Sensor and world turn half a turn about x alike, so the axis of the rotation does.
    """
    return np.multiply(quaternion, (1.0, 1.0, -1.0, -1.0))
