"""The equations of an accelerometer at rest, and their derivatives.

With the reading m of a pose, the offset o and the scale error s of each axis, and T symmetric with
ones on its diagonal, the true force is ``f = T (1 + s) * (m - o)``. At rest ``|f| = g`` in whatever
position. T has the sines by which the axes are not square to each other; a symmetric one, because
|f| does not show how the sensor as a whole is turned.

The unknowns are nine numbers: offsets in units of gravity, scale errors, and T's y to x, z to x, z
to y.
"""

import numpy as np

from hostkit.recordings.recording import Vector

UNKNOWNS = 9
TERMS = 6
"""The first six are what a filter can correct."""
PAIRS = ((0, 1), (0, 2), (1, 2))


def residual(unknowns: Vector, force_m_s2: Vector, gravity_m_s2: float) -> Vector:
    """Return |f| - g of each pose, shape ``(P,)``.

    Parameters
    ----------
    unknowns
        Shape ``(9,)``.
    force_m_s2
        Mean readings, shape ``(P, 3)``.
    gravity_m_s2
        Magnitude of gravity.
    """
    true = _straight(unknowns, force_m_s2, gravity_m_s2) @ square(unknowns)
    value: Vector = np.linalg.norm(true, axis=1) - gravity_m_s2
    return value


def jacobian(unknowns: Vector, force_m_s2: Vector, gravity_m_s2: float) -> Vector:
    """Return the derivatives of the residuals, shape ``(P, 9)``; parameters as of `residual`."""
    straight = _straight(unknowns, force_m_s2, gravity_m_s2)
    true = straight @ square(unknowns)
    length = np.linalg.norm(true, axis=1, keepdims=True)
    up = np.divide(true, length, out=np.zeros_like(true), where=length > 0.0)
    pulled = up @ square(unknowns)
    skew = [up[:, i] * straight[:, j] + up[:, j] * straight[:, i] for i, j in PAIRS]
    return np.hstack(
        (
            -pulled * (1.0 + unknowns[3:TERMS]) * gravity_m_s2,
            pulled * (force_m_s2 - unknowns[:3] * gravity_m_s2),
            np.column_stack(skew),
        )
    )


def _straight(unknowns: Vector, force_m_s2: Vector, gravity_m_s2: float) -> Vector:
    straight: Vector = (1.0 + unknowns[3:TERMS]) * (force_m_s2 - unknowns[:3] * gravity_m_s2)
    return straight


def square(unknowns: Vector) -> Vector:
    """Return T, shape ``(3, 3)``."""
    matrix = np.eye(3)
    for (i, j), value in zip(PAIRS, unknowns[TERMS:].tolist(), strict=True):
        matrix[i, j] = matrix[j, i] = value
    return matrix
