"""Offset and scale of an accelerometer from poses: at rest the force is as large as gravity.

Each pose gives one equation for six unknowns, so six poses are the least, and they must differ
enough. Axes that are not square to each other would pass for offsets if the poses are not evenly
spread, so they are estimated beside them, as numbers that are small unless the poses say otherwise;
the filters have no place for them.

Source: I. Skog, P. Handel, "Calibration of a MEMS inertial measurement unit", XVII IMEKO World
Congress, 2006.
"""

from dataclasses import dataclass
from typing import Literal

import numpy as np
from scipy.optimize import least_squares

from hostkit.calibration.accel_model import TERMS, UNKNOWNS, jacobian, residual
from hostkit.calibration.least_squares import (
    Flags,
    Noise,
    covariance,
    good_rows,
    sigma_of,
)
from hostkit.errors import CalibrationError
from hostkit.recordings.recording import Vector
from hostkit.records import read_only

NOISE = Noise(sigma=0.02, least_bad=0.1)
"""m/s^2: 2 mg for the nonlinearity and the noise of a cheap part; 10 mg make a pose bad."""
SUSPICIOUS = 2.0
"""Residual of a plain fit, in units of the assumed noise, from which on bad poses are sought."""
SKEW_PRIOR = 0.01
"""Standard deviation assumed of T's numbers; the MPU-6050's data sheet allows 0.02."""
OFFSET_ERROR_LIMIT_M_S2 = 0.06
SCALE_ERROR_LIMIT = 0.006
"""Largest standard errors that still improve a part: 6 mg, and as much at 1 g."""
HOPELESS = 6.0
"""Poses that leave errors this many times the limits are not fitted at all."""
LARGEST_SCALE = 0.25


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class AccelFit:
    """Offset and scale of an accelerometer.

    Attributes
    ----------
    offset_m_s2, scale
        The six numbers, each ``(3,)``, sensor axes; 0 if they are not fitted.
    skew_rad
        By how much y to x, z to x, z to y are not square, half of it each, shape ``(3,)``.
    offset_error_m_s2, scale_error, skew_error_rad
        Standard errors of these; infinite if the poses say nothing.
    used
        Which poses fit, shape ``(P,)``; the others are left out.
    before_m_s2, after_m_s2
        Magnitude of the force less gravity, as read and corrected by the six, shape ``(P,)``.
    model_m_s2
        The same corrected by all nine.
    condition
        Condition number of the equations of the six; six faces have 1.0.
    """

    offset_m_s2: Vector
    scale: Vector
    skew_rad: Vector
    offset_error_m_s2: Vector
    scale_error: Vector
    skew_error_rad: Vector
    used: Flags
    before_m_s2: Vector
    after_m_s2: Vector
    model_m_s2: Vector
    condition: float

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        for array in (self.offset_m_s2, self.scale, self.skew_rad, self.offset_error_m_s2):
            read_only(array)
        for array in (self.scale_error, self.skew_error_rad, self.before_m_s2, self.after_m_s2):
            read_only(array)
        read_only(self.model_m_s2)
        read_only(self.used)

    @property
    def determined(self) -> bool:
        """Whether the standard errors are small enough for the numbers to be of use."""
        return _suffices(np.concatenate((self.offset_error_m_s2, self.scale_error)), 1.0)

    @property
    def unknowns(self) -> Vector:
        """The nine numbers in the form of `hostkit.calibration.accel_model`, offsets in m/s^2."""
        return np.concatenate((self.offset_m_s2, self.scale, self.skew_rad))

    def corrected(self, force_m_s2: Vector) -> Vector:
        """Return the true force of readings, both of shape ``(..., 3)``, by the six numbers."""
        true: Vector = (1.0 + self.scale) * (force_m_s2 - self.offset_m_s2)
        return true


def fit_accelerometer(force_m_s2: Vector, gravity_m_s2: float) -> AccelFit:
    """Fit offset and scale to the mean forces of poses.

    A fit that weighs bad poses down tells which are bad; these are left out of the last one, which
    is plain least squares.

    Parameters
    ----------
    force_m_s2
        Mean reading of each pose, shape ``(P, 3)``.
    gravity_m_s2
        Magnitude of gravity.

    Raises
    ------
    CalibrationError
        If the result is no sensor's: a scale beyond 25 %.
    """
    expected = term_errors(np.zeros(UNKNOWNS), force_m_s2, gravity_m_s2, NOISE.sigma)
    solution, used = np.zeros(UNKNOWNS), np.ones(len(force_m_s2), dtype=np.bool_)
    if not _suffices(expected[:TERMS], HOPELESS):
        return _result(solution, expected, used, force_m_s2, gravity_m_s2)
    robust = _robust(force_m_s2, gravity_m_s2)
    used = good_rows(np.abs(residual(robust, force_m_s2, gravity_m_s2)), NOISE, TERMS + 2)
    solution = _solve(force_m_s2[used], gravity_m_s2, robust, "linear")
    _require_sensible(solution)
    sigma = sigma_of(residual(solution, force_m_s2[used], gravity_m_s2), TERMS, NOISE)
    error = term_errors(solution, force_m_s2[used], gravity_m_s2, sigma)
    return _result(solution, error, used, force_m_s2, gravity_m_s2)


