"""Units that cannot be: what the values look like, and what to multiply them by."""

import numpy as np

from hostkit.errors import RecordingError
from hostkit.recordings.recording import Recording
from hostkit.recordings.sanity.agreement import agreement
from hostkit.units import DEG_PER_RAD, RAD_PER_DEG, STANDARD_GRAVITY_M_S2

FORCE_LIMITS_M_S2 = (5.0, 20.0)
"""Where the median magnitude of a specific force in m/s^2 lies, on any tilting body."""
LOOKALIKE_TOLERANCE = 0.2
FORCE_LOOKALIKES = (
    (1.0, "g: multiply it by 9.80665"),
    (32.174, "ft/s^2: multiply it by 0.3048"),
    (1000.0, "mg: multiply it by 0.00980665"),
    (16384.0, "counts at +-2 g: multiply it by 9.80665 / 16384"),
    (8192.0, "counts at +-4 g: multiply it by 9.80665 / 8192"),
    (4096.0, "counts at +-8 g: multiply it by 9.80665 / 4096"),
    (2048.0, "counts at +-16 g: multiply it by 9.80665 / 2048"),
)
MAX_RATE_RAD_S = 70.0
"""4000 deg/s, the widest range of any MEMS gyroscope."""
SCALE_TOLERANCE = 1.6
SCALE_LOOKALIKES = (
    (RAD_PER_DEG, "the angular rate is in deg/s: multiply it by pi/180 (0.01745329)"),
    (DEG_PER_RAD, "the angular rate was multiplied by pi/180 twice: multiply it by 57.29578"),
    (1e-3, "the time is in ms where s (or in us where ms) is expected: divide it by 1000"),
    (1e3, "the time was divided by 1000 once too often: multiply it by 1000"),
)


def require_units(recording: Recording) -> None:
    """Refuse values that cannot be in m/s^2, rad/s and s.

    Raises
    ------
    RecordingError
        If the median specific force is not within 5 to 20 m/s^2, an angular rate is beyond
        70 rad/s, or the angular rate and the turning of the specific force differ by a factor
        that a wrong unit makes.
    """
    _require_force(recording)
    _require_rate_range(recording)
    _require_agreement(recording)


def _require_force(recording: Recording) -> None:
    median = float(np.median(np.linalg.norm(recording.specific_force_m_s2, axis=1)))
    low, high = FORCE_LIMITS_M_S2
    if low <= median <= high:
        return
    raise RecordingError(
        f"the median magnitude of the specific force is {median:.5g}; in m/s^2 it is near 9.81 "
        f"(limits {low:g} to {high:g}): {_force_remedy(median)}"
    )


def _force_remedy(median: float) -> str:
    for expected, remedy in FORCE_LOOKALIKES:
        if abs(median / expected - 1.0) < LOOKALIKE_TOLERANCE:
            return f"it looks like {remedy}"
    if median < FORCE_LIMITS_M_S2[0]:
        return "has gravity been taken out? The tilt is measured from it: export the raw values"
    return "bring it to m/s^2"


def _require_rate_range(recording: Recording) -> None:
    rate = np.abs(recording.angular_rate_rad_s)
    if rate.max() <= MAX_RATE_RAD_S:
        return
    row, axis = np.unravel_index(int(np.argmax(rate)), rate.shape)
    raise RecordingError(
        f"row {row + 1}: the angular rate about {'xyz'[axis]} is {rate[row, axis]:.5g} rad/s; no "
        f"MEMS gyroscope measures beyond {MAX_RATE_RAD_S:g}: if it is in deg/s, multiply it by "
        "pi/180 (0.01745329); if it is in counts, by the weight of a count"
    )


def _require_agreement(recording: Recording) -> None:
    scale = agreement(recording).scale
    for factor, remedy in SCALE_LOOKALIKES:
        if scale is not None and 1.0 / SCALE_TOLERANCE < scale / factor < SCALE_TOLERANCE:
            raise RecordingError(
                f"the angular rate is {1.0 / scale:.4g} times as large as the turning of the "
                f"specific force; it should be about 1: {remedy}. "
                f"(Median |f| is {_in_g(recording):.3f} g, so the force is in order.)"
            )


def _in_g(recording: Recording) -> float:
    force = np.linalg.norm(recording.specific_force_m_s2, axis=1)
    return float(np.median(force)) / STANDARD_GRAVITY_M_S2
