"""Recordings of a shaken sensor with a bias, a scale error and gusts: six parameters to tune."""

import functools

import numpy as np
from numpy.typing import NDArray

from benchmarks.problems import SENSOR
from hostkit.recordings import Recording
from hostkit.simulation import Profile, SensorErrors, simulate
from hostkit.simulation.curves import Curve, Samples, constant, multisine
from hostkit.simulation.motion import Path
from hostkit.simulation.sensor_errors import MG
from hostkit.units import RAD_PER_DEG, STANDARD_GRAVITY_M_S2

Vector = NDArray[np.float64]

SAMPLES, RATE_HZ = 2400, 20.0
GUSTS = 24
STRENGTH_G = (0.05, 0.4)
WIDTH_S = (0.5, 1.5)
BAND_HZ = (0.2, 2.0)


@functools.lru_cache(maxsize=32)
def gusty(sensor: int, motion: int) -> Recording:
    """Return a recording: one sensor, with errors of its own, on one of its motions."""
    own = np.random.default_rng([4, sensor])
    return simulate(
        Profile(name="gusty", title="roll, with gusts of acceleration", draw=_draw),
        duration_s=SAMPLES / RATE_HZ,
        rate_hz=RATE_HZ,
        sensor=SENSOR,
        errors=_errors(own),
        rng=np.random.default_rng([5, sensor, motion]),
    )


def _errors(rng: np.random.Generator) -> SensorErrors:
    bias, scale, offset = rng.uniform(-1.0, 1.0, 3)
    return SensorErrors(
        gyro_bias_rad_s=(2.0 * RAD_PER_DEG * bias, 0.0, 0.0),
        gyro_bias_walk_rad_s_rts=0.03 * RAD_PER_DEG,
        gyro_scale=(0.04 * scale, 0.0, 0.0),
        accel_offset_m_s2=(0.0, 25.0 * MG * offset, 0.0),
        vibration_m_s2=0.5,
    )


def _draw(rng: np.random.Generator) -> Path:
    return Path(
        roll_rad=multisine(rms=20.0 * RAD_PER_DEG, band_hz=(0.05, 1.0), rng=rng),
        pitch_rad=constant(0.0),
        yaw_rad=constant(0.0),
        acceleration_m_s2=(constant(0.0), _gusts(rng), _gusts(rng)),
    )


def _gusts(rng: np.random.Generator) -> Curve:
    """Return bursts of an unsteady acceleration, still in between."""
    carrier = multisine(rms=1.0, band_hz=BAND_HZ, rng=rng)
    middle_s = rng.uniform(0.0, SAMPLES / RATE_HZ, GUSTS)
    width_s = rng.uniform(*WIDTH_S, GUSTS)
    strength = rng.uniform(*STRENGTH_G, GUSTS) * STANDARD_GRAVITY_M_S2

    def at(time_s: Vector) -> Samples:
        envelope = np.zeros_like(time_s)
        for middle, width, height in zip(middle_s, width_s, strength, strict=True):
            envelope += height * np.exp(-(((time_s - middle) / width) ** 2))
        return Samples(value=envelope * carrier(time_s).value, slope=np.zeros_like(time_s))

    return at
