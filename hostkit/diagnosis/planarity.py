"""Whether filters of single angles fit the motion of a recording, and what they cost if not."""

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from hostkit.attitude import to_body
from hostkit.diagnosis.coupling import ANGLE, axis_motions
from hostkit.diagnosis.filter_errors import Case, FilterErrors, filter_errors
from hostkit.diagnosis.strapdown import Strapdown, strapdown
from hostkit.mounting import Mounting
from hostkit.recordings import Recording
from hostkit.recordings.recording import Vector
from hostkit.records import AXES, AxisChoice
from hostkit.units import RAD_PER_DEG

EXTRA_LIMIT_RAD = 1.0 * RAD_PER_DEG
"""What the neglected rates may add. docs/diagnosis.md has the recordings that this parts."""
PLANAR_SPREAD_RAD = 1.0 * RAD_PER_DEG
"""An angle that spreads by less (standard deviation) needs no filter of its own."""
SPATIAL_LIMIT_RAD = 5.0 * RAD_PER_DEG
"""Beyond it rate and force contradict each other; sound public recordings have 4.3 at most."""
MOTION_LIMIT_RAD = 1.0 * RAD_PER_DEG
"""Below this spread of the tilt there was too little motion to judge."""

Verdict = Literal["planar", "two axes suffice", "needs a three-dimensional filter"]
TiltSource = Literal["reference", "estimate"]
Triple = tuple[float, float, float]


@dataclass(frozen=True, slots=True, kw_only=True)
class Planarity:
    """How far filters of single angles get on a recording.

    Attributes
    ----------
    verdict
        None if the sensor hardly tilted, or if not even a filter in three dimensions gets near, so
        that nothing can be said.
    tilt
        What the errors are held against: the reference, or where there is none an estimate from
        the recording itself.
    scored
        Samples that the errors are over.
    rate_error_rad_s
        Root mean square of the neglected rate; with two angles, of both together.
    errors
        What the filters are wrong by.
    roll_spread_rad, pitch_spread_rad
        Standard deviation of the angles.
    turn_share
        Share of each sensor axis in the square of the angular rate.
    turn_upright
        Mean square of the up direction along the sensor axis with the largest share: near 1 the
        sensor turns about the vertical, which is no tilt.
    """

    verdict: Verdict | None
    tilt: TiltSource
    scored: int
    rate_error_rad_s: float
    errors: FilterErrors
    roll_spread_rad: float
    pitch_spread_rad: float
    turn_share: Triple
    turn_upright: float


def planarity(
    recording: Recording, *, axes: AxisChoice, mounting: Mounting, bias_rad_s: Vector
) -> Planarity:
    """Judge whether filters of single angles fit a recording.

    Parameters
    ----------
    recording
        Its time rises and its values are finite.
    axes, mounting
        What is to be tuned.
    bias_rad_s
        What the gyroscope reads at rest, taken off before, shape ``(3,)``.
    """
    frame = strapdown(recording, bias_rad_s)
    up, source, known = _tilt(recording, frame)
    rate = recording.angular_rate_rad_s - bias_rad_s
    case = _case(recording, axes, mounting, frame, up, rate, known)
    errors = filter_errors(case)
    share = np.sum(rate * rate, axis=0)
    x, y, z = (share / max(float(share.sum()), 1e-300)).tolist()
    roll_spread, pitch_spread = (_spread(ANGLE[axis](case.body_up)[case.scored]) for axis in ANGLE)
    return Planarity(
        verdict=_verdict(case, errors, min(roll_spread, pitch_spread)),
        tilt=source,
        scored=int(np.count_nonzero(case.scored)),
        rate_error_rad_s=_rate_error(case),
        errors=errors,
        roll_spread_rad=roll_spread,
        pitch_spread_rad=pitch_spread,
        turn_share=(x, y, z),
        turn_upright=float(np.mean(up[:, int(np.argmax(share))] ** 2)),
    )


def _tilt(recording: Recording, frame: Strapdown) -> tuple[Vector, TiltSource, NDArray[np.bool_]]:
    """Return the up direction everywhere, what it is, and where it may be scored."""
    everywhere = np.ones(len(recording), dtype=np.bool_)
    reference = recording.up_reference
    known = everywhere if reference is None else np.isfinite(reference.sum(axis=1))
    if reference is not None and known.all():
        return reference, "reference", everywhere
    estimate = frame.to_sensor(frame.smoothed_up(recording.rate_hz))
    if reference is None or not known.any():
        return estimate, "estimate", everywhere
    return np.where(known[:, None], reference, estimate), "reference", known


def _case(
    recording: Recording,
    axes: AxisChoice,
    mounting: Mounting,
    frame: Strapdown,
    up: Vector,
    rate: Vector,
    known: NDArray[np.bool_],
) -> Case:
    body_up, body_rate = to_body(mounting, up), to_body(mounting, rate)
    force, period_s = to_body(mounting, recording.specific_force_m_s2), 1.0 / recording.rate_hz
    motions = axis_motions(
        AXES[axes], up=body_up, rate_rad_s=body_rate, force_m_s2=force, period_s=period_s
    )
    scored = recording.valid & known
    return Case(
        axes=axes,
        mounting=mounting,
        frame=frame,
        up=up,
        body_up=body_up,
        motions=motions,
        scored=scored if scored.any() else known,
        period_s=period_s,
    )


def _rate_error(case: Case) -> float:
    squares = sum(float(np.mean(np.square(m.coupling[case.scored]))) for m in case.motions)
    return math.sqrt(squares) / case.period_s


def _spread(angle: Vector) -> float:
    """Return the circular standard deviation (K. V. Mardia, P. E. Jupp, 2000, section 2.3)."""
    length = math.hypot(float(np.cos(angle).mean()), float(np.sin(angle).mean()))
    return math.sqrt(-2.0 * math.log(min(1.0, max(length, 1e-300))))


def _verdict(case: Case, errors: FilterErrors, lesser_spread_rad: float) -> Verdict | None:
    """Judge; of unit vectors, ``2 (1 - |mean|)`` is the mean square of the distance to the mean."""
    mean = case.up[case.scored].mean(axis=0)
    if 2.0 * (1.0 - float(np.linalg.norm(mean))) < MOTION_LIMIT_RAD**2:
        return None
    if errors.extra_rad > EXTRA_LIMIT_RAD:
        return "needs a three-dimensional filter"
    if errors.spatial_rad > SPATIAL_LIMIT_RAD:
        return None
    if case.axes == "both" and lesser_spread_rad > PLANAR_SPREAD_RAD:
        return "two axes suffice"
    return "planar"
