import math
from dataclasses import replace

import numpy as np
import pytest
from designs import design

from hostkit.attitude import up_from_tilt, wrap_rad
from hostkit.errors import DesignError, FormatError
from hostkit.filters.complementary import (
    LEAST_FORCE_G,
    crossover_hz,
    eta_from_tau,
    lower,
    measured_tilt_rad,
    measured_tilt_raw,
    parameters,
    run_float,
    run_integer,
    step_integer,
    tau_from_eta,
)
from hostkit.mounting import Mounting
from hostkit.records import Parameter
from hostkit.sensors import SENSORS
from hostkit.sensors.counts import to_counts, to_rate_and_force_g
from hostkit.units import RAD_PER_HALF_TURN_LSB, STANDARD_GRAVITY_M_S2

PART = SENSORS["mpu6050"]


def degrees(raw: np.ndarray) -> np.ndarray:
    return np.degrees(raw * RAD_PER_HALF_TURN_LSB)


def test_eta_and_tau_are_inverse_and_the_papers() -> None:
    assert eta_from_tau(0.7, 1.0) == pytest.approx(0.4118, abs=1e-4)
    assert eta_from_tau(0.8, 1.0) == pytest.approx(0.4444, abs=1e-4)
    assert tau_from_eta(eta_from_tau(2.5, 0.01), 0.01) == pytest.approx(2.5)
    assert crossover_hz(eta_from_tau(1.0, 0.01), 0.01) == pytest.approx(1 / (2 * math.pi))


@pytest.mark.parametrize("axis", ["roll", "pitch"])
@pytest.mark.parametrize("method", ["atan2", "arcsin"])
def test_integer_tilt_is_close_to_the_exact_one(axis: str, method: str) -> None:
    d = design(axes=axis, tilt=method)
    rng = np.random.default_rng(7)
    counts = rng.integers(-32768, 32768, (100_000, 3))
    counts = counts[np.linalg.norm(counts, axis=1) > 16384 * LEAST_FORCE_G]
    raw = measured_tilt_raw(lower(d), counts)[:, 0]
    exact = measured_tilt_rad(axis, method, counts / 16384.0)
    error = wrap_rad(raw * RAD_PER_HALF_TURN_LSB - exact)
    assert np.degrees(np.abs(error)).max() < 0.0005


def test_zero_vector_and_corners_are_defined() -> None:
    spec = lower(design())
    corners = np.array([[0, 0, 0], [-32768, 0, 0], [0, -32768, 0], [0, 0, -32768]])
    angle = degrees(measured_tilt_raw(spec, corners))
    assert angle[0].tolist() == [0.0, 0.0]
    assert angle[1] == pytest.approx([0.0, 90.0], abs=1e-3)
    assert angle[2] == pytest.approx([-90.0, 0.0], abs=1e-3)
    assert abs(angle[3]) == pytest.approx([180.0, 0.0], abs=1e-3)


def test_first_sample_loads_the_measured_tilt() -> None:
    d, count = design(), np.array([[1000, 2000, 16000]])
    raw = run_integer(lower(d), count, np.array([[30000, 30000, 0]]))
    np.testing.assert_array_equal(raw, measured_tilt_raw(lower(d), count))


def rotating(rate_deg_s: float, samples: int, d) -> tuple[np.ndarray, np.ndarray]:
    """Body rates and specific force of a steady roll from 170 deg on."""
    rate = np.zeros((samples, 3))
    rate[:, 0] = math.radians(rate_deg_s)
    roll = math.radians(170) + rate[:, 0] * d.period_s * np.arange(samples)
    return rate, up_from_tilt(roll, np.zeros(samples)) * STANDARD_GRAVITY_M_S2


@pytest.mark.parametrize("rate_deg_s", [90.0, -90.0])
def test_angles_wrap_at_180_deg(rate_deg_s: float) -> None:
    d = design(axes="roll")
    rate, force = rotating(rate_deg_s, 1500, d)
    counts = to_counts(PART, d.sensor, rate, force)
    exact = run_float(d, *to_rate_and_force_g(PART, d.sensor, counts))
    raw = run_integer(lower(d), counts.accel, counts.gyro)
    truth = 170 + rate_deg_s * d.period_s * np.arange(1500)
    for angle in (np.degrees(exact[:, 0]), degrees(raw[:, 0])):
        assert np.abs((angle - truth + 180) % 360 - 180).max() < 0.05
        assert np.abs(angle).max() > 179


