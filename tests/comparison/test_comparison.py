import math
from dataclasses import replace

import numpy as np
import pytest
from recorded import SENSOR

from hostkit.comparison import CompareOptions, chosen_peers, compare, comparison
from hostkit.comparison.calibration import correction_of, readings_of
from hostkit.comparison.peer import Peer, PeerParameter, package
from hostkit.comparison.problem import PeerProblem
from hostkit.comparison.row import Row
from hostkit.errors import DesignError, HostkitError, RecordingError, ToolMissingError
from hostkit.filters.observer import default_parameters, parameter
from hostkit.mounting import Mounting
from hostkit.records import FilterDesign
from hostkit.tuning import HeldOut

BEST = 0.02


def leaning(rate, force, period_s, values):
    """Upright in every sample, but for a lean that is least at one value of the parameter."""
    half = 0.5 * abs(math.log(values[0] / BEST))
    return np.tile([math.cos(half), math.sin(half), 0.0, 0.0], (len(rate), 1))


def absent(rate, force, period_s, values):
    return package("hostkit_has_no_such_module", "filter")


def stub(run=leaning, slowness=1, name="stub"):
    gain = PeerParameter(name="gain", unit="1", default=0.2, lowest=0.001, highest=1.0)
    return Peer(
        name=name,
        title="Stub",
        package=name,
        parameters=(gain,),
        run=run,
        slowness=slowness,
        timed="nothing",
    )


@pytest.fixture
def with_stubs(monkeypatch):
    def use(*peers):
        monkeypatch.setattr(comparison, "chosen_peers", lambda names: peers)

    return use


@pytest.fixture(scope="module")
def upright(flights):
    up = np.tile([0.0, 0.0, 1.0], (len(flights[0]), 1))
    return tuple(replace(one, up_reference=up) for one in flights)


def problem(recordings, **changes):
    given = {
        "peer": stub(),
        "readings": tuple(readings_of(one) for one in recordings),
        "quantity": "inclination",
        "mounting": Mounting(),
        "lead_s": 0.0,
    }
    return PeerProblem(**{**given, **changes})


def design(*more):
    return FilterDesign(
        filter="observer",
        axes="both",
        tilt="atan2",
        mounting=Mounting(),
        rate_hz=100.0,
        sensor=SENSOR,
        parameters=tuple(sorted((*default_parameters(), *more), key=lambda p: p.name)),
    )


def test_a_peer_is_tuned_to_its_best_and_scored_where_it_was_not_tuned(upright, with_stubs):
    with_stubs(stub())
    found = compare(upright, CompareOptions(evaluations=60, gyro_scale=False))
    default, tuned = (r for r in found.rows if r.origin == "peer")
    assert default.mean_rad == pytest.approx(math.log(0.2 / BEST), rel=1e-6)
    assert tuned.mean_rad < 0.05
    assert tuned.held_out.folds == 3
    assert tuned.evaluations == 61
    assert tuned.parameters[0].value == pytest.approx(BEST, rel=0.05)
    assert [(r.name, r.settings) for r in found.rows if r.origin == "hostkit"] == [
        ("complementary", "default"),
        ("complementary", "tuned"),
        ("observer", "default"),
        ("observer", "tuned"),
    ]


def test_slow_peers_get_their_share_and_no_scale(upright, with_stubs):
    with_stubs(stub(name="fast"), stub(slowness=50, name="slow"))
    found = compare(upright, CompareOptions(evaluations=60, held_out=False))
    fast, slow = (r for r in found.rows if r.origin == "peer" and r.settings == "tuned")
    assert (fast.is_scaled, fast.evaluations) == (True, 61)
    assert (slow.is_scaled, slow.evaluations) == (False, 9)
    assert fast.held_out is None


def test_settings_that_are_as_good_as_can_be_stay_so_however_few_are_tried(upright, with_stubs):
    best = replace(stub(slowness=50).parameters[0], default=BEST)
    with_stubs(replace(stub(slowness=50), parameters=(best,)))
    found = compare(upright, CompareOptions(evaluations=40, held_out=False))
    default, tuned = (r for r in found.rows if r.origin == "peer")
    assert tuned.mean_rad == pytest.approx(default.mean_rad, abs=1e-9)


def test_the_worst_of_what_was_left_out_is_the_worst_that_is_scored():
    held_out = HeldOut(unit="parts", folds=3, rms_rad=0.25, each_rad=(math.nan, 0.2, 0.3))
    row = Row(name="a", title="a", origin="peer", settings="tuned", each_rad=(0.1,), parameters=())
    assert row.honest_worst_rad == 0.1
    assert replace(row, held_out=held_out).honest_worst_rad == 0.3


def test_a_missing_peer_is_named_with_its_cure(upright, with_stubs):
    with_stubs(stub(absent, name="gone"), stub())
    found = compare(upright, CompareOptions(tune=False))
    (one,) = found.missing
    assert one.name == "gone"
    assert "pip install 'hostkit[compare]'" in one.reason
    assert [r.name for r in found.rows if r.origin == "peer"] == ["stub"]


