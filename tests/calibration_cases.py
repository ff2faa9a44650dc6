"""Recordings for the tests of the calibration: a simulated sensor put down in position after
position, and the same without any motion."""

from collections.abc import Sequence
from functools import cache

import numpy as np

from hostkit.recordings import Recording
from hostkit.records import SensorConfig
from hostkit.simulation import Profile, SensorErrors, simulate
from hostkit.simulation.curves import stairs
from hostkit.simulation.motion import Path as MotionPath

DEG = np.pi / 180.0
HOLD_S = 4.0
SENSOR = SensorConfig(
    part="mpu6050", gyro_full_scale_deg_s=250, accel_full_scale_g=2, low_pass_setting=3
)
FACES = ((0, 0, 0), (90, 0, 0), (180, 0, 0), (270, 0, 0), (360, 90, 0), (360, -90, 0))
"""Roll, pitch, yaw in deg: +z, +y, -z, -y, -x and +x up."""
MANY = (
    *((0, 0, 0), (90, 0, 90), (180, 0, 90), (270, 0, 0), (360, 80, 0), (360, -80, 30)),
    *((300, 30, 90), (210, 45, 90), (120, -45, 0), (45, 20, 90), (90, 60, 90), (0, -30, 0)),
)
ERRORS = SensorErrors(
    gyro_bias_rad_s=(4.5 * DEG, -1.0 * DEG, 0.3 * DEG),
    gyro_bias_walk_rad_s_rts=0.0,
    gyro_scale=(0.02, -0.015, 0.01),
    accel_scale=(0.02, -0.03, 0.015),
    accel_offset_m_s2=(0.3, -0.2, 0.5),
    cross_axis=0.0,
)


@cache
def posed(
    poses: Sequence[tuple[int, int, int]] = FACES, errors: SensorErrors = ERRORS, seed: int = 1
) -> Recording:
    """A sensor that rests for two seconds in each position and takes two to the next."""

    def draw(rng: np.random.Generator) -> MotionPath:
        angles = DEG * np.array((*poses, poses[-1]), dtype=np.float64)
        roll, pitch, yaw = (
            stairs(levels=angles[:, i], hold_s=HOLD_S, move_s=0.5 * HOLD_S) for i in range(3)
        )
        return MotionPath(roll_rad=roll, pitch_rad=pitch, yaw_rad=yaw)

    return simulate(
        Profile(name="posed", title="put down again and again", draw=draw),
        duration_s=HOLD_S * len(poses) - 0.1,
        rate_hz=100.0,
        sensor=SENSOR,
        errors=errors,
        rng=np.random.default_rng(seed),
    )


def true_terms(errors: SensorErrors = ERRORS) -> dict[str, np.ndarray]:
    """The terms that undo the errors: the simulator scales first and offsets then."""
    return {
        "gyro_bias": np.array(errors.gyro_bias_rad_s),
        "gyro_scale": 1.0 / (1.0 + np.array(errors.gyro_scale)) - 1.0,
        "accel_offset": np.array(errors.accel_offset_m_s2),
        "accel_scale": 1.0 / (1.0 + np.array(errors.accel_scale)) - 1.0,
    }
