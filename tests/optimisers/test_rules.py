"""What holds for every optimiser."""

import numpy as np
import pytest
from scipy.signal import lfilter

from hostkit.optimisers import OPTIMISERS, adaptive_pso, minimise_many, pso, qpso, rdpso
from hostkit.records import SensorConfig
from hostkit.simulation import SensorErrors, simulate

RULES = {
    qpso.NAME: qpso.rule(),
    pso.NAME: pso.rule(),
    pso.LDW_NAME: pso.ldw_rule(),
    rdpso.NAME: rdpso.rule(),
    rdpso.ARTICLE_NAME: rdpso.article_rule(),
    adaptive_pso.NAME: adaptive_pso.rule(),
    adaptive_pso.AWP_NAME: adaptive_pso.awp_rule(),
}
SEVERAL = [o.name for o in OPTIMISERS if not o.one_dimension]
TAU_S = (0.02, 100.0)
SEEDS = 100


def sphere(points: np.ndarray) -> np.ndarray:
    return ((points - 0.7) ** 2).sum(axis=-1)


def rosenbrock(points: np.ndarray) -> np.ndarray:
    x, y = points[..., 0] + 0.5, points[..., 1] + 0.5
    return 100 * (y - x**2) ** 2 + (1 - x) ** 2


def test_the_registry_has_every_rule_of_the_packages_docs() -> None:
    assert set(RULES) | {"grid-brent", "differential-evolution"} == set(OPTIMISERS.names())
    assert [o.name for o in OPTIMISERS if o.one_dimension] == ["grid-brent"]
    assert all(o.title and "\n" not in o.title for o in OPTIMISERS)


@pytest.mark.parametrize("name", SEVERAL)
@pytest.mark.parametrize(
    ("cost", "optimum", "tolerance"), [(sphere, [0.7] * 5, 1e-5), (rosenbrock, [0.5, 0.5], 1e-3)]
)
def test_known_minima_are_found(name: str, cost, optimum: list[float], tolerance: float) -> None:
    box = np.full(len(optimum), 5.0)
    result = OPTIMISERS[name].minimise(
        cost, -box, box, particles=30, iterations=600, rng=np.random.default_rng(1)
    )
    np.testing.assert_allclose(result.x, optimum, atol=tolerance)
    assert result.cost == cost(result.x)
    assert (np.diff(result.history) <= 0).all()
    assert result.history[-1] == result.cost
    assert not result.at_bound.any()


@pytest.mark.parametrize("name", RULES)
def test_a_swarm_asks_for_as_many_points_as_it_says(name: str) -> None:
    asked: list[int] = []

    def counted(points: np.ndarray) -> np.ndarray:
        asked.append(len(points))
        return sphere(points)

    result = OPTIMISERS[name].minimise(
        counted, -np.ones(2), np.ones(2), particles=7, iterations=9, rng=np.random.default_rng(3)
    )
    assert asked == [7] * 10
    assert (result.evaluations, result.stopped_at, len(result.history)) == (70, 9, 10)


@pytest.mark.parametrize("name", OPTIMISERS.names())
def test_same_seed_same_run(name: str) -> None:
    def run(seed: int):
        return OPTIMISERS[name].minimise(
            sphere, np.array([-1.0]), np.array([2.0]), iterations=8, rng=np.random.default_rng(seed)
        )

    np.testing.assert_array_equal(run(5).x, run(5).x)
    np.testing.assert_array_equal(run(5).history, run(5).history)
    if name != "grid-brent":
        assert run(5).history[0] != run(6).history[0]


@pytest.mark.parametrize("name", OPTIMISERS.names())
def test_an_optimum_on_the_bound_is_found_and_reported(name: str) -> None:
    visited: list[np.ndarray] = []

    def cost(points: np.ndarray) -> np.ndarray:
        visited.append(points.copy())
        return points[:, 0]

    result = OPTIMISERS[name].minimise(
        cost, np.array([2.0]), np.array([9.0]), rng=np.random.default_rng(0)
    )
    assert result.x[0] == pytest.approx(2.0, abs=1e-5)
    assert result.at_bound.tolist() == [True]
    every = np.concatenate(visited)
    assert every.min() >= 2.0
    assert every.max() <= 9.0


