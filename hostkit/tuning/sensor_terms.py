"""What is searched of a sensor beside any filter: its lead, biases, scales and offsets."""

from collections.abc import Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from hostkit.tuning.dimension import Dimension, FreeName, SearchRange
from hostkit.units import RAD_PER_DEG

Vector = NDArray[np.float64]

SENSOR_RANGES: Final[tuple[SearchRange, ...]] = (
    SearchRange(name="lead", lowest=-0.02, highest=0.02, is_log=False),
    SearchRange(
        name="gyro_bias", lowest=-5.0 * RAD_PER_DEG, highest=5.0 * RAD_PER_DEG, is_log=False
    ),
    SearchRange(name="gyro_scale", lowest=-0.12, highest=0.12, is_log=False),
    SearchRange(name="accel_offset", lowest=-0.5, highest=0.5, is_log=False),
    SearchRange(name="accel_scale", lowest=-0.05, highest=0.05, is_log=False),
)

USUAL: Final[dict[FreeName, float]] = {
    "lead": 0.01,
    "gyro_bias": 1.0 * RAD_PER_DEG,
    "gyro_scale": 0.03,
    "accel_offset": 0.25,
    "accel_scale": 0.03,
}
"""How far calibrations are from zero in ordinary sensors, in the unit of a design: scale factors
within the 3 % of the MPU-6050's data sheet."""

HOLD: Final = 2e-3
"""Share by which the cost grows where a calibration is that far from zero."""


def preference(dimensions: Sequence[Dimension], points: Vector) -> Vector:
    """Return the factors that hold points of shape ``(P, D)`` to what is usual, ``(P,)``.

    The scale of an axis that the recordings do not turn about would be anything else.
    """
    factor = np.ones(len(points))
    for i, dimension in enumerate(dimensions):
        usual = USUAL.get(dimension.name)
        if usual is not None:
            factor += HOLD * (points[:, i] / usual) ** 2
    return factor
