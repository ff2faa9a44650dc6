"""The parameters of the bounded-velocity observer, and what a design says of them.

Specific force turned into the earth frame, less gravity, is acceleration, and a body that does not
fly away has a bounded velocity; so a horizontal velocity that builds up is an error of tilt. The
equations stand in :mod:`hostkit.filters.observer.float_model`. Three gains are always there; rest
detection, the alignment at the start, the lead and the calibration are neutral where a design does
not have their parameters. Axes x, y and z are those of the sensor.
"""

import math
from dataclasses import dataclass
from typing import Final, Literal

from hostkit.errors import DesignError
from hostkit.filters.sensor_terms import SENSOR_AXES, SensorAxis
from hostkit.records import FilterDesign, Parameter
from hostkit.units import DEG_PER_RAD, RAD_PER_DEG

BIAS_LIMIT_RAD_S: Final = 20.0 * RAD_PER_DEG
"""Largest gyroscope bias: the zero-rate output that the MPU-6050's data sheet allows."""

ParameterName = Literal[
    "kt",
    "kv",
    "kb",
    "start",
    "rest_rate",
    "rest_force",
    "rest_gain",
    "clip_rate",
    "lead",
    "gyro_bias",
    "gyro_scale",
    "accel_offset",
    "accel_scale",
]

SUFFIXES: Final = {
    "rad/m": "_rad_m",
    "1/s": "_per_s",
    "s": "_s",
    "rad/s": "_rad_s",
    "m/s^2": "_m_s2",
    "1": "",
}


@dataclass(frozen=True, slots=True, kw_only=True)
class ParameterKind:
    """One kind of parameter.

    Attributes
    ----------
    name, unit
        Name without axis and unit suffix, and the unit of the value in a design.
    lowest, highest
        Limits of a design, in `unit`.
    per_axis
        Whether each axis of the sensor has its own.
    neutral
        Value that leaves the filter as it is without the parameter; None where only leaving it
        out does, or where a design must have it.
    required
        Whether every design has it.
    default
        What suits an ordinary sensor; where tuning starts.
    shown_unit, shown_per_unit
        Unit on the screen and the factor to it.
    title
        What it is, for a person.
    """

    name: ParameterName
    unit: str
    lowest: float
    highest: float
    default: float
    title: str
    per_axis: bool = False
    neutral: float | None = None
    required: bool = False
    shown_unit: str
    shown_per_unit: float = 1.0

    def key(self, axis: SensorAxis | None = None) -> str:
        """Return the name of the parameter in a design, with its axis and its unit."""
        return f"{self.name}{f'_{axis}' if self.per_axis else ''}{SUFFIXES[self.unit]}"

    def names(self) -> tuple[str, ...]:
        """Return the names of all parameters of the kind."""
        return tuple(self.key(axis) for axis in SENSOR_AXES) if self.per_axis else (self.key(),)


