"""Bias and scale of a gyroscope: from rest, and from turns between poses.

With the reading w, the bias b and the scale error s of each axis, the true rate is
``(1 + s) * (w - b)``. At rest it is zero. Integrated over a turn to a rotation R, it must carry
the direction of gravity after the turn to that before it: ``u0 = R u1``. The error
``e = u0 x R u1`` changes with the numbers by

    de = P sum_k R_k (diag(w_k - b) ds - diag(1 + s) db) dt,    P = (u0 . v) I - v u0^T,  v = R u1

with R_k the rotation up to sample k. So Gauss and Newton's method needs one integration a step.
Turns about the vertical say nothing.

Source of the idea: D. Tedaldi, A. Pretto, E. Menegatti, "A robust and easy to implement method for
IMU calibration without external equipments", ICRA 2014; the derivatives are our own.
"""

from dataclasses import dataclass

import numpy as np

from hostkit.calibration.least_squares import Flags, Noise, covariance, good_rows, sigma_of
from hostkit.calibration.turns import Turn
from hostkit.diagnosis.strapdown import accumulated, quaternions, rotated
from hostkit.errors import CalibrationError
from hostkit.recordings import Recording
from hostkit.recordings.recording import Vector
from hostkit.records import read_only
from hostkit.units import RAD_PER_DEG

NOISE = Noise(sigma=0.5 * RAD_PER_DEG, least_bad=3.0 * RAD_PER_DEG)
"""rad: of a turn, from both poses, noise, and time stamps. From 3 deg on a turn is bad."""
SCALE_PRIOR = 0.1
"""Standard deviation assumed of a scale error; the MPU-6050's data sheet allows 0.03."""
SCALE_ERROR_LIMIT = 0.006
"""Largest standard error of a scale that still improves a part, whose data sheet allows 0.03."""
LARGEST_SCALE = 0.25
CONTRADICTION_RAD = 30.0 * RAD_PER_DEG
"""If half of the turns are still off by more, gyroscope and accelerometer do not belong together."""
STEPS = 12
CONVERGED = 1e-7


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class GyroFit:
    """Bias and scale of a gyroscope.

    Attributes
    ----------
    bias_rad_s, scale
        The six numbers, each ``(3,)``, sensor axes; a scale that is not determined is 0.
    bias_error_rad_s, scale_error
        Their standard errors; of a scale that is not determined, the one that it would have.
    determined
        Which scales are determined, shape ``(3,)``.
    used
        Which turns fit, shape ``(T,)``; the others are left out.
    before_rad, after_rad
        Angle between gravity carried on and gravity measured, with the bias at rest alone and with
        all numbers, shape ``(T,)``.
    """

    bias_rad_s: Vector
    scale: Vector
    bias_error_rad_s: Vector
    scale_error: Vector
    determined: Flags
    used: Flags
    before_rad: Vector
    after_rad: Vector

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        for array in (self.bias_rad_s, self.scale, self.before_rad, self.after_rad):
            read_only(array)
        for array in (self.bias_error_rad_s, self.scale_error):
            read_only(array)
        read_only(self.determined)
        read_only(self.used)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class RestRate:
    """What the gyroscope reads at rest: mean and its standard error, rad/s, each ``(3,)``."""

    mean_rad_s: Vector
    error_rad_s: Vector


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Problem:
    """The turns of all recordings, with their directions of gravity, each ``(T, 3)``."""

    recordings: tuple[Recording, ...]
    turns: tuple[Turn, ...]
    up_before: Vector
    up_after: Vector
    rest: RestRate


def fit_gyroscope(
    recordings: tuple[Recording, ...],
    turns: tuple[Turn, ...],
    up_before: Vector,
    up_after: Vector,
    rest: RestRate,
) -> GyroFit:
    """Fit bias and scale.

    What rest says of the bias is one of the equations. A scale whose standard error is above the
    limit is set to 0 and the others are fitted again.

    Parameters
    ----------
    recordings
        What the turns are taken from.
    turns
        The motions between poses; none gives the bias at rest.
    up_before, up_after
        Direction of gravity before and after each turn, from the corrected accelerometer, unit
        vectors, shape ``(T, 3)``.
    rest
        What the gyroscope reads at rest.

    Raises
    ------
    CalibrationError
        If gyroscope and accelerometer contradict each other, or a scale is off by more than 25 %.
    """
    problem = _Problem(
        recordings=recordings, turns=turns, up_before=up_before, up_after=up_after, rest=rest
    )
    start = np.concatenate((np.zeros(3), rest.mean_rad_s))
    before = np.linalg.norm(_errors(problem, start)[0], axis=1)
    free = np.ones(3, dtype=np.bool_)
    while True:
        unknowns, error, used = _fitted(problem, start, free)
        too_wide = free & (error[:3] > SCALE_ERROR_LIMIT)
        if not too_wide.any():
            break
        free[np.argmax(np.where(free, error[:3], 0.0))] = False
    after = np.linalg.norm(_errors(problem, unknowns)[0], axis=1)
    _require_sensible(unknowns, after)
    return GyroFit(
        bias_rad_s=unknowns[3:].copy(),
        scale=unknowns[:3].copy(),
        bias_error_rad_s=error[3:].copy(),
        scale_error=error[:3].copy(),
        determined=free,
        used=used,
        before_rad=before,
        after_rad=after,
    )


