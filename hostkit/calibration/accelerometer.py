"""Offset and scale of an accelerometer from poses: at rest the force is as large as gravity.

With the reading m of a pose, the offset o and the scale error s of each axis, the true force is
``f = (1 + s) * (m - o)``, and a pose at rest says ``|f| = g`` in whatever position. Each pose gives
one equation for six unknowns, so six poses are the least, and they must differ enough.

Source: I. Skog, P. Handel, "Calibration of a MEMS inertial measurement unit", XVII IMEKO World
Congress, 2006; without the misalignments, which the filters of hostkit have no place for.
"""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares

from hostkit.calibration.least_squares import Flags, Noise, covariance, good_rows, sigma_of
from hostkit.errors import CalibrationError
from hostkit.recordings.recording import Vector
from hostkit.records import read_only

UNKNOWNS = 6
NOISE = Noise(sigma=0.02, least_bad=0.2)
"""m/s^2: 2 mg for the nonlinearity and the noise of a cheap part. A pose is bad from 20 mg on, for
10 mg can come of axes that are not square to each other, which is no fault of the pose."""
OFFSET_ERROR_LIMIT_M_S2 = 0.06
SCALE_ERROR_LIMIT = 0.006
"""Largest standard errors that still improve a part: 6 mg, and as much at 1 g."""
HOPELESS = 3.0
"""Poses that leave errors this many times the limits are not fitted at all."""
LARGEST_SCALE = 0.25


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class AccelFit:
    """Offset and scale of an accelerometer.

    Attributes
    ----------
    offset_m_s2, scale
        The six numbers, each ``(3,)``, sensor axes.
    offset_error_m_s2, scale_error
        Their standard errors.
    used
        Which poses fit, shape ``(P,)``; the others are left out.
    before_m_s2, after_m_s2
        Magnitude of the force less gravity, as read and corrected, shape ``(P,)``.
    condition
        Condition number of the equations; 1 would be ideal, six faces have 1.4.
    """

    offset_m_s2: Vector
    scale: Vector
    offset_error_m_s2: Vector
    scale_error: Vector
    used: Flags
    before_m_s2: Vector
    after_m_s2: Vector
    condition: float

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        for array in (self.offset_m_s2, self.scale, self.before_m_s2, self.after_m_s2):
            read_only(array)
        read_only(self.offset_error_m_s2)
        read_only(self.scale_error)
        read_only(self.used)

    @property
    def determined(self) -> bool:
        """Whether the standard errors are small enough for the numbers to be of use."""
        return standard_errors_suffice(self.offset_error_m_s2, self.scale_error)

    def corrected(self, force_m_s2: Vector) -> Vector:
        """Return the true force of readings, both of shape ``(..., 3)``."""
        true: Vector = (1.0 + self.scale) * (force_m_s2 - self.offset_m_s2)
        return true


def standard_errors_suffice(offset_error_m_s2: Vector, scale_error: Vector) -> bool:
    """Tell whether standard errors of offset and scale, each ``(3,)``, are within the limits."""
    return bool(
        (offset_error_m_s2 <= OFFSET_ERROR_LIMIT_M_S2).all()
        and (scale_error <= SCALE_ERROR_LIMIT).all()
    )


