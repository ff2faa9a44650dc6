"""Dynamics of a digital low-pass filter of which only bandwidth and delay are known."""

import math
from dataclasses import dataclass

from hostkit.errors import DesignError
from hostkit.sensors.part import LowPass


@dataclass(frozen=True, slots=True, kw_only=True)
class LowPassSection:
    """A section of second order, then a delay of whole ticks.

    Attributes
    ----------
    numerator
        b0, b1, b2.
    denominator
        a1, a2; a0 is 1.
    delay_ticks
        Ticks that what leaves the section is held back.
    """

    numerator: tuple[float, float, float]
    denominator: tuple[float, float]
    delay_ticks: int


def gyro_section(low_pass: LowPass, tick_s: float) -> LowPassSection:
    """Return the filter of the gyroscope; see :func:`low_pass_section`."""
    return low_pass_section(low_pass.gyro_bandwidth_hz, low_pass.gyro_delay_s, tick_s)


def accel_section(low_pass: LowPass, tick_s: float) -> LowPassSection:
    """Return the filter of the accelerometer; see :func:`low_pass_section`."""
    return low_pass_section(low_pass.accel_bandwidth_hz, low_pass.accel_delay_s, tick_s)


def low_pass_section(bandwidth_hz: float, delay_s: float, tick_s: float) -> LowPassSection:
    """Return a filter with a gain of -3 dB at a frequency and a group delay at low frequencies.

    A register map that gives no more than the two leaves the order open; this is the simplest
    filter that meets them. Where the delay is that of one pole at the bandwidth, or longer: the
    pole, and a pure delay, rounded to whole ticks. Where it is shorter: two equal poles and a zero,

    .. math:: H(s) = (1 + B s') / (1 + A s')^2,\\ s' = s / \\omega_c,

    with the delay :math:`2 A - B = x = \\omega_c d` and :math:`2 (1 + B^2) = (1 + A^2)^2`. Where it
    is 0, which means not given: the pole alone. All are made discrete by the bilinear
    transformation, which leaves the delay at low frequencies, warped so that the bandwidth is
    exact.

    Raises
    ------
    DesignError
        If the bandwidth is not below half the rate of the ticks.
    """
    if not 0.0 < bandwidth_hz * tick_s < 0.5:
        raise DesignError(
            f"a low-pass of {bandwidth_hz:g} Hz needs ticks of more than {2 * bandwidth_hz:g} Hz"
        )
    omega = 2.0 * math.pi * bandwidth_hz
    x = omega * delay_s
    k = 1.0 / math.tan(omega * tick_s / 2.0)
    if delay_s == 0.0 or x >= 1.0:
        pole = 1.0 + k
        numerator = (1.0 / pole, 1.0 / pole, 0.0)
        rest_s = max(delay_s - 1.0 / omega, 0.0)
        return LowPassSection(
            numerator=numerator,
            denominator=((1.0 - k) / pole, 0.0),
            delay_ticks=round(rest_s / tick_s),
        )
    a = _double_pole(x)
    b = 2.0 * a - x
    pole = 1.0 + a * k
    return LowPassSection(
        numerator=((1.0 + b * k) / pole**2, 2.0 / pole**2, (1.0 - b * k) / pole**2),
        denominator=(2.0 * (1.0 - a * k) / pole, ((1.0 - a * k) / pole) ** 2),
        delay_ticks=0,
    )


def _double_pole(x: float) -> float:
    """Return A of the two equal poles, by bisection: (1 + A^2)^2 = 2 (1 + (2 A - x)^2), A > 1."""
    low, high = 1.0, 4.0
    for _ in range(60):
        middle = (low + high) / 2.0
        if (1.0 + middle**2) ** 2 < 2.0 * (1.0 + (2.0 * middle - x) ** 2):
            low = middle
        else:
            high = middle
    return (low + high) / 2.0
