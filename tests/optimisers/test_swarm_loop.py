"""The loop that all swarms share, and its guards."""

from collections.abc import Callable

import numpy as np
import pytest

from hostkit.errors import HostkitError
from hostkit.optimisers import adaptive_pso, pso, qpso, rdpso
from hostkit.optimisers.box import Box
from hostkit.optimisers.swarm import Move, Rule, Swarm, minimise_many

UNIT = (np.zeros(1), np.ones(1))
WITH_VELOCITY = {
    pso.NAME: pso.rule(),
    pso.LDW_NAME: pso.ldw_rule(),
    rdpso.NAME: rdpso.rule(),
    rdpso.ARTICLE_NAME: rdpso.article_rule(),
    adaptive_pso.NAME: adaptive_pso.rule(),
    adaptive_pso.AWP_NAME: adaptive_pso.awp_rule(),
}


def watched(rule: Rule, seen: list[tuple[Swarm, Move]]) -> Rule:
    def move(swarm: Swarm, rng: np.random.Generator) -> Move:
        made = rule.move(swarm, rng)
        seen.append((swarm, made))
        return made

    return Rule(move=move, starts_moving=rule.starts_moving)


def pushing(step: float) -> Rule:
    """A rule that moves every particle by the same step."""

    def move(swarm: Swarm, rng: np.random.Generator) -> Move:
        velocity = np.full_like(swarm.position, step)
        return Move(position=swarm.position + velocity, velocity=velocity)

    return Rule(move=move)


def recorded(points: list[np.ndarray], cost: Callable[[np.ndarray], np.ndarray]):
    def wrapped(position: np.ndarray) -> np.ndarray:
        points.append(position.copy())
        return cost(position)

    return wrapped


def flat(position: np.ndarray) -> np.ndarray:
    return np.ones(position.shape[:2])


def test_of_equal_costs_the_first_is_kept() -> None:
    """Only what is strictly better replaces a best, and the leader is the first of the best."""
    visited: list[np.ndarray] = []
    result = minimise_many(
        qpso.rule(), recorded(visited, flat), *UNIT, runs=2, rng=np.random.default_rng(1)
    )
    np.testing.assert_array_equal(result.x, visited[0][:, 0])


def test_a_cost_that_is_not_finite_is_not_remembered() -> None:
    seen: list[tuple[Swarm, Move]] = []

    def cost(position: np.ndarray) -> np.ndarray:
        return np.where(position[..., 0] < 0.5, np.nan, 1.0 - position[..., 0])

    minimise_many(watched(qpso.rule(), seen), cost, *UNIT, runs=3, rng=np.random.default_rng(1))
    last = seen[-1][0]
    assert np.isfinite(last.best_cost).all()
    assert (last.best >= 0.5).all()
    first = seen[0][0]
    assert np.isposinf(first.best_cost[first.best[..., 0] < 0.5]).all()


def test_all_costs_lost_is_an_error_that_says_where() -> None:
    def cost(position: np.ndarray) -> np.ndarray:
        costs = flat(position)
        costs[1] = np.nan
        return costs

    with pytest.raises(HostkitError, match="in 1 of 3 runs"):
        minimise_many(qpso.rule(), cost, *UNIT, runs=3, rng=np.random.default_rng(0))
    with pytest.raises(HostkitError, match="not finite at any point"):
        qpso.minimise(lambda p: p[:, 0] * np.nan, *UNIT, rng=np.random.default_rng(0))


@pytest.mark.parametrize("step", [0.3, 1.3, 2.3])
def test_a_particle_that_leaves_is_mirrored_and_its_velocity_turned(step: float) -> None:
    position = np.array([[[0.9]], [[0.1]]])
    inside, velocity = Box(lower=UNIT[0], upper=UNIT[1]).mirror(
        position + step, np.full_like(position, step)
    )
    folded = {0.3: ([0.8, 0.4], [-1, 1]), 1.3: ([0.2, 0.6], [1, -1]), 2.3: ([0.8, 0.4], [-1, 1])}
    np.testing.assert_allclose(inside[:, 0, 0], folded[step][0], atol=1e-12)
    np.testing.assert_array_equal(np.sign(velocity[:, 0, 0]), folded[step][1])


def test_mirroring_stays_inside_from_anywhere() -> None:
    box = Box(lower=np.array([-1.0]), upper=np.array([2.0]))
    outside = np.array([[-1.5], [2.5], [1e9], [-1e9], [0.5], [-1.0], [2.0]])
    inside, _ = box.mirror(outside, np.zeros_like(outside))
    assert ((inside >= -1.0) & (inside <= 2.0)).all()
    np.testing.assert_allclose(inside[[0, 1, 4, 5, 6], 0], [-0.5, 1.5, 0.5, -1.0, 2.0])


def test_without_bounce_particles_stop_on_the_bound_and_keep_their_velocity() -> None:
    seen: list[tuple[Swarm, Move]] = []
    visited: list[np.ndarray] = []
    minimise_many(
        watched(pushing(0.4), seen),
        recorded(visited, flat),
        *UNIT,
        runs=1,
        iterations=4,
        bounce=False,
        rng=np.random.default_rng(1),
    )
    assert (visited[-1] == 1.0).all()
    assert (seen[-1][0].velocity == 0.4).all()
    minimise_many(
        watched(pushing(0.4), seen), flat, *UNIT, runs=1, iterations=4, rng=np.random.default_rng(1)
    )
    assert (seen[-1][0].velocity == -0.4).any()


