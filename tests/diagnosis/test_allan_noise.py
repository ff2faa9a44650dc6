"""The figures of noise: of made-up signals, of the simulation and of a real sensor."""

import sys
from dataclasses import replace

import numpy as np
import pytest
from diagnosis_cases import SENSOR, Simulate, Still

from hostkit.diagnosis import sensor_noise
from hostkit.diagnosis.allan import allan_curve, overlapping_deviation
from hostkit.diagnosis.noise import SensorNoise
from hostkit.diagnosis.rest import RestStretch, rest
from hostkit.errors import ToolMissingError
from hostkit.recordings import Recording
from hostkit.simulation import SensorErrors
from hostkit.units import DEG_PER_RAD, RAD_PER_DEG

NONE = SensorErrors.none()
GYRO = (0.004 * RAD_PER_DEG, 0.006 * RAD_PER_DEG, 0.009 * RAD_PER_DEG)
ACCEL = (0.003, 0.004, 0.006)


def stretch(first: int, last: int) -> RestStretch:
    return RestStretch(
        first=first,
        last=last,
        begin_s=first / 100.0,
        end_s=last / 100.0,
        bias_rad_s=(0.0, 0.0, 0.0),
        force_m_s2=9.8,
    )


def noise_of(recording: Recording) -> SensorNoise:
    noise = sensor_noise(recording, rest(recording))
    assert noise is not None
    return noise


def test_white_noise() -> None:
    """Standard deviation s at 100 Hz: deviation s / sqrt(m), one-sided density s / sqrt(50)."""
    values = np.random.default_rng(1).standard_normal((40_000, 3)) * (1.0, 2.0, 5.0)
    curve = allan_curve(values, (stretch(0, 39_999),), 0.01, overlapping_deviation())
    lengths = np.round(curve.tau_s / 0.01)
    known = curve.intervals > 100.0
    expected = np.array((1.0, 2.0, 5.0)) / np.sqrt(lengths[known])[:, None]
    np.testing.assert_allclose(curve.deviation[known], expected, rtol=0.15)
    assert curve.noise_density == pytest.approx(
        tuple(np.array((1.0, 2.0, 5.0)) / np.sqrt(50.0)), rel=0.03
    )
    assert curve.white_noise[0] == pytest.approx(0.1, rel=0.03)
    assert curve.random_walk == (None, None, None)
    assert curve.bias_instability == (None, None, None)


def test_random_walk() -> None:
    """Steps of 0.01 at 100 Hz are 0.1 per root second; a little white noise lies under them."""
    rng = np.random.default_rng(2)
    values = np.cumsum(0.01 * rng.standard_normal((40_000, 3)), axis=0)
    values += 0.5 * rng.standard_normal((40_000, 3))
    curve = allan_curve(values, (stretch(0, 39_999),), 0.01, overlapping_deviation())
    for found in curve.random_walk:
        assert found == pytest.approx(0.1, rel=0.3)
    for found in curve.bias_instability:
        assert found is not None


def test_stretches_are_pooled() -> None:
    """A jump between two stretches is in neither; the intervals of both count."""
    values = np.random.default_rng(3).standard_normal((20_000, 3))
    values[10_000:] += 100.0
    both = allan_curve(
        values, (stretch(0, 9_999), stretch(10_000, 19_999)), 0.01, overlapping_deviation()
    )
    one = allan_curve(values, (stretch(0, 9_999),), 0.01, overlapping_deviation())
    np.testing.assert_array_equal(both.intervals, 2.0 * one.intervals)
    np.testing.assert_allclose(both.deviation[0], 1.0, rtol=0.03)
    unequal = allan_curve(
        values, (stretch(0, 9_999), stretch(10_000, 10_399)), 0.01, overlapping_deviation()
    )
    assert len(unequal.tau_s) == len(one.tau_s)
    np.testing.assert_array_equal(unequal.deviation[-1], one.deviation[-1])


def test_bottom_is_the_bias_instability() -> None:
    """White noise N over a walk K: the bottom is at sqrt(3) N / K, its square 2 N K / sqrt(3)."""
    rng = np.random.default_rng(5)
    values = rng.standard_normal((60_000, 3))
    values += np.cumsum(0.002 * rng.standard_normal((60_000, 3)), axis=0)
    curve = allan_curve(values, (stretch(0, 59_999),), 0.01, overlapping_deviation())
    bottom = np.sqrt(2.0 * 0.1 * 0.02 / np.sqrt(3.0))
    for found in curve.bias_instability:
        assert found == pytest.approx(bottom / np.sqrt(2.0 * np.log(2.0) / np.pi), rel=0.15)


