"""How far the integer model can be from the float model on the same counts.

Per sample the integer model adds an error d to the rate step (rounding of the product and of the
bias, error of the rate gain at full scale), n to the angle (rounding of the correction, error of
the blend at half a turn) and m to the bias (the same of the integral). With B the blend, c the
integral gain times the period squared and a = B, the difference p before the correction obeys::

    (1 - (2 - a - c) / z + (1 - a) / z^2) p = (1 - 1/z) (n / z + d) - m / z

Each error is weighed with a bound of the sum of the absolute impulse response from it to p: that
of a cascade is at most the product of those of its parts. The poles are real, then both positive,
where (a + c)^2 >= 4 c; else their absolute value is sqrt(1 - a).
"""

import math
from dataclasses import dataclass

from hostkit.fixedpoint import Coefficient
from hostkit.units import RAD_PER_HALF_TURN_LSB

HALF_UNIT_RAD: float = 0.5 * RAD_PER_HALF_TURN_LSB


@dataclass(frozen=True, slots=True, kw_only=True)
class SampleErrors:
    """What one sample of the integer model adds at most, rad, in its worst axis.

    Attributes
    ----------
    tilt_rad
        Error of the measured tilt, its offset included.
    step_rad
        Error of the step that the rate gives.
    """

    tilt_rad: float
    step_rad: float


def bound_without_integral_rad(errors: SampleErrors, blend: Coefficient) -> float:
    """Return the largest difference of the angles where the bias is constant.

    Each sample keeps ``1 - blend`` of the difference, so the sum is a geometric series.
    """
    kept = 1.0 - blend.quantised
    correction = _coefficient_error_rad(blend) + HALF_UNIT_RAD
    return errors.tilt_rad + (kept * errors.step_rad + correction) / blend.quantised


def bound_with_integral_rad(
    errors: SampleErrors, blend: Coefficient, gain: Coefficient, fraction_bits: int
) -> float:
    """Return the largest difference of the angles where the bias follows the correction.

    Parameters
    ----------
    gain, fraction_bits
        Integral gain of the spec, and the fraction bits of the bias.
    """
    unit = math.ldexp(1.0, -fraction_bits)
    a, c = blend.quantised, gain.quantised * unit
    start, from_step, from_bias = _responses(a, c)
    angle = a * errors.tilt_rad + _coefficient_error_rad(blend) + HALF_UNIT_RAD
    bias = c * errors.tilt_rad + unit * (_coefficient_error_rad(gain) + HALF_UNIT_RAD)
    before = start * errors.tilt_rad + from_step * (errors.step_rad + angle) + from_bias * bias
    return (1.0 - a) * before + angle + errors.tilt_rad


def _coefficient_error_rad(factor: Coefficient) -> float:
    return abs(factor.quantised - factor.real) * math.pi


def _responses(a: float, c: float) -> tuple[float, float, float]:
    """Return the bounds of the response: its peak to n, its sum to n or d, its sum to m."""
    discriminant = (a + c) ** 2 - 4.0 * c
    if discriminant >= 0.0:
        return 2.0, 4.0 / (a + c + math.sqrt(discriminant)), 1.0 / c
    decay = a / (1.0 + math.sqrt(1.0 - a))
    peak = 1.0 + math.sqrt(c) / decay
    return peak, peak / decay, 1.0 / decay**2
