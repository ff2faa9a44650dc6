"""From SI units to the counts a configured sensor gives, and back."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hostkit.records import SensorConfig, read_only
from hostkit.sensors.part import COUNTS_PER_FULL_SCALE, SensorPart
from hostkit.units import STANDARD_GRAVITY_M_S2

Vector = NDArray[np.float64]
IntArray = NDArray[np.int64]


@dataclass(frozen=True, slots=True, kw_only=True)
class Counts:
    """Raw counts in sensor axes, each of shape ``(N, 3)``."""

    accel: IntArray
    gyro: IntArray

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        read_only(self.accel)
        read_only(self.gyro)

    def __len__(self) -> int:
        return len(self.accel)


def quantise(values: Vector, si_per_count: float) -> IntArray:
    """Return counts: rounded halves upwards and clipped at full scale, as the sensor does."""
    count = np.floor(values * (1.0 / si_per_count) + 0.5)
    return np.clip(count, -COUNTS_PER_FULL_SCALE, COUNTS_PER_FULL_SCALE - 1).astype(np.int64)


def at_full_scale(count: IntArray) -> NDArray[np.bool_]:
    """Tell which samples have an axis at the end of its range, shape ``(N,)``."""
    ends = (count >= COUNTS_PER_FULL_SCALE - 1) | (count <= -COUNTS_PER_FULL_SCALE)
    return np.asarray(ends.any(axis=1))


def to_counts(
    part: SensorPart, config: SensorConfig, rate_rad_s: Vector, force_m_s2: Vector
) -> Counts:
    """Return the counts that a configured sensor gives, inputs each of shape ``(N, 3)``."""
    return Counts(
        accel=quantise(force_m_s2, part.m_s2_per_count(config)),
        gyro=quantise(rate_rad_s, part.rad_s_per_count(config)),
    )


def to_rate_and_force_g(
    part: SensorPart, config: SensorConfig, counts: Counts
) -> tuple[Vector, Vector]:
    """Return angular rate, rad/s, and specific force, g, each of shape ``(N, 3)``."""
    g_per_count = part.m_s2_per_count(config) / STANDARD_GRAVITY_M_S2
    gyro, accel = counts.gyro.astype(np.float64), counts.accel.astype(np.float64)
    return gyro * part.rad_s_per_count(config), accel * g_per_count
