"""The complementary filter of one or two tilt axes: float model, lowering, integer model.

Per axis, with w the angular rate, m the tilt measured from specific force and dt the period::

    theta_k = eta (theta_(k-1) + w_k dt) + (1 - eta) m_k,    theta_0 = m_0

as in Shi, He, Luo, He (2017), equation 4, with the time index and the start value made explicit.
It is computed as predict and correct, so that angles may wrap at +-pi::

    t = theta_(k-1) + w_k dt,    theta_k = t + (1 - eta) wrap(m_k - t)
"""

import math

import numpy as np
from numpy.typing import NDArray

from hostkit.attitude import pitch_from_up, roll_from_up, to_body
from hostkit.errors import FormatError
from hostkit.filters.complementary.parameters import settings, tau_from_eta
from hostkit.filters.cordic import arcsin_count, atan2_count, atan2_magnitude, cordic_table
from hostkit.fixedpoint import coefficient, shift_round, wrap32
from hostkit.records import AXES, Axis, FilterDesign, FixedPointSpec, TiltMethod
from hostkit.sensors import SENSORS
from hostkit.units import RAD_PER_HALF_TURN_LSB

Vector = NDArray[np.float64]
IntArray = NDArray[np.int64]

RATE_AXIS: dict[Axis, int] = {"roll": 0, "pitch": 1}
"""Body axis whose rate raises the angle."""

LEAST_FORCE_G = 0.125
"""Specific force from which on the stated error bound holds."""


def measured_tilt_rad(axis: Axis, method: TiltMethod, force_g: Vector) -> Vector:
    """Return the tilt of one axis from specific force.

    Parameters
    ----------
    axis, method
        Which angle, and whether from two components (``atan2``) or one (``arcsin``, equation 1 of
        the paper with its argument clamped).
    force_g
        Specific force in body axes, multiples of standard gravity, shape ``(N, 3)``.

    Returns
    -------
    numpy.ndarray
        Angle in rad, shape ``(N,)``.
    """
    if method == "atan2":
        return roll_from_up(force_g) if axis == "roll" else pitch_from_up(force_g)
    component = force_g[:, 1] if axis == "roll" else -force_g[:, 0]
    return np.arcsin(np.clip(component, -1.0, 1.0))


def run_float(
    design: FilterDesign, rate_rad_s: Vector, force_g: Vector, start_rad: Vector | None = None
) -> Vector:
    """Run the float model.

    Parameters
    ----------
    design
        A design of this filter.
    rate_rad_s, force_g
        Angular rate and specific force (in g) in sensor axes, each of shape ``(N, 3)``.
    start_rad
        Angles before the first sample, shape ``(A,)``; without them the first sample loads the
        measured tilt.

    Returns
    -------
    numpy.ndarray
        Angles, rad in [-pi, pi), shape ``(N, A)`` with A the number of axes of the design.
    """
    rate = to_body(design.mounting, rate_rad_s)
    force = to_body(design.mounting, force_g)
    eta = settings(design).eta
    columns = []
    for i, axis in enumerate(AXES[design.axes]):
        tilt = measured_tilt_rad(axis, design.tilt, force)
        step = rate[:, RATE_AXIS[axis]] * design.period_s
        start = None if start_rad is None else float(start_rad[i])
        columns.append(_blend(step, tilt, 1.0 - eta, start))
    return np.stack(columns, axis=-1)


def _blend(step_rad: Vector, tilt_rad: Vector, blend: float, start_rad: float | None) -> Vector:
    turn, half = 2.0 * math.pi, math.pi
    out = np.empty(len(tilt_rad))
    angle = start_rad
    for k, (step, tilt) in enumerate(zip(step_rad.tolist(), tilt_rad.tolist(), strict=True)):
        if angle is None:
            angle = tilt
        else:
            predicted = angle + step
            innovation = (tilt - predicted + half) % turn - half
            angle = (predicted + blend * innovation + half) % turn - half
        out[k] = angle
    return out


def lower(design: FilterDesign) -> FixedPointSpec:
    """Turn a design into integers.

    Raises
    ------
    FormatError
        If a full-scale rate would turn by half a turn or more within one sample.
    DesignError
        If eta or the sensor configuration is not possible.
    """
    eta = settings(design).eta
    sensor = SENSORS[design.sensor.part]
    rad_s_per_count = sensor.rad_s_per_count(design.sensor)
    gain = rad_s_per_count * design.period_s / RAD_PER_HALF_TURN_LSB
    rate_gain = coefficient("rate_gain", gain, "half turns / 2^31 per count")
    if rate_gain.format.fraction_bits < 1:
        degrees = design.sensor.gyro_full_scale_deg_s * design.period_s
        raise FormatError(
            f"rate_hz = {design.rate_hz:g} with gyro_full_scale_deg_s = "
            f"{design.sensor.gyro_full_scale_deg_s} turns up to {degrees:.4g} deg per sample; "
            "the limit is 180 deg: sample faster or narrow the range"
        )
    blend = coefficient("blend", 1.0 - eta, "1")
    full_scale_rad_s = rad_s_per_count * 32768
    tau_s = tau_from_eta(eta, design.period_s)
    bound = (
        _cordic_bound_rad(sensor.gravity_count(design.sensor) * LEAST_FORCE_G)
        + abs(blend.relative_error) * math.pi
        + abs(rate_gain.relative_error) * full_scale_rad_s * tau_s
        + RAD_PER_HALF_TURN_LSB / (1.0 - eta)
    )
    return FixedPointSpec(
        filter=design.filter,
        axes=AXES[design.axes],
        tilt=design.tilt,
        mounting=design.mounting,
        rate_gain=rate_gain,
        blend=blend,
        cordic=cordic_table(),
        gravity_count=sensor.gravity_count(design.sensor),
        error_bound_rad=bound,
    )


