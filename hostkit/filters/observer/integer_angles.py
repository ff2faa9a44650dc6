"""Roll and pitch of an orientation in integers, told ahead of it."""

import numpy as np
from numpy.typing import NDArray

from hostkit.filters.arctan import atan2_word, atan2_word_length
from hostkit.filters.observer.spec import ObserverSpec
from hostkit.records import Axis

IntArray = NDArray[np.int64]

LEAD_LIMIT = 2**25
"""Largest turn by which the angles are told ahead, 25 fraction bits."""


def angles_raw(spec: ObserverSpec, quaternion: IntArray, turn: IntArray) -> IntArray:
    """Return the angles of the design's axes, half turns, shape ``(N, A)``.

    Parameters
    ----------
    quaternion
        Orientation with 30 fraction bits, shape ``(N, 4)``.
    turn
        Half-angles of the sample with 32 fraction bits, shape ``(N, 3)``.
    """
    up = _up(quaternion)
    if spec.lead_raw != 0:
        up = _led(up, np.clip(turn * spec.lead_raw >> 32, -LEAD_LIMIT, LEAD_LIMIT))
    body = up[:, list(spec.mounting.source)] * np.asarray(spec.mounting.sign, dtype=np.int64)
    x, y, z = body.T
    roll, length, stretch = atan2_word(spec.arctan, y, z)
    angles: dict[Axis, IntArray] = {
        "roll": roll,
        "pitch": atan2_word_length(spec.arctan, -x, length, stretch),
    }
    return np.stack([angles[axis] for axis in spec.axes], axis=-1)


def _up(quaternion: IntArray) -> IntArray:
    """Return the earth's up in sensor axes with 27 fraction bits."""
    q0, q1, q2, q3 = quaternion.T
    x = (q1 * q3 >> 32) - (q0 * q2 >> 32)
    y = (q2 * q3 >> 32) + (q0 * q1 >> 32)
    z = 2**27 - (q1 * q1 >> 32) - (q2 * q2 >> 32)
    return np.stack([x, y, z], axis=-1)


def _led(up: IntArray, lead: IntArray) -> IntArray:
    """Return up advanced by a turn with 25 fraction bits."""
    (x, y, z), (wide_x, wide_y, wide_z) = up.T, (up << 3).T
    a, b, c = lead.T
    return np.stack(
        [
            x + (((wide_y * c >> 32) - (wide_z * b >> 32)) << 4),
            y + (((wide_z * a >> 32) - (wide_x * c >> 32)) << 4),
            z + (((wide_x * b >> 32) - (wide_y * a >> 32)) << 4),
        ],
        axis=-1,
    )
