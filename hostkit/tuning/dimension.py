"""What a search is over, whichever filter it is for."""

import math
from dataclasses import dataclass

from hostkit.errors import DesignError

FreeName = str
"""Name of a kind of parameter, without axis and unit."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SearchRange:
    """Where one kind of parameter is looked for, in the unit of a design."""

    name: FreeName
    lowest: float
    highest: float
    is_log: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class FixedParameter:
    """A parameter that the user sets: of one axis, or of all (None), in the unit of a design."""

    name: FreeName
    value: float
    axis: str | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Dimension:
    """One searched number.

    Attributes
    ----------
    lower, upper
        Its range; logarithms where `is_log`.
    shown_unit, shown_per_unit
        Unit on the screen, and the factor to it from the unit of a design.
    """

    name: FreeName
    axis: str | None
    lower: float
    upper: float
    is_log: bool
    shown_unit: str = ""
    shown_per_unit: float = 1.0

    @property
    def label(self) -> str:
        """Name with its axis, as in a message."""
        return self.name.replace("_", "-") + (f" of {self.axis}" if self.axis else "")

    def value(self, x: float) -> float:
        """Return the parameter of a coordinate."""
        return math.exp(x) if self.is_log else x

    def shown(self, value: float) -> tuple[float, str]:
        """Return a value of a design as on the screen, with its unit there."""
        return value * self.shown_per_unit, self.shown_unit


def check_range(search: SearchRange, floor: float, ceiling: float) -> None:
    """Refuse a range that is empty or outside what a design takes.

    Raises
    ------
    DesignError
        With the range and the limits.
    """
    low, high = search.lowest, search.highest
    if not (math.isfinite(low) and math.isfinite(high) and floor <= low < high <= ceiling):
        raise DesignError(
            f"range of {search.name}: {low:g} to {high:g}; the lower end must be below the upper "
            f"one, both within [{floor:g}, {ceiling:g}]"
        )


def check_fixed(fixed: FixedParameter, free: tuple[FreeName, ...], low: float, high: float) -> None:
    """Refuse a fixed parameter that is also free, or outside what a design takes.

    Raises
    ------
    DesignError
        With the value and the limits.
    """
    if fixed.name in free:
        raise DesignError(f"{fixed.name} is to be tuned and fixed at {fixed.value:g}; choose one")
    if not (math.isfinite(fixed.value) and low <= fixed.value <= high):
        raise DesignError(f"{fixed.name} = {fixed.value:g} is outside [{low:g}, {high:g}]")
