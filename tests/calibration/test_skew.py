"""What it is worth to estimate axes that are not square beside offset and scale."""

import numpy as np
import pytest

from hostkit.attitude import inclination_rad
from hostkit.calibration import accelerometer, fit_accelerometer
from hostkit.units import DEG_PER_RAD, STANDARD_GRAVITY_M_S2

G = STANDARD_GRAVITY_M_S2
DRAWS = 40


def unit(vectors: np.ndarray) -> np.ndarray:
    return vectors / np.linalg.norm(vectors, axis=1, keepdims=True)


def tilt_error_deg(poses: np.ndarray | None, rng: np.random.Generator) -> float:
    """Rms over all directions of a sensor calibrated in 12 free positions, or those given."""
    offset, scale = rng.normal(size=3) * 0.4, rng.normal(size=3) * 0.02
    cross = rng.normal(size=(3, 3)) * 0.005
    np.fill_diagonal(cross, scale)
    up = unit(rng.normal(size=(12, 3))) if poses is None else poses
    everywhere = unit(rng.normal(size=(300, 3)))
    gain = (np.eye(3) + cross).T
    reading = G * up @ gain + offset + rng.normal(size=up.shape) * 0.01
    fit = fit_accelerometer(reading, G)
    error = inclination_rad(fit.corrected(G * everywhere @ gain + offset), everywhere)
    return float(np.sqrt(np.mean(error**2))) * DEG_PER_RAD


def mean_error_deg(poses: np.ndarray | None) -> float:
    rng = np.random.default_rng(5)
    return float(np.sqrt(np.mean([tilt_error_deg(poses, rng) ** 2 for _ in range(DRAWS)])))


def test_skew_beside_offset_and_scale(monkeypatch: pytest.MonkeyPatch) -> None:
    faces = np.vstack((np.eye(3), -np.eye(3)))
    free, square = mean_error_deg(None), mean_error_deg(faces)
    monkeypatch.setattr(accelerometer, "SKEW_PRIOR", 1e-6)
    assert free < 0.95 * mean_error_deg(None)
    assert square == pytest.approx(mean_error_deg(faces), rel=0.01)
