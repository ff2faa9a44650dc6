"""Timing, range, rest and force of recordings of which they are known."""

from dataclasses import replace

import numpy as np
import pytest
from diagnosis_cases import Simulate, Still

from hostkit.diagnosis.clipping import reach
from hostkit.diagnosis.force import force_level
from hostkit.diagnosis.rest import rest
from hostkit.diagnosis.timing import timing
from hostkit.recordings import Recording
from hostkit.simulation import SensorErrors
from hostkit.units import RAD_PER_DEG, STANDARD_GRAVITY_M_S2

NONE = SensorErrors.none()


def test_steps_gaps_and_jitter(still: Still) -> None:
    steps = np.full(999, 0.01)
    steps[::2] += 0.001
    steps[1::2] -= 0.001
    steps[[100, 700]] = 0.5, 0.03
    found = timing(still(1000, time_s=np.concatenate(([0.0], np.cumsum(steps)))))
    assert found.gap_count == 2
    assert [gap.length_s for gap in found.gaps] == pytest.approx([0.5, 0.03])
    assert found.gaps[0].begin_s == pytest.approx(1.0, abs=0.01)
    assert found.most_s == pytest.approx(0.5)
    assert found.jitter_s == pytest.approx(0.001, rel=0.01)
    assert found.counts.sum() == 997
    assert found.counts[found.counts > 0].tolist() == [499, 498]


def test_even_steps_are_in_one_bin(still: Still) -> None:
    found = timing(still(1000, time_s=0.007 * np.arange(1000), rate_hz=1.0 / 0.007))
    assert found.counts.max() == 999
    assert found.gap_count == 0
    assert found.jitter_s < 1e-12


def test_only_the_longest_gaps_are_listed(still: Still) -> None:
    steps = np.full(999, 0.01)
    steps[::20] = 0.1 + 0.001 * np.arange(50)
    found = timing(still(1000, time_s=np.concatenate(([0.0], np.cumsum(steps)))))
    assert found.gap_count == 50
    assert [round(gap.length_s, 3) for gap in found.gaps] == [
        round(0.13 + 0.001 * k, 3) for k in range(20)
    ]


def test_clipping_names_the_range(moved: Simulate) -> None:
    recording = moved()
    limit = 250.0 * RAD_PER_DEG * 32767 / 32768
    rate = np.clip(3.0 * recording.angular_rate_rad_s, -limit, limit)
    found = reach(replace(recording, angular_rate_rad_s=rate))
    assert {c.full_scale for c in found.clippings} == {250}
    assert {c.element for c in found.clippings} == {"gyro"}
    share = {c.axis: c.share for c in found.clippings if c.value > 0.0}
    for axis, value in share.items():
        assert value == pytest.approx(np.mean(rate[:, axis] >= 0.998 * limit))
    assert max(found.largest_rad_s) == pytest.approx(limit)
    odd = reach(replace(recording, angular_rate_rad_s=np.clip(rate, -3.0, 3.0)))
    assert {c.full_scale for c in odd.clippings} == {None}
    assert reach(recording).clippings == ()


def stop_and_go(moved: Simulate) -> Recording:
    """Ten seconds of rest, ten of motion, five of rest, with a bias."""
    errors = replace(SensorErrors(), gyro_bias_rad_s=(0.01, -0.02, 0.03))
    resting, moving = moved("rest", 15.0, errors), moved("free", 10.0, errors)
    first, last = slice(0, 1000), slice(1000, 1500)
    rate, force = (
        np.concatenate((getattr(resting, n)[first], getattr(moving, n), getattr(resting, n)[last]))
        for n in ("angular_rate_rad_s", "specific_force_m_s2")
    )
    return replace(
        resting,
        time_s=np.arange(2500) / 100.0,
        angular_rate_rad_s=rate,
        specific_force_m_s2=force,
        valid=np.ones(2500, dtype=np.bool_),
        up_reference=None,
    )


def test_rest_is_where_it_is_and_shows_the_bias(moved: Simulate) -> None:
    found = rest(stop_and_go(moved))
    assert [(s.first, s.last) for s in found.stretches] == [(0, 999), (2000, 2499)]
    assert [s.duration_s for s in found.stretches] == pytest.approx([9.99, 4.99])
    assert found.share == pytest.approx(0.6)
    assert found.bias_rad_s == pytest.approx((0.01, -0.02, 0.03), abs=5e-4)
    assert found.bias_uncertainty_rad_s is not None
    assert all(1e-6 < value < 5e-4 for value in found.bias_uncertainty_rad_s)
    assert found.force_error == pytest.approx(0.02, abs=0.002)


def test_uncertainty_is_that_of_a_mean(still: Still) -> None:
    """White noise of 0.01 rad/s at 100 Hz: each axis is known to 0.01 / sqrt(60000)."""
    rng = np.random.default_rng(4)
    found = rest(still(60_000, angular_rate_rad_s=0.01 * rng.standard_normal((60_000, 3))))
    assert found.bias_uncertainty_rad_s == pytest.approx((0.01 / np.sqrt(60_000),) * 3, rel=0.15)


def test_a_long_step_parts_a_stretch(moved: Simulate) -> None:
    recording = moved("rest", 15.0)
    later = recording.time_s + np.where(np.arange(1500) >= 700, 2.0, 0.0)
    found = rest(replace(recording, time_s=later))
    assert [(s.first, s.last) for s in found.stretches] == [(0, 699), (700, 1499)]


def test_no_rest_and_one_window_are_no_rest(moved: Simulate, still: Still) -> None:
    for recording in (moved("free", 20.0), still(150), still(2)):
        found = rest(recording)
        assert found.stretches == ()
        assert found.bias_rad_s is None
        assert found.force_error is None
        assert found.force_spread == 0.0


def test_vibration_is_what_was_put_in(still: Still) -> None:
    """A sine of 30 Hz and 2 m/s^2 on x is 1.414 rms; one of 3 Hz is no vibration."""
    time_s = np.arange(5000) / 100.0
    force = np.tile((0.0, 0.0, STANDARD_GRAVITY_M_S2), (5000, 1))
    force[:, 0] = 2.0 * np.sin(2.0 * np.pi * 30.0 * time_s)
    force[:, 1] = 2.0 * np.sin(2.0 * np.pi * 3.0 * time_s)
    found = force_level(still(5000, specific_force_m_s2=force))
    assert found.vibration_m_s2 is not None
    assert found.vibration_m_s2[0] == pytest.approx(np.sqrt(2.0), rel=0.02)
    assert found.vibration_m_s2[1] < 0.01
    assert found.vibration_total_m_s2 == pytest.approx(np.sqrt(2.0), rel=0.02)


def test_slow_or_short_recordings_show_no_vibration(still: Still) -> None:
    slow = still(500, time_s=np.arange(500) / 20.0, rate_hz=20.0)
    assert force_level(slow).vibration_m_s2 is None
    assert force_level(slow).spectrum is not None
    assert force_level(still(63)).spectrum is None


def test_distance_to_one_g(still: Still) -> None:
    force = np.zeros((1000, 3))
    force[:, 2] = STANDARD_GRAVITY_M_S2 * np.concatenate((np.full(900, 1.02), np.full(100, 1.8)))
    found = force_level(still(1000, specific_force_m_s2=force))
    assert found.deviation_median_g == pytest.approx(0.02)
    assert found.deviation_percentiles_g == pytest.approx((0.02, 0.02, 0.098, 0.8, 0.8), abs=1e-3)
    assert found.counts.sum() == 1000
    assert found.counts[-1] == 100
