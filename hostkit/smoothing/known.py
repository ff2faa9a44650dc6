"""What a design says of the sensor: ranges, calibration and lead."""

from dataclasses import dataclass, replace

import numpy as np

from hostkit.records import FilterDesign
from hostkit.smoothing.rotation import Array
from hostkit.smoothing.settings import SmootherSettings
from hostkit.units import RAD_PER_DEG

Triple = tuple[float, float, float]

NONE: Triple = (0.0, 0.0, 0.0)
AT_FULL_SCALE = 0.999
"""Share of the full scale from which on a rate is clipped: the last counts and the rounding."""


@dataclass(frozen=True, slots=True, kw_only=True)
class KnownSensor:
    """What is known of a sensor before its recording is smoothed; sensor axes.

    Attributes
    ----------
    gyro_full_scale_rad_s
        Rates from here on are clipped; infinite where that is not known.
    lead_s
        Delay of the readings; None where that is not known.
    gyro_bias_rad_s, gyro_scale
        True rate is (1 + scale) times the reading less its bias.
    accel_offset_m_s2, accel_scale
        True force is (1 + scale) times the reading less its offset.
    """

    gyro_full_scale_rad_s: float = np.inf
    lead_s: float | None = None
    gyro_bias_rad_s: Triple = NONE
    gyro_scale: Triple = NONE
    accel_offset_m_s2: Triple = NONE
    accel_scale: Triple = NONE

    def delayed(self, lead_s: float) -> "KnownSensor":
        """Return the sensor with another lead."""
        return replace(self, lead_s=lead_s)

    def led(self, settings: SmootherSettings) -> SmootherSettings:
        """Return settings with the lead, where it is known."""
        return settings if self.lead_s is None else replace(settings, lead_s=self.lead_s)

    def rate_rad_s(self, reading: Array) -> Array:
        """Return angular rates, put right, of readings of shape ``(N, 3)``."""
        return np.asarray((1.0 + np.array(self.gyro_scale)) * (reading - self.gyro_bias_rad_s))

    def force_m_s2(self, reading: Array) -> Array:
        """Return specific forces, put right, of readings of shape ``(N, 3)``."""
        return np.asarray((1.0 + np.array(self.accel_scale)) * (reading - self.accel_offset_m_s2))


def known_sensor(design: FilterDesign) -> KnownSensor:
    """Return what a design says of its sensor; parameters that it does not have are zero."""
    values = {parameter.name: parameter.value for parameter in design.parameters}

    def triple(name: str, unit: str) -> Triple:
        x, y, z = (values.get(f"{name}_{axis}{unit}", 0.0) for axis in "xyz")
        return x, y, z

    return KnownSensor(
        gyro_full_scale_rad_s=AT_FULL_SCALE * design.sensor.gyro_full_scale_deg_s * RAD_PER_DEG,
        lead_s=values.get("lead_s"),
        gyro_bias_rad_s=triple("gyro_bias", "_rad_s"),
        gyro_scale=triple("gyro_scale", ""),
        accel_offset_m_s2=triple("accel_offset", "_m_s2"),
        accel_scale=triple("accel_scale", ""),
    )
