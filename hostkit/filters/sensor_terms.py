"""Calibration of a sensor in its own axes: as parameters of a filter, and put to readings."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Final, Literal

import numpy as np
from numpy.typing import NDArray

from hostkit.provenance import TERM_UNITS, CalibrationTerm
from hostkit.records import FilterDesign, Parameter

Vector = NDArray[np.float64]
Triple = tuple[float, float, float]
SensorAxis = Literal["x", "y", "z"]
SENSOR_AXES: Final[tuple[SensorAxis, ...]] = ("x", "y", "z")
NONE: Final[Triple] = (0.0, 0.0, 0.0)

SENSOR_KEYS: Final[Mapping[str, str]] = {
    f"{kind}_{axis}": f"{kind}_{axis}{suffix}"
    for kind, suffix in (
        ("gyro_bias", "_rad_s"),
        ("gyro_scale", ""),
        ("accel_offset", "_m_s2"),
        ("accel_scale", ""),
    )
    for axis in SENSOR_AXES
}
"""Parameters of a filter that corrects the sensor in its own axes, by the name of the term."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SensorCorrection:
    """What is put right on readings, sensor axes: (1 + scale) * (reading - offset)."""

    gyro_bias_rad_s: Triple = NONE
    gyro_scale: Triple = NONE
    accel_offset_m_s2: Triple = NONE
    accel_scale: Triple = NONE

    def rate_rad_s(self, reading: Vector) -> Vector:
        """Return angular rates, put right, of readings of shape ``(N, 3)``."""
        return np.asarray((1.0 + np.array(self.gyro_scale)) * (reading - self.gyro_bias_rad_s))

    def force_m_s2(self, reading: Vector) -> Vector:
        """Return specific forces, put right, of readings of shape ``(N, 3)``."""
        return np.asarray((1.0 + np.array(self.accel_scale)) * (reading - self.accel_offset_m_s2))


def sensor_correction(design: FilterDesign) -> SensorCorrection:
    """Return what a design puts right on readings; parameters that it does not have are zero."""
    values = {parameter.name: parameter.value for parameter in design.parameters}

    def triple(kind: str) -> Triple:
        x, y, z = (values.get(SENSOR_KEYS[f"{kind}_{axis}"], 0.0) for axis in SENSOR_AXES)
        return x, y, z

    return SensorCorrection(
        gyro_bias_rad_s=triple("gyro_bias"),
        gyro_scale=triple("gyro_scale"),
        accel_offset_m_s2=triple("accel_offset"),
        accel_scale=triple("accel_scale"),
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class Calibrated:
    """A design that took a calibration.

    Attributes
    ----------
    design
        The design, its parameters replaced.
    taken
        Names of the terms that it has a place for.
    """

    design: FilterDesign
    taken: tuple[str, ...]


def with_parameters(design: FilterDesign, new: tuple[Parameter, ...]) -> FilterDesign:
    """Return a design with some parameters added or replaced, sorted by name."""
    names = {parameter.name for parameter in new}
    kept = tuple(p for p in design.parameters if p.name not in names)
    return replace(design, parameters=tuple(sorted((*kept, *new), key=lambda p: p.name)))


def take_no_terms(design: FilterDesign, terms: tuple[CalibrationTerm, ...]) -> Calibrated:
    """Return the design as it is: its filter has no place for a calibration."""
    return Calibrated(design=design, taken=())


def take_sensor_terms(design: FilterDesign, terms: tuple[CalibrationTerm, ...]) -> Calibrated:
    """Return the design of a filter that corrects each axis of the sensor with the terms."""
    new = tuple(
        Parameter(name=SENSOR_KEYS[term.name], value=term.value, unit=TERM_UNITS[term.kind])
        for term in terms
    )
    return Calibrated(design=with_parameters(design, new), taken=tuple(term.name for term in terms))
