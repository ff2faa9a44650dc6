"""The settings that the registers of an FPGA can change, as words and in SI units."""

from hostkit.filters.filter import SettingWord
from hostkit.filters.observer.run_time import RUN_TIME, per_unit, words
from hostkit.filters.observer.spec import ObserverSpec
from hostkit.records import FilterDesign

TITLES = (
    "correction per sample and acceleration, kt / (2 rate^2)",
    "share of the velocity that goes in a sample, kv / rate",
    "bias per correction, kb / rate",
    "half-angle that the bias of x turns in a sample, bias (1 + scale) / (2 rate), at the start",
    "the same of y",
    "the same of z",
)


def setting_words(design: FilterDesign, spec: ObserverSpec) -> tuple[SettingWord, ...]:
    """Return the settings in the order of ``hk_settings_t``."""
    named = zip(RUN_TIME, TITLES, words(spec), per_unit(design), strict=True)
    return tuple(
        _word(f"{item.name}_{item.axis}" if item.axis else item.name, title, raw, item.unit, units)
        for item, title, raw, units in named
    )


def _word(name: str, title: str, raw: int, unit: str, units: float) -> SettingWord:
    return SettingWord(
        name=name,
        title=title,
        raw=raw,
        width=32,
        signed=True,
        unit=unit,
        to_raw=lambda value: value * units,
        to_value=lambda word: word / units,
    )
