"""Short simulated flights."""

import numpy as np

from hostkit.recordings import Recording
from hostkit.records import SensorConfig
from hostkit.simulation import SensorErrors, simulate

SENSOR = SensorConfig(
    part="mpu6050", gyro_full_scale_deg_s=500, accel_full_scale_g=4, low_pass_setting=3
)


def flight(seed: int = 1, duration_s: float = 8.0) -> Recording:
    return simulate(
        "free",
        duration_s=duration_s,
        rate_hz=100.0,
        sensor=SENSOR,
        errors=SensorErrors(),
        rng=np.random.default_rng(seed),
    )
