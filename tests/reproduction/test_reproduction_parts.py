"""The parts of the reproduction, each against a plain computation."""

import math

import numpy as np
import pytest

from hostkit.optimisers import qpso
from hostkit.reproduction.errors import (
    Groups,
    errors_rad,
    eta_of,
    first_samples,
    groups_of,
    training_cost_rad,
)
from hostkit.reproduction.errors import test_rmse_rad as rmse_of_test_samples
from hostkit.reproduction.frequency import SensorErrorSweep, sweep_cycles, sweep_time
from hostkit.reproduction.optimum import TAU_BOUNDS_S, find_optima, pooled_cost, tau_cost
from hostkit.reproduction.results import AcceptanceRow
from hostkit.reproduction.signals import FAST, SLOW, Logs, simulate_logs
from hostkit.reproduction.study import compare_weights
from hostkit.reproduction.trials import (
    Setting,
    Trial,
    grid_brent_excess_rad,
    prepare,
    run_trial,
)

PAPER = Setting(name="qpso", rule=qpso.rule(), log_tau=False, bounce=False)


@pytest.fixture(scope="module")
def logs() -> Logs:
    return simulate_logs(SLOW, 3, np.random.default_rng(1))


def filtered(logs: Logs, log: int, first: int, samples: int, eta: float) -> np.ndarray:
    """Equation 4 as it stands, minus the truth."""
    measured, rate, tilt = (
        array[log, first : first + samples]
        for array in (logs.measured_tilt_rad, logs.rate_rad_s, logs.tilt_rad)
    )
    theta = [measured[0]]
    for k in range(1, samples):
        theta.append(eta * (theta[-1] + rate[k] * logs.period_s) + (1 - eta) * measured[k])
    return np.array(theta) - tilt


@pytest.mark.parametrize("eta", [0.02, 0.412, 0.99])
def test_error_form_is_the_filter(logs: Logs, eta: float) -> None:
    groups = groups_of(logs)
    assert len(groups) == 30
    error = filtered(logs, 1, 60, 30, eta)
    every = np.full(30, eta)
    np.testing.assert_allclose(errors_rad(groups, every)[12], error, atol=1e-13)
    cost = training_cost_rad(groups, np.full((30, 2), eta))
    np.testing.assert_allclose(cost[12], np.mean(np.abs(error[:20])), atol=1e-14)
    rmse = np.sqrt(np.mean(error[20:] ** 2))
    assert rmse_of_test_samples(groups, every)[12] == pytest.approx(rmse, rel=1e-12)
    start = first_samples(logs, 35).one(2)
    np.testing.assert_allclose(
        errors_rad(start, np.array([eta]))[0], filtered(logs, 2, 0, 35, eta), atol=1e-13
    )


def test_optimum_is_that_of_a_denser_grid(logs: Logs) -> None:
    groups = groups_of(logs)
    optima = find_optima(tau_cost(groups), len(groups))
    dense = np.tile(np.geomspace(*TAU_BOUNDS_S, 40_001), (len(groups), 1))
    lowest = tau_cost(groups)(dense).min(axis=1)
    assert (optima.cost_rad <= lowest).all()
    assert (optima.cost_rad >= lowest - 1e-6).all()
    at_tau = tau_cost(groups)(optima.tau_s[:, np.newaxis])[:, 0]
    np.testing.assert_allclose(at_tau, optima.cost_rad, rtol=1e-12)


def test_optimum_counts_its_valleys_and_takes_the_lowest() -> None:
    def two_valleys(tau_s: np.ndarray) -> np.ndarray:
        x = np.log(tau_s)
        return np.minimum(np.abs(x + 1.0) + 0.1, 3.0 * np.abs(x - 2.0))

    optima = find_optima(two_valleys, 1)
    assert optima.valleys.tolist() == [2]
    assert optima.tau_s[0] == pytest.approx(math.exp(2.0), rel=1e-7)


