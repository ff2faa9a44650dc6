"""Grid and Brent's search, and scipy's differential evolution."""

import numpy as np
import pytest

from hostkit.errors import HostkitError
from hostkit.optimisers import differential_evolution, grid_brent

LOWER, UPPER = np.array([-3.0]), np.array([4.0])


def wavy(points: np.ndarray) -> np.ndarray:
    """Several minima, the lowest near 2.1."""
    x = points[:, 0]
    return np.cos(3.0 * x) + 0.1 * (x - 2.0) ** 2


def asked(calls: list[np.ndarray]):
    def cost(points: np.ndarray) -> np.ndarray:
        calls.append(points.copy())
        return wavy(points)

    return cost


def test_grid_is_one_call_and_the_search_stays_in_the_best_bracket() -> None:
    calls: list[np.ndarray] = []
    result = grid_brent.minimise(asked(calls), LOWER, UPPER, rng=np.random.default_rng(0))
    dense = np.linspace(-3.0, 4.0, 700_001)
    assert result.x[0] == pytest.approx(dense[np.argmin(wavy(dense[:, None]))], abs=1e-5)
    np.testing.assert_allclose(calls[0][:, 0], np.linspace(-3.0, 4.0, 32))
    later = np.concatenate(calls[1:])
    assert np.abs(later - result.x).max() <= 2 * 7.0 / 31
    assert result.evaluations == 32 + len(later) < 60
    assert len(result.history) == result.stopped_at + 1 == len(calls)


def test_grid_sees_a_narrow_valley_that_brent_alone_does_not() -> None:
    def narrow(points: np.ndarray) -> np.ndarray:
        return 0.01 * (points[:, 0] + 3.0) - np.exp(-(((points[:, 0] - 3.2) / 0.3) ** 2))

    result = grid_brent.minimise(narrow, LOWER, UPPER, rng=np.random.default_rng(0))
    assert result.x[0] == pytest.approx(3.2, abs=1e-2)


def test_grid_brent_takes_one_parameter_only() -> None:
    with pytest.raises(HostkitError, match="searches one parameter, the box has 3"):
        grid_brent.minimise(
            lambda p: p[:, 0], np.zeros(3), np.ones(3), rng=np.random.default_rng(0)
        )
    for wrong in ({"points": 2}, {"iterations": 0}):
        with pytest.raises(HostkitError, match="at least 3 and 1"):
            grid_brent.minimise(wavy, LOWER, UPPER, rng=np.random.default_rng(0), **wrong)


@pytest.mark.parametrize("minimise", [grid_brent.minimise, differential_evolution.minimise])
def test_all_costs_lost_and_wrong_shapes_are_refused(minimise) -> None:
    with pytest.raises(HostkitError, match="not finite at any point"):
        minimise(lambda p: p[:, 0] * np.nan, LOWER, UPPER, rng=np.random.default_rng(0))
    with pytest.raises(HostkitError, match="one number for each"):
        minimise(lambda p: p, LOWER, UPPER, rng=np.random.default_rng(0))
    with pytest.raises(HostkitError, match="bounds"):
        minimise(wavy, UPPER, LOWER, rng=np.random.default_rng(0))


def test_evolution_asks_for_a_generation_at_a_time() -> None:
    calls: list[np.ndarray] = []
    result = differential_evolution.minimise(
        asked(calls),
        LOWER,
        UPPER,
        particles=9,
        iterations=6,
        polish=False,
        rng=np.random.default_rng(1),
    )
    assert [len(call) for call in calls] == [9] * 7
    assert (result.evaluations, result.stopped_at) == (63, 6)


def test_polish_helps_and_stays_in_the_box() -> None:
    calls: list[np.ndarray] = []

    def cost(points: np.ndarray) -> np.ndarray:
        calls.append(points.copy())
        return ((points - np.array([5.0, 0.3])) ** 2).sum(axis=1)

    box = np.array([-1.0, -1.0]), np.array([1.0, 1.0])
    found = [
        differential_evolution.minimise(
            cost, *box, iterations=8, polish=polish, rng=np.random.default_rng(1)
        ).cost
        for polish in (False, True)
    ]
    assert found[1] < found[0] - 1e-9
    assert found[1] == pytest.approx(16.0, abs=1e-9)
    every = np.concatenate(calls)
    assert every.max() <= 1.0
    assert every.min() >= -1.0


def test_evolution_stops_when_patience_is_over() -> None:
    calls: list[np.ndarray] = []

    def never_better(points: np.ndarray) -> np.ndarray:
        calls.append(points)
        return points[:, 0] + 100.0 * (len(calls) > 1)

    result = differential_evolution.minimise(
        never_better,
        LOWER,
        UPPER,
        patience=4,
        polish=False,
        iterations=90,
        rng=np.random.default_rng(1),
    )
    assert result.stopped_at == 4


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"particles": 4}, "4 particles.*at least 5"),
        ({"iterations": 0}, "0 iterations"),
        ({"patience": 0}, "patience 0"),
    ],
)
def test_evolution_refuses_impossible_counts(wrong: dict[str, int], message: str) -> None:
    with pytest.raises(HostkitError, match=message):
        differential_evolution.minimise(wavy, LOWER, UPPER, rng=np.random.default_rng(0), **wrong)
