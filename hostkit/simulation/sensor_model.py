"""From what an ideal sensor would read to what a real one puts out."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

from hostkit.sensors.counts import quantise
from hostkit.simulation.curves import multisine
from hostkit.simulation.sensor_errors import SensorErrors, Triple

Vector = NDArray[np.float64]

VIBRATION_BAND_HZ = (20.0, 120.0)
MIN_FINE_RATE_HZ = 1000.0
FINE_RATE_PER_BANDWIDTH = 8.0
FILTER_REACH = 4.0
"""Standard deviations after which the filter's response is cut off."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Channel:
    """One sensing element on three axes: gyroscope or accelerometer, as it is set.

    Attributes
    ----------
    bandwidth_hz, delay_s
        Of the low-pass setting.
    noise_density
        Unit of the channel per root hertz, one-sided, of all axes or of each.
    of_samples
        Whether that density is of the samples, not of the noise before the low-pass filter.
    unit_per_count
        Weight of one count.
    scale, offset
        Relative error and constant offset per axis.
    offset_walk
        Random walk of the offset, per root second, of all axes or of each.
    """

    bandwidth_hz: float
    delay_s: float
    noise_density: float | Triple
    of_samples: bool
    unit_per_count: float
    scale: Triple
    offset: Triple
    offset_walk: float | Triple
    vibration: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Sampling:
    """When samples are taken, and how finely the time between them is resolved."""

    samples: int
    rate_hz: float
    oversampling: int

    @property
    def fine_rate_hz(self) -> float:
        """Rate at which the inside of the sensor is computed."""
        return self.rate_hz * self.oversampling


def measure(
    channel: Channel,
    ideal: Callable[[Vector], Vector],
    sampling: Sampling,
    errors: SensorErrors,
    rng: np.random.Generator,
) -> Vector:
    """Return what one channel puts out.

    Parameters
    ----------
    channel
        The sensing element.
    ideal
        What it should read as a function of time, s: shape ``(M,)`` to ``(M, 3)``.
    sampling
        Times of the samples.
    errors
        Cross-axis share, noise factor, and whether to filter and to count.
    rng
        Source of noise, walk and vibration.

    Returns
    -------
    numpy.ndarray
        Measured values in the unit of the channel, shape ``(samples, 3)``.
    """
    margin = _reach(channel, sampling) if errors.low_pass else 0
    steps = (sampling.samples - 1) * sampling.oversampling + 1
    time_s = np.arange(-margin, steps + margin) / sampling.fine_rate_hz
    delay_s = channel.delay_s if errors.low_pass else 0.0
    fine = _distorted(channel, ideal(time_s - delay_s), errors)
    fine += _disturbance(channel, time_s, sampling, errors, rng)
    if errors.low_pass:
        sigma = _sigma_s(channel) * sampling.fine_rate_hz
        fine = np.asarray(gaussian_filter1d(fine, sigma, axis=0, truncate=FILTER_REACH))
    sampled: Vector = fine[margin : margin + steps : sampling.oversampling]
    if not errors.counts:
        return sampled.copy()
    counts = quantise(sampled, channel.unit_per_count).astype(np.float64)
    return counts * channel.unit_per_count


def oversampling(rate_hz: float, bandwidth_hz: float) -> int:
    """Return how many internal steps a sample takes, so that filter and noise are resolved."""
    wanted_hz = max(MIN_FINE_RATE_HZ, FINE_RATE_PER_BANDWIDTH * bandwidth_hz)
    return int(np.ceil(wanted_hz / rate_hz))


def _sigma_s(channel: Channel) -> float:
    """Return the width of the Gaussian whose gain is -3 dB at the bandwidth."""
    return float(np.sqrt(np.log(2.0)) / (2.0 * np.pi * channel.bandwidth_hz))


def _reach(channel: Channel, sampling: Sampling) -> int:
    return int(np.ceil(FILTER_REACH * _sigma_s(channel) * sampling.fine_rate_hz)) + 1


def _distorted(channel: Channel, ideal: Vector, errors: SensorErrors) -> Vector:
    gain = np.diag(1.0 + np.asarray(channel.scale))
    gain += errors.cross_axis * (1.0 - np.eye(3))
    distorted: Vector = ideal @ gain.T + np.asarray(channel.offset)
    return distorted


def _disturbance(
    channel: Channel,
    time_s: Vector,
    sampling: Sampling,
    errors: SensorErrors,
    rng: np.random.Generator,
) -> Vector:
    """Return noise, walk of the offset and vibration, shape ``(M, 3)``."""
    fine_rate_hz, shape = sampling.fine_rate_hz, (len(time_s), 3)
    density = np.asarray(channel.noise_density)
    if channel.of_samples:
        density = density / np.sqrt(_folding(channel, sampling, errors))
    noise_rms = errors.noise * density * np.sqrt(0.5 * fine_rate_hz)
    total: Vector = noise_rms * rng.standard_normal(shape)
    if np.any(channel.offset_walk):
        walk = np.asarray(channel.offset_walk)
        steps = rng.standard_normal(shape) * walk / np.sqrt(fine_rate_hz)
        total += np.cumsum(steps, axis=0)
    if channel.vibration:
        for axis in range(3):
            curve = multisine(rms=channel.vibration, band_hz=VIBRATION_BAND_HZ, rng=rng)
            total[:, axis] += curve(time_s).value
    return total


def _folding(channel: Channel, sampling: Sampling, errors: SensorErrors) -> float:
    """Return how many times its power low-frequency noise has after sampling.

    Sampling folds the noise at every multiple of the sample rate onto frequency 0; what is left of
    it there is the square of the filter's gain, ``2 ** -(f / bandwidth)^2``.
    """
    multiples = np.arange(1 - sampling.oversampling, sampling.oversampling)
    if not errors.low_pass:
        return float(sampling.oversampling)
    gains = 2.0 ** -((multiples * sampling.rate_hz / channel.bandwidth_hz) ** 2)
    return float(gains.sum())
