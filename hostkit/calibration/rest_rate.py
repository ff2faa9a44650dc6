"""The bias of a gyroscope over time, from the poses of recordings."""

import numpy as np

from hostkit.calibration.gyroscope import LEAST_BIAS_ERROR_RAD_S
from hostkit.calibration.poses import Pose
from hostkit.calibration.turn_model import RestRate
from hostkit.recordings import Recording
from hostkit.recordings.recording import Vector


def rest_rate(recordings: tuple[Recording, ...], poses: tuple[Pose, ...]) -> RestRate:
    """Return what the gyroscope reads at rest.

    Every recording counts the same, for each may have been switched on anew. The standard error
    is from the spread of the poses or, if that is greater, of the recordings' means.

    Parameters
    ----------
    recordings
        The recordings.
    poses
        Their poses, at least one.
    """
    owner = np.array([pose.recording for pose in poses])
    rates = np.stack([pose.rate_rad_s for pose in poses])
    means = np.stack([rates[owner == i].mean(axis=0) for i in sorted(set(owner.tolist()))])
    error = np.full(3, LEAST_BIAS_ERROR_RAD_S)
    for values in (rates, means):
        if len(values) > 1:
            error = np.maximum(error, values.std(axis=0, ddof=1) / np.sqrt(len(values)))
    mean = means.mean(axis=0)
    tracks = tuple(
        _track(recording, tuple(pose for pose in poses if pose.recording == i), mean)
        for i, recording in enumerate(recordings)
    )
    return RestRate(mean_rad_s=mean, error_rad_s=error, of_sample_rad_s=tracks)


def _track(recording: Recording, poses: tuple[Pose, ...], mean: Vector) -> Vector:
    """Return the bias at every sample, in proportion to time between the middles of poses."""
    if not poses:
        return np.tile(mean, (len(recording), 1))
    middle = [0.5 * (pose.begin_s + pose.end_s) for pose in poses]
    rates = np.stack([pose.rate_rad_s for pose in poses])
    axes = [np.interp(recording.time_s, middle, rates[:, axis]) for axis in range(3)]
    return np.column_stack(axes)
