"""What a calibration of an accelerometer is worth, in degrees of tilt."""

from dataclasses import dataclass

import numpy as np

from hostkit.attitude import inclination_rad
from hostkit.calibration.accel_model import TERMS, jacobian, square
from hostkit.calibration.accelerometer import NOISE, AccelFit, fit_accelerometer, prior_rows
from hostkit.recordings.recording import Vector

DIRECTIONS = 400
LEAST_FREE = 1e-3
"""Share of a pose that the fit must not need; with less the others say nothing of it."""


@dataclass(frozen=True, slots=True, kw_only=True)
class TiltWorth:
    """Error of the tilt of a resting sensor, over all directions evenly.

    Attributes
    ----------
    before_rms_rad, before_max_rad
        Without the calibration, if the calibration is right.
    after_rms_rad
        With it: what axes that are not square leave, and the standard errors of the six numbers as
        if these were independent.
    """

    before_rms_rad: float
    before_max_rad: float
    after_rms_rad: float


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Halves:
    """How far the calibrations by every other pose differ: second less first, each ``(3,)``."""

    offset_m_s2: Vector
    scale: Vector


def tilt_worth(fit: AccelFit, gravity_m_s2: float) -> TiltWorth:
    """Return what a calibration changes, for a determined one."""
    up = _directions()
    straight = up @ np.linalg.inv(square(fit.unknowns))
    reading = gravity_m_s2 * straight / (1.0 + fit.scale) + fit.offset_m_s2
    before, left = inclination_rad(reading, up), inclination_rad(straight, up)
    spread = fit.offset_error_m_s2**2 + (gravity_m_s2 * up * fit.scale_error) ** 2
    across = ((1.0 - up**2) * spread).sum(axis=1) / gravity_m_s2**2
    return TiltWorth(
        before_rms_rad=float(np.sqrt(np.mean(before**2))),
        before_max_rad=float(before.max()),
        after_rms_rad=float(np.sqrt(np.mean(left**2 + across))),
    )


def left_out_rms_m_s2(fit: AccelFit, force_m_s2: Vector, gravity_m_s2: float) -> float | None:
    """Return the rms of |f| - g of each pose, by all nine numbers from all other poses.

    By the leverage h of a pose: ``e / (1 - h)`` (D. M. Allen's PRESS statistic), which is exact
    for equations that are linear. None if the fit cannot do without one of the poses.

    Parameters
    ----------
    fit
        The calibration.
    force_m_s2
        Mean reading of each pose, shape ``(P, 3)``.
    gravity_m_s2
        Magnitude of gravity.
    """
    poses = int(np.count_nonzero(fit.used))
    unknowns = fit.unknowns
    unknowns[:3] /= gravity_m_s2
    slopes = jacobian(unknowns, force_m_s2[fit.used], gravity_m_s2)
    orthogonal, _ = np.linalg.qr(np.vstack((slopes, NOISE.sigma * prior_rows())))
    free = 1.0 - np.sum(orthogonal[:poses] ** 2, axis=1)
    if poses <= TERMS or free.min() < LEAST_FREE:
        return None
    return float(np.sqrt(np.mean((fit.model_m_s2[fit.used] / free) ** 2)))


def halves(force_m_s2: Vector, gravity_m_s2: float) -> Halves | None:
    """Return how far calibrations by every other pose differ; None if one is not determined."""
    first, second = (fit_accelerometer(force_m_s2[i::2], gravity_m_s2) for i in (0, 1))
    if not (first.determined and second.determined):
        return None
    return Halves(
        offset_m_s2=second.offset_m_s2 - first.offset_m_s2, scale=second.scale - first.scale
    )


def _directions() -> Vector:
    """Return directions that lie evenly on the sphere, on a spiral of the golden angle."""
    index = np.arange(DIRECTIONS) + 0.5
    z = 1.0 - 2.0 * index / DIRECTIONS
    turn = np.pi * (1.0 + np.sqrt(5.0)) * index
    radius = np.sqrt(1.0 - z**2)
    return np.column_stack((radius * np.cos(turn), radius * np.sin(turn), z))
