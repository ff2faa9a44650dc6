from dataclasses import replace

import numpy as np
import pytest
from recorded import SENSOR, problem, recorded

from hostkit.simulation import SensorErrors
from hostkit.tuning import FixedParameter, TuningOptions, tune
from hostkit.tuning.complementary.problem import Problem
from hostkit.tuning.determination import profiles, remarks


def said(p: Problem, x: np.ndarray) -> tuple[str, ...]:
    return remarks(p, x, float(p.cost(x[None])[0]), profiles(p, x))


def test_a_sound_tuning_has_no_remark():
    p = problem(recorded("random", duration_s=30.0))
    x = np.log([0.25])
    assert said(p, x) == ()


def test_a_still_recording_does_not_determine_tau():
    still = recorded("rest", duration_s=20.0, errors=SensorErrors.none())
    noise = 1e-2 * np.random.default_rng(0).standard_normal((len(still), 3))
    noise[0] = 0.0
    noisy = replace(still, specific_force_m_s2=still.specific_force_m_s2 + noise)
    options = TuningOptions(axes="roll", sensor=SENSOR, held_out=False, resamples=0)
    result = tune((noisy,), options)
    assert any("tau lies on the upper end of its range, 100 s" in r for r in result.remarks)


def test_a_parameter_without_effect_is_named():
    p = problem(recorded(duration_s=20.0), free=("tau", "gyro_scale"))
    still = problem(recorded("rest", duration_s=20.0), free=("tau", "gyro_scale"))
    x = np.array([np.log(0.3), 0.0])
    flat = "the recordings do not determine gyro-scale of roll"
    assert any(r.startswith(flat) for r in said(still, x))
    assert not any(r.startswith(flat) for r in said(p, x))


def test_parameters_that_stand_for_each_other_are_named():
    """At rest a bias b is an offset of b tau: nothing tells them apart."""
    tau = (FixedParameter(name="tau", value=0.3),)
    free = ("gyro_bias", "tilt_offset")
    still = problem(recorded("rest", duration_s=60.0), free=free, fixed=tau)
    found = said(still, np.zeros(2))
    assert any(r.startswith("tilt-offset of roll and gyro-bias of roll stand for") for r in found)
    scale = ("gyro_bias", "gyro_scale")
    moving = problem(recorded("random", duration_s=60.0), free=scale, fixed=tau)
    assert not any("stand for" in r for r in said(moving, np.zeros(2)))


def test_what_is_not_determined_is_not_named_again_for_going_along_with_others():
    tau = (FixedParameter(name="tau", value=0.3),)
    still = problem(recorded("rest", duration_s=60.0), free=("gyro_bias", "tilt_offset"), fixed=tau)
    x = np.zeros(2)
    found = remarks(still, x, 1e3, profiles(still, x))
    assert len([r for r in found if r.startswith("the recordings do not determine")]) == 2
    assert not any("stand for" in r for r in found)


@pytest.mark.parametrize("free", [("tau",), ("tau", "gate", "integral_gain")])
def test_remarks_reach_the_result(free):
    options = TuningOptions(
        axes="roll", sensor=SENSOR, free=free, held_out=False, resamples=0, iterations=20
    )
    result = tune((recorded(duration_s=5.0),), options)
    assert isinstance(result.remarks, tuple)
