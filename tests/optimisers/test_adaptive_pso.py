import numpy as np
import pytest

from hostkit.optimisers.adaptive_pso import particle_share, shared_weight
from hostkit.optimisers.swarm import Swarm


def swarm(best_cost: list[float], former: float, *, iteration: int = 2) -> Swarm:
    costs = np.array([best_cost])
    position = np.zeros((1, len(best_cost), 1))
    return Swarm(
        iteration=iteration,
        iterations=10,
        position=position,
        velocity=position,
        best=position,
        best_cost=costs,
        leader=position[:, :1],
        leader_cost=costs.min(axis=1, keepdims=True),
        former_leader_cost=np.array([[former]]),
        velocity_limit=np.ones(1),
    )


def test_weights_of_a_worked_example() -> None:
    """Best costs 1, 2, 3, 6, mean 3; the leader came from 1.25: e = 0.8, s = 1/3."""
    now = swarm([1.0, 2.0, 3.0, 6.0], 1.25)
    shared = shared_weight(now, 0.9, 0.5, 0.1)
    assert shared[0, 0] == pytest.approx(0.9 - 0.5 * 0.8 + 0.1 / 3)
    np.testing.assert_allclose(particle_share(now)[0], [0.0, 0.5, 1.0, 2.5])
    np.testing.assert_allclose(
        (shared * particle_share(now))[0], [0.0, 0.266667, 0.533333, 1.333333], atol=1e-6
    )


def test_the_first_move_has_the_first_weight() -> None:
    first = swarm([1.0, 2.0], np.nan, iteration=1)
    assert shared_weight(first, 0.9, 0.5, 0.1)[0, 0] == 0.9


@pytest.mark.parametrize("value", [0.0, 2.0])
def test_a_collapsed_swarm_has_no_inertia_of_its_own(value: float) -> None:
    collapsed = swarm([value] * 3, value)
    assert particle_share(collapsed).tolist() == [[0.0, 0.0, 0.0]]
    assert shared_weight(collapsed, 0.9, 0.5, 0.1)[0, 0] == pytest.approx(0.5)


def test_particles_without_a_finite_cost_are_the_worst() -> None:
    partly = swarm([1.0, np.inf, 3.0, np.inf], np.inf)
    np.testing.assert_allclose(particle_share(partly)[0], [0.0, 4.0, 2.0, 4.0])
    assert shared_weight(partly, 0.9, 0.5, 0.1)[0, 0] == pytest.approx(0.9 + 0.1 * 0.5)
    lost = swarm([np.inf] * 3, np.inf)
    assert np.isfinite(shared_weight(lost, 0.9, 0.5, 0.1)).all()
    assert np.isfinite(particle_share(lost)).all()


def test_no_share_exceeds_the_number_of_particles() -> None:
    assert particle_share(swarm([0.0, 0.0, 0.0, 9.0], 1.0))[0].tolist() == [0.0, 0.0, 0.0, 4.0]


def test_one_particle_with_a_finite_cost_leads_the_others() -> None:
    assert particle_share(swarm([1.0, np.inf, np.inf], 1.0))[0].tolist() == [0.0, 3.0, 3.0]
