"""Bias and scale of a gyroscope: from rest, and from turns between poses.

At rest the rate is zero, which gives the bias. Integrated over a turn, the true rate must carry the
direction of gravity after the turn to that before it (`hostkit.calibration.turn_model`), which
gives the scale. What an axis sees of the two others is estimated beside it, as numbers that are
small unless the turns say otherwise: else it would pass for scale. The filters have no place for
it. So is a bias that is there in motion only; the bias that a filter gets is that at rest.

Source of the idea: D. Tedaldi, A. Pretto, E. Menegatti, "A robust and easy to implement method for
IMU calibration without external equipments", ICRA 2014.
"""

from dataclasses import dataclass

import numpy as np

from hostkit.calibration.least_squares import Flags, Noise, covariance, good_rows, sigma_of
from hostkit.calibration.turn_model import CROSS, SCALES, UNKNOWNS, Problem, RestRate, turn_errors
from hostkit.errors import CalibrationError
from hostkit.recordings.recording import Vector
from hostkit.records import read_only
from hostkit.units import RAD_PER_DEG

NOISE = Noise(sigma=0.5 * RAD_PER_DEG, least_bad=3.0 * RAD_PER_DEG)
"""rad: of a turn, from both poses, noise, and time stamps. From 3 deg on a turn is bad."""
SCALE_PRIOR = 0.1
"""Standard deviation assumed of a scale error; the MPU-6050's data sheet allows 0.03."""
CROSS_PRIOR = 0.01
"""Standard deviation assumed of what an axis sees of another; the data sheet allows 0.02."""
SCALE_ERROR_LIMIT = 0.006
"""Largest standard error of a scale that still improves a part, whose data sheet allows 0.03."""
LEAST_BIAS_ERROR_RAD_S = 0.01 * RAD_PER_DEG
"""A bias at rest is not better known for the motion: gyroscopes feel acceleration a little."""
LARGEST_SCALE = 0.25
CONTRADICTION_RAD = 30.0 * RAD_PER_DEG
CONTRADICTION_SHARE = 0.2
"""If a fifth of the turns are still off by more, gyroscope and accelerometer contradict each other.
"""
STEPS = 12
CONVERGED = 1e-6
EQUATIONS_PER_TURN = 2
"""A direction has two."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class GyroFit:
    """Bias and scale of a gyroscope.

    Attributes
    ----------
    bias_rad_s, scale
        The six numbers, each ``(3,)``, sensor axes; a scale that is not determined is 0.
    cross
        What x sees of y, x of z, y of x, y of z, z of x, z of y, shape ``(6,)``; not corrected.
    bias_error_rad_s, scale_error
        Standard errors; of a scale that is not determined, the one that it would have.
    determined
        Which scales are determined, shape ``(3,)``.
    used
        Which turns fit, shape ``(T,)``; the others are left out.
    before_rad, after_rad, model_rad
        Angle between gravity carried on and gravity measured, with the bias at rest alone, with
        bias and scale, and with all that was estimated, shape ``(T,)``.
    """

    bias_rad_s: Vector
    scale: Vector
    cross: Vector
    bias_error_rad_s: Vector
    scale_error: Vector
    determined: Flags
    used: Flags
    before_rad: Vector
    after_rad: Vector
    model_rad: Vector

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        for array in (self.bias_rad_s, self.scale, self.before_rad, self.after_rad):
            read_only(array)
        for array in (self.bias_error_rad_s, self.scale_error, self.cross, self.model_rad):
            read_only(array)
        read_only(self.determined)
        read_only(self.used)


def fit_gyroscope(problem: Problem, rest: RestRate) -> GyroFit:
    """Fit bias and scale.

    A scale whose standard error is above the limit is set to 0 and the others are fitted again.

    Parameters
    ----------
    problem
        The turns; none gives the bias at rest.
    rest
        What the gyroscope reads at rest.

    Raises
    ------
    CalibrationError
        If gyroscope and accelerometer contradict each other, or a scale is off by more than 25 %.
    """
    prior = _prior_rows(rest)
    start = np.zeros(UNKNOWNS)
    free = np.ones(3, dtype=np.bool_)
    while True:
        unknowns, error, used = _fitted(problem, prior, start, free)
        if not (free & (error[SCALES] > SCALE_ERROR_LIMIT)).any():
            break
        free[np.argmax(np.where(free, error[SCALES], 0.0))] = False
    model = np.linalg.norm(turn_errors(problem, unknowns)[0], axis=1)
    _require_sensible(unknowns, model)
    applied = np.concatenate((unknowns[SCALES], np.zeros(UNKNOWNS - 3)))
    return GyroFit(
        bias_rad_s=rest.mean_rad_s.copy(),
        scale=unknowns[SCALES].copy(),
        cross=unknowns[CROSS].copy(),
        bias_error_rad_s=rest.error_rad_s.copy(),
        scale_error=error[SCALES].copy(),
        determined=free,
        used=used,
        before_rad=np.linalg.norm(turn_errors(problem, start)[0], axis=1),
        after_rad=np.linalg.norm(turn_errors(problem, applied)[0], axis=1),
        model_rad=model,
    )


def _prior_rows(rest: RestRate) -> Vector:
    """Return what is assumed of the unknowns, in units of its deviation, ``(12, 12)``."""
    bias = 1.0 / np.maximum(rest.error_rad_s, LEAST_BIAS_ERROR_RAD_S)
    cross = np.full(UNKNOWNS - CROSS.start, 1.0 / CROSS_PRIOR)
    return np.diag(np.concatenate((np.full(3, 1.0 / SCALE_PRIOR), bias, cross)))


def _fitted(
    problem: Problem, prior: Vector, start: Vector, free: Flags
) -> tuple[Vector, Vector, Flags]:
    """Return the numbers, their standard errors, and which turns are good."""
    everything = np.ones(len(problem.turns), dtype=np.bool_)
    robust = _descend(problem, prior, start, free, everything, robustly=True)
    size = np.linalg.norm(turn_errors(problem, robust)[0], axis=1)
    used = good_rows(size, NOISE, 6)
    unknowns = _descend(problem, prior, robust, free, used, robustly=False)
    error, slopes = turn_errors(problem, unknowns)
    per_equation = error[used].ravel() * np.sqrt(EQUATIONS_PER_TURN / 3.0)
    sigma = sigma_of(per_equation, 6, NOISE)
    rows = np.vstack((slopes[used].reshape(-1, UNKNOWNS) / sigma, prior))
    return unknowns, np.sqrt(np.diag(covariance(rows))), used


def _descend(
    problem: Problem, prior: Vector, start: Vector, free: Flags, used: Flags, *, robustly: bool
) -> Vector:
    """Return the numbers that fit best, by the method of Gauss and Newton."""
    unknowns = start.copy()
    variable = np.concatenate((free, np.ones(UNKNOWNS - 3, dtype=np.bool_)))
    unknowns[~variable] = 0.0
    for _ in range(STEPS):
        error, slopes = turn_errors(problem, unknowns)
        weight = used / NOISE.sigma
        if robustly:
            weight /= np.sqrt(1.0 + (np.linalg.norm(error, axis=1) / NOISE.sigma) ** 2)
        rows = np.vstack(((slopes * weight[:, None, None]).reshape(-1, UNKNOWNS), prior))
        target = np.concatenate(((error * weight[:, None]).ravel(), prior @ unknowns))
        step = np.linalg.lstsq(rows[:, variable], target, rcond=None)[0]
        unknowns[variable] -= step
        unknowns[SCALES] = np.clip(unknowns[SCALES], -0.5, 0.5)
        if float(np.abs(step).max()) < CONVERGED:
            break
    return unknowns


def _require_sensible(unknowns: Vector, model: Vector) -> None:
    wrong = int(np.count_nonzero(model > CONTRADICTION_RAD))
    if wrong > CONTRADICTION_SHARE * model.size:
        raise CalibrationError(
            f"gyroscope and accelerometer contradict each other: {wrong} of {model.size} turns are "
            f"off by more than {np.degrees(CONTRADICTION_RAD):.0f} deg. An axis has the wrong "
            "sign, the unit of the rate is wrong, or the times are; see hostkit import --columns"
        )
    axis = int(np.argmax(np.abs(unknowns[:3])))
    if abs(unknowns[axis]) > LARGEST_SCALE:
        raise CalibrationError(
            f"the scale of the gyroscope's {'xyz'[axis]} axis would be off by "
            f"{100.0 * unknowns[axis]:.0f} %; the limit is {100.0 * LARGEST_SCALE:.0f} %. Check "
            "the unit, the range and the sign with which the recording was imported"
        )
