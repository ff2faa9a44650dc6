"""What a rigid body feels on a given path: up direction, body rates and specific force."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hostkit.attitude import up_from_tilt
from hostkit.simulation.curves import Curve, Samples
from hostkit.units import STANDARD_GRAVITY_M_S2

Vector = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class Path:
    """A motion as curves over time.

    Attributes
    ----------
    roll_rad, pitch_rad, yaw_rad
        The angles of `hostkit.attitude`.
    acceleration_m_s2
        Linear acceleration along world x, y and z; empty for none.
    """

    roll_rad: Curve
    pitch_rad: Curve
    yaw_rad: Curve
    acceleration_m_s2: tuple[Curve, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Motion:
    """What an ideal sensor reads, each of shape ``(M, 3)``, in sensor axes."""

    up: Vector
    angular_rate_rad_s: Vector
    specific_force_m_s2: Vector


def motion_at(path: Path, time_s: Vector) -> Motion:
    """Return what an ideal sensor reads on a path.

    With body to world ``Rz(yaw) Ry(pitch) Rx(roll)``, the body rates are
    ``(r' - y' sin p, p' cos r + y' sin r cos p, y' cos r cos p - p' sin r)``
    (J. Diebel, "Representing attitude", Stanford 2006), and the specific force is gravity's
    reaction plus the linear acceleration, turned into body axes.

    Parameters
    ----------
    path
        The motion.
    time_s
        Times, s, shape ``(M,)``.
    """
    roll, pitch, yaw = path.roll_rad(time_s), path.pitch_rad(time_s), path.yaw_rad(time_s)
    up = up_from_tilt(roll.value, pitch.value)
    force = STANDARD_GRAVITY_M_S2 * up
    if path.acceleration_m_s2:
        world = [curve(time_s).value for curve in path.acceleration_m_s2]
        force = force + _to_body(world, roll, pitch, yaw)
    return Motion(
        up=up, angular_rate_rad_s=_body_rates(roll, pitch, yaw), specific_force_m_s2=force
    )


def _body_rates(roll: Samples, pitch: Samples, yaw: Samples) -> Vector:
    sin_r, cos_r = np.sin(roll.value), np.cos(roll.value)
    sin_p, cos_p = np.sin(pitch.value), np.cos(pitch.value)
    return np.stack(
        (
            roll.slope - yaw.slope * sin_p,
            pitch.slope * cos_r + yaw.slope * sin_r * cos_p,
            yaw.slope * cos_r * cos_p - pitch.slope * sin_r,
        ),
        axis=-1,
    )


def _to_body(world: list[Vector], roll: Samples, pitch: Samples, yaw: Samples) -> Vector:
    """Turn world coordinates, each ``(M,)``, into body axes: yaw, pitch and roll undone in turn."""
    x, y, z = world
    x, y = _turned_back(x, y, yaw.value)
    z, x = _turned_back(z, x, pitch.value)
    y, z = _turned_back(y, z, roll.value)
    return np.stack((x, y, z), axis=-1)


def _turned_back(first: Vector, second: Vector, angle_rad: Vector) -> tuple[Vector, Vector]:
    cos, sin = np.cos(angle_rad), np.sin(angle_rad)
    return cos * first + sin * second, cos * second - sin * first
