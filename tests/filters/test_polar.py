"""Angle, arc sine and magnitude of the polar core against the exact ones."""

import math

import numpy as np
import pytest

from hostkit.attitude import wrap_rad
from hostkit.filters.arctan import GUARD_BITS, arcsin_count, arctan_table, atan2_count
from hostkit.filters.polar import (
    ANGLE_ERROR_DEG,
    ARCSIN_ERROR_DEG,
    ARCSIN_LEAST_ONE,
    MAGNITUDE_COUNTS,
    MAGNITUDE_RELATIVE,
    ONE_LIMIT,
    SIZE_LIMIT,
    polar_arcsin,
    polar_atan2,
)
from hostkit.units import RAD_PER_HALF_TURN_LSB

TABLE = arctan_table()


def vectors(largest: int) -> tuple[np.ndarray, np.ndarray]:
    """All vectors of small components, or many of larger ones, and those on the axes."""
    if largest <= 100:
        y, x = np.mgrid[-largest : largest + 1, -largest : largest + 1].reshape(2, -1)
    else:
        y, x = np.random.default_rng(largest).integers(-largest, largest + 1, (2, 300_000))
        y[:1000], x[1000:2000] = 0, 0
    nonzero = (y != 0) | (x != 0)
    return y[nonzero], x[nonzero]


def arcsin_error_deg(one: int) -> float:
    y = np.arange(-one, one + 1)
    angle = polar_arcsin(TABLE, y, np.full_like(y, one))[0]
    return math.degrees(np.abs(angle * RAD_PER_HALF_TURN_LSB - np.arcsin(y / one)).max())


@pytest.mark.parametrize("largest", [3, 100, 1000, 16384, SIZE_LIMIT])
def test_angle_and_magnitude_keep_their_stated_errors(largest: int) -> None:
    y, x = vectors(largest)
    angle, magnitude = polar_atan2(TABLE, y, x)
    off = np.abs(wrap_rad(angle * RAD_PER_HALF_TURN_LSB - np.arctan2(y, x)))
    assert math.degrees(off.max()) < ANGLE_ERROR_DEG
    exact = np.hypot(x, y)
    lost = np.abs(magnitude / 2.0**GUARD_BITS - exact)
    assert (lost <= MAGNITUDE_RELATIVE * exact + MAGNITUDE_COUNTS).all()
    assert magnitude.max() < 2**30


def test_the_stated_errors_are_not_idle() -> None:
    y, x = vectors(SIZE_LIMIT)
    angle, magnitude = polar_atan2(TABLE, y, x)
    off = np.abs(wrap_rad(angle * RAD_PER_HALF_TURN_LSB - np.arctan2(y, x)))
    assert math.degrees(off.max()) > 0.5 * ANGLE_ERROR_DEG
    lost = np.abs(magnitude / 2.0**GUARD_BITS / np.hypot(x, y) - 1.0)[np.hypot(x, y) > 10_000]
    assert lost.max() > 0.5 * MAGNITUDE_RELATIVE
    assert arcsin_error_deg(ARCSIN_LEAST_ONE) > 0.5 * ARCSIN_ERROR_DEG


@pytest.mark.parametrize("one", [ARCSIN_LEAST_ONE, 1000, 2048, 4096, 8192, 16384, ONE_LIMIT])
def test_the_arc_sine_of_every_count_keeps_its_stated_error(one: int) -> None:
    assert arcsin_error_deg(one) < ARCSIN_ERROR_DEG


def test_with_few_counts_in_1_g_the_arc_sine_is_worse_next_to_90_deg() -> None:
    """The root there is small and has whole 1/256 counts only."""
    errors = [arcsin_error_deg(one) for one in range(1, ARCSIN_LEAST_ONE)]
    assert ARCSIN_ERROR_DEG < max(errors) < 0.023


def test_the_core_is_the_filter_s_arc_tangent_and_arc_sine() -> None:
    y, x = np.random.default_rng(1).integers(-(2**15), 2**15 + 1, (2, 20_000))
    np.testing.assert_array_equal(polar_atan2(TABLE, y, x)[0], atan2_count(TABLE, y, x)[0])
    sine = polar_arcsin(TABLE, y, np.full_like(y, 16384))[0]
    np.testing.assert_array_equal(sine, arcsin_count(TABLE, y, 16384))


def test_components_are_limited() -> None:
    y, x = np.array([65535, -65536, -65536, 5]), np.array([65535, 65535, 7, -65536])
    near = np.clip(y, -SIZE_LIMIT, SIZE_LIMIT), np.clip(x, -SIZE_LIMIT, SIZE_LIMIT)
    np.testing.assert_array_equal(polar_atan2(TABLE, y, x), polar_atan2(TABLE, *near))
    one = np.full_like(y, 300)
    above = polar_arcsin(TABLE, np.array([301, 65535, -301, -65536]), one)[0]
    assert above.tolist() == [2**30, 2**30, -(2**30), -(2**30)]


def test_a_zero_vector_has_neither_angle_nor_magnitude() -> None:
    zero = np.array([0])
    for found in (polar_atan2(TABLE, zero, zero), polar_arcsin(TABLE, np.array([9]), zero)):
        assert [part.tolist() for part in found] == [[0], [0]]
