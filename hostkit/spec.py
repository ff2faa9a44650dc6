"""A design in integers: the records that `lower` makes, and templates and integer models read."""

from dataclasses import dataclass

from hostkit.fixedpoint import Coefficient
from hostkit.mounting import Mounting
from hostkit.records import Axis, TiltMethod
from hostkit.units import RAD_PER_HALF_TURN_LSB


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
class ForceGate:
    """The specific forces that correct: lowest to highest sum of squared counts, both included."""

    lowest: int
    highest: int


@dataclass(frozen=True, slots=True, kw_only=True)
class BiasIntegral:
    """How the gyroscope bias follows the correction.

    Attributes
    ----------
    gain
        Units of bias per half-turn unit of innovation.
    fraction_bits
        Fraction bits of the bias, whose unit is the half-turn unit per sample.
    limit_raw
        Largest bias, in its own units.
    """

    gain: Coefficient
    fraction_bits: int
    limit_raw: int


@dataclass(frozen=True, slots=True, kw_only=True)
class FixedPointSpec:
    """A design in integers: all that templates and the integer model know of the filter.

    Attributes
    ----------
    rate_gains
        Half-turn units of angle per count of angular rate and sample, one for each axis.
    blend
        1 - eta, the weight of the tilt measured from specific force.
    tilt_offset_raw
        Taken off the measured tilt of each axis, half-turn units.
    gyro_bias_raw
        Taken off each step of the rate, half-turn units per sample; with an integral where it
        starts, with its fraction bits.
    gate, integral
        None where the filter has none.
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
    tilt: TiltMethod
    mounting: Mounting
    rate_gains: tuple[Coefficient, ...]
    blend: Coefficient
    tilt_offset_raw: tuple[int, ...]
    gyro_bias_raw: tuple[int, ...]
    gate: ForceGate | None
    integral: BiasIntegral | None
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
