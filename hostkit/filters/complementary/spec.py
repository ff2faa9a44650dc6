"""The complementary filter in integers."""

from dataclasses import dataclass

from hostkit.fixedpoint import Coefficient
from hostkit.records import TiltMethod
from hostkit.spec import FixedPointSpec


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
class ComplementarySpec(FixedPointSpec):
    """A design of the complementary filter in integers.

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
    """

    tilt: TiltMethod
    rate_gains: tuple[Coefficient, ...]
    blend: Coefficient
    tilt_offset_raw: tuple[int, ...]
    gyro_bias_raw: tuple[int, ...]
    gate: ForceGate | None
    integral: BiasIntegral | None
