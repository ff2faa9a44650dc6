"""Which positions are missing before the poses determine an accelerometer."""

import numpy as np

from hostkit.calibration.accelerometer import (
    NOISE,
    OFFSET_ERROR_LIMIT_M_S2,
    SCALE_ERROR_LIMIT,
    accel_jacobian,
)
from hostkit.calibration.least_squares import covariance
from hostkit.recordings.recording import Vector

FACES = np.vstack((np.eye(3), -np.eye(3)))
FACE_NAMES = ("+x up", "+y up", "+z up", "-x up", "-y up", "-z up")
WEAK = 1e-3
"""Weight of the prior that keeps errors finite where poses say nothing of a number."""


def missing_faces(force_m_s2: Vector, gravity_m_s2: float) -> tuple[str, ...]:
    """Return the faces that should point up in more poses, best first; none if nothing is missing.

    The face that brings the worst standard error down most is added, until every standard error
    is within its limit.

    Parameters
    ----------
    force_m_s2
        Mean reading of each pose, shape ``(P, 3)``.
    gravity_m_s2
        Magnitude of gravity.
    """
    force = np.asarray(force_m_s2, dtype=np.float64).reshape(-1, 3)
    missing: list[int] = []
    while len(missing) < len(FACES) and _excess(force, gravity_m_s2) > 1.0:
        left = [i for i in range(len(FACES)) if i not in missing]
        excess = [_excess(np.vstack((force, gravity_m_s2 * FACES[i])), gravity_m_s2) for i in left]
        missing.append(left[int(np.argmin(excess))])
        force = np.vstack((force, gravity_m_s2 * FACES[missing[-1]]))
    return tuple(FACE_NAMES[i] for i in missing)


def _excess(force_m_s2: Vector, gravity_m_s2: float) -> float:
    """Return the mean over the numbers of standard error to limit, at most 1 where it is kept."""
    jacobian = accel_jacobian(np.zeros(6), force_m_s2, gravity_m_s2)
    scaled = np.vstack((jacobian, WEAK * np.eye(6)))
    error = NOISE.sigma * np.sqrt(np.diag(covariance(scaled)))
    limit = np.repeat((OFFSET_ERROR_LIMIT_M_S2 / gravity_m_s2, SCALE_ERROR_LIMIT), 3)
    ratio = error / limit
    return float(ratio.max()) if ratio.max() <= 1.0 else 1.0 + float(ratio.sum())
