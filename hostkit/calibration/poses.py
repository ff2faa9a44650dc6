"""Poses: the parts of a recording in which the sensor was held still, in whatever position."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hostkit.recordings import Recording
from hostkit.recordings.recording import Vector
from hostkit.recordings.sanity.clipping import runs
from hostkit.records import read_only
from hostkit.units import RAD_PER_DEG

WINDOW_S = 1.0
"""A pose is at least this long."""
MAX_STEP_S = 0.5
"""A longer time step ends a pose, and no motion across it is integrated."""
MIN_SAMPLES = 5
EDGE = 0.1
"""Share of a window that is cut off at both ends of a pose."""
TIMES_QUIETEST = 4.0
"""A window is still if it spreads by less than this many times the quietest tenth."""
RATE_SPREAD_RAD_S = (0.004, 0.03)
FORCE_SPREAD_M_S2 = (0.05, 0.3)
"""Least and greatest limit of a still window's standard deviation, whatever the quietest has."""
FORCE_DRIFT_M_S2 = 0.06
"""Largest change of the mean force between the halves of a window: 0.7 deg/s of tilting."""
MAX_RATE_RAD_S = 25.0 * RAD_PER_DEG
ALIKE_RAD_S = 0.5 * RAD_PER_DEG
"""Poses agree on the bias; one turning evenly differs from their median by more than this."""

Flags = NDArray[np.bool_]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Pose:
    """One time at rest.

    Attributes
    ----------
    recording
        Which of the recordings, counted from 0.
    first, last
        Rows of its first and its last sample.
    begin_s, end_s
        Times of these samples.
    force_m_s2, rate_rad_s
        Means over the pose, sensor axes, shape ``(3,)``.
    first_force_m_s2, last_force_m_s2
        Means over its first and its last second, which a slow drift does not blur, ``(3,)``.
    """

    recording: int
    first: int
    last: int
    begin_s: float
    end_s: float
    force_m_s2: Vector
    rate_rad_s: Vector
    first_force_m_s2: Vector
    last_force_m_s2: Vector

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        for array in (self.force_m_s2, self.rate_rad_s):
            read_only(array)
        read_only(self.first_force_m_s2)
        read_only(self.last_force_m_s2)

    @property
    def duration_s(self) -> float:
        """Time from the first to the last sample."""
        return self.end_s - self.begin_s


def find_poses(recordings: tuple[Recording, ...]) -> tuple[Pose, ...]:
    """Return the poses of recordings, in their order and that of time.

    Rate and force must spread little over every second of a pose, measured by how quiet the
    sensor is when it is most quiet, and the force must not drift. A pose whose mean rate is not
    that of the others was turned evenly and is none.
    """
    found = [pose for i, recording in enumerate(recordings) for pose in _poses(recording, i)]
    if not found:
        return ()
    rates = np.stack([pose.rate_rad_s for pose in found])
    alike = np.empty(len(found), dtype=np.bool_)
    owner = np.array([pose.recording for pose in found])
    for i in set(owner.tolist()):
        mine = owner == i
        alike[mine] = np.abs(rates[mine] - np.median(rates[mine], axis=0)).max(axis=1) < ALIKE_RAD_S
    alike &= np.linalg.norm(rates, axis=1) < MAX_RATE_RAD_S
    return tuple(pose for pose, keep in zip(found, alike.tolist(), strict=True) if keep)


def _poses(recording: Recording, index: int) -> list[Pose]:
    steps_s = np.diff(recording.time_s)
    whole = steps_s[steps_s <= MAX_STEP_S]
    if not whole.size:
        return []
    width = max(MIN_SAMPLES, round(WINDOW_S / float(whole.mean())))
    if len(recording) < width:
        return []
    at_rest = _at_rest(recording, steps_s, width)
    spans = zip(*(array.tolist() for array in runs(at_rest)), strict=True)
    return [_pose(recording, index, start, start + length, width) for start, length in spans]


def _at_rest(recording: Recording, steps_s: Vector, width: int) -> Flags:
    """Return which samples are in a still window, shape ``(N,)``."""
    rate, force = recording.angular_rate_rad_s, recording.specific_force_m_s2
    still = _quiet(_spread(rate, width), RATE_SPREAD_RAD_S)
    still &= _quiet(_spread(force, width), FORCE_SPREAD_M_S2)
    still &= _drift(force, width) < FORCE_DRIFT_M_S2
    gaps = np.concatenate(([0], np.cumsum(steps_s > MAX_STEP_S)))
    still &= gaps[width - 1 :] == gaps[: len(gaps) - width + 1]
    covered = np.zeros(len(recording) + 1, dtype=np.int64)
    np.add.at(covered, np.flatnonzero(still), 1)
    np.add.at(covered, np.flatnonzero(still) + width, -1)
    rest: Flags = np.cumsum(covered)[:-1] > 0
    rest[1:] &= (gaps[1:] == gaps[:-1]) | ~rest[:-1]
    return rest


def _quiet(spread: Vector, limits: tuple[float, float]) -> Flags:
    limit = min(max(TIMES_QUIETEST * float(np.quantile(spread, 0.1)), limits[0]), limits[1])
    return spread < limit


def _window_mean(values: Vector, width: int) -> Vector:
    """Return the means of ``width`` rows, one for each row that a window begins with."""
    total = np.cumsum(np.concatenate((np.zeros_like(values[:1]), values)), axis=0)
    mean: Vector = (total[width:] - total[:-width]) / width
    return mean


def _spread(values: Vector, width: int) -> Vector:
    """Return the largest standard deviation of the axes in each window."""
    centred = values - values.mean(axis=0)
    square = _window_mean(centred**2, width) - _window_mean(centred, width) ** 2
    spread: Vector = np.sqrt(np.maximum(square, 0.0)).max(axis=1)
    return spread


def _drift(force: Vector, width: int) -> Vector:
    half = width // 2
    means = _window_mean(force, half)
    later = width - half
    drift: Vector = np.linalg.norm(means[later:] - means[: len(means) - later], axis=1)
    return drift


def _pose(recording: Recording, index: int, begin: int, stop: int, width: int) -> Pose:
    """Return one pose, its ends cut off: there the motion may have begun."""
    cut = int(EDGE * width)
    first, end = begin + cut, stop - cut
    width -= 2 * cut
    rows, head = slice(first, end), slice(first, first + width)
    tail = slice(end - width, end)
    force = recording.specific_force_m_s2
    return Pose(
        recording=index,
        first=first,
        last=end - 1,
        begin_s=float(recording.time_s[first]),
        end_s=float(recording.time_s[end - 1]),
        force_m_s2=force[rows].mean(axis=0),
        rate_rad_s=recording.angular_rate_rad_s[rows].mean(axis=0),
        first_force_m_s2=force[head].mean(axis=0),
        last_force_m_s2=force[tail].mean(axis=0),
    )
