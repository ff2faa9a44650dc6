"""The tuning objective: the error of the complementary filter, for a whole swarm at a time.

The filter is evaluated in its error form, which is the filter itself with the reference taken
out. With w the rate, m the measured tilt, r the reference, and v = m - r::

    c_k = w_k dt - (r_k - r_(k-1)) - v_k
    e_k = eta e_(k-1) + (eta c_k + v_k),    e_0 = v_0

It equals the wrapped filter exactly as long as no innovation exceeds half a turn; the figure that
is reported of a finished design comes from the filter itself.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.signal import lfilter

from hostkit.attitude import pitch_from_up, roll_from_up, to_body, wrap_rad
from hostkit.errors import RecordingError
from hostkit.filters.complementary import RATE_AXIS, measured_tilt_rad
from hostkit.mounting import Mounting
from hostkit.recordings import Recording
from hostkit.records import AXES, Axis, AxisChoice, Objective, TiltMethod
from hostkit.units import STANDARD_GRAVITY_M_S2

Vector = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class ErrorStreams:
    """One row per recording and axis, padded with zeros to a common length.

    Attributes
    ----------
    drive, start
        c and v above, shape ``(S, N)``.
    scored
        1 where a sample counts, else 0, shape ``(S, N)``.
    """

    drive: Vector
    start: Vector
    scored: Vector


def prepare(
    recordings: tuple[Recording, ...],
    *,
    axes: AxisChoice,
    tilt: TiltMethod,
    mounting: Mounting,
    period_s: float,
) -> ErrorStreams:
    """Lay recordings out for :func:`cost`.

    Raises
    ------
    RecordingError
        If a recording has no reference, or no sample of it can be scored.
    """
    rows = [
        _row(recording, axis, tilt, mounting, period_s)
        for recording in recordings
        for axis in AXES[axes]
    ]
    length = max(len(drive) for drive, _, _ in rows)
    padded = [[np.pad(column, (0, length - len(column))) for column in row] for row in rows]
    drive, start, scored = (np.stack(columns) for columns in zip(*padded, strict=True))
    return ErrorStreams(drive=drive, start=start, scored=scored)


def reference_rad(recording: Recording, axis: Axis, mounting: Mounting) -> Vector:
    """Return the reference angle of one axis, NaN where there is none, shape ``(N,)``.

    Raises
    ------
    RecordingError
        If the recording has no reference.
    """
    if recording.up_reference is None:
        raise RecordingError(
            f"{recording.name} has no reference: add ref_roll_rad and ref_pitch_rad, or ref_qw to "
            "ref_qz, in a CSV file; ref_quat_wxyz or ref_tilt_rad in a .npz file"
        )
    up = to_body(mounting, recording.up_reference)
    return roll_from_up(up) if axis == "roll" else pitch_from_up(up)


def _row(
    recording: Recording, axis: Axis, tilt: TiltMethod, mounting: Mounting, period_s: float
) -> tuple[Vector, Vector, Vector]:
    reference = reference_rad(recording, axis, mounting)
    scored = recording.valid & np.isfinite(reference)
    if not scored.any():
        raise RecordingError(
            f"{recording.name}: none of its {len(recording)} samples is valid with a reference"
        )
    # The filter does not see the reference, so any value may stand where it is lost.
    reference = np.where(np.isfinite(reference), reference, 0.0)
    force_g = to_body(mounting, recording.specific_force_m_s2) / STANDARD_GRAVITY_M_S2
    rate = to_body(mounting, recording.angular_rate_rad_s)[:, RATE_AXIS[axis]]
    start = wrap_rad(measured_tilt_rad(axis, tilt, force_g) - reference)
    drive = rate * period_s - wrap_rad(np.diff(reference, prepend=reference[0])) - start
    drive[0] = 0.0
    return drive, start, scored.astype(np.float64)


def cost(streams: ErrorStreams, objective: Objective, eta: Vector) -> Vector:
    """Return the cost of each eta, rad, shape ``(P,)``: the mean over recordings and axes.

    Every recording counts the same, however long it is.

    Parameters
    ----------
    objective
        ``rmse``, or ``mae`` for the mean absolute error of the paper (equation 10).
    eta
        Weights of the integrated rate, shape ``(P,)``.
    """
    return np.array([_cost(streams, objective, float(value)) for value in eta])


def _cost(streams: ErrorStreams, objective: Objective, eta: float) -> float:
    error = lfilter([1.0], [1.0, -eta], eta * streams.drive + streams.start)
    samples = streams.scored.sum(axis=1)
    if objective == "mae":
        return float(np.mean((streams.scored * np.abs(error)).sum(axis=1) / samples))
    return float(np.mean(np.sqrt((streams.scored * error * error).sum(axis=1) / samples)))
