"""A design in integers: the records that `lower` makes, and templates and integer models read."""

from dataclasses import dataclass

from hostkit.fixedpoint import Coefficient
from hostkit.mounting import Mounting
from hostkit.records import Axis
from hostkit.units import RAD_PER_HALF_TURN_LSB

SAMPLE_HIDDEN_WORDS = 2
"""Hidden words that the message of a sample has room for."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ArctanTable:
    """Constants of the arc tangent that replaces libm: the same in C, VHDL and Python.

    Attributes
    ----------
    guard_bits
        How far counts are shifted left first.
    turn_digits, ratio_digits
        Binary digits of the division that choose a turn, and of the one that measures the rest.
    angles_raw
        ``round(atan(turn / 2**turn_digits) / pi * 2**31)`` half-turn units.
    stretches_raw
        What each turn adds to a length of one, 18 fraction bits.
    slope
        Half-turn units per unit of the ratio, which is 2**-22.
    """

    guard_bits: int
    turn_digits: int
    ratio_digits: int
    angles_raw: tuple[int, ...]
    stretches_raw: tuple[int, ...]
    slope: Coefficient


@dataclass(frozen=True, slots=True, kw_only=True)
class StateWord:
    """One word of a filter's state beside its angles: a signed 32-bit integer.

    Attributes
    ----------
    name, unit
        What it is, and the unit in which the float model has it.
    per_unit
        That unit's worth of one unit of the integer.
    """

    name: str
    unit: str
    per_unit: float


@dataclass(frozen=True, slots=True, kw_only=True)
class FixedPointSpec:
    """A design in integers: what all filters have in common.

    Attributes
    ----------
    arctan
        Constants of the arc tangent, which gives the angles of every filter.
    gravity_count
        Accelerometer count of 1 g.
    hidden
        Words of the state that follow the angles.
    error_bound_rad
        Largest difference to the float model on counts, for the conditions its filter states.
    error_per_closed_sample_rad
        What a sample that does not correct adds to that bound; 0 without a gate.
    """

    filter: str
    axes: tuple[Axis, ...]
    mounting: Mounting
    arctan: ArctanTable
    gravity_count: int
    hidden: tuple[StateWord, ...]
    error_bound_rad: float
    error_per_closed_sample_rad: float

    @property
    def state_per_unit(self) -> tuple[float, ...]:
        """Worth of one unit of each word of the state, angles (rad) first."""
        angles = (RAD_PER_HALF_TURN_LSB,) * len(self.axes)
        return (*angles, *(word.per_unit for word in self.hidden))

    @property
    def tells_state(self) -> bool:
        """Whether the hidden words have a message of their own: a sample's has no room."""
        return len(self.hidden) > SAMPLE_HIDDEN_WORDS
