"""The smoother on motion whose tilt is known, and its behaviour with bad input."""

from dataclasses import dataclass, replace

import numpy as np
import pytest
from numpy.typing import NDArray

from hostkit.attitude import inclination_rad
from hostkit.errors import DesignError, RecordingError
from hostkit.smoothing import Smoothed, SmootherSettings, smooth
from hostkit.smoothing.preintegration import preintegrate, up_of_samples
from hostkit.smoothing.rotation import chain, rotation_from_vector, vector_from_rotation
from hostkit.smoothing.settings import LOWEST
from hostkit.units import DEG_PER_RAD, RAD_PER_DEG, STANDARD_GRAVITY_M_S2

PERIOD_S = 0.01
BIAS_RAD_S = np.array((0.5, -0.3, 0.4)) * RAD_PER_DEG


@dataclass(frozen=True, slots=True, kw_only=True)
class Known:
    """An ideal sensor on a known motion, each of shape ``(N, 3)``."""

    rate: NDArray[np.float64]
    force: NDArray[np.float64]
    up: NDArray[np.float64]


def waves(rng: np.random.Generator, time: NDArray[np.float64], size: float) -> NDArray[np.float64]:
    """Three bounded curves of a few frequencies between 0.1 and 1.5 Hz."""
    hertz, phase = rng.uniform(0.1, 1.5, (4, 3)), rng.uniform(0.0, 2.0 * np.pi, (4, 3))
    return size * np.sin(2.0 * np.pi * hertz * time[:, None, None] + phase).sum(axis=1)


def known(*, seconds: float = 40.0, size_rad_s: float = 1.0, size_m: float = 0.05) -> Known:
    """A body that turns freely and swings about a place, its rates the mean of each period."""
    rng = np.random.default_rng(5)
    time = np.arange(round(seconds / PERIOD_S)) * PERIOD_S
    rate = waves(rng, time, size_rad_s)
    orientation = chain(rotation_from_vector(rate[1:] * PERIOD_S))
    place = waves(rng, time, size_m)
    acceleration = np.gradient(np.gradient(place, PERIOD_S, axis=0), PERIOD_S, axis=0)
    earth = acceleration + np.array((0.0, 0.0, STANDARD_GRAVITY_M_S2))
    return Known(rate=rate, force=np.einsum("kji,kj->ki", orientation, earth), up=orientation[:, 2])


def rmse_deg(smoothed: Smoothed, truth: NDArray[np.float64]) -> float:
    error = inclination_rad(smoothed.up, truth)
    return float(np.sqrt(np.mean(error**2))) * DEG_PER_RAD


def test_rotation_and_vector_are_inverse_of_each_other() -> None:
    vectors = np.array(((0.0, 0.0, 0.0), (1e-9, 0.0, 0.0), (0.3, -0.2, 0.1), (1.5, 1.0, -1.0)))
    matrices = rotation_from_vector(vectors)
    np.testing.assert_allclose(vector_from_rotation(matrices), vectors, atol=1e-15)
    np.testing.assert_allclose(matrices @ matrices.swapaxes(1, 2), [np.eye(3)] * 4, atol=1e-15)


def test_rotation_turns_by_the_right_hand() -> None:
    quarter = rotation_from_vector(np.array((0.0, 0.0, np.pi / 2.0)))
    np.testing.assert_allclose(quarter @ (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), atol=1e-15)


def test_tilt_and_bias_of_a_known_motion_are_found() -> None:
    motion = known()
    smoothed = smooth(motion.rate + BIAS_RAD_S, motion.force, PERIOD_S, SmootherSettings())
    assert smoothed.up.shape == motion.up.shape
    assert rmse_deg(smoothed, motion.up) < 0.05
    np.testing.assert_allclose(
        smoothed.gyro_bias_rad_s.mean(axis=0), BIAS_RAD_S, atol=0.02 * RAD_PER_DEG
    )


def test_a_bias_of_many_degrees_a_second_is_found() -> None:
    motion = known()
    large = np.array((4.5, -6.0, 5.0)) * RAD_PER_DEG
    settings = SmootherSettings(gyro_bias_rad_s=0.1)
    smoothed = smooth(motion.rate + large, motion.force, PERIOD_S, settings)
    assert rmse_deg(smoothed, motion.up) < 0.1


def test_scale_errors_are_found_where_they_may_be_large() -> None:
    motion = known(seconds=90.0, size_rad_s=2.0)
    gyro_scale, accel_scale = np.array((0.02, -0.01, 0.015)), np.array((0.03, -0.02, 0.01))
    offset = np.array((0.2, -0.3, 0.1))
    rate = motion.rate / (1.0 + gyro_scale)
    force = motion.force / (1.0 + accel_scale) + offset
    settings = SmootherSettings(gyro_scale=0.05, accel_scale=0.05, accel_offset_m_s2=0.5)
    held = smooth(rate, force, PERIOD_S, SmootherSettings())
    smoothed = smooth(rate, force, PERIOD_S, settings)
    assert rmse_deg(smoothed, motion.up) < 0.2 * rmse_deg(held, motion.up)
    np.testing.assert_allclose(smoothed.gyro_scale, gyro_scale, atol=1e-3)
    np.testing.assert_allclose(smoothed.accel_scale, accel_scale, atol=0.01)
    np.testing.assert_allclose(smoothed.accel_offset_m_s2, offset, atol=0.05)


