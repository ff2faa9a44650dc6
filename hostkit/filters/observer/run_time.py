"""The parameters that a running device can change: their limits, and what it tells of them.

The device takes and tells numbers of 32 bits, and keeps the integers that :func:`lower` makes of
them. What it tells of an integer is the nearest such number, kept within the limits.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from hostkit.filters.factor import factor, float_of
from hostkit.filters.filter import DeviceParameter, KnownParameter
from hostkit.filters.observer.lowering import (
    bias_turn,
    formats_of,
    gain_bits,
    gains_per_unit,
    lower,
)
from hostkit.filters.observer.parameters import (
    BY_NAME,
    ParameterName,
    parameter,
)
from hostkit.filters.observer.settings import DECAY_LIMIT, settings
from hostkit.filters.observer.spec import ObserverSpec
from hostkit.filters.sensor_terms import SENSOR_AXES, SensorAxis
from hostkit.records import FilterDesign

ROOM = 1.0 - 2.0**-22
"""What a highest value keeps below the end of its word: rounded to 32 bits it stays there."""


@dataclass(frozen=True, slots=True, kw_only=True)
class RunTimeParameter:
    """One parameter of the device, by the number that its place in RUN_TIME gives it.

    Attributes
    ----------
    name, axis
        Its kind, and its axis if it has one.
    link_name
        Its name on the link.
    """

    name: ParameterName
    axis: SensorAxis | None
    link_name: str

    @property
    def unit(self) -> str:
        """Unit of its value."""
        return BY_NAME[self.name].unit


RUN_TIME: Final[tuple[RunTimeParameter, ...]] = (
    RunTimeParameter(name="kt", axis=None, link_name="FILT_KT"),
    RunTimeParameter(name="kv", axis=None, link_name="FILT_KV"),
    RunTimeParameter(name="kb", axis=None, link_name="FILT_KB"),
    *(
        RunTimeParameter(name="gyro_bias", axis=axis, link_name=f"GYRO_BIAS_{axis.upper()}")
        for axis in SENSOR_AXES
    ),
)
"""In the order of HK_FILTER_KT and its followers."""


def words(spec: ObserverSpec) -> tuple[int, ...]:
    """Return the integer of each of RUN_TIME."""
    gains = spec.gains
    return gains.kt_raw, gains.kv_raw, gains.kb_raw, *gains.bias_raw


def per_unit(design: FilterDesign) -> tuple[float, ...]:
    """Return how many units of its integer one unit of each of RUN_TIME is."""
    formats, period_s = formats_of(design), design.period_s
    gains = zip(gains_per_unit(period_s), gain_bits(formats), strict=True)
    scales = settings(design).calibration.gyro_scale
    return (
        *(float(np.ldexp(gain, bits)) for gain, bits in gains),
        *(float(np.ldexp(bias_turn(scale, period_s), formats.bias)) for scale in scales),
    )


def device_limits(item: RunTimeParameter, design: FilterDesign) -> tuple[float, float]:
    """Return the lowest and the highest value that a device takes, numbers of 32 bits."""
    kind = BY_NAME[item.name]
    highest = kind.highest
    if item.axis is None:
        fits = ROOM * 2.0**31 / per_unit(design)[RUN_TIME.index(item)]
        highest = min(highest, fits)
    else:
        scale = settings(design).calibration.gyro_scale[SENSOR_AXES.index(item.axis)]
        highest = min(highest, highest / (1.0 + scale))
        return _inwards(-highest, 0.0), _inwards(highest, 0.0)
    if item.name == "kv":
        highest = min(highest, ROOM * DECAY_LIMIT / design.period_s)
    return _inwards(kind.lowest, kind.highest), _inwards(highest, kind.lowest)


def told_by_device(design: FilterDesign) -> tuple[float, ...]:
    """Return what a device that nothing was set on tells, one value for each of RUN_TIME.

    Raises
    ------
    HostkitError
        If the design cannot be lowered.
    """
    found = []
    for item, word, unit in zip(RUN_TIME, words(lower(design)), per_unit(design), strict=True):
        lowest, highest = device_limits(item, design)
        found.append(min(max(float_of(word, factor(1.0 / unit)), lowest), highest))
    return tuple(found)


def known_parameters() -> tuple[KnownParameter, ...]:
    """Return what is known of the parameters without a design."""
    return tuple(
        KnownParameter(
            name=item.link_name,
            unit=item.unit,
            lowest=_inwards(BY_NAME[item.name].lowest, BY_NAME[item.name].highest),
            highest=None if item.axis is None else _inwards(BY_NAME[item.name].highest, 0.0),
        )
        for item in RUN_TIME
    )


def device_parameters(design: FilterDesign) -> tuple[DeviceParameter, ...]:
    """Return the parameters that a device of a design has.

    Raises
    ------
    HostkitError
        If the design cannot be lowered.
    """
    return tuple(
        DeviceParameter(
            name=item.link_name,
            unit=item.unit,
            design_value=value,
            lowest=device_limits(item, design)[0],
            highest=device_limits(item, design)[1],
        )
        for item, value in zip(RUN_TIME, told_by_device(design), strict=True)
    )


def with_told(design: FilterDesign, values: Mapping[str, float]) -> FilterDesign:
    """Return the design that a device runs which tells these values, by their names on the link.

    A value that the device tells of the design itself leaves the design's own, so that a device
    which nothing was set on runs the design to the last bit.

    Raises
    ------
    DesignError
        If a value is outside the limits of a design.
    """
    named = {p.name: p for p in design.parameters}
    for item, mine in zip(RUN_TIME, told_by_device(design), strict=True):
        value = values.get(item.link_name, mine)
        if value != mine:
            changed = parameter(item.name, value, item.axis)
            named[changed.name] = changed
    changed_design = replace(design, parameters=tuple(named[name] for name in sorted(named)))
    settings(changed_design)
    return changed_design


def _inwards(value: float, inside: float) -> float:
    """Return the nearest number of 32 bits that is not on the far side of a limit."""
    near = np.float32(value)
    outside = float(near) > value if inside < value else float(near) < value
    return float(np.nextafter(near, np.float32(inside))) if outside else float(near)
