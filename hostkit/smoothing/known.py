"""What a design says of the sensor: ranges, calibration and lead."""

from dataclasses import dataclass, field, replace

import numpy as np

from hostkit.filters.sensor_terms import SensorCorrection, sensor_correction
from hostkit.records import FilterDesign
from hostkit.smoothing.settings import SmootherSettings
from hostkit.units import RAD_PER_DEG

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
    correction
        What is put right on the readings.
    """

    gyro_full_scale_rad_s: float = np.inf
    lead_s: float | None = None
    correction: SensorCorrection = field(default_factory=SensorCorrection)

    def delayed(self, lead_s: float) -> "KnownSensor":
        """Return the sensor with another lead."""
        return replace(self, lead_s=lead_s)

    def led(self, settings: SmootherSettings) -> SmootherSettings:
        """Return settings with the lead, where it is known."""
        return settings if self.lead_s is None else replace(settings, lead_s=self.lead_s)


def known_sensor(design: FilterDesign) -> KnownSensor:
    """Return what a design says of its sensor; parameters that it does not have are zero."""
    return KnownSensor(
        gyro_full_scale_rad_s=AT_FULL_SCALE * design.sensor.gyro_full_scale_deg_s * RAD_PER_DEG,
        lead_s=next((p.value for p in design.parameters if p.name == "lead_s"), None),
        correction=sensor_correction(design),
    )
