"""Motion profiles: how a simulated sensor is moved, by name."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from hostkit.registry import Registry
from hostkit.simulation.curves import Curve, constant, multisine, ramp, stairs, sweep
from hostkit.simulation.motion import Path
from hostkit.units import RAD_PER_DEG

SWEEP_AMPLITUDE_RAD = 30.0 * RAD_PER_DEG
SWEEP_BAND_HZ = (0.05, 1.5)
SWEEP_RISE_S = 60.0
STEP_LIMIT_RAD = 60.0 * RAD_PER_DEG
STEP_COUNT = 64
STEP_HOLD_S = 3.0
STEP_MOVE_S = 0.6
RANDOM_RMS_RAD = 20.0 * RAD_PER_DEG
RANDOM_BAND_HZ = (0.05, 1.0)
FREE_RMS_RAD = 22.0 * RAD_PER_DEG
FREE_BAND_HZ = (0.05, 1.0)
FREE_TURN_RAD_S = 8.0 * RAD_PER_DEG
FREE_ACCELERATION_M_S2 = 0.7
FREE_ACCELERATION_BAND_HZ = (0.3, 4.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class Profile:
    """One way to move.

    Attributes
    ----------
    name, title
        What it is called, and what it is in a few words.
    draw
        Returns a path, in which all that is random has been drawn from the generator: the path
        is the same however often it is evaluated.
    """

    name: str
    title: str
    draw: Callable[[np.random.Generator], Path]


def at_rest(roll_rad: float, pitch_rad: float) -> Profile:
    """Return a profile that holds one orientation."""
    path = Path(roll_rad=constant(roll_rad), pitch_rad=constant(pitch_rad), yaw_rad=constant(0.0))
    return Profile(name="rest", title="level and still", draw=lambda _: path)


def _draw_sweep(_: np.random.Generator) -> Path:
    return Path(
        roll_rad=_swept(SWEEP_AMPLITUDE_RAD, 0.0),
        pitch_rad=_swept(SWEEP_AMPLITUDE_RAD, 0.5 * np.pi),
        yaw_rad=constant(0.0),
    )


def _swept(amplitude_rad: float, phase: float) -> Curve:
    return sweep(amplitude=amplitude_rad, band_hz=SWEEP_BAND_HZ, rise_s=SWEEP_RISE_S, phase=phase)


def _draw_steps(rng: np.random.Generator) -> Path:
    roll, pitch = rng.uniform(-STEP_LIMIT_RAD, STEP_LIMIT_RAD, (2, STEP_COUNT))
    roll[0], pitch[0] = 0.0, 0.0
    return Path(
        roll_rad=stairs(levels=roll, hold_s=STEP_HOLD_S, move_s=STEP_MOVE_S),
        pitch_rad=stairs(levels=pitch, hold_s=STEP_HOLD_S, move_s=STEP_MOVE_S),
        yaw_rad=constant(0.0),
    )


def _draw_random(rng: np.random.Generator) -> Path:
    return Path(
        roll_rad=multisine(rms=RANDOM_RMS_RAD, band_hz=RANDOM_BAND_HZ, rng=rng),
        pitch_rad=multisine(rms=RANDOM_RMS_RAD, band_hz=RANDOM_BAND_HZ, rng=rng),
        yaw_rad=constant(0.0),
    )


def _draw_free(rng: np.random.Generator) -> Path:
    roll, pitch, yaw = (
        multisine(rms=FREE_RMS_RAD, band_hz=FREE_BAND_HZ, rng=rng) for _ in range(3)
    )
    turn = ramp(FREE_TURN_RAD_S)
    return Path(
        roll_rad=lambda time_s: roll(time_s) + turn(time_s),
        pitch_rad=pitch,
        yaw_rad=yaw,
        acceleration_m_s2=tuple(
            multisine(rms=FREE_ACCELERATION_M_S2, band_hz=FREE_ACCELERATION_BAND_HZ, rng=rng)
            for _ in range(3)
        ),
    )


PROFILES: Registry[Profile] = Registry(
    "profile",
    (
        at_rest(0.0, 0.0),
        Profile(name="sine-sweep", title="both angles, 0.05 to 1.5 Hz", draw=_draw_sweep),
        Profile(name="steps", title="quick turns between held angles", draw=_draw_steps),
        Profile(name="random", title="both angles, band-limited noise", draw=_draw_random),
        Profile(name="free", title="all axes, turning over, with acceleration", draw=_draw_free),
    ),
)