def test_an_old_package_is_named_with_its_cure():
    with pytest.raises(ToolMissingError, match="needs a newer one: pip install --upgrade json"):
        package("json", "AhrsSettings")


def test_a_design_takes_the_place_of_our_filters_and_brings_its_lead(upright, with_stubs):
    with_stubs(stub())
    own = design(parameter("lead", 0.004))
    found = compare(upright, CompareOptions(design=own, tune=False))
    assert [(r.name, r.settings, r.lead_s) for r in found.rows] == [
        ("observer", "design", 0.004),
        ("stub", "default", 0.004),
    ]
    other = compare(upright, CompareOptions(design=own, tune=False, lead_s=0.0))
    assert {r.lead_s for r in other.rows} == {0.0}


def test_lead_reaches_our_filters_and_their_defaults_are_among_the_settings(flights, with_stubs):
    with_stubs()
    found = compare(flights[:2], CompareOptions(evaluations=40, lead_s=0.003, held_out=False))
    rows = {(r.name, r.settings): r for r in found.rows}
    default, tuned = rows["observer", "default"], rows["observer", "tuned"]
    for row in (default, tuned):
        assert {p.name: p.value for p in row.parameters}["lead_s"] == 0.003
    assert tuned.mean_rad <= default.mean_rad * 1.001
    assert tuned.evaluations == 41
    assert rows["complementary", "default"].lead_s == 0.0


def test_lead_turns_the_direction_of_up_with_the_rate(flights):
    one = readings_of(flights[0])
    turning = replace(one, rate_rad_s=np.tile([2.0, 0.0, 0.0], (len(one.track), 1)))
    up = np.tile([0.0, 0.0, 1.0], (len(one.track), 1))
    led = turning.led(up, 0.01)
    assert np.allclose(np.arctan2(led[:, 1], led[:, 2]), 0.02, atol=1e-4)
    assert np.allclose(np.linalg.norm(led, axis=1), 1.0)
    assert turning.led(up, 0.0) is up


def test_calibration_of_the_design_is_what_peers_read(flights):
    own = design(parameter("gyro_bias", 0.1, "y"), parameter("accel_scale", 0.02, "z"))
    one = readings_of(flights[0], correction_of(own))
    assert np.allclose(one.rate_rad_s[:, 1], flights[0].angular_rate_rad_s[:, 1] - 0.1)
    assert np.allclose(one.force_m_s2[:, 2], 1.02 * flights[0].specific_force_m_s2[:, 2])
    with pytest.raises(DesignError, match="no calibration"):
        correction_of(design())


def test_scale_is_searched_behind_the_own_parameters(flights):
    seen = []

    def listening(rate, force, period_s, values):
        seen.append((rate[:, 0].copy(), values))
        return leaning(rate, force, period_s, values)

    asked = problem(flights[:1], peer=stub(listening), is_scaled=True)
    assert [d.axis for d in asked.space.dimensions] == [None, "x", "y", "z"]
    asked.deviation_rad((0.3, 0.1, 0.0, 0.0), 0)
    rate, values = seen[-1]
    assert values == (0.3,)
    assert np.allclose(rate, 1.1 * flights[0].angular_rate_rad_s[:, 0])
    cost = asked.space.preference(np.array([[0.0, 0.0, 0.0, 0.0], [0.0, 0.1, 0.0, 0.0]]))
    assert cost[0] == 1.0 < cost[1]


def test_blocks_add_up_to_the_whole(flights):
    asked = problem(flights)
    points = np.array([[math.log(0.2)], [math.log(0.5)]])
    sums, counts = asked.block_sums(points, 4), asked.block_counts(4)
    whole = asked.metric(sums.sum(axis=2), counts.sum(axis=2)[..., None]).mean(axis=(0, 1))
    assert np.allclose(whole, asked.cost(points))
    each = [asked.rms_rad(points[0], i) for i in range(3)]
    assert asked.cost(points)[0] == pytest.approx(np.mean(each))


def test_names_of_peers():
    assert [p.name for p in chosen_peers(("vqf", "vqf-online", "mahony"))] == [
        "vqf-online",
        "vqf-basic",
        "vqf-offline",
        "mahony",
    ]
    with pytest.raises(HostkitError, match="no peer 'kalman'; there are vqf-online"):
        chosen_peers(("kalman",))


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"evaluations": 39}, "at least 40"),
        ({"lead_s": 0.06}, "outside"),
        ({"lead_s": math.nan}, "outside"),
        ({"calibrated_peers": True}, "name the design"),
    ],
)
def test_impossible_options_are_refused(changes, words):
    with pytest.raises(HostkitError, match=words):
        CompareOptions(**changes)


def test_recordings_must_have_a_reference_and_one_rate(flights, with_stubs):
    with_stubs(stub())
    with pytest.raises(RecordingError, match="name at least one"):
        compare((), CompareOptions())
    blind = replace(flights[0], up_reference=None)
    with pytest.raises(RecordingError, match="has no reference"):
        compare((blind,), CompareOptions(tune=False))
    fast = replace(flights[1], rate_hz=200.0)
    with pytest.raises(RecordingError, match="200 Hz"):
        compare((flights[0], fast), CompareOptions(tune=False))
