import numpy as np
import pytest

from benchmarks.compiled import LANES, best_loop
from benchmarks.functions import DIMENSIONS, functions
from benchmarks.gusts import SAMPLES, gusty
from benchmarks.objective import HIT_RAD, TauCost, optimum
from benchmarks.problems import problem, repeated, steps, stream_of
from hostkit.errors import ToolMissingError
from hostkit.records import OBJECTIVES


@pytest.fixture(scope="module", autouse=True)
def _compiler():
    try:
        best_loop()
    except ToolMissingError as error:
        pytest.skip(str(error))


@pytest.fixture(params=OBJECTIVES)
def one(request):
    return problem(steps(300, 20.0), objective=request.param)


def test_best_loop_computes_what_the_kernel_computes(one):
    points = np.linspace(one.space.lower, one.space.upper, LANES)
    eta = np.ascontiguousarray(one.space.candidates("roll", points).table[0])
    ways = best_loop().ways(stream_of(one), eta, one.objective)
    assert len(ways) == 2
    for way in ways:
        mean = way() / 300
        found = np.sqrt(mean) if one.objective == "rmse" else mean
        np.testing.assert_allclose(found, one.cost(points), rtol=1e-12)


@pytest.mark.parametrize("log", [True, False], ids=["log tau", "tau"])
def test_peers_are_given_the_same_cost(one, log):
    cost = TauCost(one, optimum(one), log=log)
    points = np.linspace(cost.lower, cost.upper, 20)
    wanted = one.cost(points if log else np.log(points))
    np.testing.assert_allclose(cost.many(points), wanted, rtol=1e-12)
    assert [cost.point(x) for x in points] == pytest.approx(wanted, rel=1e-12)
    assert cost.evaluations == 40


def test_cost_counts_up_to_the_first_hit(one):
    best = optimum(one)
    cost = TauCost(one, best, log=True)
    at_best = np.log(best.tau_s)
    cost.many(np.array([[at_best + 1.0], [at_best - 1.0], [at_best], [at_best]]))
    assert (cost.evaluations, cost.hit_after) == (4, 3)
    cost.restart()
    cost.one(at_best + 1.0)
    assert cost.hit_after is None
    cost.one(at_best)
    assert cost.hit_after == 2


def test_nothing_is_better_than_the_optimum(one):
    grid = np.linspace(one.space.lower, one.space.upper, 50_001)
    best = optimum(one)
    assert best.cost_rad <= one.cost(grid).min() + 1e-3 * HIT_RAD
    assert one.cost(np.array([[np.log(best.tau_s)]]))[0] == pytest.approx(best.cost_rad, rel=1e-12)


def test_repeated_stream_goes_on_from_the_start():
    stream = stream_of(problem(steps(300, 20.0)))
    longer = repeated(stream, 700)
    assert (len(longer), longer.scored) == (700, 700)
    np.testing.assert_array_equal(longer.drive[300:600], stream.drive)


def test_two_logs_of_a_sensor_have_its_errors_and_another_motion():
    first, second, other = gusty(1, 0), gusty(1, 1), gusty(4, 0)
    bias = [np.median(_rate_error(one)) for one in (first, second, other)]
    assert len(first) == SAMPLES
    assert abs(bias[0] - bias[1]) < 0.015 < 0.03 < abs(bias[0] - bias[2])
    assert not np.array_equal(first.up_reference, second.up_reference)


def _rate_error(recording):
    up = recording.up_reference
    true = np.gradient(np.unwrap(np.arctan2(up[:, 1], up[:, 2])), 1.0 / recording.rate_hz)
    return recording.angular_rate_rad_s[:, 0] - true


def test_functions_have_their_least_value_off_the_centre():
    for function in functions(np.random.default_rng(7)):
        assert function.one(function.shift) == pytest.approx(0.0, abs=1e-12)
        assert function.one(np.zeros(DIMENSIONS)) > 0.1
        assert np.abs(function.shift).max() <= 0.6 * function.half_width
        assert function(np.zeros((3, 4, DIMENSIONS))).shape == (3, 4)
