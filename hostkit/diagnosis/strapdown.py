"""Up from gyroscope and accelerometer in three dimensions, for a whole recording at once.

The gyroscope is integrated to an orientation against a frame that drifts slowly. In that frame
gravity hardly moves while linear acceleration comes and goes, so the specific force is smoothed
there and turned back, as in D. Laidig, T. Seel, "VQF", Information Fusion 91, 2023.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.signal import lfilter

from hostkit.recordings import Recording
from hostkit.recordings.recording import Vector
from hostkit.records import read_only

SMOOTHING_S = 1.5
"""Reach to either side of the estimate of up. docs/diagnosis.md has what it costs to change it."""

IntArray = NDArray[np.intp]
EVERY = slice(None)
CONJUGATE = np.array(((1.0,), (-1.0,), (-1.0,), (-1.0,)))


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Strapdown:
    """A recording in a frame that does not turn with the sensor.

    Attributes
    ----------
    orientation
        Sensor axes to the frame, unit quaternions w, x, y, z, shape ``(4, N)``. The frame is that
        of the sensor at the first sample.
    force_m_s2
        Specific force in the frame, shape ``(N, 3)``.
    """

    orientation: Vector
    force_m_s2: Vector

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        read_only(self.orientation)
        read_only(self.force_m_s2)

    def to_frame(self, vectors: Vector) -> Vector:
        """Turn vectors, shape ``(N, 3)``, from sensor axes into the frame."""
        return rotated(self.orientation, vectors)

    def to_sensor(self, vectors: Vector) -> Vector:
        """Turn vectors, shape ``(N, 3)``, from the frame into sensor axes."""
        return rotated(self.orientation * CONJUGATE, vectors)

    def filtered_up(self, eta: float, rows: IntArray | slice = EVERY) -> Vector:
        """Return up in the frame from a complementary filter in three dimensions, at some rows.

        ``s_k = eta s_(k-1) + (1 - eta) f_k, s_0 = f_0``, made of unit length: in sensor axes the
        first term is the last estimate turned by the gyroscope.
        """
        source = (1.0 - eta) * self.force_m_s2.T
        source[:, 0] = self.force_m_s2[0]
        return _unit(np.asarray(lfilter([1.0], [1.0, -eta], source))[:, rows].T)

    def smoothed_up(self, rate_hz: float) -> Vector:
        """Return up in the frame from the force before and after, weighted ``exp(-|t|/1.5 s)``."""
        keep = math.exp(-1.0 / (rate_hz * SMOOTHING_S))
        force = self.force_m_s2.T
        forth = lfilter([1.0], [1.0, -keep], force)
        back = lfilter([1.0], [1.0, -keep], force[:, ::-1])[:, ::-1]
        return _unit((np.asarray(forth + back) - force).T)


def strapdown(recording: Recording, bias_rad_s: Vector) -> Strapdown:
    """Integrate the gyroscope of a recording whose time rises.

    Parameters
    ----------
    recording
        The samples.
    bias_rad_s
        What the gyroscope reads at rest, shape ``(3,)``.
    """
    steps_s = np.diff(recording.time_s, prepend=recording.time_s[0])
    turn_rad = (recording.angular_rate_rad_s - bias_rad_s) * steps_s[:, None]
    orientation = accumulated(quaternions(turn_rad))
    force = rotated(orientation, recording.specific_force_m_s2)
    return Strapdown(orientation=orientation, force_m_s2=force)


def _unit(vectors: Vector) -> Vector:
    """Return vectors of unit length; where there is no length, the z axis."""
    length = np.sqrt(np.einsum("ij,ij->i", vectors, vectors))[:, None]
    up = np.full_like(vectors, (0.0, 0.0, 1.0))
    np.divide(vectors, length, out=up, where=length > 0.0)
    return up


def quaternions(turn_rad: Vector) -> Vector:
    """Return the rotations by `turn_rad`, shape ``(N, 3)``, as quaternions, ``(4, N)``."""
    angle = np.linalg.norm(turn_rad, axis=1)
    part = 0.5 * np.sinc(angle / (2.0 * np.pi))
    return np.vstack((np.cos(0.5 * angle), (turn_rad * part[:, None]).T))


def _product(a: Vector, b: Vector) -> Vector:
    """Return Hamilton products, both of shape ``(4, ...)``."""
    aw, ax, ay, az = a
    bw, bx, by, bz = b
    return np.stack(
        (
            aw * bw - ax * bx - ay * by - az * bz,
            aw * bx + ax * bw + ay * bz - az * by,
            aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw,
        )
    )


def accumulated(steps: Vector) -> Vector:
    """Return the products of the first 1, 2, ... N quaternions, shape ``(4, N)``.

    They are cut into blocks of about root N, which are multiplied up side by side.
    """
    samples = steps.shape[1]
    length = math.isqrt(samples - 1) + 1
    blocks = -(-samples // length)
    padded = np.zeros((4, blocks * length))
    padded[0] = 1.0
    padded[:, :samples] = steps
    inner = np.ascontiguousarray(padded.reshape(4, blocks, length).transpose(2, 0, 1))
    for k in range(1, length):
        inner[k] = _product(inner[k - 1], inner[k])
    before = np.zeros((blocks, 4))
    before[0, 0] = 1.0
    for k in range(1, blocks):
        before[k] = _product(before[k - 1], inner[-1, :, k - 1])
    total = _product(before.T, inner.transpose(1, 0, 2)).transpose(0, 2, 1)
    flat = total.reshape(4, -1)[:, :samples]
    unit: Vector = flat / np.linalg.norm(flat, axis=0)
    return unit


def rotated(quaternion: Vector, vectors: Vector) -> Vector:
    """Return vectors, shape ``(N, 3)``, turned by unit quaternions ``(4, N)``.

    ``v + w t + u x t`` with ``t = 2 u x v`` for a quaternion of real part w, imaginary part u.
    """
    w, ux, uy, uz = quaternion
    x, y, z = vectors.T
    tx, ty, tz = 2.0 * (uy * z - uz * y), 2.0 * (uz * x - ux * z), 2.0 * (ux * y - uy * x)
    return np.stack(
        (
            x + w * tx + uy * tz - uz * ty,
            y + w * ty + uz * tx - ux * tz,
            z + w * tz + ux * ty - uy * tx,
        ),
        axis=-1,
    )
