import math
from dataclasses import replace

import numpy as np
import pytest
from designs import design
from recorded import SENSOR, problem, recorded

from hostkit.attitude import up_from_tilt, wrap_rad
from hostkit.errors import HostkitError, RecordingError
from hostkit.filters.complementary import parameters, run_float, tau_from_eta
from hostkit.recordings import Recording
from hostkit.records import AXES
from hostkit.simulation import SensorErrors, simulate
from hostkit.tuning import TuningOptions, evaluate, mean_rms_rad, sensor_config, tune
from hostkit.tuning.reference import reference_rad
from hostkit.units import STANDARD_GRAVITY_M_S2


def filter_cost(d, recording: Recording, objective: str) -> float:
    """The objective, computed the long way: by running the filter itself."""
    force = recording.specific_force_m_s2 / STANDARD_GRAVITY_M_S2
    angle = run_float(d, recording.angular_rate_rad_s, force)
    found = []
    for i, axis in enumerate(AXES[d.axes]):
        reference = reference_rad(recording, axis, d.mounting)
        scored = recording.valid & np.isfinite(reference)
        error = wrap_rad(angle[:, i] - reference)[scored]
        mean = np.mean(np.abs(error)) if objective == "mae" else np.sqrt(np.mean(error**2))
        found.append(mean)
    return float(np.mean(found))


@pytest.mark.parametrize("objective", ["rmse", "mae"])
@pytest.mark.parametrize("axes", ["roll", "pitch", "both"])
@pytest.mark.parametrize("tilt", ["atan2", "arcsin"])
@pytest.mark.parametrize("eta", [0.3, 0.97, 0.9995])
def test_error_form_is_the_filter(objective, axes, tilt, eta) -> None:
    recording = recorded()
    lost = np.array(recording.up_reference)
    lost[200:260] = np.nan
    valid = np.array(recording.valid)
    valid[:50] = False
    recording = replace(recording, up_reference=lost, valid=valid)
    d = replace(design(axes=axes, tilt=tilt), parameters=parameters(eta))
    p = problem(recording, axes=axes, tilt=tilt, objective=objective)
    found = p.cost(np.array([[math.log(tau_from_eta(eta, 0.01))]]))[0]
    assert found == pytest.approx(filter_cost(d, recording, objective), rel=1e-9)


def test_every_recording_counts_the_same_however_long() -> None:
    long, short = recorded(duration_s=20.0), recorded("sine-sweep", duration_s=5.0)
    x = np.array([[math.log(0.3)]])
    apart = [problem(recording).cost(x)[0] for recording in (long, short)]
    assert problem(long, short).cost(x)[0] == pytest.approx(np.mean(apart), rel=1e-12)


@pytest.mark.parametrize("optimiser", ["auto", "qpso", "pso", "awp", "differential-evolution"])
@pytest.mark.parametrize("objective", ["rmse", "mae"])
def test_optimum_is_that_of_a_dense_grid(objective: str, optimiser: str) -> None:
    recording = recorded()
    options = TuningOptions(axes="roll", objective=objective, sensor=SENSOR, optimiser=optimiser)
    result = tune((recording,), options)
    tau_s = np.geomspace(0.02, 100.0, 4000)
    grid = problem(recording, objective=objective).cost(np.log(tau_s)[:, None])
    assert result.swarm.cost <= grid.min() + 1e-9
    tau = tau_from_eta(result.design.parameter("eta"), 0.01)
    assert tau == pytest.approx(tau_s[grid.argmin()], rel=0.01)
    assert not result.swarm.at_bound.any()
    assert not result.remarks


def test_one_parameter_takes_no_swarm_unless_asked() -> None:
    recording = recorded()
    auto = tune((recording,), TuningOptions(axes="roll", sensor=SENSOR))
    assert auto.design.tuning.optimiser == "grid-brent"
    assert auto.swarm.evaluations < 100
    swarm = tune((recording,), TuningOptions(axes="roll", sensor=SENSOR, optimiser="qpso"))
    assert swarm.design.tuning.optimiser == "qpso"
    assert swarm.swarm.evaluations == 2020
    several = TuningOptions(axes="roll", sensor=SENSOR, free=("tau", "gate"), resamples=0)
    assert tune((recording,), several).design.tuning.optimiser == "qpso"


def test_restarts_keep_the_best_and_count_all() -> None:
    recording = recorded(duration_s=5.0)
    options = TuningOptions(
        axes="roll",
        sensor=SENSOR,
        free=("tau", "gate"),
        particles=4,
        iterations=5,
        held_out=False,
        resamples=0,
    )
    once = tune((recording,), options)
    thrice = tune((recording,), replace(options, restarts=3))
    assert thrice.swarm.evaluations == 3 * once.swarm.evaluations
    assert thrice.swarm.cost <= once.swarm.cost
    assert tune((recording,), replace(options, restarts=3, jobs=3)).design == thrice.design


