import math
from dataclasses import replace

import numpy as np
import pytest
from designs import design
from recorded import EVERY, SENSOR, problem, recorded

from hostkit.attitude import wrap_rad
from hostkit.errors import DesignError
from hostkit.filters.complementary import run_float
from hostkit.records import AXES
from hostkit.simulation import SensorErrors
from hostkit.tuning import FixedParameter, SearchRange, TuningOptions, evaluate, tune
from hostkit.tuning.complementary.space import search_space
from hostkit.tuning.reference import reference_rad
from hostkit.units import RAD_PER_DEG, STANDARD_GRAVITY_M_S2

DEG = RAD_PER_DEG


def test_per_axis_parameters_have_a_dimension_each():
    space = search_space("both", 0.01, EVERY)
    assert [(d.name, d.axis) for d in space.dimensions] == [
        ("tau", None),
        ("gyro_bias", "roll"),
        ("gyro_bias", "pitch"),
        ("gyro_scale", "roll"),
        ("gyro_scale", "pitch"),
        ("tilt_offset", "roll"),
        ("tilt_offset", "pitch"),
        ("gate", None),
        ("integral_gain", None),
    ]
    assert len(search_space("pitch", 0.01, EVERY).dimensions) == 6


@pytest.mark.parametrize("axes", ["roll", "pitch", "both"])
@pytest.mark.parametrize("seed", range(4))
def test_error_form_is_the_filter_with_every_parameter(axes, seed):
    """Any point: the design it becomes, run by the filter, has the cost that the search saw."""
    recording = recorded(duration_s=6.0, seed=seed)
    p = problem(recording, axes=axes, free=EVERY)
    share = np.random.default_rng(seed).random(len(p.space.dimensions))
    x = p.space.lower + (p.space.upper - p.space.lower) * share
    d = replace(design(axes=axes), parameters=p.space.design_parameters(x))
    force = recording.specific_force_m_s2 / STANDARD_GRAVITY_M_S2
    states = run_float(d, recording.angular_rate_rad_s, force)
    for i, axis in enumerate(AXES[axes]):
        reference = reference_rad(recording, axis, d.mounting)
        error = wrap_rad(states[:, i] - reference)
        assert p.error(x[None])[0, i, 0] == pytest.approx(np.sqrt(np.mean(error**2)), rel=1e-9)


def test_known_faults_of_a_sensor_are_found():
    """Bias and scale that the simulation puts in come out of the tuning."""
    errors = replace(
        SensorErrors(vibration_m_s2=1.0, low_pass=False),
        gyro_bias_rad_s=(1.5 * DEG, 0.0, 0.0),
        gyro_bias_walk_rad_s_rts=0.0,
        gyro_scale=(-0.03, 0.0, 0.0),
        cross_axis=0.0,
        accel_offset_m_s2=(0.0, 0.0, 0.0),
        accel_scale=(0.0, 0.0, 0.0),
    )
    recordings = tuple(recorded(seed=s, duration_s=40.0, errors=errors) for s in range(2))
    free = ("tau", "gyro_bias", "gyro_scale")
    options = TuningOptions(axes="roll", sensor=SENSOR, free=free, resamples=0, held_out=False)
    d = tune(recordings, options).design
    assert d.parameter("gyro_bias_roll_rad_s") / DEG == pytest.approx(1.5, abs=0.1)
    assert d.parameter("gyro_scale_roll") == pytest.approx(0.03, abs=0.006)
    plain = tune(recordings, replace(options, free=("tau",))).design
    better, worse = (evaluate(one, recordings[0]).score("roll").rms_rad for one in (d, plain))
    assert better < 0.7 * worse


def test_what_is_fixed_stays():
    recording = recorded()
    fixed = (
        FixedParameter(name="gyro_bias", value=0.3 * DEG),
        FixedParameter(name="tau", value=0.8),
    )
    options = TuningOptions(
        sensor=SENSOR, free=("gate",), fixed=fixed, resamples=0, particles=5, iterations=3
    )
    d = tune((recording,), options).design
    assert d.parameter("eta") == pytest.approx(0.8 / 0.81)
    assert d.parameter("gyro_bias_roll_rad_s") == d.parameter("gyro_bias_pitch_rad_s") == 0.3 * DEG
    assert 0.005 <= d.parameter("gate_g") <= 1.0


def test_own_range_is_kept():
    narrow = SearchRange(name="tau", lowest=2.0, highest=3.0, is_log=True)
    options = TuningOptions(axes="roll", sensor=SENSOR, ranges=(narrow,))
    result = tune((recorded(),), options)
    tau_s = 0.01 * result.design.parameter("eta") / (1.0 - result.design.parameter("eta"))
    assert tau_s == pytest.approx(2.0, rel=1e-3)
    assert result.swarm.at_bound.all()
    assert "tau lies on the lower end of its range, 2 s" in result.remarks[0]


def test_what_does_not_go_together_is_refused():
    def space(free=("tau",), fixed=(), ranges=(), axes="roll"):
        return search_space(axes, 0.01, free, fixed, ranges)

    gate = FixedParameter(name="gate", value=0.1)
    with pytest.raises(DesignError, match=r"gate is to be tuned and fixed at 0\.1 g"):
        space(free=("gate",), fixed=(gate,))
    with pytest.raises(DesignError, match="nothing to tune"):
        space(free=(), fixed=(FixedParameter(name="tau", value=1.0),))
    with pytest.raises(DesignError, match=r"gate = 7 g is outside \[0.001, 1 g\]"):
        space(fixed=(replace(gate, value=7.0),))
    with pytest.raises(DesignError, match="fixed for pitch"):
        space(fixed=(FixedParameter(name="gyro_bias", value=0.0, axis="pitch"),))
    reverse = SearchRange(name="tau", lowest=3.0, highest=2.0, is_log=True)
    with pytest.raises(DesignError, match="range of tau: 3 to 2"):
        space(ranges=(reverse,))
    with pytest.raises(DesignError, match="range of tau: 0 to 2"):
        space(ranges=(replace(reverse, lowest=0.0, highest=2.0),))
    with pytest.raises(DesignError, match="range of tau: nan"):
        space(ranges=(replace(reverse, lowest=math.nan),))
