"""Allan deviation of what a resting sensor reads, and the figures of noise that it shows.

The curves are overlapping Allan deviations (W. J. Riley, NIST Special Publication 1065, 2008,
equation 11), computed by allantools. How noise shows in them is in IEEE Std 952-1997, annex C::

    white noise N                  sigma = N / sqrt(tau)           slope -1/2
    bias instability B             sigma = 0.664 B                 the bottom
    random walk of the bias, K     sigma = K sqrt(tau / 3)         slope +1/2

N counts frequencies of both signs. The noise density of data sheets, whose square times a bandwidth
is the mean square, counts positive ones only and is ``sqrt(2) N``.

Figures are taken from averaging times of which the rest holds at least nine: there the deviation
itself is known to about a quarter.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hostkit.diagnosis.rest import RestStretch
from hostkit.errors import ToolMissingError
from hostkit.recordings.recording import Vector
from hostkit.records import read_only

POINTS_PER_DECADE = 10
MOST_SHARE = 0.25
"""Longest averaging time, as a share of a stretch."""
LEAST_INTERVALS = 9.0
SLOPE_SPAN = 2.0
"""A slope is fitted from tau divided by this to tau times this."""
SLOPE_TOLERANCES = (0.1, 0.2)
"""How far a slope may be from -1/2: the second only if no part keeps the first."""
WALK_TOLERANCE = 0.2
FLAT_SLOPE = -0.25
"""Where the curve falls less steeply than this, it has reached its bottom."""
LEAST_RUN = 3
"""Neighbouring points that must have a slope before a figure is taken from them."""
BOTTOM = 0.664
"""``sqrt(2 ln 2 / pi)``, as in IEEE Std 952-1997, annex C."""

OptionalTriple = tuple[float | None, float | None, float | None]
Deviation = Callable[[Vector, Vector], tuple[Vector, Vector]]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class AllanCurve:
    """Allan deviation of one sensing element and what it shows, per sensor axis.

    Attributes
    ----------
    tau_s
        Averaging times, shape ``(T,)``.
    deviation
        In the unit of the signal, shape ``(T, 3)``.
    intervals
        How many averaging times the rest holds, all stretches together, shape ``(T,)``.
    white_noise
        N, the deviation that white noise has at 1 s (angle random walk for a gyroscope), per root
        hertz; None where no part of the curve has slope -1/2.
    bias_instability
        B, an upper bound; None where the curve still falls at the end of what is known.
    random_walk
        K, per root second; None where the curve does not rise with slope 1/2 after it fell.
    """

    tau_s: Vector
    deviation: Vector
    intervals: Vector
    white_noise: OptionalTriple
    bias_instability: OptionalTriple
    random_walk: OptionalTriple

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        for array in (self.tau_s, self.deviation, self.intervals):
            read_only(array)

    @property
    def noise_density(self) -> OptionalTriple:
        """One-sided noise density, as in data sheets, per root hertz; of the samples as they are.

        Noise above half the sample rate that the sensor's filter lets through is folded into it.
        """
        return _triple([n if n is None else math.sqrt(2.0) * n for n in self.white_noise])


def overlapping_deviation() -> Deviation:
    """Return the function that makes a curve: values and lengths in samples to deviations, counts.

    Raises
    ------
    ToolMissingError
        If allantools is not installed.
    """
    try:
        from allantools import oadev  # type: ignore[import-untyped]
    except ImportError as error:
        raise ToolMissingError(
            "the Allan deviation needs allantools: pip install 'hostkit[allan]'"
        ) from error

    def deviation(values: Vector, lengths: Vector) -> tuple[Vector, Vector]:
        _, found, _, counts = oadev(values, rate=1.0, data_type="freq", taus=lengths)
        return np.asarray(found), np.asarray(counts)

    return deviation


def allan_curve(
    values: Vector, stretches: tuple[RestStretch, ...], period_s: float, deviation: Deviation
) -> AllanCurve:
    """Return the curve of one sensing element over stretches of rest.

    Stretches are pooled: each adds its squares, weighted by how many differences it has.

    Parameters
    ----------
    values
        All samples, in any unit, shape ``(N, 3)``.
    stretches
        At least one.
    period_s
        Sample period.
    deviation
        From :func:`overlapping_deviation`.
    """
    sizes = [s.last - s.first + 1 for s in stretches]
    lengths = _lengths(max(sizes))
    squares, counts = np.zeros((len(lengths), 3)), np.zeros(len(lengths))
    intervals = np.zeros(len(lengths))
    for stretch, size in zip(stretches, sizes, strict=True):
        fitting = int(np.count_nonzero(lengths <= max(1, int(MOST_SHARE * size))))
        part = values[stretch.first : stretch.last + 1]
        for axis in range(3):
            found, weight = deviation(part[:, axis], lengths[:fitting].astype(np.float64))
            squares[:fitting, axis] += weight * found**2
        counts[:fitting] += weight
        intervals[:fitting] += size / lengths[:fitting]
    curve = np.sqrt(squares / counts[:, None])
    tau_s = lengths.astype(np.float64) * period_s
    known = int(np.count_nonzero(intervals >= LEAST_INTERVALS))
    whites = [_white_run(tau_s[:known], curve[:known, axis]) for axis in range(3)]
    return AllanCurve(
        tau_s=tau_s,
        deviation=curve,
        intervals=intervals,
        white_noise=_triple([_white(tau_s, curve[:, k], run) for k, run in enumerate(whites)]),
        bias_instability=_triple([_instability(tau_s, curve[:, k], known) for k in range(3)]),
        random_walk=_triple(
            [_walk(tau_s[:known], curve[:known, k], run) for k, run in enumerate(whites)]
        ),
    )


def _lengths(samples: int) -> NDArray[np.int64]:
    """Return averaging lengths in samples, evenly spaced on a logarithmic scale."""
    longest = max(1, int(MOST_SHARE * samples))
    points = 1 + math.ceil(POINTS_PER_DECADE * math.log10(longest))
    return np.unique(np.round(np.geomspace(1, longest, points)).astype(np.int64))


def _slopes(tau_s: Vector, curve: Vector) -> Vector:
    """Return the slope on logarithmic scales around each point."""
    x, y = np.log(tau_s), np.log(curve)
    slopes = np.full(len(x), np.nan)
    for k in range(len(x)):
        near = np.abs(x - x[k]) <= math.log(SLOPE_SPAN) + 1e-9
        away = x[near] - x[near].mean()
        if np.count_nonzero(near) >= LEAST_RUN:
            slopes[k] = float(away @ y[near]) / float(away @ away)
    return slopes


def _first_run(tau_s: Vector, curve: Vector, slope: float, tolerance: float) -> slice | None:
    """Return the first run of points that have a slope; None if there is none or no noise."""
    if not (curve > 0.0).all():
        return None
    start = None
    fits = np.abs(_slopes(tau_s, curve) - slope) <= tolerance
    for k, good in enumerate([*fits.tolist(), False]):
        if good and start is None:
            start = k
        elif not good and start is not None:
            if k - start >= LEAST_RUN:
                return slice(start, k)
            start = None
    return None


def _white_run(tau_s: Vector, curve: Vector) -> slice | None:
    for tolerance in SLOPE_TOLERANCES:
        run = _first_run(tau_s, curve, -0.5, tolerance)
        if run is not None:
            return run
    return None


def _white(tau_s: Vector, curve: Vector, run: slice | None) -> float | None:
    return None if run is None else _geometric_mean(curve[run] * np.sqrt(tau_s[run]))


def _walk(tau_s: Vector, curve: Vector, white: slice | None) -> float | None:
    """Return K from where the curve rises after its white part; before it, filters rise too."""
    if white is None:
        return None
    later = slice(white.stop, None)
    run = _first_run(tau_s[later], curve[later], 0.5, WALK_TOLERANCE)
    return None if run is None else _geometric_mean((curve * np.sqrt(3.0 / tau_s))[later][run])


def _instability(tau_s: Vector, curve: Vector, known: int) -> float | None:
    """Return the bottom of the known part, if the curve no longer falls there."""
    if not known or not (curve > 0.0).all():
        return None
    lowest = int(np.argmin(curve[:known]))
    flat = _slopes(tau_s, curve)[lowest] > FLAT_SLOPE
    return float(curve[lowest]) / BOTTOM if flat else None


def _geometric_mean(values: Vector) -> float:
    return float(np.exp(np.mean(np.log(values))))


def _triple(values: list[float | None]) -> OptionalTriple:
    x, y, z = values
    return x, y, z
