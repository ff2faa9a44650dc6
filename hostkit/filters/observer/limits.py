"""Limits and times that the models share: none of them is a parameter of a design."""

import math
from typing import Final

ACCELERATION_LIMIT_M_S2: Final = 80.0
"""Largest horizontal acceleration that is believed, for each of its two parts. Impacts must be
taken whole: what is cut off them stays in the velocity."""

CORRECTION_LIMIT_RAD_S: Final = 8.0
CORRECTION_LIMIT_RAD: Final = 0.25
"""Fastest correction that a velocity asks for, and the largest in one sample."""

START_LIMIT_RAD: Final = 0.5
"""Largest turn in one sample that the alignment at the start asks for."""

LEAD_LIMIT_RAD: Final = 1.0
"""Largest turn by which the angles are told ahead, about each axis."""

STEP_LIMIT_RAD: Final = 0.8
"""Largest turn within one sample, about each axis, that a design may allow: the series of the
half-angle are good to 1e-3 of such a turn, and to 1e-6 of a quarter of it."""

REST_RATE_LIMIT_RAD_S: Final = 0.2
"""Largest mean rate of a sensor at rest: a faster one may be a slow turn."""

REST_MEAN_S: Final = 0.5
REST_TIME_S: Final = 1.0
"""Memory of the running means, and how long they must fit before the sensor is at rest."""

START_GAIN: Final = 0.5
"""First weight of the alignment at the start; it falls as one over the number of samples."""

CLIP_GAIN: Final = 2.0**-5
"""Least weight of the alignment after a rate that was clipped."""

FIRST_FORCE_G: Final = 1.2
"""Largest specific force of the first sample that is believed, on each axis."""

TOLD_SQUARE_LEAST: Final = 0.5
TOLD_SQUARE_MOST: Final = 2.0
"""Square of the length of an orientation that a state may begin with. Every step leaves 0.9 to 1;
from above 5 the renormalisation would run away."""

FIRST_ROUNDS: Final = 6
"""Renormalisations of the first orientation, whose length is 0.5 to 1.39."""


def correction_limit_rad(period_s: float) -> float:
    """Return the largest correction of one sample that a velocity asks for."""
    return min(CORRECTION_LIMIT_RAD_S * period_s, CORRECTION_LIMIT_RAD)


def mean_shift(period_s: float) -> int:
    """Return the power of two of samples that the running means remember."""
    return max(1, round(math.log2(REST_MEAN_S / period_s)))


def rest_samples(period_s: float) -> int:
    """Return after how many quiet samples the sensor is at rest."""
    return math.ceil(REST_TIME_S / period_s)


def start_end(start_s: float | None, period_s: float) -> float:
    """Return the weight below which the alignment at the start is over."""
    return 1.0 if start_s is None else min(period_s / start_s, 1.0)
