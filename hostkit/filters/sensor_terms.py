"""How the terms of a calibration become parameters of a filter."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Final

from hostkit.provenance import TERM_UNITS, CalibrationTerm
from hostkit.records import FilterDesign, Parameter

SENSOR_KEYS: Final[Mapping[str, str]] = {
    f"{kind}_{axis}": f"{kind}_{axis}{suffix}"
    for kind, suffix in (
        ("gyro_bias", "_rad_s"),
        ("gyro_scale", ""),
        ("accel_offset", "_m_s2"),
        ("accel_scale", ""),
    )
    for axis in "xyz"
}
"""Parameters of a filter that corrects the sensor in its own axes, by the name of the term."""


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
