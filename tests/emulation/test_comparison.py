"""A filter in floats is judged by where it says that up is."""

import math

import numpy as np
import pytest
from designs import design

from hostkit.emulation.comparison import FLOAT_TOLERANCE_RAD, Answer, compare
from hostkit.filters.complementary import run_float
from hostkit.sensors import SENSORS
from hostkit.sensors.counts import Counts, to_rate_and_force_g
from hostkit.targets import TARGETS
from hostkit.units import RAD_PER_HALF_TURN_LSB

SAMPLES = 20


@pytest.mark.parametrize(("pitch_deg", "mismatches"), [(0.0, SAMPLES), (89.95, 0)])
def test_roll_says_little_near_the_pole(pitch_deg: float, mismatches: int) -> None:
    own, pitch = design(), math.radians(pitch_deg)
    force = 16384.0 * np.array([-math.sin(pitch), 0.0, math.cos(pitch)])
    accel = np.tile(np.round(force).astype(np.int64), (SAMPLES, 1))
    counts = Counts(accel=accel, gyro=np.zeros_like(accel))
    exact = run_float(own, *to_rate_and_force_g(SENSORS["mpu6050"], own.sensor, counts))[:, :2]
    off = np.array([2.0 * FLOAT_TOLERANCE_RAD, 0.0])
    told = np.round((exact + off) / RAD_PER_HALF_TURN_LSB)
    answer = Answer(
        row=np.arange(SAMPLES),
        counts=counts,
        state_raw=told.astype(np.int64),
        cycles_mean=None,
        cycles_max=None,
        tolerance_rad=FLOAT_TOLERANCE_RAD,
    )
    result = compare(TARGETS["host"], own, counts, answer)
    assert result.mismatches == mismatches
    assert np.abs(result.residual_rad).max() > FLOAT_TOLERANCE_RAD