def test_signals_without_noise_have_no_figures(still: Still) -> None:
    noise = noise_of(still(5000))
    for curve in (noise.gyro, noise.accel):
        assert curve.noise_density == (None, None, None)
        assert curve.bias_instability == (None, None, None)
        assert curve.random_walk == (None, None, None)
        assert not curve.deviation.any()


def test_short_rest_has_no_noise(moved: Simulate) -> None:
    recording = moved("rest", 25.0)
    assert sensor_noise(recording, rest(recording)) is None


def test_missing_library_is_named(moved: Simulate, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "allantools", None)
    recording = moved("rest", 60.0)
    with pytest.raises(ToolMissingError, match=r"pip install 'hostkit\[allan\]'"):
        sensor_noise(recording, rest(recording))


def test_simulated_sensor_has_the_noise_of_its_data_sheet(moved: Simulate) -> None:
    noise = noise_of(moved("rest", 300.0))
    for found in noise.gyro.noise_density:
        assert found == pytest.approx(0.005 * RAD_PER_DEG, rel=0.07)
    for found in noise.accel.noise_density:
        assert found == pytest.approx(400e-6 * 9.80665, rel=0.07)
    for found in noise.gyro.random_walk:
        assert found == pytest.approx(0.003 * RAD_PER_DEG, rel=0.35)
    assert noise.samples == 30_000
    assert noise.rate_hz == pytest.approx(100.0)


@pytest.mark.parametrize("setting", [1, 3])
def test_measured_densities_come_out_of_the_samples(moved: Simulate, setting: int) -> None:
    """At setting 1 the filter lets 188 Hz through: folded at 100 Hz, and counted as it is."""
    errors = replace(
        NONE,
        noise=1.0,
        low_pass=True,
        gyro_noise_density_rad_s_rthz=GYRO,
        accel_noise_density_m_s2_rthz=ACCEL,
    )
    noise = noise_of(moved("rest", 200.0, errors, replace(SENSOR, low_pass_setting=setting)))
    assert noise.gyro.noise_density == pytest.approx(GYRO, rel=0.06)
    assert noise.accel.noise_density == pytest.approx(ACCEL, rel=0.06)


def test_measured_densities_without_the_low_pass(moved: Simulate) -> None:
    errors = replace(NONE, noise=1.0, gyro_noise_density_rad_s_rthz=GYRO)
    noise = noise_of(moved("rest", 100.0, errors))
    assert noise.gyro.noise_density == pytest.approx(GYRO, rel=0.08)


def test_walk_per_axis(moved: Simulate) -> None:
    walk = (0.0, 0.02, 0.05)
    errors = replace(NONE, gyro_bias_walk_rad_s_rts=walk)
    ends = [moved("rest", 20.0, errors, SENSOR, seed).angular_rate_rad_s[-1] for seed in range(40)]
    np.testing.assert_allclose(np.std(ends, axis=0), np.array(walk) * np.sqrt(20.0), rtol=0.3)


def test_real_sensor_at_rest(mpu6050_at_rest: Recording) -> None:
    """Bursty time stamps, 4.5 deg/s of bias; deviations at 1 s known from elsewhere."""
    at_rest = rest(mpu6050_at_rest)
    noise = noise_of(mpu6050_at_rest)
    at_one_s = [
        np.exp(np.interp(0.0, np.log(noise.gyro.tau_s), np.log(noise.gyro.deviation[:, axis])))
        for axis in range(3)
    ]
    expected = np.array((0.0128, 0.0091, 0.0092))
    np.testing.assert_allclose(np.array(at_one_s) * DEG_PER_RAD, expected, rtol=0.02)
    assert at_rest.share > 0.99
    assert at_rest.bias_rad_s is not None
    np.testing.assert_allclose(
        np.array(at_rest.bias_rad_s) * DEG_PER_RAD, (-4.535, 0.047, 1.122), atol=0.003
    )
    assert at_rest.force_error == pytest.approx(0.037, abs=0.001)
    assert noise.gyro.noise_density[0] == pytest.approx(0.0179 * RAD_PER_DEG, rel=0.02)
    bottom = noise.gyro.bias_instability[0]
    assert bottom is not None
    assert bottom * 0.664 * DEG_PER_RAD == pytest.approx(2.8e-3, rel=0.02)