def _cordic_bound_rad(least_count: float) -> float:
    """Residual angle of the last step, plus one unit of truncation per step and pass."""
    table = cordic_table()
    truncation = 2.0 * table.steps / (least_count * 2.0**table.guard_bits)
    return 2.0 ** (1 - table.steps) + truncation


def measured_tilt_raw(spec: FixedPointSpec, accel_count: IntArray) -> IntArray:
    """Return the tilt from specific force in integers.

    Parameters
    ----------
    accel_count
        Accelerometer counts in sensor axes, shape ``(N, 3)``.

    Returns
    -------
    numpy.ndarray
        Angles in half turns, shape ``(N, A)``.
    """
    x, y, z = _body_counts(spec, accel_count).T
    angles: dict[Axis, IntArray] = {}
    if spec.tilt == "arcsin":
        for axis, component in (("roll", y), ("pitch", -x)):
            angles[axis] = arcsin_count(spec.cordic, component, spec.gravity_count)  # type: ignore[index]
    else:
        angles["roll"], magnitude = atan2_count(spec.cordic, y, z)
        if "pitch" in spec.axes:
            angles["pitch"] = atan2_magnitude(spec.cordic, -x, magnitude)
    return np.stack([angles[axis] for axis in spec.axes], axis=-1)


def _body_counts(spec: FixedPointSpec, count: IntArray) -> IntArray:
    return count[:, list(spec.mounting.source)] * np.asarray(spec.mounting.sign, dtype=np.int64)


def _rate_steps(spec: FixedPointSpec, gyro_count: IntArray) -> IntArray:
    rate = _body_counts(spec, gyro_count)[:, [RATE_AXIS[axis] for axis in spec.axes]]
    return shift_round(rate * spec.rate_gain.raw, spec.rate_gain.format.fraction_bits)


def step_integer(
    spec: FixedPointSpec, angle_raw: IntArray, accel_count: IntArray, gyro_count: IntArray
) -> IntArray:
    """Take one step from each of N states, independently of each other.

    Parameters
    ----------
    angle_raw
        Angles before the step, half turns, shape ``(N, A)``.
    accel_count, gyro_count
        Counts of the step in sensor axes, each of shape ``(N, 3)``.

    Returns
    -------
    numpy.ndarray
        Angles after the step, shape ``(N, A)``.
    """
    tilt = measured_tilt_raw(spec, accel_count)
    return _correct(spec, angle_raw, _rate_steps(spec, gyro_count), tilt)


def _correct(spec: FixedPointSpec, angle: IntArray, step: IntArray, tilt: IntArray) -> IntArray:
    predicted = wrap32(angle + step)
    innovation = wrap32(tilt - predicted)
    correction = shift_round(innovation * spec.blend.raw, spec.blend.format.fraction_bits)
    return wrap32(predicted + correction)


def run_integer(spec: FixedPointSpec, accel_count: IntArray, gyro_count: IntArray) -> IntArray:
    """Run the integer model from its first sample, which loads the measured tilt.

    Parameters
    ----------
    accel_count, gyro_count
        Counts in sensor axes, each of shape ``(N, 3)``.

    Returns
    -------
    numpy.ndarray
        Angles in half turns, shape ``(N, A)``.
    """
    tilt = measured_tilt_raw(spec, accel_count)
    step = _rate_steps(spec, gyro_count)
    columns = [
        _run_axis(spec, step[:, axis].tolist(), tilt[:, axis].tolist())
        for axis in range(tilt.shape[1])
    ]
    return np.array(columns, dtype=np.int64).T


def _run_axis(spec: FixedPointSpec, steps: list[int], tilts: list[int]) -> list[int]:
    """Step through one axis; the wraps of :func:`wrap32` are written out, for speed."""
    blend, bits = spec.blend.raw, spec.blend.format.fraction_bits
    half, half_turn, mask = 1 << (bits - 1), 2**31, 2**32 - 1
    angles = tilts[:1]
    angle = angles[0] if angles else 0
    for step, tilt in zip(steps[1:], tilts[1:], strict=True):
        predicted = angle + step
        innovation = ((tilt - predicted + half_turn) & mask) - half_turn
        angle = predicted + ((innovation * blend + half) >> bits)
        angle = ((angle + half_turn) & mask) - half_turn
        angles.append(angle)
    return angles
