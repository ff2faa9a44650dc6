"""From a design to integers: coefficients, bounds of the gate, the format of the bias."""

import math

from hostkit.errors import FormatError
from hostkit.filters.arctan import arctan_table
from hostkit.filters.arctan_bounds import arcsin_bound_rad, arctan_bound_rad
from hostkit.filters.complementary.bounds import (
    HALF_UNIT_RAD,
    SampleErrors,
    bound_with_integral_rad,
    bound_without_integral_rad,
)
from hostkit.filters.complementary.gate import force_gate
from hostkit.filters.complementary.parameters import BIAS_LIMIT_RAD_S, Settings, settings
from hostkit.filters.complementary.spec import BiasIntegral, ComplementarySpec
from hostkit.fixedpoint import Coefficient, coefficient, round_half_up
from hostkit.records import AXES, FilterDesign
from hostkit.sensors import SENSORS
from hostkit.spec import StateWord
from hostkit.units import RAD_PER_HALF_TURN_LSB

LEAST_FORCE_G = 0.125
"""Specific force, in the plane that a tilt is taken from, from which on its error bound holds."""

RAW_LIMIT = 2**31
"""First number that a word of the state cannot hold."""


def lower(design: FilterDesign) -> ComplementarySpec:
    """Turn a design into integers.

    The bound of the difference to the float model holds while every sample has LEAST_FORCE_G or
    more in the plane that its tilt is taken from, and no innovation comes as near to half a turn
    as the bound itself. Every sample that the gate shuts out adds `error_per_closed_sample_rad`.
    With an integral no such addition is known, and the bias must not have met its limit.

    Raises
    ------
    FormatError
        If a full-scale rate would turn by half a turn or more within one sample, or the integral
        gain is too large for the sample rate.
    DesignError
        If a parameter or the sensor configuration is not possible.
    """
    own = settings(design)
    gravity = SENSORS[design.sensor.part].gravity_count(design.sensor)
    gains = _rate_gains(design, own)
    blend = coefficient("blend", 1.0 - own.eta, "1")
    integral = _integral(design, own)
    fraction_bits = 0 if integral is None else integral.fraction_bits
    bias = tuple(math.ldexp(value, fraction_bits) for value in _bias_units(design, own))
    errors = _sample_errors(design, own, gains, gravity)
    return ComplementarySpec(
        filter=design.filter,
        axes=AXES[design.axes],
        tilt=design.tilt,
        mounting=design.mounting,
        rate_gains=gains,
        blend=blend,
        tilt_offset_raw=tuple(round_half_up(value) for value in _offset_units(own)),
        gyro_bias_raw=tuple(round_half_up(value) for value in bias),
        gate=None if own.gate_g is None else force_gate(own.gate_g, gravity),
        integral=integral,
        arctan=arctan_table(),
        gravity_count=gravity,
        hidden=() if integral is None else _bias_words(design, integral),
        error_bound_rad=_bound_rad(errors, blend, integral),
        error_per_closed_sample_rad=_per_closed_sample_rad(own, errors),
    )


def _rate_gains(design: FilterDesign, own: Settings) -> tuple[Coefficient, ...]:
    """Return the gain of each axis, its scale error put right."""
    weight = SENSORS[design.sensor.part].rad_s_per_count(design.sensor)
    return tuple(
        _rate_gain(design, axis, (1.0 + scale) * weight * design.period_s)
        for axis, scale in zip(AXES[design.axes], own.gyro_scale, strict=True)
    )


def _rate_gain(design: FilterDesign, axis: str, rad_per_count: float) -> Coefficient:
    real = rad_per_count / RAD_PER_HALF_TURN_LSB
    gain = coefficient(f"rate_gain_{axis}", real, "half turns / 2^31 per count")
    if gain.format.fraction_bits < 1:
        raise FormatError(
            f"rate_hz = {design.rate_hz:g} with gyro_full_scale_deg_s = "
            f"{design.sensor.gyro_full_scale_deg_s} turns up to "
            f"{math.degrees(rad_per_count * 32768):.4g} deg per sample; "
            "the limit is 180 deg: sample faster or narrow the range"
        )
    return gain


