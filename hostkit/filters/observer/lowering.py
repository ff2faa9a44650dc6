"""From a design of the observer to integers.

Formats are chosen from the sample rate and the ranges of the sensor, so that no sum of the integer
model can leave its word of 32 bits, whatever the counts. What bounds them:

- a rotated force is at most sqrt(3) full scales, the horizontal acceleration is clamped;
- a velocity is clamped at CORRECTION_LIMIT_RAD_S of correction, which leaves it 30 bits and the sum
  before the clamp 31;
- a bias is clamped at BIAS_LIMIT_RAD_S in 30.5 bits, and one sample adds at most 29 bits to it;
- the quaternion is renormalised in each sample, from a square of 0.98 to 1.29, so that no part of
  it reaches 31 bits.
"""

import math

from hostkit.errors import DesignError, FormatError
from hostkit.filters.arctan import arctan_table
from hostkit.filters.observer.limits import (
    ACCELERATION_LIMIT_M_S2,
    FIRST_FORCE_G,
    REST_RATE_LIMIT_RAD_S,
    START_GAIN,
    STEP_LIMIT_RAD,
    correction_limit_rad,
    mean_shift,
    rest_samples,
    start_end,
)
from hostkit.filters.observer.parameters import BIAS_LIMIT_RAD_S, BY_NAME
from hostkit.filters.observer.settings import Settings, settings
from hostkit.filters.observer.spec import (
    ObserverFormats,
    ObserverGains,
    ObserverRest,
    ObserverSpec,
    Triple,
)
from hostkit.filters.observer.state_words import state_words
from hostkit.filters.sensor_terms import SENSOR_AXES
from hostkit.fixedpoint import round_half_up
from hostkit.records import AXES, FilterDesign
from hostkit.sensors import SENSORS
from hostkit.units import STANDARD_GRAVITY_M_S2

WORD_MAX = 2**31 - 1
COUNT_MAX = 2**15 - 1
BIAS_BITS = 30.5
ERROR_BOUND_RAD = math.radians(0.01)
"""Largest difference to the float model on recordings, measured; see the tests."""


def lower(design: FilterDesign) -> ObserverSpec:
    """Turn a design into integers.

    Raises
    ------
    FormatError
        If a full-scale rate would turn too far within one sample, or a gain is too large for the
        sample rate.
    DesignError
        If a parameter or the sensor configuration is not possible.
    """
    own, period_s = settings(design), design.period_s
    part = SENSORS[design.sensor.part]
    rad_s, m_s2 = part.rad_s_per_count(design.sensor), part.m_s2_per_count(design.sensor)
    formats = _formats(design.period_s, 32768 * m_s2)
    _check_step(design, own, 32768 * rad_s)
    gyro = tuple((1.0 + s) * 0.5 * rad_s * period_s for s in own.calibration.gyro_scale)
    accel = tuple((1.0 + s) * m_s2 for s in own.calibration.accel_scale)
    offsets = zip(own.calibration.accel_scale, own.calibration.accel_offset_m_s2, strict=True)
    aligns = start_end(own.start_s, period_s) < START_GAIN
    return ObserverSpec(
        filter=design.filter,
        axes=AXES[design.axes],
        mounting=design.mounting,
        arctan=arctan_table(),
        gravity_count=part.gravity_count(design.sensor),
        hidden=state_words(formats, own.kt_rad_m, period_s, rad_s, m_s2),
        error_bound_rad=ERROR_BOUND_RAD,
        error_per_closed_sample_rad=0.0,
        formats=formats,
        gains=_gains(design, own, formats),
        gyro_gain=_triple(gyro, 47),
        accel_gain=_triple(accel, formats.force + 15),
        accel_offset=_triple(tuple((1.0 + s) * o for s, o in offsets), formats.force),
        acceleration_limit=_fixed(ACCELERATION_LIMIT_M_S2, formats.force - 2),
        first_force_limit=_fixed(FIRST_FORCE_G * STANDARD_GRAVITY_M_S2, formats.force),
        correction_limit=_fixed(0.5 * correction_limit_rad(period_s), formats.correction),
        bias_limit=_fixed(0.5 * BIAS_LIMIT_RAD_S * period_s, formats.bias),
        mean_limit=min(_fixed(REST_RATE_LIMIT_RAD_S / rad_s, 14), WORD_MAX),
        mean_shift=mean_shift(period_s),
        rest_samples=rest_samples(period_s),
        start_gain=_fixed(START_GAIN, 31) if aligns else 0,
        start_end=min(_fixed(start_end(own.start_s, period_s), 31), WORD_MAX),
        rest=_rest(design, own, formats),
        clip_count=_clip_count(own, rad_s),
        lead_raw=_gain(design, "lead", 2.0 * own.lead_s / period_s, 25, 31),
    )


def formats_of(design: FilterDesign) -> ObserverFormats:
    """Return the formats of a design, which need no parameter of it."""
    m_s2 = SENSORS[design.sensor.part].m_s2_per_count(design.sensor)
    return _formats(design.period_s, 32768 * m_s2)


def _formats(period_s: float, full_scale_m_s2: float) -> ObserverFormats:
    scale = BY_NAME["accel_scale"].highest
    largest = (1.0 + scale) * (full_scale_m_s2 + BY_NAME["accel_offset"].highest)
    correction = math.floor(30.0 - math.log2(0.5 * correction_limit_rad(period_s)))
    gain_bits = math.floor(31.0 - math.log2(BY_NAME["kb"].highest * period_s))
    bias = math.floor(BIAS_BITS - math.log2(0.5 * BIAS_LIMIT_RAD_S * period_s))
    return ObserverFormats(
        force=min(math.floor(31.0 - math.log2(largest)), 26),
        correction=correction,
        bias=max(min(bias, correction - 34 + gain_bits), 32),
        rest_shift=max(math.floor(-1.0 - math.log2(period_s)), 0),
    )


