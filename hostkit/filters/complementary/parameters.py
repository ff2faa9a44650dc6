"""The parameters of the complementary filter: names, units, limits, and what a design says of them.

Per axis, with w the measured rate, m the tilt measured from specific force f, dt the period and b
the bias, the filter with all its parameters is::

    t = theta_(k-1) + ((1 + s) w_k - b_(k-1)) dt
    r = wrap(m_k - o - t)  if | |f_k| - 1 g | < gate, else 0
    theta_k = t + (1 - eta) r
    b_k = b_(k-1) - ki r dt,  kept within +-BIAS_LIMIT_RAD_S

It starts from theta_0 = m_0 - o and b_0 = `gyro_bias`. With s = o = b_0 = ki = 0 and no gate it is
the filter of Shi, He, Luo, He (2017), equation 4.
"""

import math
from dataclasses import dataclass
from typing import Final, Literal

from hostkit.errors import DesignError
from hostkit.records import AXES, Axis, FilterDesign, Parameter
from hostkit.units import DEG_PER_RAD, RAD_PER_DEG

MEMORY_LIMIT_SAMPLES = 1e6
"""Longest time constant in samples; beyond it the correction falls below one angle unit."""

BIAS_LIMIT_RAD_S: Final = 20.0 * RAD_PER_DEG
"""Largest gyroscope bias: the zero-rate output that the MPU-6050's data sheet allows."""

