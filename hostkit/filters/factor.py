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
