"""Bit-true model of the rectangular-to-polar core: angle, arc sine and magnitude of counts.

The angle is that of :mod:`hostkit.filters.arctan`, digit by digit. Its length is longer than the
vector by the stretch of the turn, ``sqrt(1 + (turn / 64)**2)``, which one product takes off again::

    magnitude = length - floor(length * shrink / 2**18)

Against the exact values, for whole counts: the angle of any vector but zero is within
``ANGLE_ERROR_DEG``. An arc sine is within ``ARCSIN_ERROR_DEG`` where 1 g is ``ARCSIN_LEAST_ONE``
counts or more. It is ill-conditioned next to +-90 deg, where it is the angle of a small root whose
unit is 1/256 count: with fewer counts in 1 g the error there grows, to 0.023 deg where 1 g is 2
counts. A magnitude is within ``MAGNITUDE_RELATIVE`` of itself and ``MAGNITUDE_COUNTS``.
"""

import math

import numpy as np
from numpy.typing import NDArray

from hostkit.filters.arctan import (
    GUARD_BITS,
    ROOT_FRACTION_BITS,
    STRETCH_FRACTION_BITS,
    vector_angle,
)
from hostkit.fixedpoint import wrap32
from hostkit.spec import ArctanTable

SIZE_LIMIT = 2**15
"""Largest size of a component; what is beyond is taken as this."""

ONE_LIMIT = 2**15 - 1
"""Largest count of 1 g in an arc sine; its square has 30 bits."""

ANGLE_ERROR_DEG = 0.0001
ARCSIN_ERROR_DEG = 0.0005
ARCSIN_LEAST_ONE = 512
MAGNITUDE_RELATIVE = 4e-6
MAGNITUDE_COUNTS = 0.001

IntArray = NDArray[np.int64]


def shrinks_raw(table: ArctanTable) -> tuple[int, ...]:
    """Return what a length loses with its stretch, for each turn, STRETCH_FRACTION_BITS."""
    turns = len(table.angles_raw)
    return tuple(
        round((1.0 - 1.0 / math.hypot(1.0, turn / turns)) * 2**STRETCH_FRACTION_BITS)
        for turn in range(turns)
    )


def polar_atan2(table: ArctanTable, y: IntArray, x: IntArray) -> tuple[IntArray, IntArray]:
    """Return the angle and the magnitude of vectors.

    Parameters
    ----------
    table
        Constants of the arc tangent.
    y, x
        Components, counts of 17 bits, shape ``(N,)``.

    Returns
    -------
    angle_raw, magnitude_raw
        Angle in half turns, signed 32 bit; magnitude in counts with GUARD_BITS fraction bits.
    """
    sizes = [np.minimum(np.abs(part), SIZE_LIMIT) << GUARD_BITS for part in (y, x)]
    angle, magnitude = _angle_and_magnitude(table, *sizes)
    angle = np.where(x < 0, 2**31 - angle, angle)
    angle = np.where((y == 0) & (x == 0), 0, angle)
    return wrap32(np.where(y < 0, -angle, angle)), magnitude


def polar_arcsin(table: ArctanTable, y: IntArray, one: IntArray) -> tuple[IntArray, IntArray]:
    """Return the arc sine of ``y / one``, and the magnitude of the vector it is the angle of.

    Parameters
    ----------
    y, one
        A component and the count of 1 g, counts of 17 bits, shape ``(N,)``. The size of `one` is
        taken, and `y` is clamped to it.

    Returns
    -------
    angle_raw, magnitude_raw
        As :func:`polar_atan2` gives them; the magnitude is 1 g again.
    """
    unit = np.minimum(np.abs(one), ONE_LIMIT)
    size = np.minimum(np.abs(y), unit)
    square = (unit * unit - size * size) << (2 * ROOT_FRACTION_BITS)
    # Exact: below 2**46 a correctly rounded root never reaches the next integer.
    root = np.sqrt(square.astype(np.float64)).astype(np.int64)
    x = root << (GUARD_BITS - ROOT_FRACTION_BITS)
    angle, magnitude = _angle_and_magnitude(table, size << GUARD_BITS, x)
    return wrap32(np.where(y < 0, -angle, angle)), magnitude


def _angle_and_magnitude(table: ArctanTable, y: IntArray, x: IntArray) -> tuple[IntArray, IntArray]:
    angle, length, stretch = vector_angle(table, y, x)
    shrink = np.array(shrinks_raw(table))[np.searchsorted(table.stretches_raw, stretch)]
    return angle, length - ((length * shrink) >> STRETCH_FRACTION_BITS)
