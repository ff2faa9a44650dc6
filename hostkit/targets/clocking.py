"""How an FPGA makes its clock from the oscillator of the board."""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from fractions import Fraction


@dataclass(frozen=True, slots=True, kw_only=True)
class ClockPlan:
    """Multiplier and divisors that make a clock.

    Attributes
    ----------
    multiply, divide
        The output is the input times one, divided by the other.
    output_divide
        Divisor behind the oscillator of a PLL; 1 for a DCM.
    """

    input_hz: int
    multiply: int
    divide: int
    output_divide: int = 1

    @property
    def output_hz(self) -> int:
        """The clock that is made, Hz, to the nearest whole number."""
        return round(self._feedback * self.input_hz)

    @property
    def _feedback(self) -> Fraction:
        """Output over input; a PLL takes its output back, so its own divisor cancels."""
        return Fraction(self.multiply, self.divide)

    @property
    def input_period_ns(self) -> str:
        """Period of the oscillator."""
        return f"{1e9 / self.input_hz:.3f}"

    @property
    def output_period_ns(self) -> str:
        """Period of the clock."""
        return f"{1e9 / self.output_hz:.3f}"

    @property
    def input_mhz(self) -> str:
        """The oscillator."""
        return f"{self.input_hz / 1e6:.6f}"

    @property
    def output_mhz(self) -> str:
        """The clock."""
        return f"{self.output_hz / 1e6:.6f}"


@dataclass(frozen=True, slots=True, kw_only=True)
class ClockMaker:
    """What a DCM or PLL can do.

    Attributes
    ----------
    title
        For messages.
    input_hz, output_hz
        Lowest and highest clock.
    multiply, divide
        Smallest and largest number.
    detector_hz, oscillator_hz
        Lowest and highest frequency of a PLL's phase detector and oscillator; None for a DCM.
    output_divide
        Largest divisor behind the oscillator.
    """

    title: str
    input_hz: tuple[int, int]
    output_hz: tuple[int, int]
    multiply: tuple[int, int]
    divide: tuple[int, int]
    detector_hz: tuple[int, int] | None = None
    oscillator_hz: tuple[int, int] | None = None
    output_divide: int = 1

    def plan(self, input_hz: int, output_hz: int) -> ClockPlan | None:
        """Return how a clock is made, or None if it is not made to the nearest Hz."""
        return next((p for p in self._plans(input_hz) if p.output_hz == output_hz), None)

    def nearest(self, input_hz: int, output_hz: int) -> int:
        """Return the clock nearest to `output_hz` that is made."""
        made = (plan.output_hz for plan in self._plans(input_hz))
        return min(made, key=lambda hz: (abs(hz - output_hz), hz))

    def _plans(self, input_hz: int) -> Iterator[ClockPlan]:
        """Yield what is made of an oscillator, small numbers first."""
        low, high = self.output_hz
        for divide in range(self.divide[0], self.divide[1] + 1):
            if not _within(self.detector_hz, input_hz / divide):
                continue
            for multiply in range(self.multiply[0], self.multiply[1] + 1):
                plan = ClockPlan(input_hz=input_hz, multiply=multiply, divide=divide)
                if low <= plan.output_hz <= high:
                    yield from self._with_oscillator(plan)

    def _with_oscillator(self, plan: ClockPlan) -> Iterator[ClockPlan]:
        """Yield a plan with an output divisor that keeps the oscillator of a PLL in its range."""
        if self.oscillator_hz is None:
            yield plan
            return
        low, high = self.oscillator_hz
        first = math.ceil(low / plan.output_hz)
        last = min(self.output_divide, high // plan.output_hz)
        if first <= last:
            yield replace(plan, output_divide=(first + last) // 2)


def _within(limits: tuple[int, int] | None, value: float) -> bool:
    return limits is None or limits[0] <= value <= limits[1]
