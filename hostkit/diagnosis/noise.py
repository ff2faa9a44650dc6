"""The noise of a sensor at rest: what its Allan deviations and its means say."""

from dataclasses import dataclass

import numpy as np

from hostkit.diagnosis.allan import AllanCurve, allan_curve, overlapping_deviation
from hostkit.diagnosis.rest import Rest, RestStretch, Triple
from hostkit.recordings import Recording

MIN_STRETCH_S = 30.0
MIN_SAMPLES = 300


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SensorNoise:
    """What a resting sensor reads besides the truth.

    Attributes
    ----------
    rate_hz
        Sample rate of the rest, from its number of samples and its length.
    duration_s, samples, stretches
        Length, samples and number of the stretches used, of at least 30 s and 300 samples each.
    gyro_bias_rad_s, gyro_bias_uncertainty_rad_s
        As in `Rest`.
    gyro, accel
        Allan deviations, in rad/s and m/s^2.
    """

    rate_hz: float
    duration_s: float
    samples: int
    stretches: int
    gyro_bias_rad_s: Triple
    gyro_bias_uncertainty_rad_s: Triple
    gyro: AllanCurve
    accel: AllanCurve


def long_stretches(rest: Rest) -> tuple[RestStretch, ...]:
    """Return the stretches that are long enough for an Allan deviation."""
    return tuple(
        s
        for s in rest.stretches
        if s.duration_s >= MIN_STRETCH_S and s.last - s.first + 1 >= MIN_SAMPLES
    )


def sensor_noise(recording: Recording, rest: Rest) -> SensorNoise | None:
    """Return the noise of a sensor from where a recording is at rest.

    Returns
    -------
    SensorNoise or None
        None if no stretch at rest is as long as `MIN_STRETCH_S`.

    Raises
    ------
    ToolMissingError
        If there is such a stretch and allantools is not installed.
    """
    stretches = long_stretches(rest)
    if not stretches or rest.bias_rad_s is None or rest.bias_uncertainty_rad_s is None:
        return None
    deviation = overlapping_deviation()
    duration_s = float(np.sum([s.duration_s for s in stretches]))
    samples = sum(s.last - s.first + 1 for s in stretches)
    period_s = duration_s / (samples - len(stretches))
    return SensorNoise(
        rate_hz=1.0 / period_s,
        duration_s=duration_s,
        samples=samples,
        stretches=len(stretches),
        gyro_bias_rad_s=rest.bias_rad_s,
        gyro_bias_uncertainty_rad_s=rest.bias_uncertainty_rad_s,
        gyro=allan_curve(recording.angular_rate_rad_s, stretches, period_s, deviation),
        accel=allan_curve(recording.specific_force_m_s2, stretches, period_s, deviation),
    )
