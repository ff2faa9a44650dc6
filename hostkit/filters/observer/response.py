"""How the observer weighs its two sensors over frequency."""

import numpy as np
from numpy.typing import NDArray

from hostkit.filters.observer.settings import settings
from hostkit.records import FilterDesign
from hostkit.units import STANDARD_GRAVITY_M_S2

Vector = NDArray[np.float64]
Weights = NDArray[np.complex128]


def response(design: FilterDesign, frequency_hz: Vector) -> tuple[Weights, Weights]:
    """Return what the observer makes of the tilt from force and of the integrated rate.

    For small tilts about one axis, after the start and without rest or lead. With q the delay of a
    sample, m the tilt from force, p the integrated rate, and what the step before the correction
    gives of them::

        G = kt g dt^2 / (1 - (1 - kv dt) q)
        L = q / (1 - q) (1 + kb dt / (1 - q)) G
        predicted = (p + L m) / (1 + L)         tilt = predicted + G (m - predicted)

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
    own, period_s = settings(design), design.period_s
    delay = np.exp(-2j * np.pi * frequency_hz * period_s)
    gain = own.kt_rad_m * STANDARD_GRAVITY_M_S2 * period_s**2
    direct = gain / (1.0 - (1.0 - own.kv_per_s * period_s) * delay)
    loop = delay / (1.0 - delay) * (1.0 + own.kb_per_s * period_s / (1.0 - delay)) * direct
    rate = (1.0 - direct) / (1.0 + loop)
    force = (1.0 - direct) * loop / (1.0 + loop) + direct
    return force, rate