def _fitted(problem: _Problem, start: Vector, free: Flags) -> tuple[Vector, Vector, Flags]:
    """Return the six numbers, their standard errors, and which turns are good."""
    robust = _descend(problem, start, free, robustly=True)
    size = np.linalg.norm(_errors(problem, robust)[0], axis=1)
    used = good_rows(size, NOISE, 6)
    unknowns = _descend(problem, robust, free, used=used)
    error, jacobian = _errors(problem, unknowns)
    sigma = sigma_of(error[used].ravel() / np.sqrt(2.0), 6, NOISE)
    rows = np.vstack((jacobian[used].reshape(-1, 6) / sigma, _prior_rows(problem.rest)))
    return unknowns, np.sqrt(np.diag(covariance(rows))), used


def _prior_rows(rest: RestRate) -> Vector:
    return np.diag(np.concatenate((np.full(3, 1.0 / SCALE_PRIOR), 1.0 / rest.error_rad_s)))


def _descend(
    problem: _Problem,
    start: Vector,
    free: Flags,
    *,
    used: Flags | None = None,
    robustly: bool = False,
) -> Vector:
    """Return the numbers that fit best, by the method of Gauss and Newton."""
    unknowns = start.copy()
    variable = np.concatenate((free, np.ones(3, dtype=np.bool_)))
    prior = _prior_rows(problem.rest)
    centre = np.concatenate((np.zeros(3), problem.rest.mean_rad_s))
    for _ in range(STEPS):
        error, jacobian = _errors(problem, unknowns)
        weight = np.full(len(error), 1.0 / NOISE.sigma)
        if robustly:
            weight /= np.sqrt(1.0 + (np.linalg.norm(error, axis=1) / NOISE.sigma) ** 2)
        if used is not None:
            weight *= used
        rows = np.vstack(((jacobian * weight[:, None, None]).reshape(-1, 6), prior))
        target = np.concatenate(((error * weight[:, None]).ravel(), prior @ (unknowns - centre)))
        step = np.linalg.lstsq(rows[:, variable], target, rcond=None)[0]
        unknowns[variable] -= step
        unknowns[:3] = np.clip(unknowns[:3], -0.5, 0.5)
        if float(np.abs(step).max()) < CONVERGED:
            break
    return unknowns


def _errors(problem: _Problem, unknowns: Vector) -> tuple[Vector, Vector]:
    """Return the errors of the turns, rad, ``(T, 3)``, and their derivatives, ``(T, 3, 6)``."""
    errors, jacobians = np.zeros((len(problem.turns), 3)), np.zeros((len(problem.turns), 3, 6))
    owner = np.array([turn.recording for turn in problem.turns], dtype=np.int64)
    for i in sorted(set(owner.tolist())):
        mine = np.flatnonzero(owner == i)
        errors[mine], jacobians[mine] = _errors_of(problem, i, mine, unknowns)
    return errors, jacobians


def _errors_of(
    problem: _Problem, index: int, mine: np.ndarray[tuple[int], np.dtype[np.intp]], unknowns: Vector
) -> tuple[Vector, Vector]:
    """Do the same for one recording, in the frame of its first sample."""
    recording = problem.recordings[index]
    first = np.array([problem.turns[t].first for t in mine])
    last = np.array([problem.turns[t].last for t in mine])
    steps_s = np.diff(recording.time_s, prepend=recording.time_s[0])[:, None]
    centred = (recording.angular_rate_rad_s - unknowns[3:]) * steps_s
    factor = 1.0 + unknowns[:3]
    orientation = accumulated(quaternions(factor * centred))
    start = rotated(orientation[:, first], problem.up_before[mine])
    end = rotated(orientation[:, last], problem.up_after[mine])
    turned = np.empty((len(mine), 3, 6))
    for axis, unit in enumerate(np.eye(3)):
        along = rotated(orientation, np.broadcast_to(unit, centred.shape))
        turned[:, :, axis] = _between(along * centred[:, axis : axis + 1], first, last)
        turned[:, :, 3 + axis] = -factor[axis] * _between(along * steps_s, first, last)
    cosine = np.einsum("ti,ti->t", start, end)
    along_start = np.einsum("ti,tiu->tu", start, turned)
    jacobian = cosine[:, None, None] * turned - end[:, :, None] * along_start[:, None, :]
    return _rotation_error(np.cross(start, end), cosine), jacobian


def _rotation_error(sine: Vector, cosine: Vector) -> Vector:
    """Return the error as a rotation vector, so that it grows up to half a turn."""
    size = np.linalg.norm(sine, axis=1)
    angle = np.arctan2(size, cosine)
    return sine * (angle / np.where(size > 0.0, size, 1.0))[:, None]


def _between(
    values: Vector,
    first: np.ndarray[tuple[int], np.dtype[np.int64]],
    last: np.ndarray[tuple[int], np.dtype[np.int64]],
) -> Vector:
    total = np.cumsum(values, axis=0)
    difference: Vector = total[last] - total[first]
    return difference


def _require_sensible(unknowns: Vector, after: Vector) -> None:
    if after.size and float(np.median(after)) > CONTRADICTION_RAD:
        raise CalibrationError(
            f"gyroscope and accelerometer contradict each other: half of {after.size} turns are "
            f"off by more than {np.degrees(np.median(after)):.0f} deg. An axis has the wrong sign, "
            "the unit of the rate is wrong, or the times are; see hostkit import --columns"
        )
    axis = int(np.argmax(np.abs(unknowns[:3])))
    if abs(unknowns[axis]) > LARGEST_SCALE:
        raise CalibrationError(
            f"the scale of the gyroscope's {'xyz'[axis]} axis would be off by "
            f"{100.0 * unknowns[axis]:.0f} %; the limit is {100.0 * LARGEST_SCALE:.0f} %. Check "
            "the unit, the range and the sign with which the recording was imported"
        )
