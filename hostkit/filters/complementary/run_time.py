"""The parameters that a running device can change: their limits, and what it tells of them.

The device takes and tells numbers of 32 bits, and keeps the integers that :func:`lower` makes of
them. What it tells of an integer is the nearest such number, kept within the limits; lowered again
it gives the same integer wherever the integer came from a number of 32 bits.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Final, Literal

import numpy as np

from hostkit.filters.complementary.lowering import bias_unit_rad_s, lower
from hostkit.filters.complementary.parameters import (
    BY_NAME,
    MEMORY_LIMIT_SAMPLES,
    ParameterName,
    eta_from_tau,
    parameter,
    settings,
)
from hostkit.filters.complementary.spec import ComplementarySpec
from hostkit.filters.filter import DeviceParameter, KnownParameter, ParameterView
from hostkit.records import AXES, Axis, FilterDesign, Parameter
from hostkit.units import RAD_PER_HALF_TURN_LSB

LEAST_TAU_SAMPLES = 2.0**-20
"""Shortest time constant, in samples: its blend is 1 already, and its eta is still above 0."""

BLEND_STEP_RELATIVE = 2.0**-16
"""One step of the weight that a device makes of FILT_TAU: it has 18 bits, 17 of them in use."""

RunTimeKind = Literal["tau", "gyro_bias", "tilt_offset"]
AXES_OF_DEVICE: Final = AXES["both"]


@dataclass(frozen=True, slots=True, kw_only=True)
class RunTimeParameter:
    """One parameter of the device, by the number that its place in RUN_TIME gives it.

    Attributes
    ----------
    kind, axis
        What it is; no axis where both have it in common.
    unit
        Unit of its value.
    """

    kind: RunTimeKind
    axis: Axis | None
    unit: str

    def of(self, design: FilterDesign) -> bool:
        """Return whether a design has it."""
        return self.axis is None or self.axis in AXES[design.axes]


RUN_TIME: Final[tuple[RunTimeParameter, ...]] = (
    RunTimeParameter(kind="tau", axis=None, unit="s"),
    *(RunTimeParameter(kind="gyro_bias", axis=axis, unit="rad/s") for axis in AXES_OF_DEVICE),
    *(RunTimeParameter(kind="tilt_offset", axis=axis, unit="rad") for axis in AXES_OF_DEVICE),
)
"""In the order of HK_FILTER_TAU and its followers."""


def limits(item: RunTimeParameter, period_s: float) -> tuple[float, float]:
    """Return the lowest and the highest value that a device takes, numbers of 32 bits."""
    if item.kind == "tau":
        lowest, highest = LEAST_TAU_SAMPLES * period_s, MEMORY_LIMIT_SAMPLES * period_s
        return _towards_zero(lowest), _towards_zero(highest * (1.0 - 2.0**-22))
    kind = BY_NAME[item.kind]
    return _towards_zero(kind.lowest), _towards_zero(kind.highest)


def told_by_device(design: FilterDesign) -> tuple[float, ...]:
    """Return what a device that nothing was set on tells, one value for each of RUN_TIME.

    Each is a number of 32 bits; 0 where the design lacks the axis.

    Raises
    ------
    HostkitError
        If the design cannot be lowered.
    """
    spec = lower(design)
    return tuple(_told(item, design, spec) for item in RUN_TIME)


def with_told(design: FilterDesign, values: tuple[float, ...]) -> FilterDesign:
    """Return the design that a device runs which tells these values.

    A value that the device tells of the design itself leaves the design's own, so that a device
    which nothing was set on runs the design to the last bit.

    Parameters
    ----------
    values
        One for each of RUN_TIME, in its unit.

    Raises
    ------
    DesignError
        If a value is outside the limits of a design.
    """
    own = told_by_device(design)
    named = {p.name: p for p in design.parameters}
    for item, value, mine in zip(RUN_TIME, values, own, strict=True):
        if value != mine and item.of(design):
            changed = _parameter(item, value, design.period_s)
            named[changed.name] = changed
    changed_design = replace(design, parameters=tuple(named[name] for name in sorted(named)))
    settings(changed_design)
    return changed_design


def _told(item: RunTimeParameter, design: FilterDesign, spec: ComplementarySpec) -> float:
    if not item.of(design):
        return 0.0
    lowest, highest = limits(item, design.period_s)
    return min(max(float(np.float32(_in_use(item, design, spec))), lowest), highest)


def _in_use(item: RunTimeParameter, design: FilterDesign, spec: ComplementarySpec) -> float:
    """Return the value of the integer in the spec."""
    if item.axis is None:
        blend = spec.blend.quantised
        return design.period_s * (1.0 - blend) / blend
    i = spec.axes.index(item.axis)
    if item.kind == "tilt_offset":
        return float(spec.tilt_offset_raw[i] * RAD_PER_HALF_TURN_LSB)
    return spec.gyro_bias_raw[i] * bias_unit_rad_s(design, spec.integral)


def _parameter(item: RunTimeParameter, value: float, period_s: float) -> Parameter:
    if item.kind == "tau":
        return parameter("eta", eta_from_tau(value, period_s))
    name: ParameterName = item.kind
    return parameter(name, value, item.axis)


def _towards_zero(value: float) -> float:
    """Return the nearest number of 32 bits that is not farther from zero."""
    near = np.float32(value)
    inside = near if abs(float(near)) <= abs(value) else np.nextafter(near, np.float32(0.0))
    return float(inside)


def link_name(item: RunTimeParameter) -> str:
    """Return the name that a parameter has on the link."""
    short = {"tau": "FILT_TAU", "gyro_bias": "GYRO_BIAS", "tilt_offset": "TILT_OFS"}[item.kind]
    return short if item.axis is None else f"{short}_{item.axis.upper()}"


def tau_views(period_s: float) -> tuple[ParameterView, ...]:
    """Return what says the same as a time constant: eta and the crossover frequency."""
    return (
        ParameterView(
            name="eta", symbol="\N{GREEK SMALL LETTER ETA}", unit="", terms=(1, 0, 1, period_s)
        ),
        ParameterView(name="crossover_hz", symbol="", unit="Hz", terms=(0, 1, 2 * math.pi, 0)),
    )


def known_parameters() -> tuple[KnownParameter, ...]:
    """Return what is known of the parameters without a design."""
    return tuple(_tau() if item.kind == "tau" else _known(item) for item in RUN_TIME)


def _tau() -> KnownParameter:
    item = RUN_TIME[0]
    return KnownParameter(
        name=link_name(item),
        unit=item.unit,
        symbol="\N{GREEK SMALL LETTER TAU}",
        title="time constant",
        views=tau_views,
        relative_step=BLEND_STEP_RELATIVE,
    )


def _known(item: RunTimeParameter) -> KnownParameter:
    lowest, highest = limits(item, 1.0)
    return KnownParameter(name=link_name(item), unit=item.unit, lowest=lowest, highest=highest)


def device_parameters(design: FilterDesign) -> tuple[DeviceParameter, ...]:
    """Return the parameters that a device of a design has.

    Raises
    ------
    HostkitError
        If the design cannot be lowered.
    """
    found = []
    for item, value in zip(RUN_TIME, told_by_device(design), strict=True):
        if item.of(design):
            lowest, highest = limits(item, design.period_s)
            found.append(
                DeviceParameter(
                    name=link_name(item),
                    unit=item.unit,
                    design_value=value,
                    lowest=lowest,
                    highest=highest,
                )
            )
    return tuple(found)


def with_told_by_name(design: FilterDesign, values: Mapping[str, float]) -> FilterDesign:
    """Return the design that a device runs which tells these values, by their names on the link.

    Raises
    ------
    DesignError
        If a value is outside the limits of a design.
    """
    own = told_by_device(design)
    return with_told(
        design,
        tuple(values.get(link_name(i), mine) for i, mine in zip(RUN_TIME, own, strict=True)),
    )
