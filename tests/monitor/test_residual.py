import math
from dataclasses import replace

import numpy as np
import pytest
from designs import design

from hostkit.design_file import (
    design_text,
    digest,
    from_document,
    load_design,
    save_design,
    to_document,
    with_acceptance_of,
)
from hostkit.errors import DesignError, HostkitError
from hostkit.records import Acceptance, ResidualStatistics, ValidationReport
from hostkit.validation import LogHistogram, Thresholds, checks
from hostkit.validation.lag import lag_samples
from hostkit.validation.residual import WINDOW, ResidualTracker

PERIOD_S = 0.01
REPORT = ValidationReport(
    samples=1000,
    checked=1000,
    lost=0,
    mismatches=0,
    rms_rad=math.radians(1e-4),
    max_rad=math.radians(3e-4),
    digest_ok=True,
    verdict="pass",
    residual=(
        ResidualStatistics(
            axis="roll",
            samples=1000,
            rms_rad=math.radians(1e-4),
            max_rad=math.radians(3e-4),
            mean_rad=0.0,
            p50_rad=math.radians(0.5e-4),
            p95_rad=math.radians(2e-4),
            p99_rad=math.radians(2.5e-4),
            lag_s=-0.002,
            drift_rad_s=math.radians(-0.001) / 60.0,
        ),
    ),
)


def motion(time_s: np.ndarray) -> np.ndarray:
    """Slow and fast parts, deg, no two of them of one period."""
    parts = ((20.0, 0.31, 0.0), (8.0, 1.13, 1.0), (3.0, 2.71, 2.0))
    return sum(a * np.sin(2 * np.pi * f * time_s + p) for a, f, p in parts)


def fed(model_rad, residual_rad, *, batch: int = 20) -> ResidualTracker:
    tracker = ResidualTracker("roll", PERIOD_S)
    time_s = np.arange(len(model_rad)) * PERIOD_S
    for i in range(0, len(model_rad), batch):
        part = slice(i, i + batch)
        known = np.isfinite(residual_rad[part])
        tracker.add(time_s[part][known], residual_rad[part][known])
        tracker.follow(model_rad[part], residual_rad[part])
    return tracker


@pytest.mark.parametrize("lag_ms", [7.5, 0.0, -7.5, 33.3, 120.0, 0.4])
@pytest.mark.parametrize("noise_deg", [0.0, 0.05])
def test_a_known_lag_is_found_within_a_tenth_of_a_sample(lag_ms: float, noise_deg: float) -> None:
    time_s = np.arange(3000) * PERIOD_S
    rng = np.random.default_rng(1)
    model = np.radians(motion(time_s))
    device = np.radians(motion(time_s - lag_ms * 1e-3) + rng.normal(0, noise_deg, len(time_s)))
    found = fed(model, device - model).statistics()
    assert found.lag_s * 1e3 == pytest.approx(lag_ms, abs=1.0 if noise_deg else 0.25)


def test_a_slow_motion_is_not_pulled_towards_no_lag() -> None:
    time_s = np.arange(WINDOW) * PERIOD_S
    model = 0.3 * np.sin(2 * np.pi * 0.05 * time_s)
    device = 0.3 * np.sin(2 * np.pi * 0.05 * (time_s - 0.05))
    assert lag_samples(model, device) == pytest.approx(5.0, abs=0.05)


def test_a_turn_through_half_a_turn_does_not_spoil_the_lag() -> None:
    time_s = np.arange(2000) * PERIOD_S
    angle = np.radians(170.0 + motion(time_s))
    behind = np.radians(170.0 + motion(time_s - 0.02))
    model = (angle + np.pi) % (2 * np.pi) - np.pi
    assert fed(model, behind - angle).statistics().lag_s == pytest.approx(0.02, abs=1e-3)


