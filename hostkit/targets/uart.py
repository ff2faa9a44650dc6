"""What a serial port makes of a baud rate: the divider of its clock and the error that is left."""

import math
from dataclasses import dataclass

STANDARD_BAUDS = (
    *(9600, 19200, 38400, 57600, 115200, 230400, 250000),
    *(460800, 500000, 921600, 1000000, 2000000),
)
"""Rates that serial adapters and terminal programs know, bit/s."""
SUGGESTED = 4


@dataclass(frozen=True, slots=True, kw_only=True)
class UartClock:
    """A clock and the whole numbers it can be divided by.

    Attributes
    ----------
    tick_hz
        The clock whose division is the baud rate, Hz; with a fractional divider the clock times
        its fractions.
    least, most
        Smallest and largest divisor.
    tolerance
        Largest relative error of a rate that counts as made.
    """

    tick_hz: float
    least: int
    most: int
    tolerance: float

    def made(self, baud: int) -> float:
        """Return the rate that is nearest to `baud`, bit/s."""
        divisor = min(max(math.floor(self.tick_hz / baud + 0.5), self.least), self.most)
        return self.tick_hz / divisor

    def error(self, baud: int) -> float:
        """Return the relative error of the rate that is made for `baud`."""
        return self.made(baud) / baud - 1.0

    def makes(self, baud: int) -> bool:
        """Tell whether a rate is made within the tolerance."""
        return abs(self.error(baud)) <= self.tolerance

    def standard(self) -> tuple[int, ...]:
        """Return the standard rates that are made within the tolerance, ascending."""
        return tuple(rate for rate in STANDARD_BAUDS if self.makes(rate))

    def near(self, baud: int) -> tuple[int, ...]:
        """Return the few standard rates nearest to `baud` that are made, ascending."""
        by_distance = sorted(self.standard(), key=lambda rate: abs(math.log(rate / baud)))
        return tuple(sorted(by_distance[:SUGGESTED]))


@dataclass(frozen=True, slots=True, kw_only=True)
class FixedRates:
    """A port that knows some rates, bit/s, ascending, and makes them exactly."""

    rates: tuple[int, ...]
    tolerance: float = 0.0

    def made(self, baud: int) -> float:
        """Return the rate that is nearest to `baud`, bit/s."""
        return min(self.rates, key=lambda rate: abs(math.log(rate / baud)))

    def error(self, baud: int) -> float:
        """Return the relative error of the rate that is nearest to `baud`."""
        return self.made(baud) / baud - 1.0

    def makes(self, baud: int) -> bool:
        """Tell whether it knows a rate."""
        return baud in self.rates

    def standard(self) -> tuple[int, ...]:
        """Return all it knows."""
        return self.rates

    def near(self, baud: int) -> tuple[int, ...]:
        """Return the few rates nearest to `baud`, ascending."""
        by_distance = sorted(self.rates, key=lambda rate: abs(math.log(rate / baud)))
        return tuple(sorted(by_distance[:SUGGESTED]))
