"""The sensor configuration that recordings ask for."""

import numpy as np

from hostkit.recordings import LargeRecording, Recording
from hostkit.records import SensorConfig
from hostkit.sensors import SENSORS
from hostkit.sensors.part import Range, SensorPart
from hostkit.units import DEG_PER_RAD, STANDARD_GRAVITY_M_S2

RANGE_MARGIN = 1.5
"""A full scale must exceed the largest reading by this factor: the next motion may be faster."""


def sensor_config(
    recordings: tuple[Recording | LargeRecording, ...],
    rate_hz: float,
    *,
    gyro_full_scale_deg_s: int | None = None,
    accel_full_scale_g: int | None = None,
    low_pass_setting: int | None = None,
    part: str = "mpu6050",
) -> SensorConfig:
    """Return a sensor configuration that fits recordings; what is given is kept.

    The ranges are the narrowest that hold every reading one and a half times, the widest where none
    does. The low-pass filter is the widest whose bandwidth stays below half the sample rate.
    """
    sensor = SENSORS[part]
    largest = [_largest(recording) for recording in recordings]
    rate_deg_s = max(rate for rate, _ in largest) * DEG_PER_RAD
    force_g = max(force for _, force in largest) / STANDARD_GRAVITY_M_S2
    return SensorConfig(
        part=part,
        gyro_full_scale_deg_s=gyro_full_scale_deg_s or _narrowest(sensor.gyro_ranges, rate_deg_s),
        accel_full_scale_g=accel_full_scale_g or _narrowest(sensor.accel_ranges, force_g),
        low_pass_setting=(
            _low_pass_setting(sensor, rate_hz) if low_pass_setting is None else low_pass_setting
        ),
    )


def _largest(recording: Recording | LargeRecording) -> tuple[float, float]:
    if isinstance(recording, LargeRecording):
        return recording.largest
    return (
        float(np.abs(recording.angular_rate_rad_s).max()),
        float(np.abs(recording.specific_force_m_s2).max()),
    )


def _narrowest(ranges: tuple[Range, ...], largest: float) -> int:
    fitting = [r.full_scale for r in ranges if r.full_scale >= RANGE_MARGIN * largest]
    return fitting[0] if fitting else ranges[-1].full_scale


def _low_pass_setting(sensor: SensorPart, rate_hz: float) -> int:
    """Return the widest filter below half the rate among those that keep the 1 kHz clock."""
    filters = [lp for lp in sensor.low_passes if lp.gyro_rate_hz == sensor.sample_base_rate_hz]
    fitting = [lp for lp in filters if lp.gyro_bandwidth_hz <= rate_hz / 2.0]
    return (fitting or filters[-1:])[0].setting
