"""How the complementary filter weighs its two sensors over frequency."""

import numpy as np
from numpy.typing import NDArray

from hostkit.filters.complementary.parameters import settings
from hostkit.records import FilterDesign

Vector = NDArray[np.float64]
Weights = NDArray[np.complex128]


def response(design: FilterDesign, frequency_hz: Vector) -> tuple[Weights, Weights]:
    """Return what the filter makes of the tilt from force and of the integrated rate.

    With q the delay of a sample and k = ki dt^2 they follow from the equations of the filter
    without a gate (:mod:`hostkit.filters.complementary.parameters`); they add up to one at every
    frequency.

    Parameters
    ----------
    frequency_hz
        Frequencies above 0, shape ``(N,)``.

    Returns
    -------
    force, rate
        Each of shape ``(N,)``.
    """
    own = settings(design)
    gain = (own.integral_gain_per_s2 or 0.0) * design.period_s**2
    delay = np.exp(-2j * np.pi * frequency_hz * design.period_s)
    learnt = delay * gain / (1.0 - delay)
    denominator = 1.0 - delay * own.eta + learnt
    rate = own.eta * (1.0 - delay) / denominator
    force = own.eta * (delay * (1.0 - own.eta) + learnt) / denominator + 1.0 - own.eta
    return force, rate
