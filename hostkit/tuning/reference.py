"""The reference angles of a recording."""

import numpy as np
from numpy.typing import NDArray

from hostkit.attitude import pitch_from_up, roll_from_up, to_body
from hostkit.errors import RecordingError
from hostkit.mounting import Mounting
from hostkit.recordings import Recording
from hostkit.records import Axis

Vector = NDArray[np.float64]


def reference_up(recording: Recording) -> Vector:
    """Return the reference direction of up, NaN where there is none, shape ``(N, 3)``.

    Raises
    ------
    RecordingError
        If the recording has no reference.
    """
    if recording.up_reference is None:
        raise RecordingError(
            f"{recording.name} has no reference: add ref_roll_rad and ref_pitch_rad, or ref_qw to "
            "ref_qz, in a CSV file; ref_quat_wxyz or ref_tilt_rad in a .npz file; or let hostkit "
            "smooth find one"
        )
    return recording.up_reference


def reference_rad(recording: Recording, axis: Axis, mounting: Mounting) -> Vector:
    """Return the reference angle of one axis, NaN where there is none, shape ``(N,)``.

    Raises
    ------
    RecordingError
        If the recording has no reference.
    """
    up = to_body(mounting, reference_up(recording))
    return roll_from_up(up) if axis == "roll" else pitch_from_up(up)
