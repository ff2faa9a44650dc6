"""A recording made up from a motion profile and a model of the sensor."""

import math

import numpy as np

from hostkit.errors import HostkitError
from hostkit.recordings import Recording
from hostkit.records import SensorConfig
from hostkit.sensors import SENSORS
from hostkit.sensors.part import SensorPart
from hostkit.simulation.motion import motion_at
from hostkit.simulation.profiles import PROFILES, Profile
from hostkit.simulation.sensor_errors import SensorErrors
from hostkit.simulation.sensor_model import Channel, Sampling, measure, oversampling

MAX_FINE_STEPS = 4_000_000
"""Internal steps of the longest simulation; about 1 GB of memory."""

LICENCE = "CC0-1.0"


def simulate(
    profile: str | Profile,
    *,
    duration_s: float,
    rate_hz: float,
    sensor: SensorConfig,
    errors: SensorErrors,
    rng: np.random.Generator,
) -> Recording:
    """Return what a sensor records while it is moved.

    The reference is the true up direction at the time of each sample; with the low-pass filter
    on, the measured values are late against it by the delays of the data sheet, as on the bench.
    The filter is a Gaussian of the data sheet's bandwidth: its noise bandwidth is 1.06 times that.

    Parameters
    ----------
    profile
        A profile, or the name of one in `PROFILES`.
    duration_s
        Time from the first to one period after the last sample.
    rate_hz
        Sample rate; one that the sensor can make.
    sensor
        Part, ranges and low-pass setting.
    errors
        What the sensor does wrong.
    rng
        Source of all randomness. The same state gives the same recording.

    Raises
    ------
    DesignError
        If the sensor has no such range, setting or rate.
    HostkitError
        If no profile has this name, or the duration is too short or too long.
    """
    chosen = PROFILES[profile] if isinstance(profile, str) else profile
    part = SENSORS[sensor.part]
    gyro, accel = _gyro(part, sensor, errors), _accel(part, sensor, errors)
    sampling = _sampling(part, duration_s, rate_hz, max(gyro.bandwidth_hz, accel.bandwidth_hz))
    path = chosen.draw(rng)
    time_s = np.arange(sampling.samples) / rate_hz
    return Recording(
        name=f"simulated-{chosen.name}",
        time_s=time_s,
        rate_hz=rate_hz,
        angular_rate_rad_s=measure(
            gyro, lambda t: motion_at(path, t).angular_rate_rad_s, sampling, errors, rng
        ),
        specific_force_m_s2=measure(
            accel, lambda t: motion_at(path, t).specific_force_m_s2, sampling, errors, rng
        ),
        valid=np.ones(sampling.samples, dtype=np.bool_),
        up_reference=motion_at(path, time_s).up,
        sensor=f"{part.title}, simulated",
        origin=f"hostkit simulation, profile {chosen.name}",
        licence=LICENCE,
    )


def _sampling(part: SensorPart, duration_s: float, rate_hz: float, bandwidth_hz: float) -> Sampling:
    if not (math.isfinite(rate_hz) and rate_hz > 0.0):
        raise HostkitError(f"rate_hz = {rate_hz} is not a sample rate; it must be above 0")
    part.sample_divider(rate_hz)
    fine = oversampling(rate_hz, bandwidth_hz)
    longest_s = MAX_FINE_STEPS / (rate_hz * fine)
    if not 2.0 / rate_hz <= duration_s <= longest_s:
        raise HostkitError(
            f"duration_s = {duration_s:g} is outside [{2.0 / rate_hz:g}, {longest_s:.0f}] s: two "
            f"samples at {rate_hz:g} Hz, and {MAX_FINE_STEPS} internal steps"
        )
    return Sampling(samples=round(duration_s * rate_hz), rate_hz=rate_hz, oversampling=fine)


def _gyro(part: SensorPart, sensor: SensorConfig, errors: SensorErrors) -> Channel:
    low_pass = part.low_pass(sensor)
    return Channel(
        bandwidth_hz=low_pass.gyro_bandwidth_hz,
        delay_s=low_pass.gyro_delay_s,
        noise_density=errors.gyro_noise_density_rad_s_rthz
        or part.noise.gyro_noise_density_rad_s_rthz,
        of_samples=errors.gyro_noise_density_rad_s_rthz is not None,
        unit_per_count=part.rad_s_per_count(sensor),
        scale=errors.gyro_scale,
        offset=errors.gyro_bias_rad_s,
        offset_walk=errors.gyro_bias_walk_rad_s_rts,
        vibration=0.0,
    )


def _accel(part: SensorPart, sensor: SensorConfig, errors: SensorErrors) -> Channel:
    low_pass = part.low_pass(sensor)
    return Channel(
        bandwidth_hz=low_pass.accel_bandwidth_hz,
        delay_s=low_pass.accel_delay_s,
        noise_density=errors.accel_noise_density_m_s2_rthz
        or part.noise.accel_noise_density_m_s2_rthz,
        of_samples=errors.accel_noise_density_m_s2_rthz is not None,
        unit_per_count=part.m_s2_per_count(sensor),
        scale=errors.accel_scale,
        offset=errors.accel_offset_m_s2,
        offset_walk=0.0,
        vibration=errors.vibration_m_s2,
    )
