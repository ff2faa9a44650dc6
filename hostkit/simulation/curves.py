"""Smooth functions of time with their derivatives, from which motions are put together."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Vector = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Samples:
    """Values of a curve and its first derivative, each of shape ``(M,)``."""

    value: Vector
    slope: Vector

    def __add__(self, other: "Samples") -> "Samples":
        return Samples(value=self.value + other.value, slope=self.slope + other.slope)


Curve = Callable[[Vector], Samples]
"""A function of time, s, shape ``(M,)``, defined for every time, negative ones too."""


def constant(value: float) -> Curve:
    """Return a curve that stays where it is."""

    def at(time_s: Vector) -> Samples:
        return Samples(value=np.full_like(time_s, value), slope=np.zeros_like(time_s))

    return at


def ramp(slope: float) -> Curve:
    """Return a curve that rises evenly through 0 at time 0."""

    def at(time_s: Vector) -> Samples:
        return Samples(value=slope * time_s, slope=np.full_like(time_s, slope))

    return at


def sweep(*, amplitude: float, band_hz: tuple[float, float], rise_s: float, phase: float) -> Curve:
    """Return a sine whose frequency rises through a band and falls again, without a jump.

    Parameters
    ----------
    amplitude
        Peak value, in the unit of the curve.
    band_hz
        Lowest frequency, at time 0, and highest, after `rise_s`.
    rise_s
        Time from the lowest to the highest frequency.
    phase
        Phase at time 0, rad.
    """
    middle, half = np.pi * (band_hz[1] + band_hz[0]), np.pi * (band_hz[1] - band_hz[0])
    pace = np.pi / rise_s

    def at(time_s: Vector) -> Samples:
        angle = phase + middle * time_s - half / pace * np.sin(pace * time_s)
        rate = middle - half * np.cos(pace * time_s)
        return Samples(value=amplitude * np.sin(angle), slope=amplitude * rate * np.cos(angle))

    return at


def multisine(
    *, rms: float, band_hz: tuple[float, float], rng: np.random.Generator, lines: int = 24
) -> Curve:
    """Return a random signal within a band: sines of random frequency and phase, equally strong.

    Parameters
    ----------
    rms
        Root of the mean square over a long time, in the unit of the curve.
    band_hz
        Lowest and highest frequency.
    rng
        Source of the frequencies and phases; used here, not when the curve is evaluated.
    lines
        Number of sines.
    """
    edges = np.linspace(band_hz[0], band_hz[1], lines + 1)
    rates = 2.0 * np.pi * (edges[:-1] + rng.random(lines) * np.diff(edges))
    phases = rng.uniform(0.0, 2.0 * np.pi, lines)
    amplitude = rms * np.sqrt(2.0 / lines)

    def at(time_s: Vector) -> Samples:
        value, slope = np.zeros_like(time_s), np.zeros_like(time_s)
        for rate, phase in zip(rates.tolist(), phases.tolist(), strict=True):
            value += amplitude * np.sin(rate * time_s + phase)
            slope += amplitude * rate * np.cos(rate * time_s + phase)
        return Samples(value=value, slope=slope)

    return at


def stairs(*, levels: Vector, hold_s: float, move_s: float) -> Curve:
    """Return smooth steps from level to level; after the last one they begin anew.

    Parameters
    ----------
    levels
        Values that are held, shape ``(L,)``.
    hold_s
        Time from the start of one step to the start of the next.
    move_s
        Time that a step takes, at most `hold_s`; speed and acceleration are 0 at its ends.
    """

    def at(time_s: Vector) -> Samples:
        index = np.floor(time_s / hold_s).astype(np.int64)
        start = levels[index % len(levels)]
        height = levels[(index + 1) % len(levels)] - start
        share = np.clip((time_s - (index + 1) * hold_s) / move_s + 1.0, 0.0, 1.0)
        return Samples(
            value=start + height * share**3 * (10.0 + share * (6.0 * share - 15.0)),
            slope=height * 30.0 * share**2 * (1.0 - share) ** 2 / move_s,
        )

    return at
