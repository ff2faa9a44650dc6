import itertools
import math

import numpy as np
import pytest

from hostkit.attitude import (
    apart_rad,
    inclination_rad,
    pitch_from_up,
    roll_from_up,
    to_body,
    up_from_quaternion,
    up_from_tilt,
    wrap_rad,
)
from hostkit.errors import DesignError
from hostkit.mounting import Mounting

FACES = {
    "z up": ((0, 0, 1), 0.0, 0.0),
    "z down": ((0, 0, -1), 180.0, 0.0),
    "y up": ((0, 1, 0), 90.0, 0.0),
    "y down": ((0, -1, 0), -90.0, 0.0),
    "x up": ((1, 0, 0), None, -90.0),
    "x down": ((-1, 0, 0), None, 90.0),
}


@pytest.mark.parametrize("face", FACES)
def test_six_faces(face: str) -> None:
    up, roll_deg, pitch_deg = FACES[face]
    vector = np.array([up], dtype=float)
    assert math.degrees(pitch_from_up(vector)[0]) == pytest.approx(pitch_deg)
    if roll_deg is not None:
        assert math.degrees(roll_from_up(vector)[0]) == pytest.approx(roll_deg)


def rotation(roll: float, pitch: float, yaw: float) -> np.ndarray:
    cr, sr, cp, sp, cy, sy = (f(a) for a in (roll, pitch, yaw) for f in (math.cos, math.sin))
    rx = np.array([[1, 0, 0], [0, cr, -sr], [0, sr, cr]])
    ry = np.array([[cp, 0, sp], [0, 1, 0], [-sp, 0, cp]])
    rz = np.array([[cy, -sy, 0], [sy, cy, 0], [0, 0, 1]])
    return rz @ ry @ rx


@pytest.mark.parametrize(("roll", "pitch", "yaw"), [(0.4, -0.3, 1.0), (-2.5, 1.2, -3.0)])
def test_up_is_third_row_of_rotation(roll: float, pitch: float, yaw: float) -> None:
    up = up_from_tilt(np.array([roll]), np.array([pitch]))[0]
    np.testing.assert_allclose(up, rotation(roll, pitch, yaw)[2], atol=1e-15)


def test_quaternion_gives_same_up_as_rotation() -> None:
    half = 0.3
    quaternion = np.array([[math.cos(half), math.sin(half), 0.0, 0.0]])
    np.testing.assert_allclose(up_from_quaternion(2.0 * quaternion)[0], rotation(0.6, 0, 0)[2])


@pytest.mark.parametrize(("axis", "angle"), [(0, roll_from_up), (1, pitch_from_up)])
def test_positive_rate_raises_the_angle(axis: int, angle) -> None:
    """A fixed direction turns by -rate in a body that turns: d(up)/dt = up x rate."""
    up = np.array([[0.1, 0.2, 1.0]])
    rate = np.zeros(3)
    rate[axis] = 1e-3
    assert angle(up + np.cross(up, rate))[0] > angle(up)[0]


def test_there_are_24_mountings_and_they_are_rotations() -> None:
    assert len(set(map(str, Mounting.all()))) == 24
    for mounting in Mounting.all():
        x, y, z = (to_body(mounting, np.eye(3)[[i]])[0] for i in range(3))
        np.testing.assert_array_equal(np.cross(x, y), z)
        assert Mounting.parse(str(mounting)) == mounting


def test_mounting_names_sensor_axes_for_body_axes() -> None:
    sensor = np.array([[1.0, 2.0, 3.0]])
    np.testing.assert_array_equal(to_body(Mounting.parse("+z+x+y"), sensor), [[3.0, 1.0, 2.0]])
    np.testing.assert_array_equal(to_body(Mounting.parse("-y-x-z"), sensor), [[-2.0, -1.0, -3.0]])


@pytest.mark.parametrize("text", ["+x+y-z", "+x+x+z", "xyz", "", "+x+y+z+x", "+X+Y+Z"])
def test_bad_mounting_is_refused(text: str) -> None:
    with pytest.raises(DesignError, match="mounting"):
        Mounting.parse(text)


def test_left_handed_mounting_is_told_how_to_mend() -> None:
    with pytest.raises(DesignError, match=r"for example \+x\+y\+z"):
        Mounting.parse("+x+y-z")


def test_wrap_and_inclination() -> None:
    np.testing.assert_allclose(
        wrap_rad(np.array([3 * math.pi, -math.pi, 0.1])), [-math.pi, -math.pi, 0.1]
    )
    ups = [
        up_from_tilt(np.array([a]), np.array([b]))
        for a, b in itertools.product((0, 1e-9), repeat=2)
    ]
    assert inclination_rad(ups[0], ups[1])[0] == pytest.approx(1e-9, rel=1e-6)


def test_near_the_pole_roll_counts_by_what_it_turns() -> None:
    angle = np.array([[0.5, 1.57], [0.5, 0.0]])
    other = angle + np.array([[0.1, 0.0], [0.1, 0.0]])
    found = apart_rad(angle, other)
    np.testing.assert_allclose(found, [0.1 * np.cos(1.57), 0.1], rtol=2e-3)
    np.testing.assert_allclose(apart_rad(angle[:, :1], other[:, :1] + 2 * np.pi), [0.1, 0.1])
