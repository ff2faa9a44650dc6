"""Integer arc tangent and arc sine: the same integers in C, in VHDL and here.

A vector is folded into the first octant and turned onto the x axis in two parts. The first six
binary digits of y / x name a vector of the table, ``(64, turn)``, and the remainder of that
division is already what is left across it::

    across = 64 y - turn x        along = x + turn y / 64        ratio = across / (64 along)

which is a rotation without its normalisation, as a step of Volder's CORDIC is (J. E. Volder, "The
CORDIC trigonometric computing technique", IRE Trans. Electronic Computers EC-8(3), 1959, pp.
330-334), by a table of 64 angles instead of powers of two. What is left is below 1/64, where the
arc tangent is a straight line within ``RATIO_LIMIT**3 / 12``; more digits of the same division
give it. The length is ``along`` times ``1 + ratio**2 / 2``, and carries ``sqrt(1 + (turn/64)**2)``.
"""

import math

import numpy as np
from numpy.typing import NDArray

from hostkit.fixedpoint import coefficient, wrap32
from hostkit.spec import ArctanTable

TURN_DIGITS = 6
RATIO_DIGITS = 14
GUARD_BITS = 14
"""Counts are shifted left this far; with 16-bit counts no intermediate leaves 32 bits."""

RATIO_FRACTION_BITS = 22
"""Fraction bits of a ratio: it is below 2**-6 and fills a word of 16 bits."""

STRETCH_FRACTION_BITS = 18
ROOT_FRACTION_BITS = 8
"""Fraction bits of the integer square root in the arc sine."""

SLOPE_BITS = 17
RATIO_LIMIT: float = 2.0**-TURN_DIGITS
LEAST_WORD = 2**13
"""A vector of two components below this is zero: of its ratio the digits would not be exact."""

QUARTER, HALF = 2**30, 2**31

IntArray = NDArray[np.int64]


def arctan_table() -> ArctanTable:
    """Return the constants of the arc tangent.

    The slope is that of the line which the arc tangent leaves least over ``0..RATIO_LIMIT`` if it
    is to go through zero: ``1 - RATIO_LIMIT**2 / 4`` of the slope at zero.
    """
    steps = 2**TURN_DIGITS
    tangents = [turn / steps for turn in range(steps)]
    half_turn = HALF / math.pi
    slope = half_turn * 2.0**-RATIO_FRACTION_BITS * (1.0 - RATIO_LIMIT**2 / 4.0)
    return ArctanTable(
        guard_bits=GUARD_BITS,
        turn_digits=TURN_DIGITS,
        ratio_digits=RATIO_DIGITS,
        angles_raw=tuple(round(math.atan(value) * half_turn) for value in tangents),
        stretches_raw=tuple(
            round((math.hypot(1.0, value) - 1.0) * 2**STRETCH_FRACTION_BITS) for value in tangents
        ),
        slope=coefficient("ratio_slope", slope, "half turns / 2^31 per 2^-22", width=SLOPE_BITS),
    )


def vector_angle(
    table: ArctanTable, y: IntArray, x: IntArray
) -> tuple[IntArray, IntArray, IntArray]:
    """Return the angle and the length of vectors of the right half plane above the x axis.

    Parameters
    ----------
    table
        Constants of the arc tangent.
    y, x
        Components with guard bits, not negative, below 2**30, shape ``(N,)``.

    Returns
    -------
    angle_raw, length_raw, stretch_raw
        Angle in half turns; the length multiplied by one plus the stretch; the stretch with
        STRETCH_FRACTION_BITS; each of shape ``(N,)``. A zero vector gives three zeros.
    """
    nothing = (x == 0) & (y == 0)
    low, high = np.minimum(y, x), np.where(nothing, 1, np.maximum(y, x))
    turn = np.minimum((low << table.turn_digits) // high, len(table.angles_raw) - 1)
    across = (low << table.turn_digits) - turn * high
    along = high + 4 * turn * (low >> 8)
    ratio = ((across << table.ratio_digits) // along) << (16 - table.ratio_digits)
    angle = np.array(table.angles_raw)[turn] + (
        (ratio * table.slope.raw) >> table.slope.format.fraction_bits
    )
    angle = np.where(y > x, QUARTER - angle, angle)
    fine = ratio >> 8
    length = along + ((((along >> 16) * fine * (fine + 1)) >> 16) << 3)
    stretch = np.array(table.stretches_raw)[turn]
    return angle, np.where(nothing, 0, length), stretch


def atan2_count(
    table: ArctanTable, y_count: IntArray, x_count: IntArray
) -> tuple[IntArray, IntArray, IntArray]:
    """Return the angle of vectors in counts, and length and stretch as :func:`vector_angle` does.

    Parameters
    ----------
    y_count, x_count
        Components, from -2**15 to 2**15, shape ``(N,)``.
    """
    return atan2_word(table, y_count << table.guard_bits, x_count << table.guard_bits)


def atan2_word(table: ArctanTable, y: IntArray, x: IntArray) -> tuple[IntArray, IntArray, IntArray]:
    """Return the same of vectors whose components fill a word.

    Parameters
    ----------
    y, x
        Components, from -2**30 to 2**30, shape ``(N,)``. Where both are below LEAST_WORD, the
        vector counts as zero.
    """
    nothing = np.maximum(np.abs(y), np.abs(x)) < LEAST_WORD
    y, x = np.where(nothing, 0, y), np.where(nothing, 0, x)
    angle, length, stretch = vector_angle(table, np.abs(y), np.abs(x))
    angle = np.where(x < 0, HALF - angle, angle)
    return _with_sign_of(y, angle), length, stretch


def atan2_length(
    table: ArctanTable, y_count: IntArray, length: IntArray, stretch: IntArray
) -> IntArray:
    """Return the angle of ``(length, y)`` for a length that :func:`atan2_count` gave."""
    return atan2_word_length(table, y_count << table.guard_bits, length, stretch)


def atan2_word_length(
    table: ArctanTable, y: IntArray, length: IntArray, stretch: IntArray
) -> IntArray:
    """Return the angle of ``(length, y)`` for a length that :func:`atan2_word` gave.

    The stretch of the length is put on `y` instead of being divided out of `length`.
    """
    size = np.abs(y)
    size = size + ((size * stretch) >> STRETCH_FRACTION_BITS)
    return _with_sign_of(y, vector_angle(table, size, length)[0])


def arcsin_count(table: ArctanTable, y_count: IntArray, one_count: int) -> IntArray:
    """Return the arc sine of ``y_count / one_count``, clamped to +-90 deg, in half turns."""
    y = np.minimum(np.abs(y_count), one_count)
    square = (one_count * one_count - y * y) << (2 * ROOT_FRACTION_BITS)
    # Exact: below 2**44 a correctly rounded root never reaches the next integer.
    root = np.sqrt(square.astype(np.float64)).astype(np.int64)
    x = root << (table.guard_bits - ROOT_FRACTION_BITS)
    return _with_sign_of(y_count, vector_angle(table, y << table.guard_bits, x)[0])


def _with_sign_of(y_count: IntArray, angle: IntArray) -> IntArray:
    return wrap32(np.where(y_count < 0, -angle, angle))
