"""The equations of a gyroscope over turns, and their derivatives.

With the reading w, the bias b, the scale error s of each axis and C what an axis sees of the
others (zero on its diagonal), the true rate is ``K (w - b)``, ``K = I + diag(s) + C``. Integrated
over a turn to a rotation R it must carry the direction of gravity after the turn to that before
it: ``u0 = R u1``. The error ``e = u0 x R u1`` changes with the numbers by

    de = P sum_k R_k (dK (w_k - b) - K db) dt,    P = (u0 . v) I - v u0^T,    v = R u1

with R_k the rotation up to sample k, so one integration gives all derivatives. Turns about the
vertical say nothing.

The bias differs from recording to recording and creeps with temperature, so between two poses it
is taken from both, in proportion to time; the unknown b is what has to be added to that.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hostkit.calibration.turns import Turn
from hostkit.diagnosis.strapdown import accumulated, quaternions, rotated
from hostkit.recordings import Recording
from hostkit.recordings.recording import Vector
from hostkit.records import read_only

SCALES, BIASES, CROSS = slice(0, 3), slice(3, 6), slice(6, 12)
"""Where the unknowns are: scale errors, biases, and C row by row."""
UNKNOWNS = 12
OFF_DIAGONAL = ((0, 1), (0, 2), (1, 0), (1, 2), (2, 0), (2, 1))

Rows = NDArray[np.int64]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class RestRate:
    """What the gyroscope reads at rest.

    Attributes
    ----------
    mean_rad_s, error_rad_s
        Mean over the recordings and its standard error, each ``(3,)``.
    of_sample_rad_s
        For each recording the bias at every sample, shape ``(N, 3)``.
    """

    mean_rad_s: Vector
    error_rad_s: Vector
    of_sample_rad_s: tuple[Vector, ...]

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        for array in (self.mean_rad_s, self.error_rad_s, *self.of_sample_rad_s):
            read_only(array)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Problem:
    """What the equations are made of.

    Attributes
    ----------
    recordings, turns
        The turns and what they are taken from.
    up_before, up_after
        Direction of gravity before and after each turn, from the corrected accelerometer, unit
        vectors, shape ``(T, 3)``.
    bias_rad_s
        For each recording the bias at every sample, shape ``(N, 3)``.
    """

    recordings: tuple[Recording, ...]
    turns: tuple[Turn, ...]
    up_before: Vector
    up_after: Vector
    bias_rad_s: tuple[Vector, ...]


def turn_errors(problem: Problem, unknowns: Vector) -> tuple[Vector, Vector]:
    """Return the errors of the turns, rad, ``(T, 3)``, and their derivatives, ``(T, 3, 12)``.

    Parameters
    ----------
    problem
        The turns.
    unknowns
        Shape ``(12,)``, rates in rad/s.
    """
    turns = len(problem.turns)
    errors, slopes = np.zeros((turns, 3)), np.zeros((turns, 3, UNKNOWNS))
    owner = np.array([turn.recording for turn in problem.turns], dtype=np.int64)
    for i in sorted(set(owner.tolist())):
        mine = np.flatnonzero(owner == i)
        errors[mine], slopes[mine] = _of_recording(problem, i, mine, unknowns)
    return errors, slopes


def _of_recording(
    problem: Problem, index: int, mine: Rows, unknowns: Vector
) -> tuple[Vector, Vector]:
    """Return the same of the turns `mine` of one recording, in the frame of its first sample."""
    recording = problem.recordings[index]
    first = np.array([problem.turns[t].first for t in mine])
    last = np.array([problem.turns[t].last for t in mine])
    steps_s = np.diff(recording.time_s, prepend=recording.time_s[0])[:, None]
    bias = problem.bias_rad_s[index] + unknowns[BIASES]
    reading = (recording.angular_rate_rad_s - bias) * steps_s
    gain = _gain(unknowns)
    orientation = accumulated(quaternions(reading @ gain.T))
    start = rotated(orientation[:, first], problem.up_before[mine])
    end = rotated(orientation[:, last], problem.up_after[mine])
    turned = _turned(orientation, reading, steps_s, gain, first, last)
    cosine = np.einsum("ti,ti->t", start, end)
    along = np.einsum("ti,tiu->tu", start, turned)
    slopes = cosine[:, None, None] * turned - end[:, :, None] * along[:, None, :]
    return _rotation_vector(np.cross(start, end), cosine), slopes


def _gain(unknowns: Vector) -> Vector:
    gain = np.eye(3) + np.diag(unknowns[SCALES])
    for (i, j), value in zip(OFF_DIAGONAL, unknowns[CROSS].tolist(), strict=True):
        gain[i, j] = value
    return gain


def _turned(
    orientation: Vector, reading: Vector, steps_s: Vector, gain: Vector, first: Rows, last: Rows
) -> Vector:
    """Return by what small rotations the turns change with each unknown, ``(T, 3, 12)``."""
    turned = np.empty((len(first), 3, UNKNOWNS))
    axes = [rotated(orientation, np.broadcast_to(unit, reading.shape)) for unit in np.eye(3)]
    for axis in range(3):
        turned[:, :, axis] = _between(axes[axis] * reading[:, [axis]], first, last)
    for k, (i, j) in enumerate(OFF_DIAGONAL):
        turned[:, :, CROSS.start + k] = _between(axes[i] * reading[:, [j]], first, last)
    plain = np.stack([_between(axis * steps_s, first, last) for axis in axes], axis=2)
    turned[:, :, BIASES] = -plain @ gain
    return turned


def _between(values: Vector, first: Rows, last: Rows) -> Vector:
    total = np.cumsum(values, axis=0)
    difference: Vector = total[last] - total[first]
    return difference


def _rotation_vector(sine: Vector, cosine: Vector) -> Vector:
    """Return the error so that it grows up to half a turn."""
    size = np.linalg.norm(sine, axis=1)
    angle = np.arctan2(size, cosine)
    vector: Vector = sine * (angle / np.where(size > 0.0, size, 1.0))[:, None]
    return vector
