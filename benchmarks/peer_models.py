"""The peers of our filter on a device, in NumPy: what their C is held against.

The references stand in ``benchmarks/firmware``. Each takes angular rate (rad/s) and specific force,
shape ``(N, 3)``, and the sample period (s), and gives roll and pitch, rad, shape ``(N, 2)``.
"""

from collections.abc import Callable, Iterator

import numpy as np
from numpy.typing import NDArray

Vector = NDArray[np.float64]
Model = Callable[[Vector, Vector, float], Vector]

BETA = 0.1
PROPORTIONAL, INTEGRAL = 1.0, 0.05
ANGLE_NOISE, BIAS_NOISE, TILT_NOISE = 1e-3, 3e-3, 3e-2


def madgwick(rate_rad_s: Vector, force: Vector, period_s: float) -> Vector:
    """Run the gradient filter of Madgwick's report."""

    def attitudes() -> Iterator[Vector]:
        q = np.array([1.0, 0.0, 0.0, 0.0])
        for w, f in zip(rate_rad_s, force, strict=True):
            a, b, c, d = q
            jacobian = 2.0 * np.array([[-c, d, -a, b], [b, a, d, c], [0, -2 * b, -2 * c, 0]])
            slope = _unit(jacobian.T @ (_up(q) - _unit(f)))
            q = _unit(q + period_s * (0.5 * _product(q, w) - BETA * slope))
            yield q

    return np.array([_angles(_up(q)) for q in attitudes()])


def mahony(rate_rad_s: Vector, force: Vector, period_s: float) -> Vector:
    """Run the explicit complementary filter of Mahony, Hamel and Pflimlin."""

    def attitudes() -> Iterator[Vector]:
        q, bias = np.array([1.0, 0.0, 0.0, 0.0]), np.zeros(3)
        for w, f in zip(rate_rad_s, force, strict=True):
            error = np.cross(_unit(f), _up(q))
            turned = _product(q, w - bias + PROPORTIONAL * error)
            bias = bias - INTEGRAL * period_s * error
            q = _unit(q + 0.5 * period_s * turned)
            yield q

    return np.array([_angles(_up(q)) for q in attitudes()])


def kalman(rate_rad_s: Vector, force: Vector, period_s: float) -> Vector:
    """Run the filter of angle and bias in matrices, one axis after the other."""
    tilts = np.array([_angles(f) for f in force])
    return np.stack([_kalman(rate_rad_s[:, i], tilts[:, i], period_s) for i in range(2)], axis=1)


def _kalman(rate_rad_s: Vector, tilt: Vector, period_s: float) -> Vector:
    state, spread = np.array([tilt[0], 0.0]), np.zeros((2, 2))
    forward = np.array([[1.0, -period_s], [0.0, 1.0]])
    noise = period_s * np.diag([ANGLE_NOISE, BIAS_NOISE])
    out = [tilt[0]]
    for w, measured in zip(rate_rad_s[1:], tilt[1:], strict=True):
        state = forward @ state + np.array([period_s * w, 0.0])
        spread = forward @ spread @ forward.T + noise
        gain = spread[:, 0] / (spread[0, 0] + TILT_NOISE)
        state = state + gain * _wrapped(measured - state[0])
        state[0] = _wrapped(state[0])
        spread = spread - np.outer(gain, spread[0])
        out.append(state[0])
    return np.array(out)


def _wrapped(angle: float) -> float:
    return float((angle + np.pi) % (2.0 * np.pi) - np.pi)


def _unit(v: Vector) -> Vector:
    return np.asarray(v / np.linalg.norm(v))


def _product(q: Vector, w: Vector) -> Vector:
    """Return the product of a quaternion and one without a real part."""
    v = q[1:]
    return np.concatenate([[-v @ w], q[0] * w + np.cross(v, w)])


def _up(q: Vector) -> Vector:
    a, b, c, d = q
    return np.array([2 * (b * d - a * c), 2 * (a * b + c * d), 1 - 2 * (b * b + c * c)])


def _angles(v: Vector) -> Vector:
    return np.array([np.arctan2(v[1], v[2]), np.arctan2(-v[0], np.hypot(v[1], v[2]))])


MODELS: dict[str, Model] = {"madgwick": madgwick, "mahony": mahony, "kalman": kalman}
"""By the name of their C file."""
