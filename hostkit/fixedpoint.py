"""Signed fixed-point formats, rounding halves upwards, and 32-bit wrap.

The rounding rule everywhere is *halves upwards*: add half a unit and shift arithmetically. In
hardware that is one adder; in C one addition and one arithmetic shift.
"""

import math
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from hostkit.errors import FormatError

COEFFICIENT_BITS = 18
"""Width of a coefficient: the multiplier input of a Xilinx DSP48A."""

IntLike = TypeVar("IntLike", int, NDArray[np.int64])


@dataclass(frozen=True, slots=True, kw_only=True)
class QFormat:
    """A signed two's-complement format: `width` bits of which `fraction_bits` are fraction.

    `fraction_bits` may exceed `width`: the number is then smaller than one.
    """

    width: int
    fraction_bits: int

    def __str__(self) -> str:
        return f"s{self.width - 1 - self.fraction_bits}.{self.fraction_bits}"


@dataclass(frozen=True, slots=True, kw_only=True)
class Coefficient:
    """One constant of the generated code: real value, unit, format and integer."""

    name: str
    real: float
    unit: str
    format: QFormat
    raw: int

    @property
    def quantised(self) -> float:
        """Real value of the integer."""
        return math.ldexp(self.raw, -self.format.fraction_bits)

    @property
    def relative_error(self) -> float:
        """Relative error of the integer against the real value."""
        return self.quantised / self.real - 1.0


def round_half_up(value: float) -> int:
    """Round to the nearest integer, halves upwards."""
    return math.floor(value + 0.5)


def coefficient(name: str, real: float, unit: str, *, width: int = COEFFICIENT_BITS) -> Coefficient:
    """Give a positive constant the format that keeps most of its digits in `width` bits.

    Parameters
    ----------
    name, unit
        Name and unit of the constant, for the generated comment.
    real
        The constant, greater than zero.
    width
        Bits of the word, sign included.

    Raises
    ------
    FormatError
        If `real` is not a positive finite number.
    """
    if not (math.isfinite(real) and real > 0.0):
        raise FormatError(f"{name} = {real} {unit} cannot be lowered: it must be positive, finite")
    raw_max = 2 ** (width - 1) - 1
    fraction_bits = width - 1 - math.frexp(real)[1]
    raw = round_half_up(math.ldexp(real, fraction_bits))
    if raw > raw_max:
        fraction_bits -= 1
        raw = round_half_up(math.ldexp(real, fraction_bits))
    q_format = QFormat(width=width, fraction_bits=fraction_bits)
    return Coefficient(name=name, real=real, unit=unit, format=q_format, raw=raw)


def shift_round(value: IntLike, bits: int) -> IntLike:
    """Divide by ``2**bits``, rounding halves upwards; `bits` is at least one."""
    return (value + (1 << (bits - 1))) >> bits


def wrap32(value: IntLike) -> IntLike:
    """Keep the low 32 bits as a signed number: the wrap of an angle in half turns at +-pi."""
    return ((value + 2**31) & 0xFFFFFFFF) - 2**31
