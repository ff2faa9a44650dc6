"""Recordings for the tests of the diagnosis: simulated ones, and ones without any noise."""

from collections.abc import Callable
from functools import cache

import numpy as np

from hostkit.recordings import Recording
from hostkit.records import SensorConfig
from hostkit.simulation import Profile, SensorErrors, simulate
from hostkit.simulation.curves import Curve, constant, multisine
from hostkit.simulation.motion import Path as MotionPath
from hostkit.units import RAD_PER_DEG, STANDARD_GRAVITY_M_S2

Simulate = Callable[..., Recording]
Still = Callable[..., Recording]

SENSOR = SensorConfig(
    part="mpu6050", gyro_full_scale_deg_s=500, accel_full_scale_g=4, low_pass_setting=3
)


@cache
def simulated(
    profile: str = "free",
    duration_s: float = 30.0,
    errors: SensorErrors = SensorErrors(),  # noqa: B008
    sensor: SensorConfig = SENSOR,
    seed: int = 1,
) -> Recording:
    return simulate(
        _planar() if profile == "planar" else profile,
        duration_s=duration_s,
        rate_hz=100.0,
        sensor=sensor,
        errors=errors,
        rng=np.random.default_rng(seed),
    )


def _planar() -> Profile:
    """A swing in roll alone, shaken along all axes."""

    def draw(rng: np.random.Generator) -> MotionPath:
        def noise(rms: float, low: float, high: float) -> Curve:
            return multisine(rms=rms, band_hz=(low, high), rng=rng)

        return MotionPath(
            roll_rad=noise(25.0 * RAD_PER_DEG, 0.05, 1.0),
            pitch_rad=constant(0.0),
            yaw_rad=constant(0.0),
            acceleration_m_s2=(noise(1.0, 1.0, 5.0), noise(1.0, 1.0, 5.0), noise(1.0, 1.0, 5.0)),
        )

    return Profile(name="planar", title="roll alone", draw=draw)


def made(samples: int = 500, **changes: object) -> Recording:
    """A recording at rest without any noise, with some of its fields replaced."""
    fields: dict[str, object] = {
        "name": "made",
        "time_s": np.arange(samples) / 100.0,
        "rate_hz": 100.0,
        "angular_rate_rad_s": np.zeros((samples, 3)),
        "specific_force_m_s2": np.tile((0.0, 0.0, STANDARD_GRAVITY_M_S2), (samples, 1)),
        "valid": np.ones(samples, dtype=np.bool_),
    }
    return Recording(**{**fields, **changes})  # type: ignore[arg-type]
