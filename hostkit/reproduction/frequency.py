"""Figure 4: how wrong each sensor alone is, over the frequency of the motion.

The tilt swings as a sine. The accelerometer sits on a lever arm and so feels the swing's tangential
acceleration; the gyroscope is integrated from the true angle on, with the bias that a look at
standstill leaves. Both are averaged over random phases.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hostkit.records import read_only
from hostkit.reproduction.signals import measured_rate, measured_tilt
from hostkit.units import RAD_PER_DEG, STANDARD_GRAVITY_M_S2

Vector = NDArray[np.float64]

PERIOD_S = 0.05
AMPLITUDE_RAD = 10.0 * RAD_PER_DEG
LEVER_ARM_M = 0.2
RESIDUAL_BIAS_RAD_S = 0.05 * RAD_PER_DEG
FREQUENCIES_RAD_S = (0.05, 10.0)
FREQUENCY_COUNT = 25
PHASES = 32


@dataclass(frozen=True, slots=True, kw_only=True)
class SensorErrorSweep:
    """Mean absolute errors, rad, over angular frequencies, rad/s, each of shape ``(F,)``."""

    frequency_rad_s: Vector
    accel_rad: Vector
    gyro_rad: Vector

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        for array in (self.frequency_rad_s, self.accel_rad, self.gyro_rad):
            read_only(array)

    @property
    def crossing_rad_s(self) -> float:
        """Lowest frequency from which the accelerometer is the worse one; infinite if none is.

        Between two points both errors are taken as powers of the frequency.
        """
        excess = np.log(self.accel_rad / self.gyro_rad)
        above = np.flatnonzero((excess[1:] > 0.0) & (excess[:-1] <= 0.0))
        if above.size == 0:
            return float("inf")
        k = int(above[0])
        share = excess[k] / (excess[k] - excess[k + 1])
        low, high = np.log(self.frequency_rad_s[k : k + 2])
        return float(np.exp(low + share * (high - low)))


def sweep_cycles(cycles: float, rng: np.random.Generator) -> SensorErrorSweep:
    """Observe every frequency for the same number of cycles."""
    return _sweep(2.0 * np.pi * cycles / _frequencies(), rng)


def sweep_time(duration_s: float, rng: np.random.Generator) -> SensorErrorSweep:
    """Observe every frequency for the same time."""
    return _sweep(np.full(FREQUENCY_COUNT, duration_s), rng)


def _frequencies() -> Vector:
    return np.geomspace(*FREQUENCIES_RAD_S, FREQUENCY_COUNT)


def _sweep(duration_s: Vector, rng: np.random.Generator) -> SensorErrorSweep:
    pairs = [
        _errors_rad(float(frequency), float(span), rng)
        for frequency, span in zip(_frequencies(), duration_s, strict=True)
    ]
    accel, gyro = np.array(pairs).T
    return SensorErrorSweep(frequency_rad_s=_frequencies(), accel_rad=accel, gyro_rad=gyro)


def _errors_rad(
    frequency_rad_s: float, duration_s: float, rng: np.random.Generator
) -> tuple[float, float]:
    """Return the mean absolute error of accelerometer and gyroscope at one frequency."""
    time_s = np.arange(round(duration_s / PERIOD_S) + 1) * PERIOD_S
    phase = frequency_rad_s * time_s + rng.uniform(0.0, 2.0 * np.pi, (PHASES, 1))
    tilt = AMPLITUDE_RAD * np.sin(phase)
    rate = AMPLITUDE_RAD * frequency_rad_s * np.cos(phase)
    tangential_m_s2 = -LEVER_ARM_M * frequency_rad_s**2 * tilt
    by_accel = measured_tilt(np.sin(tilt) - tangential_m_s2 / STANDARD_GRAVITY_M_S2, rng)
    by_gyro = _integrated(measured_rate(rate, RESIDUAL_BIAS_RAD_S, PERIOD_S, rng)) + tilt[:, :1]
    return float(np.mean(np.abs(by_accel - tilt))), float(np.mean(np.abs(by_gyro - tilt)))


def _integrated(rate_rad_s: Vector) -> Vector:
    """Integrate by trapezia, equation 3; the rectangles of equation 4 would lag half a sample."""
    steps = 0.5 * PERIOD_S * (rate_rad_s[:, 1:] + rate_rad_s[:, :-1])
    return np.asarray(np.pad(np.cumsum(steps, axis=1), ((0, 0), (1, 0))))
