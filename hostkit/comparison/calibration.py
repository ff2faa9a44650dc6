"""What peers get to read: a recording as it is, or put right as the design puts it right."""

from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from hostkit.errors import DesignError
from hostkit.filters.sensor_terms import SensorCorrection, sensor_correction
from hostkit.recordings import Recording
from hostkit.records import FilterDesign, read_only
from hostkit.tuning.track import Track, track_of

Vector = NDArray[np.float64]

LEAST_LENGTH: Final = 1e-12

AS_READ: Final = SensorCorrection()
"""The correction that changes nothing."""


def correction_of(design: FilterDesign) -> SensorCorrection:
    """Return the calibration in a design, axis by axis of the sensor.

    Raises
    ------
    DesignError
        If it has none.
    """
    found = sensor_correction(design)
    if found == AS_READ:
        raise DesignError(
            f"the design of the {design.filter} filter has no calibration of the sensor's axes "
            "that peers could be given: gyro_bias, gyro_scale, accel_offset, accel_scale"
        )
    return found


@dataclass(frozen=True, slots=True, kw_only=True)
class Readings:
    """A recording as a peer reads it.

    Attributes
    ----------
    track
        Reference and scored samples.
    rate_rad_s, force_m_s2
        What the peer is given, sensor axes, shape ``(N, 3)`` each.
    """

    track: Track
    rate_rad_s: Vector
    force_m_s2: Vector
    period_s: float

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        read_only(self.rate_rad_s)
        read_only(self.force_m_s2)

    def scaled(self, gyro_scale: Vector) -> "Readings":
        """Return the same with each axis of the gyroscope times 1 + scale, shape ``(3,)``."""
        return replace(self, rate_rad_s=(1.0 + gyro_scale) * self.rate_rad_s)

    def led(self, up: Vector, lead_s: float) -> Vector:
        """Return directions of up told ahead, of unit length: up - lead w x up."""
        if lead_s == 0.0:
            return up
        ahead = up - lead_s * np.cross(self.rate_rad_s, up)
        length = np.linalg.norm(ahead, axis=1, keepdims=True)
        return np.asarray(ahead / np.maximum(length, LEAST_LENGTH))


def readings_of(recording: Recording, correction: SensorCorrection = AS_READ) -> Readings:
    """Lay out a recording.

    Raises
    ------
    RecordingError
        If it has no reference, or no sample of it can be scored.
    """
    track = track_of(recording)
    return Readings(
        track=track,
        rate_rad_s=np.ascontiguousarray(correction.rate_rad_s(track.rate_rad_s)),
        force_m_s2=np.ascontiguousarray(correction.force_m_s2(track.force_m_s2)),
        period_s=1.0 / recording.rate_hz,
    )
