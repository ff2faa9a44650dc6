"""The settings that the registers of an FPGA can change, as words and in SI units."""

import math

from hostkit.filters.complementary.lowering import bias_unit_rad_s
from hostkit.filters.complementary.spec import ComplementarySpec
from hostkit.filters.filter import SettingWord
from hostkit.fixedpoint import COEFFICIENT_BITS
from hostkit.records import AXES, Axis, FilterDesign
from hostkit.units import RAD_PER_HALF_TURN_LSB, STANDARD_GRAVITY_M_S2

WORD_BITS = 32


def setting_words(design: FilterDesign, spec: ComplementarySpec) -> tuple[SettingWord, ...]:
    """Return the settings in the order of ``hk_settings_t``.

    The value of `blend` is eta, the weight of the integrated rate.
    """
    return (
        _blend(spec),
        *(_rate_gain(design, spec, axis) for axis in AXES["both"]),
        _integral_gain(design, spec),
        *(_tilt_offset(spec, axis) for axis in AXES["both"]),
        *(_gyro_bias(design, spec, axis) for axis in AXES["both"]),
        _gate(spec, "gate_lowest", "sum of squared counts from which on the force corrects"),
        _gate(spec, "gate_highest", "and up to which the force corrects"),
    )


def _linear(
    name: str,
    title: str,
    raw: int | None,
    unit: str,
    per_raw: float,
    *,
    width: int = COEFFICIENT_BITS,
) -> SettingWord:
    return SettingWord(
        name=name,
        title=title,
        raw=raw,
        width=width,
        signed=True,
        unit=unit,
        to_raw=lambda value: value / per_raw,
        to_value=lambda word: word * per_raw,
    )


def _blend(spec: ComplementarySpec) -> SettingWord:
    per_raw = math.ldexp(1.0, -spec.blend.format.fraction_bits)
    return SettingWord(
        name="blend",
        title="weight of the measured tilt",
        raw=spec.blend.raw,
        width=COEFFICIENT_BITS,
        signed=True,
        unit="1",
        to_raw=lambda eta: (1.0 - eta) / per_raw,
        to_value=lambda word: 1.0 - word * per_raw,
    )


def _rate_gain(design: FilterDesign, spec: ComplementarySpec, axis: Axis) -> SettingWord:
    gain = spec.rate_gains[spec.axes.index(axis)] if axis in spec.axes else None
    bits = 0 if gain is None else gain.format.fraction_bits
    return _linear(
        f"rate_gain_{axis}",
        "half turns / 2**31 per count",
        None if gain is None else gain.raw,
        "rad/s per count",
        math.ldexp(RAD_PER_HALF_TURN_LSB * design.rate_hz, -bits),
    )


def _integral_gain(design: FilterDesign, spec: ComplementarySpec) -> SettingWord:
    own = spec.integral
    bits = 0 if own is None else own.gain.format.fraction_bits + own.fraction_bits
    return _linear(
        "integral_gain",
        "units of bias per half turn / 2**31 of innovation",
        None if own is None else own.gain.raw,
        "1/s^2",
        math.ldexp(design.rate_hz**2, -bits),
    )


def _tilt_offset(spec: ComplementarySpec, axis: Axis) -> SettingWord:
    return _linear(
        f"tilt_offset_{axis}",
        "half turns / 2**31",
        _of_axis(spec, spec.tilt_offset_raw, axis),
        "rad",
        RAD_PER_HALF_TURN_LSB,
        width=WORD_BITS,
    )


def _gyro_bias(design: FilterDesign, spec: ComplementarySpec, axis: Axis) -> SettingWord:
    return _linear(
        f"gyro_bias_{axis}",
        "half turns / 2**31 per sample",
        _of_axis(spec, spec.gyro_bias_raw, axis),
        "rad/s",
        bias_unit_rad_s(design, spec.integral),
        width=WORD_BITS,
    )


def _of_axis(spec: ComplementarySpec, words: tuple[int, ...], axis: Axis) -> int | None:
    return words[spec.axes.index(axis)] if axis in spec.axes else None


def _gate(spec: ComplementarySpec, name: str, title: str) -> SettingWord:
    per_count = STANDARD_GRAVITY_M_S2 / spec.gravity_count
    raw = None
    if spec.gate is not None:
        raw = spec.gate.lowest if name == "gate_lowest" else spec.gate.highest
    return SettingWord(
        name=name,
        title=title,
        raw=raw,
        width=WORD_BITS,
        signed=False,
        unit="m/s^2",
        to_raw=lambda value: value / per_count * abs(value / per_count),
        to_value=lambda word: math.sqrt(word) * per_count,
    )