def test_pooled_cost_is_the_mean_over_ten_groups_of_a_log(logs: Logs) -> None:
    groups = groups_of(logs)
    tau_s = np.array([[0.5, 2.0]] * 3)
    single = tau_cost(groups)(np.repeat(tau_s, 10, axis=0))
    np.testing.assert_allclose(pooled_cost(groups, 10)(tau_s)[1], single[10:20].mean(axis=0))


def test_simulated_signals_are_those_that_are_stated() -> None:
    slow = simulate_logs(SLOW, 200, np.random.default_rng(1))
    assert np.sqrt(np.mean(slow.tilt_rad**2)) == pytest.approx(math.radians(20.0), rel=0.05)
    spectrum = np.abs(np.fft.rfft(slow.tilt_rad * np.hanning(300))) ** 2
    above = np.fft.rfftfreq(300, slow.period_s) > 0.03
    assert spectrum[:, above].sum() < 1e-4 * spectrum.sum()
    true_rate = np.gradient(slow.tilt_rad, slow.period_s, axis=1)[:, 1:-1]
    offset = np.mean(slow.rate_rad_s[:, 1:-1] - 1.01 * true_rate)
    assert math.degrees(offset) == pytest.approx(0.3, abs=0.02)
    residual = (slow.measured_tilt_rad - slow.tilt_rad) * np.cos(slow.tilt_rad)
    rms_mg = 1e3 * residual.reshape(-1, 30).std(axis=1)
    assert np.median(rms_mg) == pytest.approx(math.sqrt(60.0), rel=0.1)
    fast = simulate_logs(FAST, 50, np.random.default_rng(1))
    residual = (fast.measured_tilt_rad - fast.tilt_rad) * np.cos(fast.tilt_rad)
    assert 1e3 * residual.std() == pytest.approx(math.hypot(20.0, 0.4 * math.sqrt(10.0)), rel=0.03)


def test_readings_are_whole_counts() -> None:
    logs = simulate_logs(SLOW, 1, np.random.default_rng(1))
    for values, weight in (
        (logs.rate_rad_s, math.radians(2000.0) / 32768),
        (np.sin(logs.measured_tilt_rad), 2.0 / 32768),
    ):
        counts = values / weight
        np.testing.assert_allclose(counts, np.round(counts), atol=1e-6)


def trial(excess_rad: list[float], tau_s: list[float]) -> Trial:
    shape = (1, 1, len(tau_s))
    excess = np.reshape(excess_rad, shape)
    return Trial(
        setting=PAPER,
        tau_s=np.reshape(tau_s, shape),
        excess_rad=excess,
        rmse_rad=excess + 0.01,
        excess_history_rad=np.stack([np.full(shape, 1.0), excess + 1e-5, excess], axis=-1),
        period_s=1.0,
    )


def test_misses_and_hits_are_counted_as_stated() -> None:
    found = trial([0.0, 0.9e-6, 2e-6, 0.1, 0.1], [0.7, 0.02, 5.0, 0.02, 0.02])
    assert found.missed.tolist() == [[[False, False, True, True, True]]]
    assert found.miss_share == 0.6
    assert found.stuck_share == pytest.approx(2 / 3)
    assert found.iterations_to_hit().tolist() == [[[2.0, 2.0, np.inf, np.inf, np.inf]]]
    assert math.isnan(trial([0.0], [0.7]).stuck_share)


