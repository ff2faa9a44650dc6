"""What is known of a device's parameters without asking it: units, limits, the design's values."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

from hostkit.filters import FILTERS
from hostkit.filters.filter import DeviceParameter, KnownParameter, ParameterView, no_views
from hostkit.records import FilterDesign

HIGHEST_SYSTEM = 254
FORBIDDEN_SYSTEM = 250


@dataclass(frozen=True, slots=True, kw_only=True)
class ParameterFacts:
    """One parameter that the firmware has.

    Attributes
    ----------
    unit
        Unit of its value; empty for a plain number.
    lowest, highest
        Least and greatest value that the device takes; None where that needs the sample rate of a
        design that was not given.
    design_value
        What the device tells when nothing was set on it; None where there is no design, and for
        parameters that are not the filter's.
    whole
        Whether only whole numbers are taken.
    symbol, title, views, relative_step
        As in :class:`hostkit.filters.filter.KnownParameter`.
    """

    name: str
    unit: str
    lowest: float | None
    highest: float | None
    design_value: float | None = None
    whole: bool = False
    symbol: str = ""
    title: str = ""
    views: Callable[[float], tuple[ParameterView, ...]] = no_views
    relative_step: float = 0.0

    def takes(self, value: float) -> bool:
        """Tell whether the device takes a value; where the limits are not known, it may."""
        if not math.isfinite(value) or (self.whole and value != int(value)):
            return False
        if self.name == "SYS_ID" and value == FORBIDDEN_SYSTEM:
            return False
        return (self.lowest is None or value >= self.lowest) and (
            self.highest is None or value <= self.highest
        )

    def range_text(self) -> str:
        """Return what it takes in words; empty where nothing of it is known."""
        ends = (("at least ", self.lowest), ("at most ", self.highest))
        if self.lowest is None or self.highest is None:
            return " and ".join(self._text(word, end) for word, end in ends if end is not None)
        but = f" but not {FORBIDDEN_SYSTEM}" if self.name == "SYS_ID" else ""
        number = "whole numbers from " if self.whole else ""
        return f"{number}{self.lowest:.7g} to {self._text('', self.highest)}{but}"

    def _text(self, word: str, value: float) -> str:
        return f"{word}{value:.7g} {self.unit}".rstrip()


_OWN: Final = (
    ParameterFacts(name="SYS_ID", unit="", lowest=1.0, highest=float(HIGHEST_SYSTEM), whole=True),
    ParameterFacts(name="CAL_START", unit="", lowest=0.0, highest=1.0, whole=True),
)


def parameter_facts(design: FilterDesign | None = None) -> dict[str, ParameterFacts]:
    """Return what is known of each parameter by its name.

    Parameters
    ----------
    design
        What the device runs. Without it there are the parameters of all filters, no values of a
        design, and no limits of what depends on the sample rate.

    Raises
    ------
    HostkitError
        If the design cannot be lowered.
    """
    facts = {own.name: own for own in _OWN}
    if design is None:
        for filter_ in FILTERS:
            for known in filter_.run_time.known:
                earlier = facts.get(known.name)
                facts[known.name] = _known_facts(known, earlier)
        return facts
    run_time = FILTERS[design.filter].run_time
    by_name = {known.name: known for known in run_time.known}
    for parameter in run_time.parameters(design):
        facts[parameter.name] = _filter_facts(parameter, by_name.get(parameter.name))
    return facts


def _known_facts(known: KnownParameter, earlier: ParameterFacts | None) -> ParameterFacts:
    """Return what is known of a parameter; the limits only where all filters have the same."""
    limits = known.lowest, known.highest
    if earlier is not None and limits != (earlier.lowest, earlier.highest):
        limits = None, None
    return ParameterFacts(
        name=known.name,
        unit=known.unit,
        lowest=limits[0],
        highest=limits[1],
        symbol=known.symbol,
        title=known.title,
        views=known.views,
        relative_step=known.relative_step,
    )


def _filter_facts(parameter: DeviceParameter, known: KnownParameter | None) -> ParameterFacts:
    return ParameterFacts(
        name=parameter.name,
        unit=parameter.unit,
        lowest=parameter.lowest,
        highest=parameter.highest,
        design_value=parameter.design_value,
        symbol="" if known is None else known.symbol,
        title="" if known is None else known.title,
        views=no_views if known is None else known.views,
        relative_step=0.0 if known is None else known.relative_step,
    )
