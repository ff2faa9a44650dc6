"""Factors between integers of a filter and numbers of 32 bits, as the firmware has them."""

import math
from dataclasses import dataclass

MANTISSA_BITS = 53


@dataclass(frozen=True, slots=True, kw_only=True)
class FactorContext:
    """A positive factor: the integer of 63 bits in two words, times ``2**(exponent - 64)``."""

    high: int
    low: int
    exponent: int


def factor(real: float) -> FactorContext:
    """Split a positive number into the words of a factor, exactly."""
    mantissa, exponent = math.frexp(real)
    whole = int(math.ldexp(mantissa, MANTISSA_BITS)) << 63 - MANTISSA_BITS
    return FactorContext(high=whole >> 32, low=whole & 0xFFFFFFFF, exponent=exponent + 1)


def float_of(raw: int, by: FactorContext) -> float:
    """Return an integer times a factor as the firmware does: a number of 32 bits, halves upwards.

    The firmware's product has 64 bits and loses what is beyond them, so that this is not always the
    nearest number where the exact product lies half-way between two.
    """
    size, whole = 0, by.high << 32 | by.low
    number, shift = abs(raw), 32 - abs(raw).bit_length()
    for bit in range(32):
        size = (size + (whole if (number << shift) >> bit & 1 else 0)) >> 1
    if size == 0:
        return 0.0
    more = 64 - size.bit_length()
    mantissa = (((size << more) >> 39) + 1) >> 1
    return math.copysign(math.ldexp(mantissa, by.exponent + 8 - shift - more), raw)
