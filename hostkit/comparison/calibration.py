"""What peers get to read: a recording as it is, or put right as the design puts it right."""

from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from hostkit.errors import DesignError
from hostkit.recordings import Recording
from hostkit.records import FilterDesign, read_only
from hostkit.tuning.track import Track, track_of

Vector = NDArray[np.float64]

SENSOR_AXES: Final = ("x", "y", "z")
LEAST_LENGTH: Final = 1e-12


@dataclass(frozen=True, slots=True, kw_only=True)
class SensorCorrection:
    """Offset and scale of both elements, sensor axes: (1 + scale) * (reading - offset).

    Each has the shape ``(3,)``; offsets in rad/s and m/s^2.
    """

    gyro_bias_rad_s: Vector
    gyro_scale: Vector
    accel_offset_m_s2: Vector
    accel_scale: Vector

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        for array in (self.gyro_bias_rad_s, self.gyro_scale):
            read_only(array)
        read_only(self.accel_offset_m_s2)
        read_only(self.accel_scale)


def no_correction() -> SensorCorrection:
    """Return the correction that changes nothing."""
    return SensorCorrection(
        gyro_bias_rad_s=np.zeros(3),
        gyro_scale=np.zeros(3),
        accel_offset_m_s2=np.zeros(3),
        accel_scale=np.zeros(3),
    )


def correction_of(design: FilterDesign) -> SensorCorrection:
    """Return the calibration in a design, axis by axis of the sensor.

    Raises
    ------
    DesignError
        If it has none.
    """
    values = {p.name: p.value for p in design.parameters}

    def triple(name: str, suffix: str = "") -> Vector:
        return np.array([values.get(f"{name}_{axis}{suffix}", 0.0) for axis in SENSOR_AXES])

    found = SensorCorrection(
        gyro_bias_rad_s=triple("gyro_bias", "_rad_s"),
        gyro_scale=triple("gyro_scale"),
        accel_offset_m_s2=triple("accel_offset", "_m_s2"),
        accel_scale=triple("accel_scale"),
    )
    parts = (found.gyro_bias_rad_s, found.gyro_scale, found.accel_offset_m_s2, found.accel_scale)
    if not any(part.any() for part in parts):
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


def readings_of(recording: Recording, correction: SensorCorrection) -> Readings:
    """Lay out a recording.

    Raises
    ------
    RecordingError
        If it has no reference, or no sample of it can be scored.
    """
    track = track_of(recording)
    rate = (1.0 + correction.gyro_scale) * (track.rate_rad_s - correction.gyro_bias_rad_s)
    force = (1.0 + correction.accel_scale) * (track.force_m_s2 - correction.accel_offset_m_s2)
    return Readings(
        track=track,
        rate_rad_s=np.ascontiguousarray(rate),
        force_m_s2=np.ascontiguousarray(force),
        period_s=1.0 / recording.rate_hz,
    )
