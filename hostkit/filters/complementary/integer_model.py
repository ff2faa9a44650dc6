"""The integer model: what the generated C and VHDL compute, bit for bit."""

import numpy as np
from numpy.typing import NDArray

from hostkit.filters.complementary.gate import corrects_integer
from hostkit.filters.complementary.spec import BiasIntegral, ComplementarySpec
from hostkit.filters.complementary.tilt import RATE_AXIS, body_counts, measured_tilt_raw
from hostkit.fixedpoint import shift_round, wrap32

IntArray = NDArray[np.int64]

HALF_TURN, MASK = 2**31, 2**32 - 1


def step_integer(
    spec: ComplementarySpec, state_raw: IntArray, accel_count: IntArray, gyro_count: IntArray
) -> IntArray:
    """Take one step from each of N states, independently of each other.

    Parameters
    ----------
    state_raw
        States before the step, shape ``(N, S)``: the A angles in half turns, and with an integral
        the A biases.
    accel_count, gyro_count
        Counts of the step in sensor axes, each of shape ``(N, 3)``.

    Returns
    -------
    numpy.ndarray
        States after the step, shape ``(N, S)``.
    """
    angle, bias = np.split(state_raw, [len(spec.axes)], axis=1)
    corrects = corrects_integer(spec.gate, accel_count)[:, None]
    predicted = wrap32(angle + _rate_steps(spec, gyro_count) - _bias_steps(spec, bias))
    innovation = wrap32(_tilts(spec, accel_count) - predicted) * corrects
    correction = shift_round(innovation * spec.blend.raw, spec.blend.format.fraction_bits)
    after = [wrap32(predicted + correction)]
    if spec.integral is not None:
        gain, limit = spec.integral.gain, spec.integral.limit_raw
        change = shift_round(innovation * gain.raw, gain.format.fraction_bits)
        after.append(np.clip(bias - change, -limit, limit))
    return np.hstack(after)


def run_integer(
    spec: ComplementarySpec,
    accel_count: IntArray,
    gyro_count: IntArray,
    start: IntArray | None = None,
) -> IntArray:
    """Run the integer model.

    Parameters
    ----------
    accel_count, gyro_count
        Counts in sensor axes, each of shape ``(N, 3)``.
    start
        State before the first sample, shape ``(S,)``; without it the first sample loads the
        measured tilt.

    Returns
    -------
    numpy.ndarray
        States, shape ``(N, S)``: the A angles in half turns, and with an integral the A biases.
    """
    if start is not None and len(accel_count):
        first = step_integer(spec, start[np.newaxis], accel_count[:1], gyro_count[:1])
        return _run(spec, accel_count, gyro_count, first[0])
    return _run(spec, accel_count, gyro_count, None)


def _run(
    spec: ComplementarySpec, accel_count: IntArray, gyro_count: IntArray, first: IntArray | None
) -> IntArray:
    """Run from the state after the first sample, or from its measured tilt."""
    tilt, step = _tilts(spec, accel_count), _rate_steps(spec, gyro_count)
    corrects = corrects_integer(spec.gate, accel_count)
    if spec.integral is None:
        step -= spec.gyro_bias_raw
    angles, biases = [], []
    axes = len(spec.axes)
    if first is not None:
        tilt[0] = first[:axes]
    for i in range(axes):
        samples = step[:, i].tolist(), tilt[:, i].tolist(), corrects.tolist()
        if spec.integral is None:
            angles.append(_run_axis(spec, *samples))
        else:
            bias = spec.gyro_bias_raw[i] if first is None else int(first[axes + i])
            run = _run_axis_and_learn(spec, spec.integral, bias, *samples)
            angles.append(run[0])
            biases.append(run[1])
    return np.array([*angles, *biases], dtype=np.int64).T


def _tilts(spec: ComplementarySpec, accel_count: IntArray) -> IntArray:
    return wrap32(measured_tilt_raw(spec, accel_count) - np.array(spec.tilt_offset_raw))


def _rate_steps(spec: ComplementarySpec, gyro_count: IntArray) -> IntArray:
    rate = body_counts(spec, gyro_count)
    steps = [
        shift_round(rate[:, RATE_AXIS[axis]] * gain.raw, gain.format.fraction_bits)
        for axis, gain in zip(spec.axes, spec.rate_gains, strict=True)
    ]
    return np.stack(steps, axis=-1)


def _bias_steps(spec: ComplementarySpec, bias_raw: IntArray) -> IntArray:
    if spec.integral is None:
        return np.array(spec.gyro_bias_raw)
    return shift_round(bias_raw, spec.integral.fraction_bits)


def _run_axis(
    spec: ComplementarySpec, steps: list[int], tilts: list[int], corrects: list[int]
) -> list[int]:
    """Step through one axis; the wraps of :func:`wrap32` are written out, for speed."""
    blend, bits = spec.blend.raw, spec.blend.format.fraction_bits
    half = 1 << (bits - 1)
    angles = tilts[:1]
    angle = angles[0] if angles else 0
    for step, tilt, weight in zip(steps[1:], tilts[1:], corrects[1:], strict=True):
        predicted = angle + step
        innovation = (((tilt - predicted + HALF_TURN) & MASK) - HALF_TURN) * weight
        angle = predicted + ((innovation * blend + half) >> bits)
        angle = ((angle + HALF_TURN) & MASK) - HALF_TURN
        angles.append(angle)
    return angles


def _run_axis_and_learn(
    spec: ComplementarySpec,
    integral: BiasIntegral,
    bias: int,
    steps: list[int],
    tilts: list[int],
    corrects: list[int],
) -> tuple[list[int], list[int]]:
    """Step through one axis whose bias follows the correction."""
    blend, bits = spec.blend.raw, spec.blend.format.fraction_bits
    gain, gain_bits = integral.gain.raw, integral.gain.format.fraction_bits
    limit, fraction_bits = integral.limit_raw, integral.fraction_bits
    angles = tilts[:1]
    biases = [bias] * len(angles)
    angle = angles[0] if angles else 0
    for step, tilt, weight in zip(steps[1:], tilts[1:], corrects[1:], strict=True):
        predicted = angle + step - shift_round(bias, fraction_bits)
        innovation = (((tilt - predicted + HALF_TURN) & MASK) - HALF_TURN) * weight
        angle = predicted + shift_round(innovation * blend, bits)
        angle = ((angle + HALF_TURN) & MASK) - HALF_TURN
        bias = min(max(bias - shift_round(innovation * gain, gain_bits), -limit), limit)
        angles.append(angle)
        biases.append(bias)
    return angles, biases
