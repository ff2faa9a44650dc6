"""The float model. Its equations stand in :mod:`hostkit.filters.complementary.parameters`."""

import math

import numpy as np
from numpy.typing import NDArray

from hostkit.attitude import to_body, wrap_rad
from hostkit.filters.complementary.gate import corrects_float, force_gate
from hostkit.filters.complementary.parameters import BIAS_LIMIT_RAD_S, Settings, settings
from hostkit.filters.complementary.tilt import RATE_AXIS, measured_tilt_rad
from hostkit.records import AXES, FilterDesign
from hostkit.sensors import SENSORS

Vector = NDArray[np.float64]

TURN, HALF = 2.0 * math.pi, math.pi


def run_float(
    design: FilterDesign, rate_rad_s: Vector, force_g: Vector, start: Vector | None = None
) -> Vector:
    """Run the float model.

    Parameters
    ----------
    design
        A design of this filter.
    rate_rad_s, force_g
        Angular rate and specific force (in g) in sensor axes, each of shape ``(N, 3)``.
    start
        State before the first sample, shape ``(S,)``; without it the first sample loads the
        measured tilt.

    Returns
    -------
    numpy.ndarray
        States, shape ``(N, S)``: the A angles of the design's axes, rad in [-pi, pi), and with an
        integral gain the A biases, rad/s, within +-BIAS_LIMIT_RAD_S.

    Raises
    ------
    DesignError
        If a parameter is not possible.
    """
    own = settings(design)
    rate, force = to_body(design.mounting, rate_rad_s), to_body(design.mounting, force_g)
    corrects = _corrects(design, own, force_g)
    axes = AXES[design.axes]
    angles, biases = [], []
    for i, axis in enumerate(axes):
        tilt = wrap_rad(measured_tilt_rad(axis, design.tilt, force) - own.tilt_offset_rad[i])
        step = (1.0 + own.gyro_scale[i]) * rate[:, RATE_AXIS[axis]] * design.period_s
        angle = None if start is None else float(start[i])
        if own.integral_gain_per_s2 is None:
            step -= own.gyro_bias_rad_s[i] * design.period_s
            angles.append(_blend(step, tilt, (1.0 - own.eta) * corrects, angle))
        else:
            bias = own.gyro_bias_rad_s[i] if start is None else float(start[len(axes) + i])
            weights = np.stack(((1.0 - own.eta) * corrects, own.integral_gain_per_s2 * corrects))
            run = _blend_and_learn(step, tilt, weights, (angle, bias), design.period_s)
            angles.append(run[0])
            biases.append(run[1])
    return np.stack([*angles, *biases], axis=-1)


def _corrects(design: FilterDesign, own: Settings, force_g: Vector) -> Vector:
    gravity = SENSORS[design.sensor.part].gravity_count(design.sensor)
    gate = None if own.gate_g is None else force_gate(own.gate_g, gravity)
    return corrects_float(gate, gravity, force_g)


def _blend(step: Vector, tilt: Vector, weight: Vector, angle: float | None) -> Vector:
    out = np.empty(len(tilt))
    samples = zip(step.tolist(), tilt.tolist(), weight.tolist(), strict=True)
    for k, (turned, measured, blend) in enumerate(samples):
        if angle is None:
            angle = measured
        else:
            predicted = angle + turned
            innovation = (measured - predicted + HALF) % TURN - HALF
            angle = (predicted + blend * innovation + HALF) % TURN - HALF
        out[k] = angle
    return out


def _blend_and_learn(
    step: Vector,
    tilt: Vector,
    weights: Vector,
    start: tuple[float | None, float],
    period_s: float,
) -> tuple[Vector, Vector]:
    """Run one axis with its integral; `weights` are 1 - eta and ki, shape ``(2, N)``."""
    angles, biases = np.empty(len(tilt)), np.empty(len(tilt))
    angle, bias = start
    samples = zip(step.tolist(), tilt.tolist(), *weights.tolist(), strict=True)
    for k, (turned, measured, blend, gain) in enumerate(samples):
        if angle is None:
            angle = measured
        else:
            predicted = angle + turned - bias * period_s
            innovation = (measured - predicted + HALF) % TURN - HALF
            angle = (predicted + blend * innovation + HALF) % TURN - HALF
            bias -= gain * innovation * period_s
            bias = min(max(bias, -BIAS_LIMIT_RAD_S), BIAS_LIMIT_RAD_S)
        angles[k], biases[k] = angle, bias
    return angles, biases
