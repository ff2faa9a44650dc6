"""Laying a recording out for the kernel: the filter in error form.

The error form is the filter itself with the reference taken out. With w the rate, m the measured
tilt, r the reference, v = m - r and dt the period, the filter of
`hostkit.filters.complementary.parameters` becomes::

    p_k = e_(k-1) + ((1 + s) w_k - b_(k-1)) dt - (r_k - r_(k-1))
    i_k = v_k - o - p_k  if | |f_k| - 1 g | < gate, else 0
    e_k = p_k + (1 - eta) i_k,    b_k = b_(k-1) - ki i_k dt,    e_0 = v_0 - o

and where eta is the only parameter::

    c_k = w_k dt - (r_k - r_(k-1)) - v_k
    e_k = eta e_(k-1) + (eta c_k + v_k),    e_0 = v_0

It equals the wrapped filter exactly as long as no innovation exceeds half a turn; the figure that
is reported of a finished design comes from the filter itself.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import DTypeLike, NDArray

from hostkit.attitude import to_body, wrap_rad
from hostkit.errors import RecordingError
from hostkit.filters.complementary import RATE_AXIS, measured_tilt_rad
from hostkit.filters.complementary.parameters import BIAS_LIMIT_RAD_S
from hostkit.mounting import Mounting
from hostkit.recordings import Recording
from hostkit.records import AXES, Axis, AxisChoice, TiltMethod
from hostkit.tuning.kernel import ErrorStream, runs_of
from hostkit.tuning.reference import reference_rad
from hostkit.units import STANDARD_GRAVITY_M_S2

Vector = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class Layout:
    """How recordings are laid out for the kernel.

    Attributes
    ----------
    full
        Whether more than eta is tuned, so that the longer recursion is needed.
    dtype
        Of the streams, float64 or float32.
    """

    axes: AxisChoice
    tilt: TiltMethod
    mounting: Mounting
    period_s: float
    full: bool
    dtype: DTypeLike = np.float64


def prepare(recording: Recording, layout: Layout) -> tuple[ErrorStream, ...]:
    """Lay a recording out for the kernel, a stream for each axis.

    Raises
    ------
    RecordingError
        If the recording has no reference, or no sample of it can be scored.
    """
    return tuple(_whole(recording, axis, layout) for axis in AXES[layout.axes])


def _whole(recording: Recording, axis: Axis, layout: Layout) -> ErrorStream:
    stream = lay_out(recording, axis, layout)
    if not len(stream.runs):
        raise RecordingError(
            f"{recording.name}: none of its {len(recording)} samples is valid with a reference"
        )
    return stream


def lay_out(
    recording: Recording, axis: Axis, layout: Layout, before_rad: float | None = None
) -> ErrorStream:
    """Lay out one axis of a recording, or of a part of one.

    Parameters
    ----------
    before_rad
        Reference of the sample before the part; None if the filter starts here.

    Raises
    ------
    RecordingError
        If the recording has no reference.
    """
    reference = reference_rad(recording, axis, layout.mounting)
    scored = recording.valid & np.isfinite(reference)
    # The filter does not see the reference, so any value may stand where it is lost.
    reference = np.where(np.isfinite(reference), reference, 0.0)
    body = to_body(layout.mounting, recording.angular_rate_rad_s)
    rate_step = body[:, RATE_AXIS[axis]] * layout.period_s
    force_g = to_body(layout.mounting, recording.specific_force_m_s2) / STANDARD_GRAVITY_M_S2
    start = wrap_rad(measured_tilt_rad(axis, layout.tilt, force_g) - reference)
    first = reference[0] if before_rad is None else before_rad
    reference_step = wrap_rad(np.diff(reference, prepend=first))
    drive = rate_step - reference_step - start
    if before_rad is None:
        rate_step[0] = drive[0] = 0.0
    deviation = np.abs(np.linalg.norm(force_g, axis=1) - 1.0)
    kept = {"drive": drive, "start": start, "reference": reference}
    if layout.full:
        kept |= {
            "rate_step": rate_step,
            "reference_step": reference_step,
            "force_deviation": deviation,
        }
    return ErrorStream(
        runs=runs_of(scored),
        bias_limit_rad=BIAS_LIMIT_RAD_S * layout.period_s,
        **{name: column.astype(layout.dtype) for name, column in kept.items()},
    )
