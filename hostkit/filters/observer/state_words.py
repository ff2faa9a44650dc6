"""The words of the observer's state, in the order in which devices tell them."""

import math

from hostkit.filters.observer.spec import ObserverFormats
from hostkit.spec import StateWord

MEAN_BITS = 14


def state_words(
    formats: ObserverFormats,
    kt_rad_m: float,
    period_s: float,
    rad_s_per_count: float,
    m_s2_per_count: float,
) -> tuple[StateWord, ...]:
    """Return the hidden words of a design's state."""
    velocity = math.ldexp(2.0 / (kt_rad_m * period_s), -formats.correction)
    bias = math.ldexp(2.0 / period_s, -formats.bias)
    mean = math.ldexp(1.0, -MEAN_BITS)
    return (
        *_words("quaternion", "wxyz", "1", math.ldexp(1.0, -30)),
        *_words("velocity", "xy", "m/s", velocity),
        *_words("gyro_bias", "xyz", "rad/s", bias),
        *_words("rate_mean", "xyz", "rad/s", mean * rad_s_per_count),
        *_words("force_mean", "xyz", "m/s^2", mean * m_s2_per_count),
        StateWord(name="start_gain", unit="1", per_unit=math.ldexp(1.0, -31)),
        StateWord(name="still", unit="s", per_unit=period_s),
        StateWord(name="rested", unit="1", per_unit=1.0),
    )


def _words(name: str, parts: str, unit: str, per_unit: float) -> tuple[StateWord, ...]:
    return tuple(StateWord(name=f"{name}_{part}", unit=unit, per_unit=per_unit) for part in parts)
