"""Tilt from a whole recording: weighted least squares over all of it.

An online filter knows the past; here what comes later counts as well. The model is that of the
bounded-velocity observer: the specific force, turned into the earth frame, less gravity is the
acceleration of a body that neither flies away nor keeps a speed. With R from sensor to earth, v, p
and b at the nodes between blocks of time T, and from each block its rotation D, its velocity s
(both in the axes of the first node) and the derivative B of D by the bias, the equations are::

    log(R' (R D)^T) + R B b  = 0      a turn is what the gyroscope says, less its bias
    v' - v - R s + g T       = 0      velocity gains what force says, less gravity
    p' - p - T (v + v') / 2  = 0
    b' - b                   = 0      the bias wanders slowly
    v = 0,  p = 0                     a bounded motion, heavy-tailed

each divided by its standard deviation (`SmootherSettings`). Scale errors of both sensors and the
offset of the accelerometer are nine more unknowns, held near zero. A tilt error e makes gravity
look like an acceleration g e. In one block that cannot be told from motion, but over seconds v and
p would grow; and as they are bounded before and after a moment, the tilt has no lag.

The equations are solved by Gauss and Newton on the rotations; the matrix is banded, so time and
memory grow with the length of the recording only. The start is the direction of the force in the
frame of the integrated rates, low-passed there and back.
"""

from dataclasses import dataclass

import numpy as np
from scipy.signal import butter, sosfiltfilt

from hostkit.errors import RecordingError
from hostkit.smoothing.equations import (
    ACCEL_OFFSET,
    ACCEL_SCALE,
    COMMON,
    GYRO_SCALE,
    Estimate,
    improve,
)
from hostkit.smoothing.preintegration import Blocks, preintegrate, up_of_samples
from hostkit.smoothing.rotation import Array, chain, rotation_from_vector, turn
from hostkit.smoothing.settings import SmootherSettings

STEPS = 4
"""Steps of Gauss and Newton; further ones change the tilt by less than its error."""
FEWEST_BLOCKS = 20
START_CUTOFF_HZ = 0.1
ADVICE = "are units, axes, the rate and the settings right?"


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Smoothed:
    """What a recording says of its tilt and of its sensor.

    Attributes
    ----------
    up
        Up direction in sensor axes, shape ``(N, 3)``.
    node_time_s, gyro_bias_rad_s
        Times from the first sample, shape ``(K + 1,)``, and the bias there, shape ``(K + 1, 3)``.
    gyro_scale
        True rate is (1 + scale) times the reading less its bias, shape ``(3,)``.
    accel_offset_m_s2, accel_scale
        True force is (1 + scale) times the reading less its offset, shape ``(3,)`` each.
    """

    up: Array
    node_time_s: Array
    gyro_bias_rad_s: Array
    gyro_scale: Array
    accel_offset_m_s2: Array
    accel_scale: Array


def smooth(
    angular_rate_rad_s: Array,
    specific_force_m_s2: Array,
    period_s: float,
    settings: SmootherSettings,
) -> Smoothed:
    """Return the tilt at each sample, given all samples.

    Parameters
    ----------
    angular_rate_rad_s, specific_force_m_s2
        In sensor axes, shape ``(N, 3)`` each, evenly sampled, without gaps.
    period_s
        Sample period.
    settings
        Deviations of sensor and motion.

    Raises
    ------
    RecordingError
        If the arrays do not fit together, hold something that is not a finite number, are
        shorter than twenty blocks, or cannot be solved.
    """
    _require_fit(angular_rate_rad_s, specific_force_m_s2, period_s, settings)
    samples = max(1, round(settings.block_s / period_s))
    full_scale_rad_s = settings.gyro_full_scale_rad_s
    blocks = preintegrate(
        angular_rate_rad_s, specific_force_m_s2, period_s, samples, full_scale_rad_s
    )
    estimate = _solve(blocks, settings)
    up = up_of_samples(blocks, estimate.orientation, period_s)
    return Smoothed(
        up=_led(up, angular_rate_rad_s, settings.lead_s),
        node_time_s=np.concatenate(((0.0,), np.cumsum(blocks.duration_s))),
        gyro_bias_rad_s=estimate.bias_rad_s,
        gyro_scale=estimate.constants[GYRO_SCALE],
        accel_offset_m_s2=estimate.constants[ACCEL_OFFSET],
        accel_scale=estimate.constants[ACCEL_SCALE],
    )


def _require_fit(rate: Array, force: Array, period_s: float, settings: SmootherSettings) -> None:
    if rate.ndim != 2 or rate.shape[1] != 3 or rate.shape != force.shape:
        raise RecordingError(
            f"rates {rate.shape} and forces {force.shape} to smooth are not both (N, 3)"
        )
    if not 0.0 < period_s < np.inf:
        raise RecordingError(f"a sample period of {period_s:g} s cannot be smoothed")
    needed = FEWEST_BLOCKS * max(1, round(settings.block_s / period_s)) + 1
    if len(rate) < needed:
        raise RecordingError(f"{len(rate)} samples are too few to smooth: it takes {needed}")
    if not (np.isfinite(rate).all() and np.isfinite(force).all()):
        raise RecordingError("a rate or force to smooth is not a finite number; cut the gap out")


def _solve(blocks: Blocks, settings: SmootherSettings) -> Estimate:
    estimate = _start(blocks)
    try:
        for _ in range(STEPS):
            estimate = improve(blocks, settings, estimate)
    except np.linalg.LinAlgError as error:
        raise RecordingError(f"the smoother found no tilt: {error}; {ADVICE}") from error
    if not np.isfinite(estimate.orientation).all():
        raise RecordingError(f"the smoother found no tilt, numbers ran over; {ADVICE}")
    return estimate


def _start(blocks: Blocks) -> Estimate:
    """Level the integrated rates by the force, low-passed forwards and backwards."""
    integrated = chain(blocks.rotation)
    force = turn(integrated[:-1], blocks.velocity_m_s) / blocks.duration_s[:, None]
    nyquist_hz = 0.5 / blocks.duration_s[0]
    cutoff = min(START_CUTOFF_HZ / nyquist_hz, 0.9)
    padding = min(len(force) - 1, round(6.0 / cutoff))
    low = butter(2, cutoff, output="sos")
    up = sosfiltfilt(low, force, axis=0, padtype="even", padlen=padding)
    nodes = len(integrated)
    return Estimate(
        orientation=_levelling(np.vstack((up, up[-1:]))) @ integrated,
        velocity_m_s=np.zeros((nodes, 3)),
        position_m=np.zeros((nodes, 3)),
        bias_rad_s=np.zeros((nodes, 3)),
        constants=np.zeros(COMMON),
    )


def _levelling(up: Array) -> Array:
    """Return the shortest rotations that turn directions, shape ``(K, 3)``, upright."""
    axis = np.stack((up[:, 1], -up[:, 0], np.zeros(len(up))), axis=1)
    sine = np.linalg.norm(axis, axis=1, keepdims=True)
    axis = np.where(sine > 0.0, axis / np.where(sine > 0.0, sine, 1.0), (1.0, 0.0, 0.0))
    return rotation_from_vector(axis * np.arctan2(sine, up[:, 2:]))


def _led(up: Array, angular_rate_rad_s: Array, lead_s: float) -> Array:
    """Turn up directions on by rate times lead."""
    led = up + lead_s * np.cross(up, angular_rate_rad_s)
    return np.asarray(led / np.linalg.norm(led, axis=1, keepdims=True))
