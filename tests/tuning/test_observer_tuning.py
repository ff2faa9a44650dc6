from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from recorded import SENSOR, recorded

from hostkit.errors import DesignError, HostkitError, RecordingError
from hostkit.filters.observer import lower
from hostkit.filters.observer.parameters import BY_NAME
from hostkit.mounting import Mounting
from hostkit.records import FilterDesign
from hostkit.simulation import SensorErrors
from hostkit.tuning import FixedParameter, SearchRange, TuningOptions, tune
from hostkit.tuning.archive import archived
from hostkit.tuning.kernel.library import library
from hostkit.tuning.observer import OBSERVER_TUNER, RANGES, SOURCES, observer_problem
from hostkit.tuning.observer.space import observer_space
from hostkit.tuning.retuning import cross_validate
from hostkit.tuning.search import search
from hostkit.tuning.start import default_point, search_from

EVERY = tuple(r.name for r in RANGES)


def problem(*recordings, **changes):
    options = TuningOptions(filter="observer", sensor=SENSOR, **changes)
    return observer_problem(recordings, options, Path())


def points(p, count: int, seed: int = 1) -> np.ndarray:
    share = np.random.default_rng(seed).random((count, len(p.space.lower)))
    return p.space.lower + share * (p.space.upper - p.space.lower)


@pytest.mark.skipif(library(SOURCES) is None, reason="no C compiler")
@pytest.mark.parametrize("objective", ["rmse", "mae"])
@pytest.mark.parametrize(
    ("axes", "mounting"), [("both", "+x+y+z"), ("roll", "+z+x+y"), ("pitch", "-y+x+z")]
)
def test_the_compiled_observer_is_the_float_model(axes, mounting: str, objective) -> None:
    recordings = recorded(duration_s=4.0), recorded("sine-sweep", seed=2, duration_s=3.0)
    p = problem(
        *recordings,
        free=EVERY,
        axes=axes,
        mounting=Mounting.parse(mounting),
        objective=objective,
    )
    x = points(p, 11)
    compiled, modelled = p.block_sums(x, 3), replace(p, kernel=None).block_sums(x, 3)
    assert compiled.shape == (2, 1, 3, 11)
    np.testing.assert_allclose(compiled, modelled, rtol=1e-5 if axes == "both" else 1e-9)


