"""Settings of the filter in SI units, to and from the words of their registers."""

import math
from typing import Final

from hostkit.errors import FormatError, RenderError
from hostkit.filters.complementary.lowering import bias_unit_rad_s
from hostkit.fixedpoint import round_half_up
from hostkit.records import FilterDesign
from hostkit.render.registers.setting_registers import Setting, settings_of
from hostkit.spec import FixedPointSpec
from hostkit.units import RAD_PER_HALF_TURN_LSB, STANDARD_GRAVITY_M_S2

UNITS: Final = {
    "blend": "1",
    "rate_gain": "rad/s per count",
    "integral_gain": "1/s^2",
    "tilt_offset": "rad",
    "gyro_bias": "rad/s",
    "gate": "m/s^2",
}
"""Unit of each kind of setting; the value of `blend` is eta, the weight of the integrated rate."""


def setting_word(design: FilterDesign, spec: FixedPointSpec, name: str, value: float) -> int:
    """Return the register's word for a setting.

    Parameters
    ----------
    name
        Name of the register, in either case.
    value
        In the unit that UNITS has for its kind.

    Raises
    ------
    FormatError
        If the value does not fit the register.
    RenderError
        If the design has no such setting.
    """
    setting = _setting(spec, name)
    scaled = _scaled(design, spec, setting.name, value)
    low, high = _limits(setting)
    raw = round_half_up(scaled) if math.isfinite(scaled) else high + 1
    if not low <= raw <= high:
        raise FormatError(
            f"{name} = {value} {_unit(setting.name)} is {scaled:.6g} in its register; "
            f"the range is {low} to {high}"
        )
    return raw & 0xFFFFFFFF


def setting_value(design: FilterDesign, spec: FixedPointSpec, name: str, word: int) -> float:
    """Return what a word of a setting's register means, in the unit that UNITS has.

    Raises
    ------
    RenderError
        If the design has no such setting.
    """
    setting = _setting(spec, name)
    raw = word & (1 << setting.width) - 1
    if setting.kind == "signed" and raw >> setting.width - 1:
        raw -= 1 << setting.width
    if setting.name == "blend":
        return 1.0 - raw * _weight(design, spec, setting.name)
    if _kind(setting.name) == "gate":
        return math.sqrt(raw) * STANDARD_GRAVITY_M_S2 / spec.gravity_count
    return raw * _weight(design, spec, setting.name)


def _scaled(design: FilterDesign, spec: FixedPointSpec, name: str, value: float) -> float:
    if name == "blend":
        return (1.0 - value) / _weight(design, spec, name)
    if _kind(name) == "gate":
        counts = value / STANDARD_GRAVITY_M_S2 * spec.gravity_count
        return counts * abs(counts)
    return value / _weight(design, spec, name)


def _weight(design: FilterDesign, spec: FixedPointSpec, name: str) -> float:
    """Return the worth of one unit of a word."""
    if name == "blend":
        return math.ldexp(1.0, -spec.blend.format.fraction_bits)
    kind = _kind(name)
    if kind == "rate_gain":
        gain = next(gain for gain in spec.rate_gains if gain.name == name)
        unit = RAD_PER_HALF_TURN_LSB * design.rate_hz
        return math.ldexp(unit, -gain.format.fraction_bits)
    if kind == "integral_gain" and spec.integral is not None:
        bits = spec.integral.gain.format.fraction_bits + spec.integral.fraction_bits
        return math.ldexp(design.rate_hz**2, -bits)
    return bias_unit_rad_s(design, spec.integral) if kind == "gyro_bias" else RAD_PER_HALF_TURN_LSB


def _kind(name: str) -> str:
    return next(kind for kind in UNITS if name.startswith(kind))


def _unit(name: str) -> str:
    return UNITS[_kind(name)]


def _limits(setting: Setting) -> tuple[int, int]:
    if setting.kind == "signed":
        return -(1 << setting.width - 1), (1 << setting.width - 1) - 1
    return 0, (1 << setting.width) - 1


def _setting(spec: FixedPointSpec, name: str) -> Setting:
    present = [setting for setting in settings_of(spec) if setting.raw is not None]
    for setting in present:
        if setting.name == name.lower():
            return setting
    known = ", ".join(setting.name.upper() for setting in present)
    raise RenderError(f"the design has no setting {name!r}; it has: {known}")
