"""How the observer weighs its two sensors over frequency, near upright and in steady state."""

import numpy as np
from numpy.typing import NDArray

from hostkit.filters.observer.settings import settings
from hostkit.records import FilterDesign
from hostkit.units import STANDARD_GRAVITY_M_S2

Vector = NDArray[np.float64]
Weights = NDArray[np.complex128]


def response(design: FilterDesign, frequency_hz: Vector) -> tuple[Weights, Weights]:
    """Return what the filter makes of the tilt from force and of the integrated rate.

    Both follow from the linear model of :mod:`hostkit.filters.observer.float_model`, in continuous
    time, with s the Laplace variable and D its characteristic polynomial::

        force = kt g (s + kb) / D        rate = s^2 (s + kv) / D

    They add up to one at every frequency.

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
    s = 2j * np.pi * frequency_hz
    stiffness = own.kt_rad_m * STANDARD_GRAVITY_M_S2
    force = stiffness * (s + own.kb_per_s)
    rate = s**2 * (s + own.kv_per_s)
    return force / (force + rate), rate / (force + rate)
