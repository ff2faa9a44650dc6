from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from hostkit.recordings import Recording
from hostkit.records import SensorConfig
from hostkit.simulation import SensorErrors, simulate

Make = Callable[..., Recording]


@cache
def simulated(profile: str, duration_s: float) -> Recording:
    return simulate(
        profile,
        duration_s=duration_s,
        rate_hz=100.0,
        sensor=SensorConfig(
            part="mpu6050", gyro_full_scale_deg_s=500, accel_full_scale_g=4, low_pass_setting=3
        ),
        errors=SensorErrors(),
        rng=np.random.default_rng(7),
    )


def moved(profile: str = "free", duration_s: float = 30.0, **changes: object) -> Recording:
    """A simulated recording, with some of its fields replaced."""
    return replace(simulated(profile, duration_s), **changes)  # type: ignore[arg-type]


@pytest.fixture(scope="session")
def make() -> Make:
    return moved


@pytest.fixture
def full() -> Recording:
    """A small recording that has everything a recording can have."""
    rng = np.random.default_rng(3)
    samples = 50
    up = rng.standard_normal((samples, 3))
    up /= np.linalg.norm(up, axis=1, keepdims=True)
    up[10:13] = np.nan
    force = 9.8 * up + 0.01 * rng.standard_normal((samples, 3))
    force[10:13] = (0.1, 0.2, 9.8)
    return Recording(
        name="full",
        time_s=np.arange(samples) / 100.0 + 1e-5 * rng.random(samples),
        rate_hz=100.0,
        angular_rate_rad_s=rng.standard_normal((samples, 3)),
        specific_force_m_s2=force,
        valid=rng.random(samples) > 0.2,
        up_reference=up,
        mag_ut=40.0 * rng.standard_normal((samples, 3)),
        temperature_deg_c=25.0 + rng.random(samples),
        sensor="MPU-6050, board 3",
        origin="bench: 2nd run, µT coil",
        licence="CC0-1.0",
    )