def test_the_lag_is_that_of_the_longest_stretch_without_a_break() -> None:
    time_s = np.arange(2000) * PERIOD_S
    model = np.radians(motion(time_s))
    residual = np.radians(motion(time_s - 0.03)) - model
    residual[[100, 700, 1900]] = np.nan
    assert fed(model, residual).statistics().lag_s == pytest.approx(0.03, abs=1e-3)
    residual[::50] = np.nan
    assert fed(model, residual).statistics().lag_s is None


@pytest.mark.parametrize("model", [np.zeros(500), np.radians(motion(np.arange(40) * PERIOD_S))])
def test_no_lag_is_told_of_rest_or_of_few_samples(model: np.ndarray) -> None:
    assert fed(model, 0.0 * model).statistics().lag_s is None


def test_no_lag_is_told_of_what_does_not_resemble() -> None:
    rng = np.random.default_rng(2)
    model, device = rng.normal(0.0, 0.1, (2, 1000))
    assert lag_samples(model, device) is None
    ramp = np.linspace(0.0, 1.0, 1000)
    assert lag_samples(ramp, -ramp) is None


@pytest.mark.parametrize("batch", [1, 20, 5000])
def test_a_known_drift_is_found_from_one_minute_on(batch: int) -> None:
    rng = np.random.default_rng(3)
    time_s = np.arange(9000) * PERIOD_S
    slope = math.radians(0.02) / 60.0
    residual = 1e-3 + slope * time_s + rng.normal(0.0, 1e-6, len(time_s))
    found = fed(np.zeros(len(time_s)), residual, batch=batch).statistics()
    assert found.drift_rad_s == pytest.approx(slope, rel=1e-3)
    assert fed(np.zeros(5999), residual[:5999]).statistics().drift_rad_s is None


def test_figures_are_those_of_numpy_and_percentiles_within_one_percent() -> None:
    rng = np.random.default_rng(4)
    residual = rng.normal(1e-6, 1e-5, 50_000)
    found = fed(np.zeros(len(residual)), residual, batch=333).statistics()
    assert found.rms_rad == pytest.approx(np.sqrt(np.mean(residual**2)), rel=1e-12)
    assert found.mean_rad == pytest.approx(residual.mean(), rel=1e-9)
    assert found.max_rad == np.abs(residual).max()
    for share, value in ((50, found.p50_rad), (95, found.p95_rad), (99, found.p99_rad)):
        assert value == pytest.approx(np.percentile(np.abs(residual), share), rel=0.0105)


def test_a_residual_of_nothing_has_percentiles_of_nothing() -> None:
    found = fed(np.zeros(100), np.zeros(100)).statistics()
    assert (found.p50_rad, found.p99_rad, found.max_rad, found.rms_rad) == (0.0, 0.0, 0.0, 0.0)
    assert ResidualTracker("roll", PERIOD_S).statistics() is None


def test_a_histogram_holds_every_sample_at_its_place() -> None:
    histogram = LogHistogram(1e-6, 1.0)
    sizes = np.array([0.0, 1e-9, 0.5e-3, 1.5e-3, 1.5e-3, 0.2, 99.0])
    histogram.add(sizes)
    shown = histogram.histogram()
    assert shown.counts.sum() == len(sizes)
    assert len(shown.edges) == len(shown.counts) + 1
    inside = (shown.edges[:-1] <= 1.5e-3) & (shown.edges[1:] > 1.5e-3)
    assert shown.counts[inside].tolist() == [2]
    empty = LogHistogram(1e-6, 1.0)
    assert (empty.percentile(0.5), empty.histogram().counts.sum()) == (0.0, 0)


