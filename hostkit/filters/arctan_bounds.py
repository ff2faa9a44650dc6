"""How far the integer arc tangent and arc sine can be from the exact ones."""

import math

from hostkit.filters.arctan import (
    RATIO_LIMIT,
    ROOT_FRACTION_BITS,
    STRETCH_FRACTION_BITS,
    arctan_table,
)
from hostkit.units import RAD_PER_HALF_TURN_LSB

ALONG_UNITS = 4 * 63
"""Largest error of ``along``, in its units: a turn times four times the bits that y loses."""

LENGTH_UNITS = 16
"""The same of a length: eight units for each of two truncations, of ``along`` and the product."""

FINE_RATIO = 2.0**-14
"""Unit of the ratio with which a length is corrected."""


def arctan_bound_rad(least_count: float) -> float:
    """Return the largest error of an angle from two or three components, rad.

    Parameters
    ----------
    least_count
        Length of the shortest vector, counts.
    """
    table = arctan_table()
    unit = 1.0 / (least_count * 2.0**table.guard_bits)
    stretch = math.ldexp(1.0, -STRETCH_FRACTION_BITS - 1)
    fine = 0.5 * RATIO_LIMIT * FINE_RATIO
    relative = stretch + fine + RATIO_LIMIT**4 / 8.0
    # An error of a length turns a vector by half its relative size at most: sin x cos x.
    return (
        _line_error_rad() + 0.5 * relative + (LENGTH_UNITS + 1 + RATIO_LIMIT * ALONG_UNITS) * unit
    )


def arcsin_bound_rad(one_count: float) -> float:
    """Return the largest error of an arc sine of counts over `one_count`, rad."""
    root = math.ldexp(1.0, -ROOT_FRACTION_BITS) / one_count
    unit = 1.0 / (one_count * 2.0 ** arctan_table().guard_bits)
    return _line_error_rad() + root + RATIO_LIMIT * ALONG_UNITS * unit


def _line_error_rad() -> float:
    """Return the error of the last part: the line, the digits of the ratio, two roundings."""
    table = arctan_table()
    slope = table.slope.quantised / table.slope.real * (1.0 - RATIO_LIMIT**2 / 4.0)
    ends = math.sqrt(1.0 / slope - 1.0), RATIO_LIMIT
    line = max(abs(math.atan(ratio) - slope * ratio) for ratio in ends)
    digits = math.ldexp(RATIO_LIMIT, -table.ratio_digits)
    roundings: float = 2.0 * RAD_PER_HALF_TURN_LSB
    return line + digits + roundings