def gain_bits(formats: ObserverFormats) -> tuple[int, int, int]:
    """Return the fraction bits of what multiplies acceleration, velocity and correction."""
    return formats.correction + 8, 32, formats.bias + 34 - formats.correction


def gains_per_unit(period_s: float) -> tuple[float, float, float]:
    """Return what kt, kv and kb are multiplied with before they are words."""
    return 0.5 * period_s**2, period_s, period_s


def largest_that_fits(name: str, period_s: float) -> float:
    """Return the largest value of a parameter whose word has room for it at a sample period.

    Parameters
    ----------
    name
        Of a kind of parameter, such as ``kt``.
    """
    formats = _formats(period_s, STANDARD_GRAVITY_M_S2)
    highest = BY_NAME[name].highest
    if name == "kt":
        unit = math.ldexp(gains_per_unit(period_s)[0], gain_bits(formats)[0])
        return min(highest, (2.0**31 - 1.0) / unit)
    if name == "rest_gain":
        unit = math.ldexp(period_s, formats.bias - formats.rest_shift)
        return min(highest, (2.0**30 - 1.0) / unit)
    return highest


def bias_turn(scale: float, period_s: float) -> float:
    """Return the half-angle that a bias of one rad/s of an axis with a scale makes in a sample."""
    return (1.0 + scale) * 0.5 * period_s


def _gains(design: FilterDesign, own: Settings, formats: ObserverFormats) -> ObserverGains:
    period_s, bits = design.period_s, gain_bits(formats)
    kt, kv, kb = gains_per_unit(period_s)
    cal = own.calibration
    biases = zip(cal.gyro_scale, cal.gyro_bias_rad_s, strict=True)
    turns = _triple(tuple(b * bias_turn(s, period_s) for s, b in biases), formats.bias)
    _check_bias(own)
    return ObserverGains(
        kt_raw=_gain(design, "kt", own.kt_rad_m * kt, bits[0], 31),
        kv_raw=_gain(design, "kv", own.kv_per_s * kv, bits[1], 31),
        kb_raw=_gain(design, "kb", own.kb_per_s * kb, bits[2], 31),
        bias_raw=turns,
    )


def _rest(design: FilterDesign, own: Settings, formats: ObserverFormats) -> ObserverRest | None:
    if own.rest is None:
        return None
    part = SENSORS[design.sensor.part]
    rate = own.rest.rate_rad_s / part.rad_s_per_count(design.sensor)
    force = own.rest.force_m_s2 / part.m_s2_per_count(design.sensor)
    gain = own.rest.gain_per_s * design.period_s
    return ObserverRest(
        rate_limit=min(_fixed(rate, 14), WORD_MAX),
        force_limit=min(_fixed(force, 14), WORD_MAX),
        gain_raw=_gain(design, "rest_gain", gain, formats.bias - formats.rest_shift, 30),
    )


def _check_step(design: FilterDesign, own: Settings, full_scale_rad_s: float) -> None:
    """Refuse a full-scale rate that turns too far in a sample."""
    scale = max(own.calibration.gyro_scale)
    turn = ((1.0 + scale) * full_scale_rad_s + BIAS_LIMIT_RAD_S) * design.period_s
    if turn > STEP_LIMIT_RAD:
        least_hz = design.rate_hz * turn / STEP_LIMIT_RAD
        raise FormatError(
            f"rate_hz = {design.rate_hz:g} with gyro_full_scale_deg_s = "
            f"{design.sensor.gyro_full_scale_deg_s} turns up to {turn:.3g} rad per sample; the "
            f"observer's limit is {STEP_LIMIT_RAD}: sample at {least_hz:.0f} Hz or faster, or "
            "narrow the range"
        )


def _clip_count(own: Settings, rad_s_per_count: float) -> int | None:
    """Return the largest count that is not clipped; None where every count is one."""
    if own.clip_rate_rad_s is None:
        return None
    count = math.floor(own.clip_rate_rad_s / rad_s_per_count)
    return count if count < COUNT_MAX else None


def _check_bias(own: Settings) -> None:
    """Refuse a bias that the scale of its axis makes too large."""
    cal = own.calibration
    for axis, scale, bias in zip(SENSOR_AXES, cal.gyro_scale, cal.gyro_bias_rad_s, strict=True):
        if (1.0 + scale) * abs(bias) > BIAS_LIMIT_RAD_S * (1.0 + 1e-9):
            raise DesignError(
                f"gyro_bias_{axis}_rad_s = {bias:g} rad/s is {(1.0 + scale) * bias:.4g} rad/s with "
                f"gyro_scale_{axis} = {scale:g}; the limit is {BIAS_LIMIT_RAD_S:.4g} rad/s"
            )


def _gain(design: FilterDesign, name: str, value: float, bits: int, width: int) -> int:
    """Return a gain as a word, refusing one that is too large."""
    raw = _fixed(value, bits)
    if abs(raw) >= 2**width:
        kind = BY_NAME[name]
        own = design.parameter(kind.key())
        fits = math.floor(1e3 * (2.0**width - 1.0) / abs(raw) * abs(own)) / 1e3
        raise FormatError(
            f"{kind.key()} = {own:g} {kind.unit} at rate_hz = {design.rate_hz:g} does not fit its "
            f"word; up to {fits:g} {kind.unit} fits: sample faster or lower it"
        )
    return raw


def _fixed(value: float, bits: int) -> int:
    return round_half_up(math.ldexp(value, bits))


def _triple(values: tuple[float, ...], bits: int) -> Triple:
    x, y, z = (_fixed(value, bits) for value in values)
    return x, y, z