def wild():
    """Clipped rates and shocks at the start, a slow even turn that is no rest, and a rest."""
    recording, rng = recorded(duration_s=9.0), np.random.default_rng(4)
    rate, force = np.zeros((len(recording), 3)), np.tile([2.0, 1.0, 9.5], (len(recording), 1))
    first = slice(0, len(recording) // 3)
    rate[first] = rng.normal(0.0, 2.0, rate[first].shape)
    force[first] += rng.normal(0.0, 20.0, force[first].shape)
    rate[first.stop : 2 * first.stop] = [0.0, 0.22, 0.1]
    rate[2 * first.stop :] = [0.0, 0.15, -0.1]
    return replace(recording, angular_rate_rad_s=rate, specific_force_m_s2=force)


@pytest.mark.skipif(library(SOURCES) is None, reason="no C compiler")
def test_the_compiled_observer_has_the_limits_of_the_float_model() -> None:
    fixed = FixedParameter(name="clip_rate", value=3.0), FixedParameter(name="start", value=8.0)
    p = problem(wild(), axes="roll", free=("kt", "rest_gain"), fixed=fixed)
    x = points(p, 4)
    compiled, modelled = p.block_sums(x, 6), replace(p, kernel=None).block_sums(x, 6)
    np.testing.assert_allclose(compiled, modelled, rtol=1e-7)


def test_blocks_add_up_and_only_scored_samples_count() -> None:
    recording = recorded(duration_s=4.0)
    valid = np.arange(len(recording)) % 3 == 0
    p = problem(replace(recording, valid=valid))
    x = points(p, 2)
    np.testing.assert_allclose(p.block_sums(x, 4).sum(axis=2), p.block_sums(x, 1)[:, :, 0])
    assert p.block_counts(4).sum() == valid.sum()
    rms = np.sqrt(p.block_sums(x[:1], 1)[0, 0, 0, 0] / valid.sum())
    assert p.rms_rad(x[0], 0) == pytest.approx(rms, rel=1e-6)
    assert p.cost(x)[0] == pytest.approx(rms * p.preference(x)[0], rel=1e-6)


def test_a_search_beats_the_defaults_and_is_repeatable() -> None:
    recordings = tuple(recorded("sine-sweep", seed=s, duration_s=6.0) for s in (1, 2, 3))
    options = TuningOptions(filter="observer", iterations=20)
    p = archived(problem(*recordings), 16)
    found = search(p, options, "qpso")
    again = search(archived(problem(*recordings), 16), options, "qpso")
    np.testing.assert_array_equal(found.x, again.x)
    middle = 0.5 * (p.space.lower + p.space.upper)
    assert found.cost < p.cost(middle[np.newaxis])[0]
    held_out = cross_validate(p, options)
    assert held_out.folds == 3
    assert all(np.isfinite(held_out.each_rad))


def test_visited_points_are_judged_again_with_other_weights() -> None:
    recording = recorded(duration_s=5.0)
    p = archived(problem(recording), 16)
    x = points(p, 6)
    cost = p.cost(x)
    visited = p.visited()
    np.testing.assert_allclose(visited.in_blocks(5), p.block_sums(x, 5), rtol=1e-12)
    np.testing.assert_allclose(visited.in_blocks(16), p.block_sums(x, 16), rtol=1e-12)
    assert cost.shape == (6,)
    held_out = cross_validate(p, TuningOptions(filter="observer"))
    assert (held_out.unit, held_out.folds) == ("parts", 5)


def test_what_is_fixed_and_what_is_left_stands_in_the_design() -> None:
    fixed = (
        FixedParameter(name="kv", value=0.5),
        FixedParameter(name="gyro_scale", value=0.01, axis="y"),
    )
    p = problem(recorded(duration_s=2.0), free=("kt",), fixed=fixed)
    found = {q.name: q.value for q in p.space.design_parameters(np.log([0.03]))}
    assert found["kt_rad_m"] == pytest.approx(0.03)
    assert found["kv_per_s"] == 0.5
    assert found["gyro_scale_y"] == 0.01
    assert "gyro_scale_x" not in found
    assert "rest_rate_rad_s" in found


@pytest.mark.parametrize("rate_hz", [10.0, 25.0, 50.0, 100.0, 1000.0])
def test_every_corner_of_the_box_can_be_lowered(rate_hz: float) -> None:
    space = observer_space(rate_hz, EVERY)
    sensor = replace(SENSOR, gyro_full_scale_deg_s=250)
    for corner in (space.lower, space.upper):
        lower(
            FilterDesign(
                filter="observer",
                axes="both",
                tilt="atan2",
                mounting=Mounting.parse("+x+y+z"),
                rate_hz=rate_hz,
                sensor=sensor,
                parameters=space.design_parameters(corner),
            )
        )
    shown = [d.value(x) for d, x in zip(space.dimensions, space.upper, strict=True)]
    key = {p.name: p.value for p in space.design_parameters(space.upper)}
    assert key["kt_rad_m"] == shown[0] <= 12.0


def test_what_cannot_be_tuned_is_refused() -> None:
    recording = recorded(duration_s=2.0)
    with pytest.raises(DesignError, match="kt is to be tuned and fixed"):
        problem(recording, free=("kt",), fixed=(FixedParameter(name="kt", value=0.1),))
    outside = r"gyro-bias = 515.662 deg/s is outside \[-20, 20 deg/s\]"
    with pytest.raises(DesignError, match=outside):
        problem(recording, fixed=(FixedParameter(name="gyro_bias", value=9.0),))
    narrow = SearchRange(name="kv", lowest=2.0, highest=1.0, is_log=True)
    with pytest.raises(DesignError, match="range of kv"):
        problem(recording, ranges=(narrow,))
    with pytest.raises(RecordingError, match="no reference"):
        problem(replace(recording, up_reference=None))
    with pytest.raises(RecordingError, match="is valid"):
        problem(replace(recording, valid=np.zeros(len(recording), dtype=bool)))
    every = tuple(FixedParameter(name=n, value=BY_NAME[n].default) for n in EVERY)
    with pytest.raises(HostkitError, match="every parameter is fixed"):
        problem(recording, fixed=every)


def test_a_scale_that_no_motion_shows_stays_near_nothing() -> None:
    still = recorded("rest", duration_s=10.0, errors=SensorErrors())
    p = archived(problem(still, free=("gyro_scale",)), 16)
    found = search(p, TuningOptions(filter="observer", iterations=40), "qpso")
    assert np.abs(found.x).max() < 0.02


def test_a_search_too_short_to_find_anything_leaves_the_default() -> None:
    recordings = tuple(recorded("random", seed=s, duration_s=6.0) for s in (1, 2))
    options = TuningOptions(filter="observer", particles=2, iterations=1, seed=2)
    p = archived(problem(*recordings), 16)
    start = default_point(p.space, OBSERVER_TUNER)
    expected = p.cost(start[np.newaxis])[0]
    assert expected < search(p, options, "qpso").cost
    found = search_from(p, options, "qpso", start)
    np.testing.assert_array_equal(found.x, start)
    assert (found.cost, found.history[-1], found.evaluations) == (expected, expected, 5)


def test_where_tuning_brings_nothing_tune_says_so() -> None:
    recordings = tuple(recorded("random", seed=s, duration_s=6.0) for s in (1, 2))
    short = TuningOptions(
        filter="observer", sensor=SENSOR, particles=2, iterations=1, seed=2, resamples=0
    )
    assert any("the defaults, 1.1" in r for r in tune(recordings, short).remarks)
    tuned = tune(recordings, replace(short, particles=16, iterations=30))
    assert tuned.held_out.rms_rad < np.radians(1.1)
    assert not any("the defaults" in r for r in tuned.remarks)


def test_the_default_is_a_point_of_every_search() -> None:
    free = ("kt", "start", "lead")
    narrow = SearchRange(name="kt", lowest=0.1, highest=1.0, is_log=True)
    p = problem(recorded(duration_s=2.0), free=free, ranges=(narrow,))
    point = default_point(p.space, OBSERVER_TUNER)
    np.testing.assert_allclose(point, [np.log(0.1), np.log(BY_NAME["start"].default), 0.0])
    bare = default_point(p.space, replace(OBSERVER_TUNER, default=tuple))
    np.testing.assert_array_equal(bare, [*p.space.lower[:2], 0.0])


def test_thresholds_of_rest_stay_near_their_defaults_where_nothing_moves_them() -> None:
    swinging = recorded("sine-sweep", duration_s=6.0, errors=SensorErrors())
    p = archived(problem(swinging, free=("rest_rate", "rest_gain", "kt")), 16)
    found = search(p, TuningOptions(filter="observer", iterations=60), "qpso")
    defaults = np.log([BY_NAME["rest_rate"].default, BY_NAME["rest_gain"].default])
    np.testing.assert_allclose(found.x[1:], defaults, atol=0.1)
    usual = np.array([found.x[0], *defaults])
    doubled = usual + np.log([1.0, 2.0, 1.0])
    np.testing.assert_allclose(p.preference(np.array([usual, doubled])), [1.0, 1.002])
