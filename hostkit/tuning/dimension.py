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
    largest
        What a design takes at its sample rate, in its unit; a larger coordinate counts as that.
    shown_unit, shown_per_unit
        Unit on the screen, and the factor to it from the unit of a design.
    """

    name: FreeName
    axis: str | None
    lower: float
    upper: float
    is_log: bool
    largest: float = math.inf
    shown_unit: str = ""
    shown_per_unit: float = 1.0

    @property
    def label(self) -> str:
        """Name with its axis, as in a message."""
        return option_name(self.name) + (f" of {self.axis}" if self.axis else "")

    def value(self, x: float) -> float:
        """Return the parameter of a coordinate."""
        return min(math.exp(x) if self.is_log else x, self.largest)

    def shown(self, value: float) -> tuple[float, str]:
        """Return a value of a design as on the screen, with its unit there."""
        return value * self.shown_per_unit, self.shown_unit


def option_name(name: FreeName) -> str:
    """Return the name of a parameter as options have it."""
    return name.replace("_", "-")


@dataclass(frozen=True, slots=True, kw_only=True)
class Limits:
    """What a design takes of one kind of parameter, and how the screen shows it."""

    lowest: float
    highest: float
    shown_unit: str = ""
    shown_per_unit: float = 1.0

    def text(self, value: float) -> str:
        """Return a value as on the screen."""
        return f"{value * self.shown_per_unit:g} {self.shown_unit}".rstrip()

    def within(self) -> str:
        """Return the limits as on the screen."""
        return f"[{self.lowest * self.shown_per_unit:g}, {self.text(self.highest)}]"


def check_range(search: SearchRange, limits: Limits) -> None:
    """Refuse a range that is empty or outside what a design takes.

    Raises
    ------
    DesignError
        With the range and the limits.
    """
    low, high = search.lowest, search.highest
    order = limits.lowest <= low < high <= limits.highest
    if not (math.isfinite(low) and math.isfinite(high) and order):
        raise DesignError(
            f"range of {option_name(search.name)}: {low * limits.shown_per_unit:g} to "
            f"{limits.text(high)}; the lower end must be below the upper one, both within "
            f"{limits.within()}"
        )


def check_fixed(fixed: FixedParameter, free: tuple[FreeName, ...], limits: Limits) -> None:
    """Refuse a fixed parameter that is also free, or outside what a design takes.

    Raises
    ------
    DesignError
        With the value and the limits.
    """
    if fixed.name in free:
        raise DesignError(
            f"{option_name(fixed.name)} is to be tuned and fixed at {limits.text(fixed.value)}; "
            "choose one"
        )
    if not limits.lowest <= fixed.value <= limits.highest:
        raise DesignError(
            f"{option_name(fixed.name)} = {limits.text(fixed.value)} is outside {limits.within()}"
        )
