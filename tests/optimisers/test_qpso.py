import numpy as np
import pytest

from hostkit.errors import HostkitError
from hostkit.optimisers import qpso
from hostkit.optimisers.swarm import falling, minimise_many


def sphere(points: np.ndarray) -> np.ndarray:
    return ((points - 0.7) ** 2).sum(axis=-1)


def rastrigin(points: np.ndarray) -> np.ndarray:
    shifted = points - 0.3
    return (shifted**2 - 10 * np.cos(2 * np.pi * shifted) + 10).sum(axis=-1)


def holes(points: np.ndarray) -> np.ndarray:
    return np.where(points[..., 0] < 0, np.nan, sphere(points))


def plain_qpso(cost, lower, upper, *, particles, iterations, rng):
    """The rule written out for one run, with its draws in the stated order."""
    width, shape = upper - lower, (particles, len(lower))
    x = lower + width * rng.random(shape)
    best, value = x.copy(), np.nan_to_num(cost(x), nan=np.inf)
    history = [value.min()]
    for t in range(1, iterations + 1):
        alpha = (0.9 - 0.5) * (1 - t / iterations) + 0.5
        phi, u, sign = rng.random(shape), rng.random(shape), rng.random(shape)
        p = phi * best + (1 - phi) * best[np.argmin(value)]
        reach = alpha * np.abs(best.mean(axis=0) - x)
        x = p + np.where(sign < 0.5, 1.0, -1.0) * (reach * np.log(1 / (1 - u)))
        offset = np.mod(x - lower, 2 * width)
        x = lower + np.minimum(offset, 2 * width - offset)
        now = np.nan_to_num(cost(x), nan=np.inf)
        better = now < value
        best[better], value[better] = x[better], now[better]
        history.append(value.min())
    return best[np.argmin(value)], value.min(), np.array(history)


@pytest.mark.parametrize(
    ("cost", "dimensions", "particles", "iterations", "seed"),
    [(sphere, 3, 5, 12, 3), (rastrigin, 2, 20, 100, 7), (holes, 1, 6, 9, 2)],
)
def test_draw_order_is_the_plain_one(cost, dimensions, particles, iterations, seed) -> None:
    box, size = np.full(dimensions, 5.0), {"particles": particles, "iterations": iterations}
    got = qpso.minimise(cost, -box, box, **size, rng=np.random.default_rng(seed))
    x, value, history = plain_qpso(cost, -box, box, **size, rng=np.random.default_rng(seed))
    np.testing.assert_array_equal(got.x, x)
    np.testing.assert_array_equal(got.history, history)
    assert got.cost == value


@pytest.mark.parametrize(
    ("cost", "dimensions", "particles", "iterations", "seed", "x", "history_sum"),
    [
        (sphere, 3, 5, 12, 3, [0.17236642282633, 0.43148362827191, 0.71293767375059], 37.87281469),
        (rastrigin, 2, 20, 100, 7, [0.300084132813194, 0.299927842510357], 50.2928423383),
        (holes, 1, 6, 9, 2, [0.7007415818327312], 0.2786009510),
    ],
)
def test_results_from_before_the_shared_loop(
    cost, dimensions, particles, iterations, seed, x, history_sum
) -> None:
    """Values of the loop that QPSO had of its own before all rules shared one."""
    box = np.full(dimensions, 5.0)
    got = qpso.minimise(
        cost, -box, box, particles=particles, iterations=iterations, rng=np.random.default_rng(seed)
    )
    np.testing.assert_allclose(got.x, x, rtol=1e-9)
    assert got.history.sum() == pytest.approx(history_sum, rel=1e-9)


def test_one_run_is_the_batch_of_one() -> None:
    box = np.full(2, 5.0)
    one = qpso.minimise(rastrigin, -box, box, rng=np.random.default_rng(4))
    batch = minimise_many(
        qpso.rule(), rastrigin, -box, box, runs=1, rng=np.random.default_rng(4)
    ).run(0)
    np.testing.assert_array_equal(one.history, batch.history)
    np.testing.assert_array_equal(one.x, batch.x)


def test_alpha_falls_from_09_to_05_over_the_planned_iterations() -> None:
    assert qpso.CONTRACTION == (0.9, 0.5)
    assert [falling(0.9, 0.5, t, 100) for t in (0, 25, 100)] == pytest.approx([0.9, 0.8, 0.5])


@pytest.mark.parametrize("contraction", [(1.8, 0.5), (0.9, -0.1), (0.9, 1.79), (np.nan, 0.5)])
def test_contractions_that_do_not_settle_are_refused(contraction: tuple[float, float]) -> None:
    with pytest.raises(HostkitError, match=r"1\.781"):
        qpso.rule(contraction)