def test_a_reading_that_comes_late_is_led() -> None:
    motion = known(size_rad_s=2.0)
    late = 2
    rate, force, up = motion.rate[:-late], motion.force[:-late], motion.up[late:]
    plain = smooth(rate, force, PERIOD_S, SmootherSettings())
    led = smooth(rate, force, PERIOD_S, SmootherSettings(lead_s=late * PERIOD_S))
    assert rmse_deg(led, up) < 0.25 * rmse_deg(plain, up)


@pytest.mark.parametrize("cut", [0, 1, 19])
def test_a_last_block_that_is_not_full_is_as_good(cut: int) -> None:
    motion = known(seconds=20.0)
    keep = slice(0, len(motion.rate) - cut)
    smoothed = smooth(motion.rate[keep], motion.force[keep], PERIOD_S, SmootherSettings())
    assert rmse_deg(smoothed, motion.up[keep]) < 0.05
    assert smoothed.node_time_s[-1] == pytest.approx((len(motion.rate) - cut - 1) * PERIOD_S)


@pytest.mark.parametrize("down", [1.0, -1.0])
def test_at_rest_and_upside_down_the_force_is_up(down: float) -> None:
    force = np.tile((0.0, 0.0, down * STANDARD_GRAVITY_M_S2), (1000, 1))
    smoothed = smooth(np.zeros((1000, 3)), force, PERIOD_S, SmootherSettings())
    np.testing.assert_allclose(smoothed.up, np.tile((0.0, 0.0, down), (1000, 1)), atol=1e-9)


def test_bad_input_is_refused() -> None:
    good, settings = np.ones((1000, 3)), SmootherSettings()
    holed = good.copy()
    holed[7, 1] = np.nan
    for rate, force, period, reason in (
        (good[:, :2], good, PERIOD_S, "not both"),
        (good[:900], good, PERIOD_S, "not both"),
        (good[:400], good[:400], PERIOD_S, "too few"),
        (good, holed, PERIOD_S, "finite"),
        (good, good, 0.0, "period"),
        (good, good, np.nan, "period"),
    ):
        with pytest.raises(RecordingError, match=reason):
            smooth(rate, force, period, settings)


@pytest.mark.parametrize("value", [0.0, -1.0, np.nan, np.inf])
def test_a_deviation_that_cannot_weigh_is_refused(value: float) -> None:
    with pytest.raises(DesignError, match="speed_m_s"):
        replace(SmootherSettings(), speed_m_s=value)


def test_a_force_of_zero_is_no_crash() -> None:
    zeros = np.zeros((1000, 3))
    smoothed = smooth(zeros, zeros, PERIOD_S, SmootherSettings())
    np.testing.assert_allclose(np.linalg.norm(smoothed.up, axis=1), 1.0)


@pytest.mark.parametrize("count", [101, 93])
def test_what_the_rates_missed_is_spread_over_the_block(count: int) -> None:
    blocks = preintegrate(np.zeros((count, 3)), np.zeros((count, 3)), PERIOD_S, 20)
    tilt_rad = 0.5 * np.arange(count) * PERIOD_S
    turned = rotation_from_vector(np.stack((tilt_rad, 0.0 * tilt_rad, 0.0 * tilt_rad), axis=1))
    at_node = np.append(np.arange(0, count - 1, 20), count - 1)
    up = up_of_samples(blocks, turned[at_node], PERIOD_S)
    np.testing.assert_allclose(up, turned[:, 2], atol=1e-3)  # a chord's sag


@pytest.mark.filterwarnings("ignore::RuntimeWarning")
def test_numbers_that_run_over_are_refused() -> None:
    force = np.full((1000, 3), 1e200)
    with pytest.raises(RecordingError, match="found no tilt"):
        smooth(np.zeros((1000, 3)), force, PERIOD_S, SmootherSettings())


@pytest.mark.parametrize(
    "name",
    [
        "gyro_noise_density_rad_s_rthz",
        "gyro_bias_walk_rad_s_rts",
        "gyro_scale",
        "accel_offset_m_s2",
        "accel_scale",
    ],
)
def test_the_smallest_deviation_holds_a_value_and_spoils_nothing(name: str) -> None:
    motion = known(seconds=100.0)
    settings = replace(SmootherSettings(), **{name: LOWEST})
    smoothed = smooth(motion.rate + BIAS_RAD_S, motion.force, PERIOD_S, settings)
    assert rmse_deg(smoothed, motion.up) < 0.05


def test_clipped_rates_are_not_believed() -> None:
    motion = known(size_rad_s=2.0)
    rate = np.clip(motion.rate, -4.0, 4.0)
    believed = smooth(rate, motion.force, PERIOD_S, SmootherSettings())
    settings = SmootherSettings(gyro_full_scale_rad_s=4.0)
    doubted = smooth(rate, motion.force, PERIOD_S, settings)
    assert rmse_deg(doubted, motion.up) < 0.5 * rmse_deg(believed, motion.up)