@pytest.mark.parametrize("name", WITH_VELOCITY)
def test_no_step_is_longer_than_half_the_box(name: str) -> None:
    seen: list[tuple[Swarm, Move]] = []
    lower, upper = np.array([-3.0, 0.0]), np.array([5.0, 0.5])
    minimise_many(
        watched(WITH_VELOCITY[name], seen),
        lambda p: np.abs(p).sum(axis=-1),
        lower,
        upper,
        runs=3,
        iterations=40,
        rng=np.random.default_rng(1),
    )
    steps = np.concatenate([np.abs(move.velocity).reshape(-1, 2) for _, move in seen])
    assert (steps <= 0.5 * (upper - lower) + 1e-15).all()
    assert np.isclose(steps.max(axis=0), 0.5 * (upper - lower)).all()


def test_first_velocities_are_drawn_only_where_the_rule_has_some() -> None:
    for rule, moving in ((pso.rule(), True), (qpso.rule(), False), (rdpso.rule(), False)):
        seen: list[tuple[Swarm, Move]] = []
        minimise_many(watched(rule, seen), flat, *UNIT, runs=1, rng=np.random.default_rng(1))
        velocity = seen[0][0].velocity
        assert bool(velocity.any()) is moving
        assert np.abs(velocity).max() <= 0.5


def test_patience_stops_and_schedules_do_not_notice() -> None:
    seen: list[tuple[Swarm, Move]] = []
    result = minimise_many(
        watched(qpso.rule(), seen),
        flat,
        *UNIT,
        runs=1,
        particles=6,
        iterations=50,
        patience=3,
        rng=np.random.default_rng(1),
    ).run(0)
    assert (result.stopped_at, result.evaluations, len(result.history)) == (3, 6 * 4, 4)
    assert [(s.iteration, s.iterations) for s, _ in seen] == [(1, 50), (2, 50), (3, 50)]
    patient = minimise_many(
        qpso.rule(), flat, *UNIT, runs=1, iterations=50, rng=np.random.default_rng(1)
    )
    assert patient.stopped_at.tolist() == [50]


def test_one_gain_starts_patience_anew() -> None:
    """Costs of run 0 fall once, at the third move; run 1 never improves; both end apart."""
    calls = [0]

    def cost(position: np.ndarray) -> np.ndarray:
        calls[0] += 1
        costs = flat(position)
        costs[0] -= 0.5 * (calls[0] > 3)
        costs[1] -= 0.5 * (calls[0] > 5)
        return costs

    batch = minimise_many(
        qpso.rule(),
        cost,
        *UNIT,
        runs=2,
        particles=5,
        iterations=50,
        patience=4,
        rng=np.random.default_rng(1),
    )
    assert batch.stopped_at.tolist() == [7, 4]
    assert batch.evaluations.tolist() == [5 * 8, 5 * 5]
    assert batch.cost.tolist() == [0.5, 1.0]
    assert len(batch.run(1).history) == 5


def test_runs_of_a_batch_do_not_know_each_other() -> None:
    target = np.array([0.1, 0.5, 0.8])

    def cost(position: np.ndarray) -> np.ndarray:
        return np.abs(position[..., 0] - target[:, np.newaxis])

    batch = minimise_many(pso.rule(), cost, *UNIT, runs=3, rng=np.random.default_rng(1))
    np.testing.assert_allclose(batch.x[:, 0], target, atol=1e-6)
    with pytest.raises(ValueError, match="read-only"):
        batch.cost[0] = 0.0


@pytest.mark.parametrize("minimise", [adaptive_pso.minimise, adaptive_pso.minimise_awp])
def test_rules_that_compare_by_ratio_refuse_negative_costs(minimise) -> None:
    with pytest.raises(HostkitError, match=r"the cost is -0\.\d+.*0 or more"):
        minimise(lambda p: p[:, 0] - 1.0, *UNIT, rng=np.random.default_rng(0))
    assert minimise(lambda p: p[:, 0], *UNIT, rng=np.random.default_rng(0)).cost >= 0.0
    assert pso.minimise(lambda p: p[:, 0] - 1.0, *UNIT, rng=np.random.default_rng(0)).cost < -0.99


@pytest.mark.parametrize(("low", "high"), [(1.0, 0.0), (0.0, 0.0), (np.nan, 1.0), (0.0, np.inf)])
def test_impossible_bounds_are_refused(low: float, high: float) -> None:
    with pytest.raises(HostkitError, match="bounds"):
        qpso.minimise(lambda p: p[:, 0], np.array([low]), np.array([high]), rng=None)


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"particles": 0}, "0 particles"),
        ({"iterations": 0}, "0 iterations"),
        ({"runs": 0}, "0 runs"),
        ({"patience": 0}, "patience = 0"),
    ],
)
def test_impossible_counts_are_refused(wrong: dict[str, int], message: str) -> None:
    counts = {"runs": 1, **wrong}
    with pytest.raises(HostkitError, match=message):
        minimise_many(qpso.rule(), flat, *UNIT, **counts, rng=np.random.default_rng(0))


def test_costs_of_the_wrong_shape_are_refused() -> None:
    with pytest.raises(HostkitError, match=r"\(1,\).*20 particles"):
        qpso.minimise(lambda p: p.sum(), *UNIT, rng=np.random.default_rng(0))
    with pytest.raises(HostkitError, match=r"shapes \(1,\) and \(2,\)"):
        qpso.minimise(lambda p: p[:, 0], np.zeros(1), np.ones(2), rng=np.random.default_rng(0))
