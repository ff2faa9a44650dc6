"""Turns: the motions between two poses, on which gyroscope and gravity can be compared."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from hostkit.calibration.poses import MAX_STEP_S, WINDOW_S, Flags, Pose
from hostkit.recordings import Recording
from hostkit.recordings.recording import Vector
from hostkit.recordings.sanity.clipping import NARROWEST_GYRO_RAD_S, clips
from hostkit.records import read_only

LONGEST_S = 60.0
"""A longer motion says more of the bias than of the scale."""
AT_EXTREME = 0.998


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Turn:
    """One motion from pose to pose.

    Attributes
    ----------
    recording
        Which of the recordings, counted from 0.
    first, last
        Rows from which and to which the gyroscope is integrated: in the middle of the last second
        of one pose and of the first second of the next.
    force_before_m_s2, force_after_m_s2
        Mean readings in these seconds, sensor axes, shape ``(3,)``.
    """

    recording: int
    first: int
    last: int
    force_before_m_s2: Vector
    force_after_m_s2: Vector

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        read_only(self.force_before_m_s2)
        read_only(self.force_after_m_s2)


def find_turns(recordings: tuple[Recording, ...], poses: tuple[Pose, ...]) -> tuple[Turn, ...]:
    """Return the motions between neighbouring poses of the same recording.

    Left out are motions of more than a minute, with a gap in time, or in which the gyroscope was
    at the end of its range.
    """
    found = []
    for i, recording in enumerate(recordings):
        clipped = _clipped(recording)
        mine = [pose for pose in poses if pose.recording == i]
        for before, after in pairwise(mine):
            turn = _turn(recording, before, after)
            rows = slice(turn.first, turn.last + 1)
            steps_s = np.diff(recording.time_s[rows])
            too_long = float(steps_s.sum()) > LONGEST_S or float(steps_s.max()) > MAX_STEP_S
            if not too_long and not clipped[rows].any():
                found.append(turn)
    return tuple(found)


def _turn(recording: Recording, before: Pose, after: Pose) -> Turn:
    times = (before.end_s - 0.5 * WINDOW_S, after.begin_s + 0.5 * WINDOW_S)
    first, last = np.searchsorted(recording.time_s, times).tolist()
    return Turn(
        recording=before.recording,
        first=first,
        last=last,
        force_before_m_s2=before.last_force_m_s2,
        force_after_m_s2=after.first_force_m_s2,
    )


def _clipped(recording: Recording) -> Flags:
    """Return which samples are at the end of the gyroscope's range, shape ``(N,)``."""
    rate = recording.angular_rate_rad_s
    at_end = np.zeros(len(recording), dtype=np.bool_)
    for clip in clips(rate, NARROWEST_GYRO_RAD_S):
        at_end |= rate[:, clip.axis] / clip.value >= AT_EXTREME
    return at_end
