"""Fewer samples of the same motion: rotations composed, not rates averaged."""

from dataclasses import replace

import numpy as np

from hostkit.errors import RecordingError
from hostkit.importers.log import Vector
from hostkit.importers.rotation import (
    conjugate,
    from_rotation_vector,
    multiply,
    to_rotation_vector,
    to_world,
)
from hostkit.recordings import Recording


def decimated(recording: Recording, factor: int) -> Recording:
    """Turn every `factor` samples into one.

    The rate of a sample turns the sensor over the step that ends with it. The steps of a group
    are composed as rotations and divided by their time, which is exact where a mean of rates is
    not: rotations about different axes do not commute. Force and field are turned into the axes
    of the group's last sample and averaged there. Time and reference are those of the last
    sample; a group is valid if all its samples are. Samples beyond the last whole group are left
    out.

    Raises
    ------
    RecordingError
        If fewer than two groups are left.
    """
    groups = len(recording) // factor
    if groups < 2:
        raise RecordingError(
            f"--decimate {factor} leaves {groups} of {len(recording)} samples; it needs at least "
            f"2: take {max(1, len(recording) // 2)} or less"
        )
    used = slice(0, groups * factor)
    steps_s = _steps(recording.time_s)[used].reshape(groups, factor)
    rate = recording.angular_rate_rad_s[used].reshape(groups, factor, 3)
    turned, to_last = _composed(rate * steps_s[:, :, None])
    last = slice(factor - 1, groups * factor, factor)

    def averaged(values: Vector | None) -> Vector | None:
        if values is None:
            return None
        grouped = values[used].reshape(groups, factor, 3)
        seen = [to_world(to_last[:, i], grouped[:, i]) for i in range(factor)]
        mean: Vector = np.mean(seen, axis=0)
        return mean

    force = averaged(recording.specific_force_m_s2)
    assert force is not None
    heat, up = recording.temperature_deg_c, recording.up_reference
    return replace(
        recording,
        time_s=recording.time_s[last],
        rate_hz=recording.rate_hz / factor,
        angular_rate_rad_s=to_rotation_vector(turned) / steps_s.sum(axis=1, keepdims=True),
        specific_force_m_s2=force,
        valid=np.asarray(recording.valid[used].reshape(groups, factor).all(axis=1)),
        up_reference=None if up is None else up[last],
        mag_ut=averaged(recording.mag_ut),
        temperature_deg_c=None if heat is None else heat[used].reshape(groups, factor).mean(axis=1),
    )


def _steps(time_s: Vector) -> Vector:
    steps_s = np.diff(time_s)
    return np.concatenate(([np.median(steps_s)], steps_s))


def _composed(turns_rad: Vector) -> tuple[Vector, Vector]:
    """Return the rotation of each group, and from each of its samples to its last one.

    Parameters
    ----------
    turns_rad
        Rotation vectors of the steps, shape ``(G, factor, 3)``.

    Returns
    -------
    tuple
        Quaternions of shape ``(G, 4)``: last sample to the one before the group; and of shape
        ``(G, factor, 4)``, which turn a vector in a sample's axes into those of the last.
    """
    groups, factor, _ = turns_rad.shape
    to_last = np.empty((groups, factor, 4))
    later = np.tile(np.array((1.0, 0.0, 0.0, 0.0)), (groups, 1))
    for sample in reversed(range(factor)):
        to_last[:, sample] = conjugate(later)
        later = multiply(from_rotation_vector(turns_rad[:, sample]), later)
    return later, to_last
