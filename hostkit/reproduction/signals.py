"""Simulated recordings of the kind the tilt paper must have had.

The paper's data are lost. These are made up: an MPU-6050 by the noise of its data sheet, and
external acceleration as white noise whose strength was chosen because the errors then come out near
those of the paper's Table 1. That shows that the table is possible; it does not confirm it.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hostkit.records import SensorConfig, read_only
from hostkit.sensors import SENSORS
from hostkit.sensors.counts import quantise
from hostkit.simulation.curves import multisine
from hostkit.units import RAD_PER_DEG, STANDARD_GRAVITY_M_S2

Vector = NDArray[np.float64]

PART = SENSORS["mpu6050"]
SENSOR = SensorConfig(
    part=PART.name, gyro_full_scale_deg_s=2000, accel_full_scale_g=2, low_pass_setting=5
)
"""The paper's gyroscope range; the other settings are not in the paper."""

NOISE_BANDWIDTH_HZ = 10.0
GYRO_SCALE_ERROR = 0.01
BIAS_WALK_RAD_S_RTS = 0.003 * RAD_PER_DEG
MOTION_LINES = 8
GROUPS, GROUP_SAMPLES, TRAINING_SAMPLES = 10, 30, 20
LOG_SAMPLES = GROUPS * GROUP_SAMPLES


@dataclass(frozen=True, slots=True, kw_only=True)
class DataClass:
    """What kind of recording is simulated.

    Attributes
    ----------
    name, title
        What it is called, and what it is in one line.
    period_s
        Sample interval.
    disturbance_g
        Lowest and highest rms of the external acceleration, drawn anew for every group with an
        even logarithm.
    motion_rms_rad, motion_band_hz
        Strength and highest frequency of the tilt.
    bias_rad_s
        Constant offset of the gyroscope.
    """

    name: str
    title: str
    period_s: float
    disturbance_g: tuple[float, float]
    motion_rms_rad: float
    motion_band_hz: float
    bias_rad_s: float


SLOW = DataClass(
    name="table-1-like",
    title="1 s, 1 to 60 mg per group, 20 deg, motion to 0.02 Hz, bias 0.3 deg/s",
    period_s=1.0,
    disturbance_g=(0.001, 0.060),
    motion_rms_rad=20.0 * RAD_PER_DEG,
    motion_band_hz=0.02,
    bias_rad_s=0.3 * RAD_PER_DEG,
)
FAST = DataClass(
    name="20-hz",
    title="0.05 s, 20 mg, 20 deg, motion to 0.5 Hz, bias 0.3 deg/s",
    period_s=0.05,
    disturbance_g=(0.020, 0.020),
    motion_rms_rad=20.0 * RAD_PER_DEG,
    motion_band_hz=0.5,
    bias_rad_s=0.3 * RAD_PER_DEG,
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Logs:
    """L recordings of 300 samples, every array of shape ``(L, 300)``.

    Attributes
    ----------
    measured_tilt_rad
        From specific force by equation 1, with its argument clamped.
    rate_rad_s
        What the gyroscope says.
    tilt_rad
        The truth.
    period_s
        Sample interval.
    """

    measured_tilt_rad: Vector
    rate_rad_s: Vector
    tilt_rad: Vector
    period_s: float

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        for array in (self.measured_tilt_rad, self.rate_rad_s, self.tilt_rad):
            read_only(array)


def simulate_logs(kind: DataClass, logs: int, rng: np.random.Generator) -> Logs:
    """Return recordings of one class; the same generator state gives the same ones."""
    time_s = kind.period_s * np.arange(LOG_SAMPLES, dtype=np.float64)
    motions = [
        multisine(
            rms=kind.motion_rms_rad, band_hz=(0.0, kind.motion_band_hz), rng=rng, lines=MOTION_LINES
        )(time_s)
        for _ in range(logs)
    ]
    tilt = np.stack([motion.value for motion in motions])
    true_rate = np.stack([motion.slope for motion in motions])
    return Logs(
        measured_tilt_rad=measured_tilt(np.sin(tilt) + _disturbance_g(kind, logs, rng), rng),
        rate_rad_s=measured_rate(true_rate, kind.bias_rad_s, kind.period_s, rng),
        tilt_rad=tilt,
        period_s=kind.period_s,
    )


def accel_noise_g() -> float:
    """Return the rms noise of the accelerometer in its bandwidth."""
    density = PART.noise.accel_noise_density_m_s2_rthz / STANDARD_GRAVITY_M_S2
    return density * math.sqrt(NOISE_BANDWIDTH_HZ)


def g_per_count() -> float:
    """Return the weight of one count of the accelerometer."""
    return PART.m_s2_per_count(SENSOR) / STANDARD_GRAVITY_M_S2


def measured_tilt(force_g: Vector, rng: np.random.Generator) -> Vector:
    """Return the tilt, rad, that a noisy and counting accelerometer gives; any shape."""
    noisy = force_g + accel_noise_g() * rng.standard_normal(force_g.shape)
    counted = quantise(noisy, g_per_count()) * g_per_count()
    return np.asarray(np.arcsin(np.clip(counted, -1.0, 1.0)))


def measured_rate(
    rate_rad_s: Vector, bias_rad_s: float, period_s: float, rng: np.random.Generator
) -> Vector:
    """Return what the gyroscope says; the last axis of the input is time."""
    shape = rate_rad_s.shape
    noise = PART.noise.gyro_noise_density_rad_s_rthz * math.sqrt(NOISE_BANDWIDTH_HZ)
    walk = BIAS_WALK_RAD_S_RTS * math.sqrt(period_s) * rng.standard_normal(shape)
    rate = (1.0 + GYRO_SCALE_ERROR) * rate_rad_s + bias_rad_s + np.cumsum(walk, axis=-1)
    weight = PART.rad_s_per_count(SENSOR)
    counted = quantise(rate + noise * rng.standard_normal(shape), weight)
    return np.asarray(counted * weight)


def _disturbance_g(kind: DataClass, logs: int, rng: np.random.Generator) -> Vector:
    low, high = np.log(kind.disturbance_g)
    rms = np.exp(rng.uniform(low, high, (logs, GROUPS)))
    noise = rng.standard_normal((logs, LOG_SAMPLES))
    return np.asarray(np.repeat(rms, GROUP_SAMPLES, axis=1) * noise)
