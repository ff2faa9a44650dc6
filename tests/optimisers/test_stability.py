"""The bounds on constants: right by an independent computation, and enforced."""

import numpy as np
import pytest

from hostkit.errors import HostkitError
from hostkit.optimisers import adaptive_pso, pso, rdpso, stability

DRAWS = 200_000


def radius(matrix: np.ndarray) -> float:
    return float(np.abs(np.linalg.eigvals(matrix)).max())


@pytest.mark.parametrize("weight", [0.0, 0.4, 0.7298, 0.9])
def test_order_one_is_where_the_mean_settles(weight: float) -> None:
    def mean_map(total_pull: float) -> np.ndarray:
        return np.array([[1 + weight - total_pull / 2, -weight], [1, 0]])

    limit = stability.velocity_order_one(weight)
    assert radius(mean_map(0.99 * limit)) < 1.0 < radius(mean_map(1.01 * limit))


@pytest.mark.parametrize("weight", [0.0, 0.4, 0.5, 0.7298, 0.9])
def test_order_two_is_where_the_variance_settles(weight: float) -> None:
    """Second moments of X(t+1) = (1 + w - phi) X(t) - w X(t-1), phi the sum of two even draws."""

    def moment_map(total_pull: float) -> np.ndarray:
        mean, variance = total_pull / 2, total_pull**2 / 24
        gain = 1 + weight - mean
        return np.array(
            [[gain**2 + variance, -2 * gain * weight, weight**2], [gain, -weight, 0], [1, 0, 0]]
        )

    limit = stability.velocity_order_two(weight)
    assert radius(moment_map(0.99 * limit)) < 1.0 < radius(moment_map(1.01 * limit))


def test_drift_factors_are_those_of_drawn_particles() -> None:
    rng = np.random.default_rng(1)
    r1, r2, z = rng.random(DRAWS), rng.random(DRAWS), rng.standard_normal(DRAWS)
    for alpha, pull in ((0.9, 1.45), (0.3, 0.5), (0.669, 1.45)):
        article = np.mean((1 - pull * (r1 + r2) + alpha * z) ** 2)
        beta = np.mean((1 - pull + alpha * z) ** 2)
        assert stability.pull_spread(alpha, pull) == pytest.approx(article, rel=0.01)
        assert stability.drift_spread(alpha, pull) == pytest.approx(beta, rel=0.01)


def test_qpso_limit_is_where_the_mean_logarithm_of_a_step_is_zero() -> None:
    u = 1.0 - np.random.default_rng(1).random(DRAWS)
    growth = np.mean(np.log(stability.QPSO_LIMIT * np.log(1 / u)))
    assert growth == pytest.approx(0.0, abs=0.01)


def test_constriction_is_the_usual_one_and_settles() -> None:
    chi = pso.constriction(4.1)
    assert chi == pytest.approx(0.7298, abs=5e-5)
    assert chi * 4.1 / 2 == pytest.approx(1.49618, abs=5e-6)
    assert chi * 4.1 < stability.velocity_order_two(chi)


@pytest.mark.parametrize(
    ("phi", "message"),
    [(4.0, "more than 4"), (np.nan, "more than 4"), (4.05, r"c1 \+ c2 = 3.*below 2")],
)
def test_constriction_outside_its_bounds_is_refused(phi: float, message: str) -> None:
    with pytest.raises(HostkitError, match=message):
        pso.rule(phi)


@pytest.mark.parametrize(
    ("weight", "pull", "message"),
    [
        ((1.0, 0.4), 2.0, "weight = 1 to 0.4"),
        ((0.9, 0.4), 2.8, r"pull = 2\.8.*0, 2\.8\)"),
        ((0.9, 0.4), 0.0, "pull = 0"),
    ],
)
def test_velocity_constants_outside_their_bounds_are_refused(weight, pull, message) -> None:
    with pytest.raises(HostkitError, match=message):
        pso.ldw_rule(weight, pull)
    assert pso.ldw_rule((0.9, 0.4), 2.79)


def test_adaptive_constants_outside_their_bounds_are_refused() -> None:
    for rule in (adaptive_pso.rule, adaptive_pso.awp_rule):
        with pytest.raises(HostkitError, match="weight = 1 "):
            rule(weight=1.0)
        with pytest.raises(HostkitError, match=r"pull = 3.*0, 2\.8\)"):
            rule(pull=3.0)


@pytest.mark.parametrize(
    ("contraction", "pull", "figures"),
    [
        ((0.9, 0.3), 2.0, r"= 1\.757 must be below 1.*12/7"),
        ((0.9, 0.3), 1.72, "12/7"),
        ((0.9, 0.7), 1.45, r"= 1\.043 must be below 1.*0\.6686 would fit"),
        ((0.9, 0.3), 0.0, "12/7"),
    ],
)
def test_article_constants_outside_the_bound_are_refused(contraction, pull, figures) -> None:
    with pytest.raises(HostkitError, match=figures):
        rdpso.article_rule(contraction, pull)


@pytest.mark.parametrize("pull", [0.5, 1.45, 1.5, 1.6])
def test_article_constants_inside_the_bound_are_taken(pull: float) -> None:
    assert rdpso.article_rule((0.9, 0.3), pull)


def test_drift_outside_the_bound_is_refused() -> None:
    with pytest.raises(HostkitError, match=r"drift = 2 .*= 1\.09 must be below 1"):
        rdpso.rule((0.9, 0.3), 2.0)
    with pytest.raises(HostkitError, match="contraction"):
        rdpso.rule((-0.1, 0.3))
    assert rdpso.rule((0.9, 0.3), 1.9)


def test_s_curve_falls_most_in_the_middle() -> None:
    curve = [rdpso.s_curve((0.9, 0.3), t, 100) for t in range(101)]
    assert curve[50] == pytest.approx(0.6)
    assert curve[0] == pytest.approx(0.9, abs=0.005)
    assert curve[100] == pytest.approx(0.3, abs=0.005)
    assert int(np.argmax(-np.diff(curve))) in (49, 50)
    assert next(t for t, alpha in enumerate(curve) if alpha < 0.669) == 46
