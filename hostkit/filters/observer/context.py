"""What templates see of the observer: its constants, its parts, its parameters."""

from dataclasses import dataclass

from hostkit.filters.factor import FactorContext, factor
from hostkit.filters.observer.float_context import RealContext, real_constants
from hostkit.filters.observer.integer_angles import LEAD_LIMIT
from hostkit.filters.observer.integer_geometry import FIFTH, HALF_PER_G, SIXTH, TWENTY_FOURTH
from hostkit.filters.observer.integer_model import CLIP_GAIN, START_LIMIT
from hostkit.filters.observer.limits import FIRST_ROUNDS
from hostkit.filters.observer.parameters import BY_NAME
from hostkit.filters.observer.run_time import (
    RUN_TIME,
    RunTimeParameter,
    device_limits,
    per_unit,
    words,
)
from hostkit.filters.observer.spec import ObserverFormats, ObserverSpec
from hostkit.filters.sensor_terms import SENSOR_AXES
from hostkit.literals import float32_text
from hostkit.records import FilterDesign
from hostkit.sensors import SENSORS


@dataclass(frozen=True, slots=True, kw_only=True)
class ConstantContext:
    """An integer constant of the code: its name in small letters, its value and what it is."""

    name: str
    raw: int
    title: str


@dataclass(frozen=True, slots=True, kw_only=True)
class ParameterContext:
    """A parameter that can be changed while the filter runs.

    Attributes
    ----------
    name, link_name
        Name of its number in small letters, and its name on the link.
    raw, value
        Its integer in the design, and its value as C99 hexadecimal text.
    unit
        Unit of its value.
    lowest, highest
        What a device takes, C99 hexadecimal text; and the same as numbers.
    raw_per_unit, unit_per_raw
        Factors between the value and the integer.
    """

    name: str
    link_name: str
    raw: int
    value: str
    unit: str
    lowest: str
    highest: str
    shown_lowest: float
    shown_highest: float
    raw_per_unit: FactorContext
    unit_per_raw: FactorContext


@dataclass(frozen=True, slots=True, kw_only=True)
class ObserverContext:
    """The observer of a design.

    Attributes
    ----------
    constants
        All integers of the code that are not parameters.
    aligns, clips, rests, leads
        Which of its parts the design has; `aligns` also where only a clipped rate aligns.
    state_words
        How many hidden words there are.
    rad_s_per_count
        Weight of a count of rate, C99 hexadecimal text.
    real
        The constants of the code in floats.
    """

    formats: ObserverFormats
    constants: tuple[ConstantContext, ...]
    parameters: tuple[ParameterContext, ...]
    aligns: bool
    clips: bool
    rests: bool
    leads: bool
    state_words: int
    rad_s_per_count: str
    real: tuple[RealContext, ...]


def filter_context(design: FilterDesign, spec: ObserverSpec) -> ObserverContext:
    """Lay out what templates need of the filter."""
    weight = SENSORS[design.sensor.part].rad_s_per_count(design.sensor)
    return ObserverContext(
        formats=spec.formats,
        constants=_constants(spec),
        parameters=_parameters(design, spec),
        aligns=spec.start_gain > 0 or spec.clip_count is not None,
        clips=spec.clip_count is not None,
        rests=spec.rest is not None,
        leads=spec.lead_raw != 0,
        state_words=len(spec.hidden),
        rad_s_per_count=float32_text(weight),
        real=real_constants(design, spec),
    )


def _constants(spec: ObserverSpec) -> tuple[ConstantContext, ...]:
    formats = spec.formats
    axes = SENSOR_AXES
    force, bias = formats.force, formats.bias
    own = [
        *_triple("gyro_gain", spec.gyro_gain, axes, "half-angle per count, 47 fraction bits"),
        *_triple("accel_gain", spec.accel_gain, axes, f"m/s^2 per count, {force + 15}"),
        *_triple("accel_offset", spec.accel_offset, axes, f"m/s^2, {force}"),
        ("first_force_limit", spec.first_force_limit, f"m/s^2, {force}"),
        ("acceleration_limit", spec.acceleration_limit, f"m/s^2, {force - 2}"),
        ("correction_limit", spec.correction_limit, f"half-angle, {formats.correction}"),
        ("bias_limit", spec.bias_limit, f"half-angle per sample, {bias}"),
        ("half_per_g", HALF_PER_G, "1 / (2 g), s^2/m, 35"),
        ("sixth", SIXTH, "1/6, 32"),
        ("fifth", FIFTH, "1/5, 32"),
        ("twenty_fourth", TWENTY_FOURTH, "1/24, 32"),
        ("first_rounds", FIRST_ROUNDS, "renormalisations of the first orientation"),
        ("start_gain", spec.start_gain, "31"),
        ("start_end", spec.start_end, "31"),
        ("start_limit", START_LIMIT, "half-angle, 26"),
        ("clip_gain", CLIP_GAIN, "31"),
        ("clip_count", spec.clip_count or 0, "counts"),
        ("mean_shift", spec.mean_shift, "running means forget 2^-this at each sample"),
        ("mean_limit", spec.mean_limit, "counts, 14"),
        ("rest_samples", spec.rest_samples, "samples"),
        ("lead", spec.lead_raw, "lead per half-angle, 25"),
        ("lead_limit", LEAD_LIMIT, "rad, 25"),
        *_rest(spec),
    ]
    return tuple(ConstantContext(name=name, raw=raw, title=title) for name, raw, title in own)


def _rest(spec: ObserverSpec) -> list[tuple[str, int, str]]:
    rest, bits = spec.rest, spec.formats.bias - spec.formats.rest_shift
    return [
        ("rest_rate", 0 if rest is None else rest.rate_limit, "counts, 14"),
        ("rest_force", 0 if rest is None else rest.force_limit, "counts, 14"),
        ("rest_gain", 0 if rest is None else rest.gain_raw, f"{bits}"),
    ]


def _triple(
    name: str, raws: tuple[int, int, int], axes: tuple[str, ...], title: str
) -> list[tuple[str, int, str]]:
    return [(f"{name}_{axis}", raw, title) for axis, raw in zip(axes, raws, strict=True)]


def _value(design: FilterDesign, item: RunTimeParameter) -> float:
    key = BY_NAME[item.name].key(item.axis)
    return next((p.value for p in design.parameters if p.name == key), 0.0)


def _parameters(design: FilterDesign, spec: ObserverSpec) -> tuple[ParameterContext, ...]:
    found = []
    for item, raw, units in zip(RUN_TIME, words(spec), per_unit(design), strict=True):
        lowest, highest = device_limits(item, design)
        found.append(
            ParameterContext(
                name=f"bias_{item.axis}" if item.axis else item.name,
                link_name=item.link_name,
                raw=raw,
                value=float32_text(_value(design, item)),
                unit=item.unit,
                lowest=float32_text(lowest),
                highest=float32_text(highest),
                shown_lowest=lowest,
                shown_highest=highest,
                raw_per_unit=factor(units),
                unit_per_raw=factor(1.0 / units),
            )
        )
    return tuple(found)