def test_design_remembers_how_it_was_found() -> None:
    recording = recorded()
    options = TuningOptions(seed=11, iterations=5, sensor=SENSOR, optimiser="qpso")
    result = tune((recording,), options)
    record = result.design.tuning
    assert (record.seed, record.iterations, record.evaluations) == (11, 5, 120)
    assert record.recordings[0].samples == len(recording)
    assert record.rmse_deg == pytest.approx(math.degrees(result.rms_rad))
    assert record.held_out_rmse_deg == pytest.approx(
        math.degrees(result.held_out.rms_rad), abs=1e-6
    )
    again = tune((recording,), options)
    assert again.design == result.design


def test_evaluation_against_a_constructed_error() -> None:
    """A reference turned by one degree about x is one degree of roll and of inclination."""
    recording = simulate(
        "rest",
        duration_s=5.0,
        rate_hz=100.0,
        sensor=SENSOR,
        errors=SensorErrors.none(),
        rng=np.random.default_rng(0),
    )
    samples = len(recording)
    level = up_from_tilt(np.zeros(samples), np.zeros(samples))
    tilted = up_from_tilt(np.full(samples, math.radians(1.0)), np.zeros(samples))
    recording = replace(
        recording,
        specific_force_m_s2=level * STANDARD_GRAVITY_M_S2,
        up_reference=tilted,
        angular_rate_rad_s=np.zeros((samples, 3)),
    )
    scores = {s.quantity: s for s in evaluate(design(), recording).scores}
    assert math.degrees(scores["roll"].rms_rad) == pytest.approx(1.0, abs=1e-3)
    assert math.degrees(scores["roll"].max_rad) == pytest.approx(1.0, abs=1e-3)
    assert math.degrees(scores["pitch"].rms_rad) == pytest.approx(0.0, abs=1e-3)
    assert math.degrees(scores["inclination"].rms_rad) == pytest.approx(1.0, abs=1e-3)


def test_evaluation_without_a_reference_still_compares_the_models() -> None:
    recording = replace(recorded(), up_reference=None)
    evaluation = evaluate(design(accel_full_scale_g=4), recording)
    assert evaluation.scores == ()
    assert 0 < math.degrees(evaluation.integer_vs_float_max_rad) < 0.005
    assert mean_rms_rad((evaluation,), "roll") is None


def test_clipped_samples_are_counted() -> None:
    recording = recorded()
    rate = np.array(recording.angular_rate_rad_s)
    rate[100:110, 2] = math.radians(600)
    assert (
        evaluate(
            design(accel_full_scale_g=16), replace(recording, angular_rate_rad_s=rate)
        ).clipped_samples
        == 10
    )


def test_ranges_leave_room_and_what_is_given_is_kept() -> None:
    recording = recorded()
    rate = np.array(recording.angular_rate_rad_s)
    rate[5, 0] = math.radians(340)
    recording = replace(recording, angular_rate_rad_s=rate)
    chosen = sensor_config((recording,), 100.0)
    assert chosen.gyro_full_scale_deg_s == 1000
    assert chosen.low_pass_setting == 3
    kept = sensor_config((recording,), 100.0, gyro_full_scale_deg_s=250, low_pass_setting=0)
    assert (kept.gyro_full_scale_deg_s, kept.low_pass_setting) == (250, 0)


def test_low_pass_follows_the_rate() -> None:
    recording = recorded()
    found = [sensor_config((recording,), rate).low_pass_setting for rate in (1000, 200, 100, 20, 5)]
    assert found == [1, 2, 3, 5, 6]


def test_what_cannot_be_tuned_is_refused() -> None:
    recording = recorded()
    with pytest.raises(RecordingError, match="no recording"):
        tune((), TuningOptions())
    with pytest.raises(RecordingError, match="no reference"):
        tune((replace(recording, up_reference=None),), TuningOptions())
    with pytest.raises(RecordingError, match="none of its"):
        tune((replace(recording, valid=np.zeros(len(recording), bool)),), TuningOptions())
    with pytest.raises(RecordingError, match="200 Hz"):
        tune((recording, replace(recording, rate_hz=200.0)), TuningOptions())
    with pytest.raises(HostkitError, match="no optimiser"):
        tune((recording,), TuningOptions(optimiser="magic"))
    with pytest.raises(RecordingError, match="a design holds for one rate"):
        evaluate(design(rate_hz=50.0), recording)
