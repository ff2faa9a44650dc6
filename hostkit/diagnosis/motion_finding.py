"""The verdict on the motion, in a sentence."""

from hostkit.diagnosis.diagnosis import Diagnosis
from hostkit.diagnosis.planarity import EXTRA_LIMIT_RAD, SPATIAL_LIMIT_RAD
from hostkit.units import DEG_PER_RAD

SINGLE_SHARE = 0.9
LEAST_ACROSS = 0.5
ROLL_ABOUT = ("+x+y+z", "+y+z+x", "+z+x+y")
"""The mounting that makes sensor x, y or z the roll axis."""

GYRO_UNUSED_S = 0.03
"""The shortest time constant that is tried is below this, the next above."""
_UNUSED = (
    "the accelerometer alone is best here, because nothing shakes it: record the accelerations "
    "that the filter is to stand"
)


def motion_sentence(diagnosis: Diagnosis) -> tuple[str, str]:
    """Return what the motion asks for, and what to do; empty if nothing."""
    planarity = diagnosis.planarity
    errors = planarity.errors
    if planarity.verdict is None and errors.spatial_rad > SPATIAL_LIMIT_RAD:
        return (
            "cannot be judged: even a three-dimensional filter would be "
            f"{errors.spatial_rad * DEG_PER_RAD:.2f} deg rms off against the {planarity.tilt} "
            f"(limit {SPATIAL_LIMIT_RAD * DEG_PER_RAD:g})",
            "look for an axis of the wrong sign, a wrong unit, or readings that are clipped",
        )
    if planarity.verdict is None:
        return (
            "the sensor hardly tilts, so the motion cannot be judged",
            "record the motion that the filter is for",
        )
    text = (
        f"{planarity.verdict}: {_filters(diagnosis)} "
        f"{errors.predicted_rad * DEG_PER_RAD:.2f} deg rms off against the {planarity.tilt}, a "
        f"three-dimensional one {errors.spatial_rad * DEG_PER_RAD:.2f}; "
        f"{errors.extra_rad * DEG_PER_RAD:.2f} deg come from rates about other axes (limit "
        f"{EXTRA_LIMIT_RAD * DEG_PER_RAD:g})"
    )
    return text, _action(diagnosis)


def _filters(diagnosis: Diagnosis) -> str:
    what = "filters of roll and pitch" if diagnosis.axes == "both" else f"a {diagnosis.axes} filter"
    return f"{what} with tau {diagnosis.planarity.errors.tau_s:.2g} s would be"


def _action(diagnosis: Diagnosis) -> str:
    planarity = diagnosis.planarity
    if planarity.verdict != "needs a three-dimensional filter":
        return _UNUSED if planarity.errors.tau_s < GYRO_UNUSED_S else ""
    axis = max(range(3), key=planarity.turn_share.__getitem__)
    share = planarity.turn_share[axis]
    is_roll = diagnosis.axes == "roll" and diagnosis.mounting.source[0] == axis
    if share < SINGLE_SHARE or planarity.turn_upright > LEAST_ACROSS or is_roll:
        return "tune with --filter observer, which is three-dimensional; no eta mends this"
    return (
        f"{100.0 * share:.0f} % of the turning is about sensor {'xyz'[axis]}: try --axes roll "
        f"--mounting {ROLL_ABOUT[axis]}, else --filter observer, which is three-dimensional"
    )
