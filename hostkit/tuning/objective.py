"""The tuning objective: the error of the complementary filter, for a whole swarm at a time.

The filter is evaluated in its error form, which is the filter itself with the reference taken
out. With w the rate, m the measured tilt, r the reference, and v = m - r::

    c_k = w_k dt - (r_k - r_(k-1)) - v_k
    e_k = eta e_(k-1) + (eta c_k + v_k),    e_0 = v_0

It equals the wrapped filter exactly as long as no innovation exceeds half a turn; the figure that
is reported of a finished design comes from the filter itself.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.signal import lfilter

from hostkit.attitude import pitch_from_up, roll_from_up, to_body, wrap_rad
from hostkit.errors import RecordingError
from hostkit.filters.complementary import RATE_AXIS, measured_tilt_rad
from hostkit.mounting import Mounting
from hostkit.recordings import Recording
from hostkit.records import AXES, Axis, AxisChoice, Objective, TiltMethod, read_only
from hostkit.units import STANDARD_GRAVITY_M_S2

Vector = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class ErrorStream:
    """One axis of one recording.

    Attributes
    ----------
    drive, start
        c and v above, shape ``(N,)``.
    scored
        Samples that count, shape ``(N,)``.
    """

    drive: Vector
    start: Vector
    scored: NDArray[np.bool_]

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        for array in (self.drive, self.start, self.scored):
            read_only(array)


def prepare(
    recordings: tuple[Recording, ...],
    *,
    axes: AxisChoice,
    tilt: TiltMethod,
    mounting: Mounting,
    period_s: float,
) -> tuple[ErrorStream, ...]:
    """Lay recordings out for :func:`cost`, a stream for each recording and axis.

    Raises
    ------
    RecordingError
        If a recording has no reference, or no sample of it can be scored.
    """
    return tuple(
        _stream(recording, axis, tilt, mounting, period_s)
        for recording in recordings
        for axis in AXES[axes]
    )


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


def _stream(
    recording: Recording, axis: Axis, tilt: TiltMethod, mounting: Mounting, period_s: float
) -> ErrorStream:
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
    return ErrorStream(drive=drive, start=start, scored=scored)


def cost(streams: tuple[ErrorStream, ...], objective: Objective, eta: Vector) -> Vector:
    """Return the cost of each eta, rad, shape ``(P,)``: the mean over recordings and axes.

    Every recording counts the same, however long it is.

    Parameters
    ----------
    objective
        ``rmse``, or ``mae`` for the mean absolute error of the paper (equation 10).
    eta
        Weights of the integrated rate, shape ``(P,)``.
    """
    costs = [[_cost(stream, objective, float(value)) for stream in streams] for value in eta]
    return np.asarray(np.mean(costs, axis=1))


def _cost(stream: ErrorStream, objective: Objective, eta: float) -> float:
    error = lfilter([1.0], [1.0, -eta], eta * stream.drive + stream.start)[stream.scored]
    if objective == "mae":
        return float(np.mean(np.abs(error)))
    return math.sqrt(float(np.vdot(error, error)) / len(error))
