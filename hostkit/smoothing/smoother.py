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
from numpy.typing import NDArray
from scipy.signal import butter, sosfiltfilt

from hostkit.errors import RecordingError
from hostkit.smoothing.automatic import chosen, held, is_planar
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
    settings
        The settings in use: those asked for or chosen, less what the motion does not show.
    compared
        How many settings were compared; 0 where they were told.
    """

    up: Array
    node_time_s: Array
    gyro_bias_rad_s: Array
    gyro_scale: Array
    accel_offset_m_s2: Array
    accel_scale: Array
    settings: SmootherSettings
    compared: int = 0


def smooth(
    angular_rate_rad_s: Array,
    specific_force_m_s2: Array,
    period_s: float,
    settings: SmootherSettings,
    *,
    automatic: bool = False,
    doubted: NDArray[np.bool_] | None = None,
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
    automatic
        Whether to begin with `settings` and take others where the recording itself asks for them,
        see `hostkit.smoothing.automatic`.
    doubted
        Samples whose rate is not believed, shape ``(N,)``, beside those at the full scale.

    Raises
    ------
    RecordingError
        If the arrays do not fit together, hold something that is not a finite number, are
        shorter than twenty blocks, or cannot be solved.
    """
    rate, force = angular_rate_rad_s, specific_force_m_s2
    return solve(prepare(rate, force, period_s, settings, doubted), settings, automatic=automatic)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Prepared:
    """What is the same for all settings: readings as blocks, and where the solution starts."""

    angular_rate_rad_s: Array
    period_s: float
    blocks: Blocks
    start: Estimate
    planar: bool


def prepare(
    angular_rate_rad_s: Array,
    specific_force_m_s2: Array,
    period_s: float,
    settings: SmootherSettings,
    doubted: NDArray[np.bool_] | None = None,
) -> Prepared:
    """Return what solving takes; of the settings, full scale and block count here.

    Raises
    ------
    RecordingError
        If the arrays cannot be smoothed, see `smooth`.
    """
    rate, force = angular_rate_rad_s, specific_force_m_s2
    _require_fit(rate, force, period_s, settings)
    clipped = np.any(np.abs(rate) >= settings.gyro_full_scale_rad_s, axis=1)
    unknown = clipped if doubted is None else clipped | doubted
    blocks = preintegrate(rate, force, period_s, block_samples(settings, period_s), unknown)
    return Prepared(
        angular_rate_rad_s=rate,
        period_s=period_s,
        blocks=blocks,
        start=_start(blocks),
        planar=is_planar(rate),
    )


def solve(prepared: Prepared, settings: SmootherSettings, *, automatic: bool = False) -> Smoothed:
    """Return the tilt of what was prepared.

    Raises
    ------
    RecordingError
        If it cannot be solved.
    """
    blocks, compared = prepared.blocks, 0
    settings = held(settings, prepared.planar)
    if automatic:
        settings, compared = chosen(blocks, prepared.start, settings, prepared.planar)
    estimate = _solve(blocks, settings, prepared.start)
    up = up_of_samples(blocks, estimate.orientation, prepared.period_s)
    return Smoothed(
        up=_led(up, prepared.angular_rate_rad_s, settings.lead_s),
        node_time_s=np.concatenate(((0.0,), np.cumsum(blocks.duration_s))),
        gyro_bias_rad_s=estimate.bias_rad_s,
        gyro_scale=estimate.constants[GYRO_SCALE],
        accel_offset_m_s2=estimate.constants[ACCEL_OFFSET],
        accel_scale=estimate.constants[ACCEL_SCALE],
        settings=settings,
        compared=compared,
    )


def block_samples(settings: SmootherSettings, period_s: float) -> int:
    """Return how many samples a block has."""
    return max(1, round(settings.block_s / period_s))


def fewest_samples(settings: SmootherSettings, period_s: float) -> int:
    """Return how many samples it takes at least."""
    return FEWEST_BLOCKS * block_samples(settings, period_s) + 1


def _require_fit(rate: Array, force: Array, period_s: float, settings: SmootherSettings) -> None:
    if rate.ndim != 2 or rate.shape[1] != 3 or rate.shape != force.shape:
        raise RecordingError(
            f"rates {rate.shape} and forces {force.shape} to smooth are not both (N, 3)"
        )
    if not 0.0 < period_s < np.inf:
        raise RecordingError(f"a sample period of {period_s:g} s cannot be smoothed")
    needed = fewest_samples(settings, period_s)
    if len(rate) < needed:
        raise RecordingError(f"{len(rate)} samples are too few to smooth: it takes {needed}")
    if not (np.isfinite(rate).all() and np.isfinite(force).all()):
        raise RecordingError("a rate or force to smooth is not a finite number; cut the gap out")


def _solve(blocks: Blocks, settings: SmootherSettings, estimate: Estimate) -> Estimate:
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
