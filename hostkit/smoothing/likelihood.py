"""How likely a recording is under settings: what settings can be chosen by without a reference.

Small deviations make the equations' residuals expensive, large ones make every residual equally
unlikely; and unknowns that are left freer than the recording needs cost as well. With residuals r
and weights w of the equations, and H the matrix of the normal equations at their solution,
Laplace's approximation of the probability of the readings, the unknowns integrated out, is::

    -2 log p = sum(w r^2 - log w) + log det H + what does not depend on the settings

The heavy tails of speed and place enter with the density of Student's t in three dimensions, to
that power with which the equations have its slope.

References
----------
D. J. C. MacKay, "Bayesian interpolation", Neural Computation 4(3):415-447, 1992.
"""

import numpy as np
from scipy.linalg import cho_solve_banded, cholesky_banded

from hostkit.smoothing.equations import (
    TAIL,
    Estimate,
    System,
    assemble,
    constants_weight,
    node_time_s,
)
from hostkit.smoothing.preintegration import Blocks
from hostkit.smoothing.rotation import Array
from hostkit.smoothing.settings import SmootherSettings

DIMENSIONS = 3


def deviance(blocks: Blocks, settings: SmootherSettings, estimate: Estimate) -> float:
    """Return -2 log p of a recording at its solution, up to what settings do not change.

    Raises
    ------
    numpy.linalg.LinAlgError
        If the estimate is no solution.
    """
    system = assemble(blocks, settings, estimate)
    held = system.weight * system.residual**2 - np.log(system.weight)
    return float(
        held.sum() + _motion(blocks, settings, estimate) + _sensor(settings, estimate)
    ) + _log_determinant(system)


def _motion(blocks: Blocks, settings: SmootherSettings, estimate: Estimate) -> float:
    time = node_time_s(blocks)

    def heavy(vectors: Array, size: float) -> float:
        share = np.sum(vectors * vectors, axis=1) / (TAIL * size * size)
        scale = TAIL * DIMENSIONS / (TAIL + DIMENSIONS) * np.log(size)
        return float(np.sum(time * (TAIL * np.log1p(share) + 2.0 * scale)))

    return heavy(estimate.velocity_m_s, settings.speed_m_s) + heavy(
        estimate.position_m, settings.reach_m
    )


def _sensor(settings: SmootherSettings, estimate: Estimate) -> float:
    weight = np.append(constants_weight(settings), np.full(3, settings.gyro_bias_rad_s**-2))
    value = np.append(estimate.constants, estimate.bias_rad_s[0])
    return float(np.sum(weight * value * value - np.log(weight)))


def _log_determinant(system: System) -> float:
    factor = cholesky_banded(system.banded, lower=True, check_finite=False)
    solved = cho_solve_banded((factor, True), system.border, check_finite=False)
    sign, rest = np.linalg.slogdet(system.common - system.border.T @ solved)
    return float(2.0 * np.log(factor[0]).sum() + rest) if sign > 0.0 else np.inf