def test_a_trial_is_judged_against_the_optimum_of_its_group() -> None:
    material = prepare(SLOW, 2, np.random.default_rng(1))
    found = run_trial(material, PAPER, repeats=3, rng=np.random.default_rng(2))
    assert found.tau_s.shape == (2, 10, 3)
    assert found.excess_history_rad.shape == (2, 10, 3, 101)
    eta = eta_of(found.tau_s, 1.0)
    cost = training_cost_rad(material.groups, eta.reshape(20, 3)).reshape(2, 10, 3)
    best = material.optima.cost_rad.reshape(2, 10, 1)
    np.testing.assert_allclose(found.excess_rad, cost - best, atol=1e-15)
    assert found.excess_rad.min() >= -1e-12
    assert (found.tau_s >= TAU_BOUNDS_S[0]).all()
    excess, evaluations = grid_brent_excess_rad(material, np.random.default_rng(3))
    assert excess.min() >= -1e-12
    assert (excess <= 1e-6).mean() >= 0.9
    assert ((evaluations > 32) & (evaluations < 90)).all()


def test_weights_are_compared_on_whole_logs() -> None:
    ratio = compare_weights(2, np.random.default_rng(9))
    logs = simulate_logs(SLOW, 2, np.random.default_rng(9))
    for i in range(2):
        errors = [filtered(logs, i, 0, 300, tau / (tau + 1.0)) for tau in (0.7, 0.8)]
        rms = [np.sqrt(np.mean(e**2)) for e in errors]
        assert ratio[i] == pytest.approx(rms[0] / rms[1], rel=1e-10)


def test_crossing_is_found_between_two_points() -> None:
    frequency = np.array([0.5, 1.0, 4.0, 8.0])
    sweep = SensorErrorSweep(
        frequency_rad_s=frequency, accel_rad=0.01 * frequency**2, gyro_rad=0.04 / frequency
    )
    assert sweep.crossing_rad_s == pytest.approx(4.0 ** (1 / 3))
    never = SensorErrorSweep(
        frequency_rad_s=frequency, accel_rad=np.ones(4), gyro_rad=np.full(4, 2.0)
    )
    assert never.crossing_rad_s == math.inf


def test_sensor_errors_over_frequency_have_their_known_ends() -> None:
    rng = np.random.default_rng(1)
    cycles, time = sweep_cycles(2.0, rng), sweep_time(30.0, rng)
    drift = math.radians(0.05) * 30.0 / 2.0
    assert np.mean(time.gyro_rad) == pytest.approx(drift, rel=0.1)
    swing = 0.2 * 10.0**2 * math.radians(10.0) * (2 / math.pi) / 9.80665
    assert time.accel_rad[-1] == pytest.approx(swing, rel=0.08)
    noise = 400e-6 * math.sqrt(10.0) * math.sqrt(2 / math.pi)
    assert time.accel_rad[0] == pytest.approx(noise, rel=0.08)
    assert cycles.gyro_rad[0] > 20 * cycles.gyro_rad[-1]


@pytest.mark.parametrize(
    ("low", "high", "ours", "holds"),
    [
        (1.0, 2.0, 1.5, True),
        (1.0, 2.0, 2.1, False),
        (1.0, 2.0, 0.9, False),
        (-math.inf, 2.0, -5.0, True),
        (0.9, 0.9, 0.9, True),
        (0.0, 1.0, math.nan, False),
        (1.0, 2.0, math.inf, False),
        (None, None, 7.0, None),
    ],
)
def test_a_row_holds_within_its_band(low, high, ours, holds) -> None:
    row = AcceptanceRow(figure="x", paper="y", ours=ours, low=low, high=high)
    assert row.holds is holds
    assert row.is_only_shown is (holds is None)


def test_rows_speak_in_their_unit() -> None:
    row = AcceptanceRow(figure="x", paper="y", ours=0.123, unit="share", low=0.05, high=0.5)
    assert (row.text, row.band) == ("12.3 %", "5 to 50 %")
    late = AcceptanceRow(figure="x", paper="y", ours=math.inf, low=-math.inf, high=19.0)
    assert (late.text, late.band) == ("never", "up to 19")


def test_groups_are_read_only(logs: Logs) -> None:
    groups: Groups = groups_of(logs)
    with pytest.raises(ValueError, match="read-only"):
        groups.drive[0, 0] = 1.0
