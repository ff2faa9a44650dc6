"""Which axes reach the end of a range, and of which range."""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from hostkit.recordings import Recording
from hostkit.recordings.recording import Vector
from hostkit.recordings.sanity.clipping import NARROWEST_ACCEL_M_S2, NARROWEST_GYRO_RAD_S, clips
from hostkit.sensors import SENSORS
from hostkit.units import DEG_PER_RAD, STANDARD_GRAVITY_M_S2

PART = SENSORS["mpu6050"]
RANGE_TOLERANCE = 0.02
"""Relative distance within which the end of an axis is taken for that of a range of the part."""

Element = Literal["gyro", "accel"]
Triple = tuple[float, float, float]


@dataclass(frozen=True, slots=True, kw_only=True)
class Clipping:
    """One axis at one end of its range.

    Attributes
    ----------
    element, axis
        Gyroscope or accelerometer; sensor axis 0, 1 or 2.
    value
        Where it stays, rad/s or m/s^2.
    share
        Share of the samples that are there.
    full_scale
        Range of the MPU-6050 that ends there, deg/s or g; None if none does.
    """

    element: Element
    axis: int
    value: float
    share: float
    full_scale: int | None


@dataclass(frozen=True, slots=True, kw_only=True)
class Reach:
    """How far the readings go: the largest of each axis, rad/s and m/s^2, and what is clipped."""

    largest_rad_s: Triple
    largest_m_s2: Triple
    clippings: tuple[Clipping, ...]


def reach(recording: Recording) -> Reach:
    """Return how far the readings of a recording go, and where they stay at an extreme."""
    rate, force = recording.angular_rate_rad_s, recording.specific_force_m_s2
    return Reach(
        largest_rad_s=_largest(rate),
        largest_m_s2=_largest(force),
        clippings=_clippings("gyro", rate) + _clippings("accel", force),
    )


def _largest(values: Vector) -> Triple:
    x, y, z = np.abs(values).max(axis=0).tolist()
    return x, y, z


def _clippings(element: Element, values: Vector) -> tuple[Clipping, ...]:
    narrowest = NARROWEST_GYRO_RAD_S if element == "gyro" else NARROWEST_ACCEL_M_S2
    return tuple(
        Clipping(
            element=element,
            axis=clip.axis,
            value=clip.value,
            share=clip.share,
            full_scale=_full_scale(element, abs(clip.value)),
        )
        for clip in clips(values, narrowest)
    )


def _full_scale(element: Element, value: float) -> int | None:
    if element == "gyro":
        ranges, shown = PART.gyro_ranges, value * DEG_PER_RAD
    else:
        ranges, shown = PART.accel_ranges, value / STANDARD_GRAVITY_M_S2
    near = [r.full_scale for r in ranges if abs(shown / r.full_scale - 1.0) < RANGE_TOLERANCE]
    return near[0] if near else None