@pytest.mark.parametrize("name", OPTIMISERS.names())
def test_a_cost_that_is_not_finite_never_wins(name: str) -> None:
    def holes(points: np.ndarray) -> np.ndarray:
        bad = np.where(points[:, 0] < -0.5, -np.inf, np.nan)
        return np.where(points[:, 0] < 0.4, bad, sphere(points))

    result = OPTIMISERS[name].minimise(
        holes, np.array([-1.0]), np.array([1.0]), rng=np.random.default_rng(2)
    )
    assert result.x[0] == pytest.approx(0.7, abs=1e-4)
    assert np.isfinite(result.cost)


@pytest.fixture(scope="module")
def tilt() -> tuple[np.ndarray, np.ndarray, float]:
    """Error form of the roll of 300 simulated samples: c, v and the sample period."""
    recording = simulate(
        "steps",
        duration_s=3.0,
        rate_hz=100.0,
        sensor=SensorConfig(
            part="mpu6050", gyro_full_scale_deg_s=500, accel_full_scale_g=4, low_pass_setting=3
        ),
        errors=SensorErrors(vibration_m_s2=2.0),
        rng=np.random.default_rng(1),
    )
    force, up = recording.specific_force_m_s2, recording.up_reference
    reference = np.arctan2(up[:, 1], up[:, 2])
    start = np.arctan2(force[:, 1], force[:, 2]) - reference
    drive = recording.angular_rate_rad_s[:, 0] / recording.rate_hz
    drive = drive - np.diff(reference, prepend=reference[0]) - start
    drive[0] = 0.0
    assert len(start) == 300
    return drive, start, 1.0 / recording.rate_hz


def batch_cost(tilt, log_tau: np.ndarray) -> np.ndarray:
    """RMSE of the filter for time constants of any shape."""
    drive, start, period_s = tilt
    tau_s = np.exp(log_tau)
    eta = tau_s / (tau_s + period_s)
    error, total = np.full(eta.shape, start[0]), np.full(eta.shape, start[0] ** 2)
    for c, v in zip(drive[1:], start[1:], strict=True):
        error = eta * (error + c) + v
        total += error**2
    return np.sqrt(total / len(start))


def point_cost(tilt, log_tau: float) -> float:
    """The same for one time constant, quickly."""
    drive, start, period_s = tilt
    eta = np.exp(log_tau) / (np.exp(log_tau) + period_s)
    return float(np.sqrt(np.mean(lfilter([1.0], [1.0, -eta], eta * drive + start) ** 2)))


@pytest.fixture(scope="module")
def exact_rad(tilt) -> float:
    """The lowest cost: a dense grid, then closer and closer around its best point."""
    points = np.linspace(*np.log(TAU_S), 4001)
    for _ in range(6):
        best = points[np.argmin(batch_cost(tilt, points))]
        spacing = points[1] - points[0]
        points = np.clip(best + spacing * np.linspace(-1, 1, 81), *np.log(TAU_S))
    return float(batch_cost(tilt, points).min())


@pytest.mark.parametrize("name", RULES)
def test_every_run_of_a_swarm_finds_the_tilt_filter(name: str, tilt, exact_rad: float) -> None:
    low, high = np.log(TAU_S)
    batch = minimise_many(
        RULES[name],
        lambda points: batch_cost(tilt, points[..., 0]),
        np.array([low]),
        np.array([high]),
        runs=SEEDS,
        rng=np.random.default_rng(1),
    )
    excess = batch.cost - exact_rad
    assert excess.min() >= -1e-12
    assert np.mean(excess <= 1e-6) == 1.0


@pytest.mark.parametrize(("name", "runs"), [("grid-brent", 1), ("differential-evolution", SEEDS)])
def test_every_run_of_a_baseline_finds_the_tilt_filter(
    name: str, runs: int, tilt, exact_rad: float
) -> None:
    low, high = np.log(TAU_S)

    def cost(points: np.ndarray) -> np.ndarray:
        return np.array([point_cost(tilt, x) for x in points[:, 0]])

    found = [
        OPTIMISERS[name]
        .minimise(
            cost,
            np.array([low]),
            np.array([high]),
            iterations=25,
            rng=np.random.default_rng(seed),
        )
        .cost
        for seed in range(runs)
    ]
    excess = np.array(found) - exact_rad
    assert excess.min() >= -1e-12
    assert np.mean(excess <= 1e-6) == 1.0