KINDS: Final[tuple[ParameterKind, ...]] = (
    ParameterKind(
        name="kt",
        unit="rad/m",
        lowest=1e-4,
        highest=20.0,
        default=0.0177,
        required=True,
        shown_unit="rad/m",
        title="tilt gain: rate of correction per velocity",
    ),
    ParameterKind(
        name="kv",
        unit="1/s",
        lowest=1e-3,
        highest=100.0,
        default=0.375,
        required=True,
        shown_unit="1/s",
        title="decay of the velocity",
    ),
    ParameterKind(
        name="kb",
        unit="1/s",
        lowest=0.0,
        highest=0.3,
        default=0.011,
        required=True,
        shown_unit="1/s",
        title="bias gain",
    ),
    ParameterKind(
        name="start",
        unit="s",
        lowest=1e-3,
        highest=60.0,
        default=1.0,
        shown_unit="s",
        title="longest memory of the alignment at the start",
    ),
    ParameterKind(
        name="rest_rate",
        unit="rad/s",
        lowest=1e-4,
        highest=0.5,
        default=0.03,
        shown_unit="deg/s",
        shown_per_unit=DEG_PER_RAD,
        title="rest: largest deviation of the rate",
    ),
    ParameterKind(
        name="rest_force",
        unit="m/s^2",
        lowest=1e-3,
        highest=20.0,
        default=0.3,
        shown_unit="m/s^2",
        title="rest: largest deviation of the specific force",
    ),
    ParameterKind(
        name="rest_gain",
        unit="1/s",
        lowest=1e-3,
        highest=5.0,
        default=0.5,
        shown_unit="1/s",
        title="rest: gain of the bias",
    ),
    ParameterKind(
        name="clip_rate",
        unit="rad/s",
        lowest=0.1,
        highest=70.0,
        default=34.0,
        shown_unit="deg/s",
        shown_per_unit=DEG_PER_RAD,
        title="rate beyond which the gyroscope is clipped",
    ),
    ParameterKind(
        name="lead",
        unit="s",
        lowest=-0.05,
        highest=0.05,
        default=0.0,
        neutral=0.0,
        shown_unit="ms",
        shown_per_unit=1e3,
        title="how far the angles are told ahead",
    ),
    ParameterKind(
        name="gyro_bias",
        unit="rad/s",
        lowest=-BIAS_LIMIT_RAD_S,
        highest=BIAS_LIMIT_RAD_S,
        default=0.0,
        per_axis=True,
        neutral=0.0,
        shown_unit="deg/s",
        shown_per_unit=DEG_PER_RAD,
        title="bias of the gyroscope at the start",
    ),
    ParameterKind(
        name="gyro_scale",
        unit="1",
        lowest=-0.25,
        highest=0.25,
        default=0.0,
        per_axis=True,
        neutral=0.0,
        shown_unit="",
        title="what the rate lacks of the true one",
    ),
    ParameterKind(
        name="accel_offset",
        unit="m/s^2",
        lowest=-2.0,
        highest=2.0,
        default=0.0,
        per_axis=True,
        neutral=0.0,
        shown_unit="m/s^2",
        title="offset of the accelerometer",
    ),
    ParameterKind(
        name="accel_scale",
        unit="1",
        lowest=-0.1,
        highest=0.1,
        default=0.0,
        per_axis=True,
        neutral=0.0,
        shown_unit="",
        title="what the specific force lacks of the true one",
    ),
)

BY_NAME: Final[dict[str, ParameterKind]] = {kind.name: kind for kind in KINDS}


def parameter(name: ParameterName, value: float, axis: SensorAxis | None = None) -> Parameter:
    """Return one parameter of a design, in the unit of its kind."""
    kind = BY_NAME[name]
    return Parameter(name=kind.key(axis), value=value, unit=kind.unit)


def parameters(*chosen: Parameter) -> tuple[Parameter, ...]:
    """Return the parameters of a design, gains that are not `chosen` at their defaults, sorted."""
    names = {p.name for p in chosen}
    gains = [
        parameter(kind.name, kind.default)
        for kind in KINDS
        if kind.required and kind.key() not in names
    ]
    return tuple(sorted((*gains, *chosen), key=lambda p: p.name))


def default_parameters() -> tuple[Parameter, ...]:
    """Return what suits an ordinary sensor: gains, start and rest detection."""
    names: tuple[ParameterName, ...] = ("start", "rest_rate", "rest_force", "rest_gain")
    return parameters(*(parameter(name, BY_NAME[name].default) for name in names))


def checked_value(design: FilterDesign, kind: ParameterKind, key: str) -> float | None:
    """Return one parameter of a design, None where it does not have it.

    Raises
    ------
    DesignError
        If it is outside its limits.
    """
    found = [p.value for p in design.parameters if p.name == key]
    if not found:
        return None
    if not (math.isfinite(found[0]) and kind.lowest <= found[0] <= kind.highest):
        unit = "" if kind.unit == "1" else f" {kind.unit}"
        raise DesignError(
            f"{key} = {found[0]:g}{unit} is outside [{kind.lowest:g}, {kind.highest:g}]"
        )
    return found[0]