@pytest.mark.parametrize(
    ("limit", "reason"),
    [
        ({"max_rms_deg": 0.99e-4}, "residual 0.000100 deg rms exceeds 9.9e-05 deg"),
        ({"max_abs_deg": 2.9e-4}, "residual 0.000300 deg at most exceeds 0.00029 deg"),
        ({"max_p99_deg": 2.4e-4}, "residual 0.000250 deg in the 99th percentile exceeds 0.00024"),
        ({"max_lag_ms": 1.9}, "lag -2.000000 ms exceeds 1.9 ms"),
        ({"max_drift_deg_min": 0.9e-3}, "drift -0.001000 deg/min exceeds 0.0009 deg/min"),
    ],
)
def test_each_limit_fails_what_is_beyond_it_and_nothing_else(
    limit: dict[str, float], reason: str
) -> None:
    (name, value), *_ = limit.items()
    reasons = [c.reason for c in checks(REPORT, Thresholds(**limit)) if c.reason]
    assert len(reasons) == 1
    assert reason in reasons[0]
    assert not any(c.reason for c in checks(REPORT, Thresholds(**{name: 1.2 * value})))


def test_a_limit_on_what_could_not_be_measured_is_not_kept() -> None:
    short = replace(REPORT, residual=(replace(REPORT.residual[0], lag_s=None, drift_rad_s=None),))
    for limit in ({"max_lag_ms": 5.0}, {"max_drift_deg_min": 5.0}):
        (reason,) = [c.reason for c in checks(short, Thresholds(**limit)) if c.reason]
        assert "could not be measured" in reason
    assert not any(c.reason for c in checks(short, Thresholds()))


def test_no_limit_at_all_leaves_the_steps() -> None:
    free = Thresholds(max_rms_deg=None, max_lost_share=None)
    bad = replace(REPORT, rms_rad=1.0, max_rad=2.0, lost=10_000)
    assert not any(c.reason for c in checks(bad, free))
    wrong = replace(bad, mismatches=1)
    assert [c.reason for c in checks(wrong, free) if c.reason] == [
        "1 of 1000 steps differ from the integer model"
    ]


def test_acceptance_is_no_part_of_the_digest_and_survives_the_file(tmp_path) -> None:
    plain = design()
    limited = replace(plain, acceptance=Acceptance(max_rms_deg=0.001, max_lag_ms=5.0))
    assert digest(limited) == digest(plain)
    assert "acceptance" not in design_text(plain)
    assert to_document(limited) == to_document(plain)
    path = tmp_path / "design.json"
    save_design(limited, path)
    assert load_design(path) == limited
    assert '"max_lag_ms": 5.0' in path.read_text()
    assert with_acceptance_of(plain, path) == limited
    assert with_acceptance_of(plain, tmp_path / "none.json") == plain
    path.write_text("not a design")
    assert with_acceptance_of(plain, path) == plain


@pytest.mark.parametrize(
    ("acceptance", "says"),
    [
        (3, "must be an object"),
        ({"max_rms": 1.0}, "unknown key 'max_rms'"),
        ({"max_rms_deg": "1"}, "max_rms_deg"),
        ({"max_rms_deg": None}, "max_rms_deg"),
        ({"max_lag_ms": -1.0}, "max_lag_ms = -1.0"),
        ({"max_lost_share": 2.0}, "at most 1"),
        ({"max_abs_deg": True}, "max_abs_deg"),
    ],
)
def test_a_wrong_acceptance_is_refused_by_name(acceptance: object, says: str) -> None:
    document = {**to_document(design()), "acceptance": acceptance}
    with pytest.raises(DesignError, match=says):
        from_document(document)


def test_the_command_line_wins_over_the_design_and_the_design_over_the_default() -> None:
    limited = replace(design(), acceptance=Acceptance(max_rms_deg=0.001, max_lag_ms=5.0))
    assert Thresholds.of(design()) == Thresholds()
    found = Thresholds.of(limited, max_lag_ms=7.0, max_abs_deg=1.0)
    assert (found.max_rms_deg, found.max_lag_ms, found.max_abs_deg) == (0.001, 7.0, 1.0)
    assert found.max_lost_share == Thresholds().max_lost_share
    assert Thresholds.of(limited, max_rms_deg=0.0).max_rms_deg == 0.0
    with pytest.raises(HostkitError, match="max_lag_ms = nan"):
        Thresholds.of(limited, max_lag_ms=math.nan)
