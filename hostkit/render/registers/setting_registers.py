"""Registers of the filter's settings, which become effective together."""

from typing import Final

from hostkit.errors import RenderError
from hostkit.filters import FILTERS
from hostkit.filters.filter import SettingWord
from hostkit.records import FilterDesign
from hostkit.render.registers.records import WORD_BYTES, Field, Register
from hostkit.spec import FixedPointSpec

SETTINGS_ADDRESS: Final = 0x40
MOST_SETTINGS: Final = 16
"""So many words lie between their address and that of the sample."""


def setting_registers(design: FilterDesign, spec: FixedPointSpec) -> tuple[Register, ...]:
    """Return one register a setting; one that the design lacks is reserved.

    Raises
    ------
    RenderError
        If the filter has more settings than there is room for.
    """
    settings = FILTERS[spec.filter].setting_words(design, spec)
    if len(settings) > MOST_SETTINGS:
        raise RenderError(
            f"the filter {spec.filter} has {len(settings)} settings; the registers have room for "
            f"{MOST_SETTINGS}"
        )
    return tuple(
        Register(
            name=setting.name.upper(),
            address=SETTINGS_ADDRESS + WORD_BYTES * i,
            description=f"Setting: {setting.title}.",
            fields=(_field(setting),),
        )
        for i, setting in enumerate(settings)
    )


def _field(setting: SettingWord) -> Field:
    return Field(
        name="VALUE",
        description=setting.title,
        low=0,
        width=setting.width,
        access="rw",
        source="setting",
        element=setting.name,
        kind="signed" if setting.signed else "unsigned",
        reset=(setting.raw or 0) % 2**setting.width,
        present=setting.raw is not None,
    )
