"""Which positions are missing before the poses determine an accelerometer."""

import numpy as np

from hostkit.calibration.accel_model import TERMS, UNKNOWNS, jacobian
from hostkit.calibration.accelerometer import NOISE, prior_rows, standard_errors_over_limits
from hostkit.calibration.least_squares import covariance
from hostkit.recordings.recording import Vector

FACES = np.vstack((np.eye(3), -np.eye(3)))
FACE_NAMES = ("+x up", "+y up", "+z up", "-x up", "-y up", "-z up")
LOOSE = 1.0
"""Standard deviation of a prior that keeps errors finite where poses say nothing of a term."""


def missing_faces(force_m_s2: Vector, gravity_m_s2: float) -> tuple[str, ...]:
    """Return the faces that should point up in more poses, best first; none if nothing is missing.

    The face that brings the standard errors down most is added, until each is within its limit;
    then those are taken off that have become needless.

    Parameters
    ----------
    force_m_s2
        Mean reading of each pose, shape ``(P, 3)``.
    gravity_m_s2
        Magnitude of gravity.
    """
    force = np.asarray(force_m_s2, dtype=np.float64).reshape(-1, 3)
    missing: list[int] = []
    while len(missing) < len(FACES) and _excess(force, missing, gravity_m_s2) > 0.0:
        left = [i for i in range(len(FACES)) if i not in missing]
        missing.append(min(left, key=lambda i: _excess(force, [*missing, i], gravity_m_s2)))
    for face in tuple(missing):
        others = [i for i in missing if i != face]
        if _excess(force, others, gravity_m_s2) == 0.0:
            missing = others
    return tuple(FACE_NAMES[i] for i in missing)


def _excess(force_m_s2: Vector, faces: list[int], gravity_m_s2: float) -> float:
    """Return the sum of standard errors over limits with some faces added; 0 if each is kept."""
    poses = np.vstack((force_m_s2, gravity_m_s2 * FACES[faces]))
    slopes = jacobian(np.zeros(UNKNOWNS), poses, gravity_m_s2) / NOISE.sigma
    loose = np.eye(UNKNOWNS)[:TERMS] / LOOSE
    error = np.sqrt(np.diag(covariance(np.vstack((slopes, prior_rows(), loose)))))
    error[:3] *= gravity_m_s2
    ratio = standard_errors_over_limits(error)
    return float(ratio.sum()) if ratio.max() > 1.0 else 0.0
