"""What the fits of a calibration share: a prior on the noise, standard errors, bad rows."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hostkit.recordings.recording import Vector

Flags = NDArray[np.bool_]

PRIOR_ROWS = 4.0
"""How many rows the assumed noise counts for beside the measured residuals."""
TIMES_TYPICAL = 5.0
"""A row is bad if its residual is this many times the typical one."""
MEDIAN_TO_SIGMA = 1.4826
"""Standard deviation of a normal distribution whose median absolute value is 1."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Noise:
    """What is assumed of the residuals before any is seen.

    Attributes
    ----------
    sigma
        Standard deviation, in the unit of the residuals.
    least_bad
        Smallest residual that can make a row bad.
    """

    sigma: float
    least_bad: float


def sigma_of(residual: Vector, unknowns: int, noise: Noise) -> float:
    """Return the standard deviation of a row from residuals and the assumed noise.

    With few rows the residuals say nothing of the noise (six poses fit six numbers exactly), so
    the assumed variance is averaged in with the weight of `PRIOR_ROWS` degrees of freedom: the
    mean of the scaled inverse chi-squared posterior (A. Gelman et al., "Bayesian Data Analysis",
    section 2.6).

    Parameters
    ----------
    residual
        Residuals of the rows in use, shape ``(R,)``.
    unknowns
        How many numbers were fitted.
    noise
        What is assumed.
    """
    freedom = max(0, residual.size - unknowns)
    total = PRIOR_ROWS * noise.sigma**2 + float(residual @ residual)
    return float(np.sqrt(total / (PRIOR_ROWS + freedom)))


def covariance(jacobian: Vector) -> Vector:
    """Return ``(J^T J)^-1`` for unit noise; infinite where `jacobian` determines nothing.

    Parameters
    ----------
    jacobian
        Derivatives of the residuals, shape ``(R, U)``.
    """
    _, sizes, rows = np.linalg.svd(jacobian, full_matrices=False)
    unknowns = jacobian.shape[1]
    if sizes.size < unknowns or sizes[-1] <= 1e-9 * sizes[0]:
        return np.full((unknowns, unknowns), np.inf)
    inverse: Vector = (rows.T / sizes**2) @ rows
    return inverse


def good_rows(size: Vector, noise: Noise, at_least: int) -> Flags:
    """Return which rows fit, from the sizes of residuals of a fit that bad rows do not bend.

    Parameters
    ----------
    size
        Absolute residuals, shape ``(R,)``.
    noise
        What is assumed of them.
    at_least
        If fewer rows than this would be left, all are kept: then nothing tells good from bad.
    """
    typical = MEDIAN_TO_SIGMA * float(np.median(size)) if size.size else 0.0
    good: Flags = size <= max(TIMES_TYPICAL * typical, noise.least_bad)
    return good if np.count_nonzero(good) >= at_least else np.ones_like(good)
