"""Findings about what was measured: clipping, signs, bias, force at rest, reference."""

from collections.abc import Iterator

import numpy as np

from hostkit.recordings.recording import Recording, Vector
from hostkit.recordings.sanity.agreement import agreement
from hostkit.recordings.sanity.clipping import (
    NARROWEST_ACCEL_M_S2,
    NARROWEST_GYRO_RAD_S,
    clips,
)
from hostkit.recordings.sanity.findings import Finding
from hostkit.recordings.sanity.standstill import Standstill, standstill
from hostkit.units import DEG_PER_RAD, STANDARD_GRAVITY_M_S2

AXES = "xyz"
MAX_BIAS_DEG_S = 1.0
MAX_FORCE_ERROR = 0.03
MAX_REFERENCE_DEG = 10.0


def sensor_findings(recording: Recording) -> Iterator[Finding]:
    """Yield what is unusual about the measured values and the reference."""
    yield from _clipping(recording.angular_rate_rad_s, "gyro", NARROWEST_GYRO_RAD_S, "rad/s")
    yield from _clipping(recording.specific_force_m_s2, "accel", NARROWEST_ACCEL_M_S2, "m/s^2")
    yield from _signs(recording)
    if recording.up_reference is None or not np.isfinite(recording.up_reference).any():
        message = (
            "there is no reference: a filter can be run on it, not tuned or scored; hostkit smooth "
            "finds one"
        )
        yield Finding(kind="reference", message=message)
    still = standstill(recording)
    if still is not None:
        yield from _at_rest(still)


def _clipping(values: Vector, name: str, narrowest: float, unit: str) -> Iterator[Finding]:
    for clip in clips(values, narrowest):
        message = (
            f"{name} {AXES[clip.axis]} stays at {clip.value:.5g} {unit} for "
            f"{100.0 * clip.share:.2g} % of the samples, first at row {clip.row}; that is the end "
            "of its range, unless it was held there: take a wider range"
        )
        yield Finding(kind="clipping", message=message)


def _signs(recording: Recording) -> Iterator[Finding]:
    flipped = [a for a, wrong in zip(AXES, agreement(recording).flipped, strict=True) if wrong]
    if not flipped:
        return
    message = (
        f"gyro {' and '.join(flipped)} turn(s) against the accelerometer (slope -1 of rate "
        f"against d(up)/dt, +1 expected): {_sign_remedy(flipped)}; axes are right-handed, and the "
        "accelerometer reads +1 g on the axis that points up"
    )
    yield Finding(kind="sign", message=message)


def _sign_remedy(flipped: list[str]) -> str:
    """Say what to negate; one wrong accelerometer axis looks like two wrong gyro axes."""
    if len(flipped) == 1:
        return f"negate gyro {flipped[0]}"
    if len(flipped) == 2:
        (other,) = set(AXES) - set(flipped)
        return f"negate gyro {' and '.join(flipped)}, or accel {other} if that is the wrong one"
    return "negate all three gyro axes"


def _at_rest(still: Standstill) -> Iterator[Finding]:
    bias_deg_s = still.bias_rad_s * DEG_PER_RAD
    for axis in np.flatnonzero(np.abs(bias_deg_s) > MAX_BIAS_DEG_S):
        message = (
            f"gyro {AXES[axis]} reads {bias_deg_s[axis]:+.3g} deg/s at rest (limit "
            f"{MAX_BIAS_DEG_S:g} deg/s, {still.windows} s at rest); subtract "
            f"{still.bias_rad_s[axis]:+.5f} rad/s, let hostkit calibrate imu put it into the "
            "design, or tune a filter that estimates it"
        )
        yield Finding(kind="bias", message=message)
    error = still.force_m_s2 / STANDARD_GRAVITY_M_S2 - 1.0
    if abs(error) > MAX_FORCE_ERROR:
        message = (
            f"the specific force at rest is {still.force_m_s2:.4g} m/s^2, {100.0 * error:+.2g} % "
            f"off gravity (limit {100.0 * MAX_FORCE_ERROR:g} %); calibrate offset and scale of "
            "the accelerometer on its six faces (hostkit calibrate imu)"
        )
        yield Finding(kind="force", message=message)
    yield from _reference(still)


def _reference(still: Standstill) -> Iterator[Finding]:
    if still.reference_error_rad is None:
        return
    error_deg = still.reference_error_rad * DEG_PER_RAD
    if error_deg > MAX_REFERENCE_DEG:
        message = (
            f"at rest the reference is {error_deg:.3g} deg from the accelerometer (limit "
            f"{MAX_REFERENCE_DEG:g} deg); it must turn sensor axes to a world with z up, and the "
            "accelerometer must read +1 g on the axis that points up"
        )
        yield Finding(kind="reference", message=message)