@pytest.mark.parametrize(
    ("axes", "tilt", "mounting", "eta", "rate_hz"),
    [
        ("both", "atan2", "+x+y+z", 0.9965, 100.0),
        ("roll", "atan2", "+z+x+y", 0.9999, 500.0),
        ("pitch", "arcsin", "-y-x-z", 0.98, 250.0),
        ("both", "arcsin", "+x+y+z", 0.412, 20.0),
    ],
)
def test_integer_stays_within_the_stated_bound_of_float(axes, tilt, mounting, eta, rate_hz) -> None:
    d = design(axes=axes, tilt=tilt, mounting=mounting, eta=eta, rate_hz=rate_hz)
    spec, rng = lower(d), np.random.default_rng(3)
    smooth = np.cumsum(rng.normal(0, 0.01, (5000, 2)), axis=0)
    force = up_from_tilt(smooth[:, 0], 0.5 * smooth[:, 1]) + rng.normal(0, 0.02, (5000, 3))
    rate = rng.normal(0, 1.5, (5000, 3))
    counts = to_counts(PART, d.sensor, rate, force * STANDARD_GRAVITY_M_S2)
    raw = run_integer(spec, counts.accel, counts.gyro)
    exact = run_float(d, *to_rate_and_force_g(PART, d.sensor, counts))
    error = np.abs(wrap_rad(raw * RAD_PER_HALF_TURN_LSB - exact)).max()
    assert error <= spec.error_bound_rad


def test_mounting_turns_the_sensor_not_the_answer() -> None:
    """A sensor that is mounted turned, with its mounting named, gives the body's angles."""
    rng = np.random.default_rng(5)
    accel, gyro = rng.integers(-20000, 20000, (2, 50, 3))
    plain = run_integer(lower(design()), accel, gyro)
    for mounting in Mounting.all():
        turned_accel, turned_gyro = np.empty_like(accel), np.empty_like(gyro)
        for body, (source, sign) in enumerate(zip(mounting.source, mounting.sign, strict=True)):
            turned_accel[:, source] = sign * accel[:, body]
            turned_gyro[:, source] = sign * gyro[:, body]
        spec = lower(design(mounting=str(mounting)))
        np.testing.assert_array_equal(run_integer(spec, turned_accel, turned_gyro), plain)


def test_single_steps_make_up_the_run() -> None:
    rng, spec = np.random.default_rng(1), lower(design())
    accel, gyro = rng.integers(-32768, 32768, (2, 500, 3))
    run = run_integer(spec, accel, gyro)
    np.testing.assert_array_equal(step_integer(spec, run[:-1], accel[1:], gyro[1:]), run[1:])


@pytest.mark.parametrize("eta", [0.0, 1.0, -0.1, 1.5, 1.0 - 1e-8])
def test_impossible_eta_is_refused(eta: float) -> None:
    with pytest.raises(DesignError, match="eta"):
        lower(design(eta=eta))


def test_half_a_turn_per_sample_is_refused_with_the_numbers() -> None:
    with pytest.raises(FormatError, match="200 deg per sample; the limit is 180"):
        lower(design(rate_hz=10.0, gyro_full_scale_deg_s=2000))


def test_rate_gain_at_its_limit_is_lowered_or_refused() -> None:
    limit_hz = 2000 / 180
    with pytest.raises(FormatError, match="limit is 180"):
        lower(design(rate_hz=limit_hz * (1 + 2e-6), gyro_full_scale_deg_s=2000))
    spec = lower(design(rate_hz=limit_hz * 1.001, gyro_full_scale_deg_s=2000))
    assert [gain.format.fraction_bits for gain in spec.rate_gains] == [1, 1]


def test_parameter_that_the_filter_does_not_have_is_refused() -> None:
    more = (*parameters(0.97), Parameter(name="beta", value=1.0, unit="1"))
    with pytest.raises(DesignError, match="beta"):
        lower(replace(design(), parameters=more))