ParameterName = Literal["eta", "gyro_bias", "gyro_scale", "tilt_offset", "gate", "integral_gain"]


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
        Whether each axis of the design has its own.
    neutral
        Value that leaves the filter as it is without the parameter; None where only leaving it
        out does.
    shown_unit, shown_per_unit
        Unit on the screen and the factor to it.
    """

    name: ParameterName
    unit: str
    lowest: float
    highest: float
    per_axis: bool
    neutral: float | None
    shown_unit: str
    shown_per_unit: float = 1.0

    def key(self, axis: Axis | None) -> str:
        """Return the name of the parameter in a design, with its axis and its unit."""
        suffix = {"rad/s": "_rad_s", "rad": "_rad", "g": "_g", "1/s^2": "_per_s2"}.get(
            self.unit, ""
        )
        return f"{self.name}{f'_{axis}' if self.per_axis else ''}{suffix}"


KINDS: Final[tuple[ParameterKind, ...]] = (
    ParameterKind(
        name="eta",
        unit="1",
        lowest=0.0,
        highest=1.0,
        per_axis=False,
        neutral=None,
        shown_unit="",
    ),
    ParameterKind(
        name="gyro_bias",
        unit="rad/s",
        lowest=-BIAS_LIMIT_RAD_S,
        highest=BIAS_LIMIT_RAD_S,
        per_axis=True,
        neutral=0.0,
        shown_unit="deg/s",
        shown_per_unit=DEG_PER_RAD,
    ),
    ParameterKind(
        name="gyro_scale",
        unit="1",
        lowest=-0.25,
        highest=0.25,
        per_axis=True,
        neutral=0.0,
        shown_unit="",
    ),
    ParameterKind(
        name="tilt_offset",
        unit="rad",
        lowest=-30.0 * RAD_PER_DEG,
        highest=30.0 * RAD_PER_DEG,
        per_axis=True,
        neutral=0.0,
        shown_unit="deg",
        shown_per_unit=DEG_PER_RAD,
    ),
    ParameterKind(
        name="gate",
        unit="g",
        lowest=0.001,
        highest=1.0,
        per_axis=False,
        neutral=None,
        shown_unit="g",
    ),
    ParameterKind(
        name="integral_gain",
        unit="1/s^2",
        lowest=1e-6,
        highest=10.0,
        per_axis=False,
        neutral=None,
        shown_unit="1/s^2",
    ),
)

BY_NAME: Final[dict[str, ParameterKind]] = {kind.name: kind for kind in KINDS}


@dataclass(frozen=True, slots=True, kw_only=True)
class Settings:
    """The parameters of a design, ready for the models.

    Attributes
    ----------
    eta
        Weight of the integrated rate.
    gyro_bias_rad_s, gyro_scale, tilt_offset_rad
        One for each axis of the design, in its order.
    gate_g
        Largest difference of the specific force to 1 g that still corrects; None for no gate.
    integral_gain_per_s2
        ki; None where the bias is constant.
    """

    eta: float
    gyro_bias_rad_s: tuple[float, ...]
    gyro_scale: tuple[float, ...]
    tilt_offset_rad: tuple[float, ...]
    gate_g: float | None = None
    integral_gain_per_s2: float | None = None


def settings(design: FilterDesign) -> Settings:
    """Return the parameters of a design, checked.

    Raises
    ------
    DesignError
        If one is outside its limits, eta is missing or its time constant is longer than a million
        samples, or the design has a parameter that this filter does not.
    """
    axes = AXES[design.axes]
    _refuse_strangers(design, axes)
    eta = design.parameter("eta")
    if not 0.0 < eta < 1.0:
        raise DesignError(f"eta = {eta} is outside the open interval (0, 1)")
    if eta / (1.0 - eta) > MEMORY_LIMIT_SAMPLES:
        raise DesignError(
            f"eta = {eta} is a time constant of {eta / (1.0 - eta):.3g} samples; "
            f"the limit is {MEMORY_LIMIT_SAMPLES:.0e}"
        )
    return Settings(
        eta=eta,
        gyro_bias_rad_s=tuple(_neutral_or(design, "gyro_bias", axis) for axis in axes),
        gyro_scale=tuple(_neutral_or(design, "gyro_scale", axis) for axis in axes),
        tilt_offset_rad=tuple(_neutral_or(design, "tilt_offset", axis) for axis in axes),
        gate_g=_value(design, BY_NAME["gate"], None),
        integral_gain_per_s2=_value(design, BY_NAME["integral_gain"], None),
    )


def parameter(name: ParameterName, value: float, axis: Axis | None = None) -> Parameter:
    """Return one parameter of a design, in the unit of its kind."""
    kind = BY_NAME[name]
    return Parameter(name=kind.key(axis), value=value, unit=kind.unit)


def parameters(eta: float, *others: Parameter) -> tuple[Parameter, ...]:
    """Return the parameters of a design of this filter, sorted by name as in a design file."""
    return tuple(sorted((parameter("eta", eta), *others), key=lambda p: p.name))


def _keys(kind: ParameterKind, axes: tuple[Axis, ...]) -> tuple[str, ...]:
    return tuple(kind.key(axis) for axis in axes) if kind.per_axis else (kind.key(None),)


def _refuse_strangers(design: FilterDesign, axes: tuple[Axis, ...]) -> None:
    known = tuple(key for kind in KINDS for key in _keys(kind, axes))
    for parameter in design.parameters:
        if parameter.name not in known:
            raise DesignError(_stranger(parameter.name, known))


def _stranger(name: str, known: tuple[str, ...]) -> str:
    return f"the complementary filter has no parameter {name!r}; it has: {', '.join(known)}"


def _value(design: FilterDesign, kind: ParameterKind, axis: Axis | None) -> float | None:
    key = kind.key(axis)
    found = [p.value for p in design.parameters if p.name == key]
    if not found:
        return None
    if not (math.isfinite(found[0]) and kind.lowest <= found[0] <= kind.highest):
        unit = "" if kind.unit == "1" else f" {kind.unit}"
        raise DesignError(
            f"{key} = {found[0]:g}{unit} is outside [{kind.lowest:g}, {kind.highest:g}]"
        )
    return found[0]


def _neutral_or(design: FilterDesign, name: ParameterName, axis: Axis) -> float:
    value = _value(design, BY_NAME[name], axis)
    return 0.0 if value is None else value


def eta_from_tau(tau_s: float, period_s: float) -> float:
    """Return the weight of the integrated rate, ``tau / (tau + dt)`` (equation 5)."""
    return tau_s / (tau_s + period_s)


def tau_from_eta(eta: float, period_s: float) -> float:
    """Return the time constant, ``eta dt / (1 - eta)`` (equation 5)."""
    return eta * period_s / (1.0 - eta)


def crossover_hz(eta: float, period_s: float) -> float:
    """Return the frequency at which rate and force weigh the same, ``1 / (2 pi tau)``."""
    return 1.0 / (2.0 * math.pi * tau_from_eta(eta, period_s))
