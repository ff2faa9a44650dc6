"""The integer arc tangent and arc sine against the exact ones, and against their stated bounds."""

import math

import numpy as np
import pytest

from hostkit.attitude import wrap_rad
from hostkit.filters.arctan import (
    GUARD_BITS,
    STRETCH_FRACTION_BITS,
    arcsin_count,
    arctan_table,
    atan2_count,
    atan2_length,
)
from hostkit.filters.arctan_bounds import arcsin_bound_rad, arctan_bound_rad
from hostkit.units import RAD_PER_HALF_TURN_LSB

TABLE = arctan_table()
LENGTHS = (100, 256, 1000, 2048, 16384, 32767)
DEMANDED_RAD = math.radians(0.0005)
EIGHTH = 2**29


def directions(length: float, seed: int = 1, samples: int = 100_000) -> np.ndarray:
    """Counts of vectors of one length or a little more, shape ``(N, 3)``."""
    vector = np.random.default_rng(seed).normal(size=(samples, 3))
    vector *= length / np.linalg.norm(vector, axis=1, keepdims=True)
    counts = np.rint(vector).astype(np.int64)
    return counts[np.linalg.norm(counts, axis=1) >= length]


def errors(length: float) -> tuple[float, float]:
    """Largest error of roll where its plane sees the length, and of pitch, rad."""
    x, y, z = directions(length).T
    roll, long, stretch = atan2_count(TABLE, y, z)
    pitch = atan2_length(TABLE, -x, long, stretch)
    off_roll = wrap_rad(roll * RAD_PER_HALF_TURN_LSB - np.arctan2(y, z))
    off_pitch = pitch * RAD_PER_HALF_TURN_LSB - np.arctan2(-x, np.hypot(y, z))
    seen = np.hypot(y, z) > 0.5 * length
    return float(np.abs(off_roll[seen]).max()), float(np.abs(off_pitch).max())


@pytest.mark.parametrize("length", LENGTHS)
def test_both_arc_tangents_keep_the_stated_bound(length: int) -> None:
    assert errors(length)[0] <= arctan_bound_rad(0.5 * length)
    assert errors(length)[1] <= arctan_bound_rad(length)


def test_the_bound_is_not_idle() -> None:
    assert arctan_bound_rad(16384) < 1.2 * errors(16384)[1]
    y = np.arange(-16384, 16385)
    off = arcsin_count(TABLE, y, 16384) * RAD_PER_HALF_TURN_LSB - np.arcsin(y / 16384)
    assert arcsin_bound_rad(16384) < 2.0 * np.abs(off).max()


@pytest.mark.parametrize("length", [length for length in LENGTHS if length >= 1000])
def test_from_1000_counts_on_the_error_is_below_the_demand(length: int) -> None:
    assert max(errors(length)) < DEMANDED_RAD
    assert arctan_bound_rad(length) < DEMANDED_RAD


@pytest.mark.parametrize("one_count", [2048, 4096, 8192, 16384])
def test_the_arc_sine_of_every_count_keeps_the_stated_bound_and_the_demand(one_count: int) -> None:
    y = np.arange(-one_count - 2, one_count + 3)
    exact = np.arcsin(np.clip(y / one_count, -1.0, 1.0))
    off = np.abs(arcsin_count(TABLE, y, one_count) * RAD_PER_HALF_TURN_LSB - exact).max()
    assert off <= arcsin_bound_rad(one_count) < DEMANDED_RAD


def test_lengths_carry_their_stretch() -> None:
    x, y, _ = directions(20000).T
    _, length, stretch = atan2_count(TABLE, y, x)
    got = length / 2.0**GUARD_BITS / (1.0 + stretch / 2.0**STRETCH_FRACTION_BITS)
    off = np.abs(got / np.hypot(x, y) - 1.0)
    assert off[np.hypot(x, y) > 1000].max() < 4e-6


@pytest.mark.parametrize("size", [1, 100, 32767, 32768])
def test_the_axes_are_exact(size: int) -> None:
    y, x = np.array([0, size, 0, -size]), np.array([size, 0, -size, 0])
    angle = atan2_count(TABLE, y, x)[0]
    assert angle.tolist() == [0, 2 * EIGHTH, -4 * EIGHTH, -2 * EIGHTH]


@pytest.mark.parametrize("size", [1, 100, 32767, 32768])
def test_equal_components_are_half_way(size: int) -> None:
    angle = atan2_count(TABLE, np.array([size, -size]), np.array([size, -size]))[0]
    assert np.abs(angle - [EIGHTH, -3 * EIGHTH]).max() * RAD_PER_HALF_TURN_LSB < 2e-6


def test_a_zero_vector_has_neither_angle_nor_length() -> None:
    angle, length, stretch = atan2_count(TABLE, np.array([0]), np.array([0]))
    assert (angle[0], length[0]) == (0, 0)
    assert atan2_length(TABLE, np.array([0]), length, stretch)[0] == 0
    assert atan2_length(TABLE, np.array([-5]), length, stretch)[0] == -2 * EIGHTH


def test_mirrored_vectors_have_mirrored_angles() -> None:
    x, y, _ = directions(3000, samples=5000).T
    angle = atan2_count(TABLE, y, x)[0]
    off_axis = (y != 0) & (x != 0)
    np.testing.assert_array_equal(atan2_count(TABLE, -y, x)[0][off_axis], -angle[off_axis])
    swapped = atan2_count(TABLE, np.abs(x), np.abs(y))[0]
    plain = atan2_count(TABLE, np.abs(y), np.abs(x))[0]
    unequal = np.abs(x) != np.abs(y)
    np.testing.assert_array_equal((swapped + plain)[unequal], 2 * EIGHTH)


def test_no_word_leaves_its_bits_at_the_extremes() -> None:
    """30 bits for the components of both passes; the C and VHDL rely on it."""
    edges = np.array([-32768, -32767, 32767])
    y, x = (part.ravel() for part in np.meshgrid(edges, edges))
    rng = np.random.default_rng(3)
    y = np.append(y, rng.integers(-32768, 32768, 50_000))
    x = np.append(x, np.full(50_000, -32768))
    _, length, stretch = atan2_count(TABLE, y, x)
    assert length.max() < 2**30
    assert 32768 * int(stretch.max()) < 2**32
    assert (32768 << GUARD_BITS) + ((32768 * int(stretch.max())) >> 4) < 2**30
