"""Settings of the filter in their own units, to and from the words of their registers."""

import math

from hostkit.errors import FormatError, RenderError
from hostkit.filters import FILTERS
from hostkit.filters.filter import SettingWord
from hostkit.fixedpoint import round_half_up
from hostkit.records import FilterDesign
from hostkit.spec import FixedPointSpec


def setting_word(design: FilterDesign, spec: FixedPointSpec, name: str, value: float) -> int:
    """Return the register's word for a setting.

    Parameters
    ----------
    name
        Name of the register, in either case.
    value
        In the unit that the filter tells for the setting.

    Raises
    ------
    FormatError
        If the value does not fit the register.
    RenderError
        If the design has no such setting.
    """
    setting = _setting(design, spec, name)
    scaled = setting.to_raw(value)
    low, high = _limits(setting)
    raw = round_half_up(scaled) if math.isfinite(scaled) else high + 1
    if not low <= raw <= high:
        raise FormatError(
            f"{name} = {value} {setting.unit} is {scaled:.6g} in its register; "
            f"the range is {low} to {high}"
        )
    return raw & 0xFFFFFFFF


def setting_value(design: FilterDesign, spec: FixedPointSpec, name: str, word: int) -> float:
    """Return what a word of a setting's register means, in the unit that the filter tells.

    Raises
    ------
    RenderError
        If the design has no such setting.
    """
    setting = _setting(design, spec, name)
    raw = word & (1 << setting.width) - 1
    if setting.signed and raw >> setting.width - 1:
        raw -= 1 << setting.width
    return setting.to_value(raw)


def _limits(setting: SettingWord) -> tuple[int, int]:
    if setting.signed:
        return -(1 << setting.width - 1), (1 << setting.width - 1) - 1
    return 0, (1 << setting.width) - 1


def _setting(design: FilterDesign, spec: FixedPointSpec, name: str) -> SettingWord:
    words = FILTERS[spec.filter].setting_words(design, spec)
    present = [setting for setting in words if setting.raw is not None]
    for setting in present:
        if setting.name == name.lower():
            return setting
    known = ", ".join(setting.name.upper() for setting in present)
    raise RenderError(f"the design has no setting {name!r}; it has: {known}")