def _offset_units(own: Settings) -> tuple[float, ...]:
    return tuple(value / RAD_PER_HALF_TURN_LSB for value in own.tilt_offset_rad)


def _bias_units(design: FilterDesign, own: Settings) -> tuple[float, ...]:
    """Return the bias of each axis in half-turn units per sample."""
    unit = RAD_PER_HALF_TURN_LSB * design.rate_hz
    return tuple(value / unit for value in own.gyro_bias_rad_s)


def _integral(design: FilterDesign, own: Settings) -> BiasIntegral | None:
    """Return the integral with as many fraction bits of the bias as one word can hold.

    The word holds the limit, and beyond it the largest change of one sample, before the clamp, and
    the half unit that rounds the bias.
    """
    if own.integral_gain_per_s2 is None:
        return None
    gain = own.integral_gain_per_s2 * design.period_s**2
    limit = BIAS_LIMIT_RAD_S * design.period_s / RAD_PER_HALF_TURN_LSB
    largest = gain * RAW_LIMIT * (1.0 + 2.0**-16)
    fraction_bits = math.floor(math.log2((RAW_LIMIT - 1) / (limit + largest + 1.0)))
    if fraction_bits < 1:
        fits = own.integral_gain_per_s2 * ((RAW_LIMIT - 1) / 2.0 - limit - 1.0) / largest
        raise FormatError(
            f"integral_gain = {own.integral_gain_per_s2:g} 1/s^2 with rate_hz = "
            f"{design.rate_hz:g} changes the bias by up to {gain:.4g} half turns per sample and "
            f"sample; up to {math.floor(1e4 * fits) / 1e4:g} 1/s^2 fits: sample faster or lower it"
        )
    return BiasIntegral(
        gain=coefficient("integral_gain", math.ldexp(gain, fraction_bits), "1"),
        fraction_bits=fraction_bits,
        limit_raw=round_half_up(math.ldexp(limit, fraction_bits)),
    )


def bias_unit_rad_s(design: FilterDesign, integral: BiasIntegral | None) -> float:
    """Return the worth of one unit of a bias in the spec, rad/s."""
    fraction_bits = 0 if integral is None else integral.fraction_bits
    return math.ldexp(RAD_PER_HALF_TURN_LSB * design.rate_hz, -fraction_bits)


def _bias_words(design: FilterDesign, integral: BiasIntegral) -> tuple[StateWord, ...]:
    per_unit = bias_unit_rad_s(design, integral)
    return tuple(
        StateWord(name=f"gyro_bias_{axis}", unit="rad/s", per_unit=per_unit)
        for axis in AXES[design.axes]
    )


def _sample_errors(
    design: FilterDesign, own: Settings, gains: tuple[Coefficient, ...], gravity: int
) -> SampleErrors:
    offset = max(abs(value - round_half_up(value)) for value in _offset_units(own))
    bias = max(abs(value - round_half_up(value)) for value in _bias_units(design, own))
    if own.integral_gain_per_s2 is not None:
        bias = 0.5
    rate = max(abs(gain.quantised - gain.real) * 32768 for gain in gains)
    return SampleErrors(
        tilt_rad=_tilt_bound_rad(design, gravity) + offset * RAD_PER_HALF_TURN_LSB,
        step_rad=HALF_UNIT_RAD + (bias + rate) * RAD_PER_HALF_TURN_LSB,
    )


def _tilt_bound_rad(design: FilterDesign, gravity: int) -> float:
    if design.tilt == "arcsin":
        return arcsin_bound_rad(gravity)
    return arctan_bound_rad(gravity * LEAST_FORCE_G)


def _bound_rad(errors: SampleErrors, blend: Coefficient, integral: BiasIntegral | None) -> float:
    if integral is None:
        return bound_without_integral_rad(errors, blend)
    return bound_with_integral_rad(errors, blend, integral.gain, integral.fraction_bits)


def _per_closed_sample_rad(own: Settings, errors: SampleErrors) -> float:
    if own.gate_g is None:
        return 0.0
    return errors.step_rad if own.integral_gain_per_s2 is None else math.inf
