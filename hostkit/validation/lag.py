"""How far one signal is behind another, by cross-correlation."""

import numpy as np
from numpy.typing import NDArray

from hostkit.units import RAD_PER_DEG

Vector = NDArray[np.float64]

LEAST_SAMPLES = 64
LEAST_MOTION_RAD = 0.01 * RAD_PER_DEG
"""Smallest standard deviation of an angle that tells of a lag."""

LEAST_CORRELATION = 0.5


def lag_samples(model: Vector, device: Vector) -> float | None:
    """Return how many samples a device is behind its model.

    The mean squared difference over the samples in common is taken for every shift of up to a
    quarter of the samples; it is the cross-correlation put right for the energy at the ends,
    without which slow motion pulls the result towards zero. A parabola through its least value and
    the two beside it gives the part of a sample.

    Parameters
    ----------
    model, device
        Angles without jumps, rad, each of shape ``(N,)``.

    Returns
    -------
    float or None
        Positive where the device is late; None with fewer than 64 samples, too little motion, too
        little resemblance, or a lag longer than a quarter of the samples.
    """
    if len(model) < LEAST_SAMPLES:
        return None
    mean = float(model.mean())
    model, device = model - mean, device - mean
    variance = float(model.var())
    if variance < LEAST_MOTION_RAD**2:
        return None
    most = len(model) // 4
    best = int(np.argmin(_differences(model, device, most))) - most
    if abs(best) >= most:
        return None
    around = [_difference(model, device, best + k) for k in (-1, 0, 1)]
    bend = around[0] - 2.0 * around[1] + around[2]
    if bend <= 0.0 or around[1] > 2.0 * (1.0 - LEAST_CORRELATION) * variance:
        return None
    return best + 0.5 * (around[0] - around[2]) / bend


def _differences(model: Vector, device: Vector, most: int) -> Vector:
    """Return the mean squared difference for shifts of ``-most .. most``."""
    count = len(model)
    size = 1 << (2 * count - 1).bit_length()
    spectrum = np.fft.rfft(device, size) * np.conj(np.fft.rfft(model, size))
    product = np.fft.irfft(spectrum, size)
    shifts = np.arange(-most, most + 1)
    ahead, behind = np.maximum(shifts, 0), np.maximum(-shifts, 0)
    model_energy = np.concatenate([[0.0], np.cumsum(model**2)])
    device_energy = np.concatenate([[0.0], np.cumsum(device**2)])
    energy = model_energy[count - ahead] - model_energy[behind]
    energy += device_energy[count - behind] - device_energy[ahead]
    differences: Vector = (energy - 2.0 * product[shifts]) / (count - np.abs(shifts))
    return differences


def _difference(model: Vector, device: Vector, shift: int) -> float:
    if shift >= 0:
        model, device = model[: len(model) - shift], device[shift:]
    else:
        model, device = model[-shift:], device[: len(device) + shift]
    return float(np.mean((device - model) ** 2))
