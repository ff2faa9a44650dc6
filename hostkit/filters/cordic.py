"""Integer CORDIC: the arc tangent and arc sine of the C, VHDL and Python integer models.

The algorithm is Volder's vectoring mode (J. E. Volder, "The CORDIC trigonometric computing
technique", IRE Trans. Electronic Computers EC-8(3), 1959, pp. 330-334) with arithmetic shifts, a
quadrant fold and angles in half turns. Everything here is vectorised over samples; the same steps
in C and VHDL give the same integers.
"""

import math

import numpy as np
from numpy.typing import NDArray

from hostkit.fixedpoint import coefficient, shift_round, wrap32
from hostkit.spec import CordicTable

STEPS = 20
GUARD_BITS = 12
"""Counts are shifted left this far; with 16-bit counts no intermediate leaves 32 bits."""

ROOT_FRACTION_BITS = 8
"""Fraction bits of the integer square root in the arc sine."""

GAIN_BITS = 17
"""Width of the CORDIC gain: a bit less than a coefficient, so a product with a count fits 32."""

IntArray = NDArray[np.int64]


def cordic_table(steps: int = STEPS) -> CordicTable:
    """Return the arc tangents in half turns and the gain of `steps` micro-rotations."""
    angles = tuple(round(math.atan(2.0**-i) / math.pi * 2**31) for i in range(steps))
    gain = math.prod(math.sqrt(1.0 + 4.0**-i) for i in range(steps))
    return CordicTable(
        guard_bits=GUARD_BITS,
        angles_raw=angles,
        gain=coefficient("cordic_gain", gain, "1", width=GAIN_BITS),
    )


def vectoring(table: CordicTable, y: IntArray, x: IntArray) -> tuple[IntArray, IntArray]:
    """Rotate ``(x, y)`` onto the positive x axis.

    Parameters
    ----------
    table
        Constants of the CORDIC.
    y, x
        Components with guard bits, shape ``(N,)``.

    Returns
    -------
    angle_raw, magnitude
        Angle in half turns, and the length multiplied by the gain, both of shape ``(N,)``. A zero
        vector gives zero and zero.
    """
    nothing = (x == 0) & (y == 0)
    behind = x < 0
    angle = np.where(behind, np.int64(2**31), np.int64(0))
    x, y = np.where(behind, -x, x), np.where(behind, -y, y)
    for i, step in enumerate(table.angles_raw):
        turn = np.where(y >= 0, np.int64(1), np.int64(-1))
        x, y = x + turn * (y >> i), y - turn * (x >> i)
        angle = angle + turn * step
    return np.where(nothing, 0, wrap32(angle)), np.where(nothing, 0, x)


def atan2_count(table: CordicTable, y: IntArray, x: IntArray) -> tuple[IntArray, IntArray]:
    """Return :func:`vectoring` of a vector in counts."""
    return vectoring(table, y << table.guard_bits, x << table.guard_bits)


def atan2_magnitude(table: CordicTable, y_count: IntArray, magnitude: IntArray) -> IntArray:
    """Return the angle of ``(magnitude, y)`` where `magnitude` still carries the gain.

    The gain of the first pass is put on `y_count` instead of being divided out of `magnitude`.
    """
    bits = table.gain.format.fraction_bits - table.guard_bits
    y = shift_round(y_count * table.gain.raw, bits)
    return vectoring(table, y, magnitude)[0]


def arcsin_count(table: CordicTable, y_count: IntArray, one_count: int) -> IntArray:
    """Return the arc sine of ``y_count / one_count``, clamped to +-90 deg, in half turns."""
    y = np.clip(y_count, -one_count, one_count)
    square = (one_count * one_count - y * y) << (2 * ROOT_FRACTION_BITS)
    # Exact: below 2**44 a correctly rounded root never reaches the next integer.
    x = np.sqrt(square.astype(np.float64)).astype(np.int64) << (
        table.guard_bits - ROOT_FRACTION_BITS
    )
    return vectoring(table, y << table.guard_bits, x)[0]