def term_errors(unknowns: Vector, force_m_s2: Vector, gravity_m_s2: float, sigma: float) -> Vector:
    """Return standard errors, offsets in m/s^2, shape ``(9,)``; infinite if poses are missing.

    Parameters
    ----------
    unknowns
        Where to take the derivatives, shape ``(9,)``.
    force_m_s2
        Mean readings, shape ``(P, 3)``.
    gravity_m_s2
        Magnitude of gravity.
    sigma
        Standard deviation of a pose, m/s^2.
    """
    if len(force_m_s2) < TERMS:
        return np.full(UNKNOWNS, np.inf)
    rows = np.vstack((jacobian(unknowns, force_m_s2, gravity_m_s2) / sigma, prior_rows()))
    error: Vector = np.sqrt(np.diag(covariance(rows)))
    error[:3] *= gravity_m_s2
    return error


def prior_rows() -> Vector:
    """Return the rows that keep T's numbers small, in units of their deviation, ``(3, 9)``."""
    return np.eye(UNKNOWNS)[TERMS:] / SKEW_PRIOR


def standard_errors_over_limits(error: Vector) -> Vector:
    """Return standard errors of the six terms, offsets in m/s^2 first, over their limits."""
    limit = np.repeat((OFFSET_ERROR_LIMIT_M_S2, SCALE_ERROR_LIMIT), 3)
    ratio: Vector = error[:TERMS] / limit
    return ratio


def _suffices(error: Vector, times: float) -> bool:
    return bool((standard_errors_over_limits(error) <= times).all())


def _robust(force_m_s2: Vector, gravity_m_s2: float) -> Vector:
    """Return a fit that bad poses do not bend, by Cauchy's loss.

    That loss has many minima: a bad pose far from all others can draw the fit to it. So it starts
    from the best, by that loss, of the plain fits to all poses and to all but one.
    """
    plain = _solve(force_m_s2, gravity_m_s2, np.zeros(UNKNOWNS), "linear")
    size = np.abs(residual(plain, force_m_s2, gravity_m_s2))
    if size.max() < SUSPICIOUS * NOISE.sigma:
        return plain
    starts = [plain]
    for i in range(len(force_m_s2)):
        others = np.delete(force_m_s2, i, axis=0)
        starts.append(_solve(others, gravity_m_s2, plain, "linear"))
    loss = [
        float(np.log1p((residual(start, force_m_s2, gravity_m_s2) / NOISE.sigma) ** 2).sum())
        for start in starts
    ]
    return _solve(force_m_s2, gravity_m_s2, starts[int(np.argmin(loss))], "cauchy")


def _solve(
    force_m_s2: Vector, gravity_m_s2: float, start: Vector, loss: Literal["cauchy", "linear"]
) -> Vector:
    prior = NOISE.sigma * prior_rows()

    def errors(unknowns: Vector) -> Vector:
        return np.concatenate((residual(unknowns, force_m_s2, gravity_m_s2), prior @ unknowns))

    def slopes(unknowns: Vector) -> Vector:
        return np.vstack((jacobian(unknowns, force_m_s2, gravity_m_s2), prior))

    found = least_squares(errors, start, jac=slopes, loss=loss, f_scale=NOISE.sigma)
    return np.asarray(found.x, dtype=np.float64)


def _result(
    solution: Vector, error: Vector, used: Flags, force_m_s2: Vector, gravity_m_s2: float
) -> AccelFit:
    six = np.concatenate((solution[:TERMS], np.zeros(UNKNOWNS - TERMS)))
    slopes = jacobian(solution, force_m_s2[used], gravity_m_s2)[:, :TERMS]
    whole = bool(np.isfinite(error).all())
    return AccelFit(
        offset_m_s2=solution[:3] * gravity_m_s2,
        scale=solution[3:TERMS].copy(),
        skew_rad=solution[TERMS:].copy(),
        offset_error_m_s2=error[:3].copy(),
        scale_error=error[3:TERMS].copy(),
        skew_error_rad=error[TERMS:].copy(),
        used=used,
        before_m_s2=np.linalg.norm(force_m_s2, axis=1) - gravity_m_s2,
        after_m_s2=residual(six, force_m_s2, gravity_m_s2),
        model_m_s2=residual(solution, force_m_s2, gravity_m_s2),
        condition=float(np.linalg.cond(slopes)) if whole else float("inf"),
    )


def _require_sensible(solution: Vector) -> None:
    axis = int(np.argmax(np.abs(solution[3:TERMS])))
    if abs(solution[3 + axis]) > LARGEST_SCALE:
        raise CalibrationError(
            f"the scale of the accelerometer's {'xyz'[axis]} axis would be off by "
            f"{100.0 * solution[3 + axis]:.0f} %; the limit is {100.0 * LARGEST_SCALE:.0f} %. "
            "Check the unit and the range with which the recording was imported"
        )
