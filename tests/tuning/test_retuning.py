from dataclasses import replace

import numpy as np
import pytest
from recorded import SENSOR, problem, recorded

from hostkit.simulation import SensorErrors
from hostkit.tuning import TuningOptions, tune
from hostkit.tuning.retuning import bootstrap, cross_validate, retune
from hostkit.tuning.weighting import weighted_cost

OPTIONS = TuningOptions(axes="roll", sensor=SENSOR)
RECORDINGS = tuple(
    recorded(profile, seed=seed, duration_s=8.0)
    for seed, profile in enumerate(("steps", "sine-sweep", "random", "steps"))
)


def tau_of(x: np.ndarray) -> float:
    return float(np.exp(x[0]))


def test_leaving_a_recording_out_is_tuning_on_the_others():
    p = problem(*RECORDINGS)
    weights = (1.0 - np.eye(4))[:, :, None]
    found = retune(p, weights, OPTIONS)
    held_out = cross_validate(p, OPTIONS)
    assert (held_out.unit, held_out.folds) == ("recordings", 4)
    for k in range(4):
        others = tuple(r for i, r in enumerate(RECORDINGS) if i != k)
        alone = tune(others, replace(OPTIONS, held_out=False, resamples=0))
        assert tau_of(found[k]) == pytest.approx(tau_of(alone.swarm.x), rel=2e-3)
        error = problem(RECORDINGS[k]).error(alone.swarm.x[None])[0, 0, 0]
        assert held_out.each_rad[k] == pytest.approx(error, rel=1e-3)
    assert held_out.rms_rad == pytest.approx(np.mean(held_out.each_rad))


def test_parts_of_a_single_recording_are_left_out():
    recording = recorded("random", duration_s=20.0)
    p = problem(recording)
    held_out = cross_validate(p, OPTIONS)
    assert (held_out.unit, held_out.folds) == ("parts", 5)
    x = retune(p, 1.0 - np.eye(5)[:, None, :], OPTIONS)
    valid = np.zeros(len(recording), dtype=bool)
    valid[400:800] = True
    second = problem(replace(recording, valid=valid)).error(x[1][None])[0, 0, 0]
    assert held_out.each_rad[1] == pytest.approx(second, rel=1e-9)


def test_the_error_on_parts_is_the_error_of_the_whole_if_nothing_is_tuned(monkeypatch):
    recording = recorded("random", duration_s=20.0)
    p = problem(replace(recording, valid=np.arange(len(recording)) > 500))
    x = np.log([0.5])
    monkeypatch.setattr("hostkit.tuning.retuning.retune", lambda *_: np.tile(x, (5, 1)))
    held_out = cross_validate(p, OPTIONS)
    assert len(set(held_out.each_rad)) == 5
    assert held_out.rms_rad == pytest.approx(p.rms_rad(x, 0), rel=1e-9)


def test_weights_of_one_give_the_cost_and_of_two_a_recording_twice():
    p = problem(*RECORDINGS, axes="both")
    x = np.log(np.geomspace(0.05, 20.0, 7))[:, None]
    sums, counts = p.block_sums(x, 1), p.block_counts(1)
    assert weighted_cost(p, sums, counts, np.ones((4, 1))) == pytest.approx(p.cost(x), rel=1e-12)
    twice = weighted_cost(p, sums, counts, np.array([[2.0], [1.0], [0.0], [0.0]]))
    pair = problem(RECORDINGS[0], RECORDINGS[0], RECORDINGS[1], axes="both")
    assert twice == pytest.approx(pair.cost(x), rel=1e-12)


def test_bootstrap_is_wide_where_recordings_disagree():
    like = tuple(recorded("random", seed=s, duration_s=8.0) for s in range(8))
    calm = SensorErrors(vibration_m_s2=0.2)
    mixed = (*like[:4], *(recorded("steps", seed=s, duration_s=8.0, errors=calm) for s in range(4)))
    spread = [np.ptp(bootstrap(problem(*r), OPTIONS)[:, 0]) for r in (like, mixed)]
    assert 0.0 < 2.0 * spread[0] < spread[1]
    assert bootstrap(problem(*like), replace(OPTIONS, resamples=0)).shape == (0, 1)


def test_interval_holds_the_optimum_and_the_seed_decides():
    result = tune(RECORDINGS, OPTIONS)
    interval = result.intervals[0]
    assert interval.low < interval.value < interval.high
    assert tune(RECORDINGS, OPTIONS).intervals == result.intervals
    assert tune(RECORDINGS, replace(OPTIONS, seed=2)).intervals != result.intervals
    none = tune(RECORDINGS, replace(OPTIONS, resamples=0, held_out=False))
    assert none.intervals[0].low is None
    assert none.held_out is None
    assert none.design.tuning.held_out_rmse_deg is None


def test_held_out_of_several_parameters_is_worse_than_training():
    free = ("tau", "gyro_bias", "gate")
    options = replace(OPTIONS, free=free, resamples=0, particles=10, iterations=30)
    result = tune(RECORDINGS, options)
    assert result.held_out.rms_rad > result.rms_rad
    assert result.held_out == tune(RECORDINGS, replace(options, jobs=2)).held_out
