import numpy as np
import pytest

from hostkit.errors import HostkitError
from hostkit.optimisers import OPTIMISERS
from hostkit.optimisers.qpso import _alpha, _reflect, minimise


def sphere(points: np.ndarray) -> np.ndarray:
    return ((points - 0.7) ** 2).sum(axis=1)


def rastrigin(points: np.ndarray) -> np.ndarray:
    shifted = points - 0.3
    return (shifted**2 - 10 * np.cos(2 * np.pi * shifted) + 10).sum(axis=1)


@pytest.mark.parametrize(("cost", "optimum", "dimensions"), [(sphere, 0.7, 5), (rastrigin, 0.3, 2)])
@pytest.mark.parametrize("name", OPTIMISERS.names())
def test_known_minima_are_found(name: str, cost, optimum: float, dimensions: int) -> None:
    box = np.full(dimensions, 5.0)
    result = OPTIMISERS[name].minimise(
        cost, -box, box, particles=30, iterations=300, rng=np.random.default_rng(1)
    )
    np.testing.assert_allclose(result.x, optimum, atol=1e-4)
    assert result.evaluations == 30 * 301
    assert len(result.history) == 301
    assert (np.diff(result.history) <= 0).all()
    assert not result.at_bound.any()


def test_same_seed_same_run_and_evaluations_are_counted() -> None:
    calls = []

    def counted(points: np.ndarray) -> np.ndarray:
        calls.append(len(points))
        return sphere(points)

    box = np.ones(2)
    runs = [
        minimise(counted, -box, box, particles=7, iterations=9, rng=np.random.default_rng(3))
        for _ in range(2)
    ]
    np.testing.assert_array_equal(runs[0].x, runs[1].x)
    assert sum(calls) == 2 * runs[0].evaluations == 2 * 7 * 10


def test_optimum_on_the_edge_is_found_and_reported() -> None:
    result = minimise(
        lambda p: p[:, 0], np.array([2.0]), np.array([9.0]), rng=np.random.default_rng(0)
    )
    assert result.x[0] == pytest.approx(2.0, abs=1e-5)
    assert result.at_bound.tolist() == [True]


def test_alpha_falls_from_09_to_05() -> None:
    assert _alpha((0.9, 0.5), 0, 100) == pytest.approx(0.9)
    assert _alpha((0.9, 0.5), 100, 100) == pytest.approx(0.5)


def test_reflection_stays_inside_from_anywhere() -> None:
    lower, upper = np.array([-1.0]), np.array([2.0])
    outside = np.array([[-1.5], [2.5], [1e9], [-1e9], [0.5], [-1.0], [2.0]])
    inside = _reflect(outside, lower, upper)
    assert ((inside >= lower) & (inside <= upper)).all()
    np.testing.assert_allclose(inside[[0, 1, 4, 5, 6], 0], [-0.5, 1.5, 0.5, -1.0, 2.0])


def test_nan_never_wins() -> None:
    def holes(points: np.ndarray) -> np.ndarray:
        return np.where(points[:, 0] < 0, np.nan, sphere(points))

    result = minimise(holes, np.array([-1.0]), np.array([1.0]), rng=np.random.default_rng(2))
    assert result.x[0] == pytest.approx(0.7, abs=1e-4)
    with pytest.raises(HostkitError, match="not finite"):
        minimise(lambda p: p[:, 0] * np.nan, np.zeros(1), np.ones(1), rng=np.random.default_rng(0))


@pytest.mark.parametrize(("low", "high"), [(1.0, 0.0), (0.0, 0.0), (np.nan, 1.0), (0.0, np.inf)])
def test_impossible_bounds_are_refused(low: float, high: float) -> None:
    with pytest.raises(HostkitError, match="bounds"):
        minimise(sphere, np.array([low]), np.array([high]), rng=np.random.default_rng(0))
