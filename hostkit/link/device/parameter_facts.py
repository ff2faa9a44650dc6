"""What is known of a device's parameters without asking it: units, limits, the design's values."""

import math
from dataclasses import dataclass
from typing import Final

from hostkit.filters.complementary import RUN_TIME, RunTimeParameter, limits, told_by_device
from hostkit.records import FilterDesign

_STEM: Final = {"gyro_bias": "GYRO_BIAS", "tilt_offset": "TILT_OFS"}

TAU_NAME: Final = "FILT_TAU"
HIGHEST_SYSTEM = 254
FORBIDDEN_SYSTEM = 250


def filter_parameter_name(item: RunTimeParameter) -> str:
    """Return the name that a parameter of the filter has on the link."""
    return TAU_NAME if item.axis is None else f"{_STEM[item.kind]}_{item.axis.upper()}"


FILTER_NAMES: Final[dict[str, int]] = {
    filter_parameter_name(item): place for place, item in enumerate(RUN_TIME)
}
"""Place in RUN_TIME of each name on the link."""


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
    """

    name: str
    unit: str
    lowest: float | None
    highest: float | None
    design_value: float | None = None
    whole: bool = False

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
        """Return what it takes in words; empty where that is not known."""
        if self.lowest is None or self.highest is None:
            return ""
        but = f" but not {FORBIDDEN_SYSTEM}" if self.name == "SYS_ID" else ""
        number = "whole numbers from " if self.whole else ""
        unit = f" {self.unit}" if self.unit else ""
        return f"{number}{self.lowest:.7g} to {self.highest:.7g}{unit}{but}"


_OWN: Final = (
    ParameterFacts(name="SYS_ID", unit="", lowest=1.0, highest=float(HIGHEST_SYSTEM), whole=True),
    ParameterFacts(name="CAL_START", unit="", lowest=0.0, highest=1.0, whole=True),
)


def parameter_facts(design: FilterDesign | None = None) -> dict[str, ParameterFacts]:
    """Return what is known of each parameter by its name.

    Parameters
    ----------
    design
        What the device runs. Without it there are no values of a design, and no limits of
        FILT_TAU, which depend on the sample rate.

    Raises
    ------
    HostkitError
        If the design cannot be lowered.
    """
    told = (None,) * len(RUN_TIME) if design is None else told_by_device(design)
    facts = {own.name: own for own in _OWN}
    for item, value in zip(RUN_TIME, told, strict=True):
        if design is None or item.of(design):
            fact = _filter_facts(item, design, value)
            facts[fact.name] = fact
    return facts


def _filter_facts(
    item: RunTimeParameter, design: FilterDesign | None, value: float | None
) -> ParameterFacts:
    known = design is not None or item.kind != "tau"
    period_s = 1.0 if design is None else design.period_s
    lowest, highest = limits(item, period_s) if known else (None, None)
    return ParameterFacts(
        name=filter_parameter_name(item),
        unit=item.unit,
        lowest=lowest,
        highest=highest,
        design_value=value,
    )