def fit_accelerometer(force_m_s2: Vector, gravity_m_s2: float) -> AccelFit:
    """Fit offset and scale to the mean forces of poses.

    The first fit weighs bad poses down (Cauchy's loss); poses far from it are left out of the
    second, which is plain least squares. Standard errors are infinite if the poses do not
    determine the numbers.

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
    before = np.linalg.norm(force_m_s2, axis=1) - gravity_m_s2
    expected = _errors(np.zeros(UNKNOWNS), force_m_s2, gravity_m_s2, NOISE.sigma)
    if not standard_errors_suffice(expected[:3] / HOPELESS, expected[3:] / HOPELESS):
        return _undetermined(before, expected)
    robust = _solve(force_m_s2, gravity_m_s2, loss="cauchy")
    size = np.abs(_residual(robust, force_m_s2, gravity_m_s2))
    used = good_rows(size, NOISE, UNKNOWNS + 2)
    solution = _solve(force_m_s2[used], gravity_m_s2, loss="linear")
    _require_sensible(solution)
    after = _residual(solution, force_m_s2, gravity_m_s2)
    sigma = sigma_of(after[used], UNKNOWNS, NOISE)
    error = _errors(solution, force_m_s2[used], gravity_m_s2, sigma)
    return AccelFit(
        offset_m_s2=solution[:3] * gravity_m_s2,
        scale=solution[3:].copy(),
        offset_error_m_s2=error[:3].copy(),
        scale_error=error[3:].copy(),
        used=used,
        before_m_s2=before,
        after_m_s2=after,
        condition=float(np.linalg.cond(accel_jacobian(solution, force_m_s2[used], gravity_m_s2))),
    )


def accel_jacobian(unknowns: Vector, force_m_s2: Vector, gravity_m_s2: float) -> Vector:
    """Return the derivatives of the residuals, shape ``(P, 6)``.

    Parameters
    ----------
    unknowns
        Offsets in units of gravity, then scales, shape ``(6,)``.
    force_m_s2
        Mean readings, shape ``(P, 3)``.
    gravity_m_s2
        Magnitude of gravity.
    """
    centred = force_m_s2 - unknowns[:3] * gravity_m_s2
    true = (1.0 + unknowns[3:]) * centred
    up = true / np.linalg.norm(true, axis=1, keepdims=True)
    return np.hstack((-up * (1.0 + unknowns[3:]) * gravity_m_s2, up * centred))


def _residual(unknowns: Vector, force_m_s2: Vector, gravity_m_s2: float) -> Vector:
    true = (1.0 + unknowns[3:]) * (force_m_s2 - unknowns[:3] * gravity_m_s2)
    residual: Vector = np.linalg.norm(true, axis=1) - gravity_m_s2
    return residual


def _solve(force_m_s2: Vector, gravity_m_s2: float, *, loss: str) -> Vector:
    found = least_squares(
        _residual,
        np.zeros(UNKNOWNS),
        jac=accel_jacobian,
        loss=loss,
        f_scale=NOISE.sigma,
        args=(force_m_s2, gravity_m_s2),
    )
    return np.asarray(found.x, dtype=np.float64)


def _errors(unknowns: Vector, force_m_s2: Vector, gravity_m_s2: float, sigma: float) -> Vector:
    """Return standard errors of offsets, m/s^2, and scales, shape ``(6,)``; infinite if unknown."""
    if len(force_m_s2) < UNKNOWNS:
        return np.full(UNKNOWNS, np.inf)
    error = sigma * np.sqrt(np.diag(covariance(accel_jacobian(unknowns, force_m_s2, gravity_m_s2))))
    error[:3] *= gravity_m_s2
    return np.asarray(error, dtype=np.float64)


def _undetermined(before: Vector, error: Vector) -> AccelFit:
    return AccelFit(
        offset_m_s2=np.zeros(3),
        scale=np.zeros(3),
        offset_error_m_s2=error[:3].copy(),
        scale_error=error[3:].copy(),
        used=np.ones(len(before), dtype=np.bool_),
        before_m_s2=before,
        after_m_s2=before.copy(),
        condition=float("inf"),
    )


def _require_sensible(solution: Vector) -> None:
    axis = int(np.argmax(np.abs(solution[3:])))
    if abs(solution[3 + axis]) > LARGEST_SCALE:
        raise CalibrationError(
            f"the scale of the accelerometer's {'xyz'[axis]} axis would be off by "
            f"{100.0 * solution[3 + axis]:.0f} %; the limit is {100.0 * LARGEST_SCALE:.0f} %. "
            "Check the unit and the range with which the recording was imported"
        )
