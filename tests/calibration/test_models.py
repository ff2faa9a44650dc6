"""The equations of the calibration: derivatives, and a bias that creeps."""

from dataclasses import replace

import numpy as np
from calibration_cases import DEG, MANY, posed

from hostkit.calibration import Problem, calibrate, find_poses, find_turns
from hostkit.calibration.accel_model import UNKNOWNS, jacobian, residual
from hostkit.calibration.rest_rate import rest_rate
from hostkit.calibration.turn_model import UNKNOWNS as TURN_UNKNOWNS
from hostkit.calibration.turn_model import turn_errors
from hostkit.units import STANDARD_GRAVITY_M_S2

G = STANDARD_GRAVITY_M_S2
STEP = 1e-6


def test_derivatives_of_the_accelerometer() -> None:
    rng = np.random.default_rng(3)
    force = rng.normal(size=(7, 3)) * 6.0
    at = rng.normal(size=UNKNOWNS) * 0.03
    steps = STEP * np.eye(UNKNOWNS)
    slopes = [(residual(at + s, force, G) - residual(at - s, force, G)) / (2 * STEP) for s in steps]
    np.testing.assert_allclose(jacobian(at, force, G), np.transpose(slopes), atol=1e-6)


def test_derivatives_of_the_turns() -> None:
    """Near numbers that fit, where the formula holds."""
    recording = posed(MANY)
    poses = find_poses((recording,))
    turns = find_turns((recording,), poses)
    found = calibrate((recording,))
    up = [
        found.accel.corrected(np.stack([getattr(turn, name) for turn in turns]))
        for name in ("force_before_m_s2", "force_after_m_s2")
    ]
    problem = Problem(
        recordings=(recording,),
        turns=turns,
        up_before=up[0] / np.linalg.norm(up[0], axis=1, keepdims=True),
        up_after=up[1] / np.linalg.norm(up[1], axis=1, keepdims=True),
        bias_rad_s=rest_rate((recording,), poses).of_sample_rad_s,
    )
    at = np.concatenate((found.gyro.scale, np.zeros(3), found.gyro.cross))
    _, slopes = turn_errors(problem, at)
    for i, step in enumerate(STEP * np.eye(TURN_UNKNOWNS)):
        moved = turn_errors(problem, at + step)[0] - turn_errors(problem, at - step)[0]
        size = np.abs(slopes[:, :, i]).max()
        np.testing.assert_allclose(moved / (2 * STEP), slopes[:, :, i], atol=0.03 * size)


def test_a_bias_that_creeps_leaves_the_scales_alone() -> None:
    recording = posed(MANY)
    creep = 0.03 * DEG * recording.time_s[:, None] * np.array((1.0, -1.0, 1.0))
    crept = replace(recording, angular_rate_rad_s=recording.angular_rate_rad_s + creep)
    steady, found = calibrate((recording,)), calibrate((crept,))
    assert len(found.poses) >= len(MANY) - 8
    tracks = rest_rate((crept,), found.poses).of_sample_rad_s[0]
    first, last = found.poses[0], found.poses[-1]
    inside = slice(first.last, last.first)
    expected = steady.gyro.bias_rad_s + creep
    assert np.abs(tracks - expected)[inside].max() < 0.08 * DEG
    np.testing.assert_allclose(found.gyro.scale, steady.gyro.scale, atol=0.004)
