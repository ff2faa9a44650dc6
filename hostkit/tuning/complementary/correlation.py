"""The RMSE from correlation tables: what a recording costs once, and every tuning of it no more.

With d_k = w_k dt - (r_k - r_(k-1)) and v_k = m_k - r_k (d_0 = v_0), the error form is the
recursion ``e_k = eta e_(k-1) + x_k`` on ``x_k = eta d_k + (1 - eta) v_k``. By Parseval's theorem
its energy is that of x seen through the filter's own correlation, less what would come after the
end::

    sum e_k^2 = (sum_L p_L R_xx(L) - eta^2 e_last^2) / (1 - eta^2),    p_0 = 1, p_L = 2 eta^L
    R_xx = eta^2 R_dd + (1 - eta)^2 R_vv + eta (1 - eta) (R_dv + R_vd)

where ``R_ab(L) = sum_k a_k b_(k+L)``. It is exact but for the lags beyond ``40 / (1 - eta)``, whose
weight is below 1e-17.
"""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.fft import irfft, next_fast_len, rfft

from hostkit.records import read_only
from hostkit.tuning.complementary.laid_out import LaidOut
from hostkit.tuning.kernel import ErrorStream

Vector = NDArray[np.float64]

MEMORY = 40.0
"""Time constants after which the past has no weight left in a float64: exp(-40) = 4e-18."""

TABLE_NS, LAG_NS, KERNEL_NS = 120.0, 8.0, 0.11
"""Measured: tables per sample, an evaluation per lag, the kernel per sample and evaluation."""


@dataclass(frozen=True, slots=True, kw_only=True)
class CorrelationTable:
    """The correlations of one stream.

    Attributes
    ----------
    rate, force, both
        R_dd, R_vv and R_dv + R_vd, rad^2, for lags from 0, shape ``(L,)``.
    rate_end, force_end
        The last values of d and v, from which the last error follows, shape ``(L,)``.
    samples
        Length of the stream.
    """

    rate: Vector
    force: Vector
    both: Vector
    rate_end: Vector
    force_end: Vector
    samples: int

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        for array in (self.rate, self.force, self.both, self.rate_end, self.force_end):
            read_only(array)

    def mean_square(self, eta: float) -> float:
        """Return the mean of e_k^2 over the whole stream, rad^2."""
        lags = min(len(self.rate), lags_of(eta))
        power = np.exp(math.log(eta) * np.arange(lags))
        x_end = eta * self.rate_end[-lags:] + (1.0 - eta) * self.force_end[-lags:]
        last = _dot(power[::-1], x_end)
        power[1:] *= 2.0
        energy = (
            eta**2 * _dot(power, self.rate[:lags])
            + (1.0 - eta) ** 2 * _dot(power, self.force[:lags])
            + eta * (1.0 - eta) * _dot(power, self.both[:lags])
        )
        return float((energy - (eta * last) ** 2) / (1.0 - eta**2) / self.samples)


def _dot(a: Vector, b: Vector) -> float:
    """Sum of products on this thread; BLAS would start others for it."""
    return float(np.einsum("i,i->", a, b))


def lags_of(eta: float) -> int:
    """Return how many lags have weight."""
    return math.ceil(MEMORY / (1.0 - eta))


def tabulate(stream: ErrorStream, most_lags: int) -> CorrelationTable:
    """Return the correlations of a stream up to a lag."""
    lags = min(most_lags, len(stream))
    force = stream.start.astype(np.float64)
    rate = stream.drive.astype(np.float64) + force
    size = next_fast_len(len(stream) + lags, real=True)
    rate_line, force_line = rfft(rate, size), rfft(force, size)

    def correlation(spectrum: NDArray[np.complexfloating[Any, Any]]) -> Vector:
        return np.asarray(irfft(spectrum, size))[:lags].copy()

    # R_dv + R_vd is the even part of the cross correlation, twice: its spectrum is real.
    return CorrelationTable(
        rate=correlation(rate_line * rate_line.conj()),
        force=correlation(force_line * force_line.conj()),
        both=correlation(2.0 * (rate_line * force_line.conj()).real + 0j),
        rate_end=rate[-lags:],
        force_end=force[-lags:],
        samples=len(stream),
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class TabulatedProblem:
    """A problem whose cost comes from tables; in the order of `Problem.streams`."""

    problem: LaidOut
    tables: tuple[tuple[CorrelationTable, ...], ...]

    def cost(self, points: Vector) -> Vector:
        """Return the cost of points, as `Problem.cost`."""
        eta = self.problem.space.candidates(self.problem.space.axes[0], points).table[0]
        errors = [
            [
                [math.sqrt(max(table.mean_square(float(value)), 0.0)) for table in recording]
                for recording in self.tables
            ]
            for value in eta
        ]
        return np.asarray(np.mean(errors, axis=(1, 2)))


def tabulated(problem: LaidOut, evaluations: int) -> TabulatedProblem | None:
    """Return the problem in tables, or None where they do not hold or do not pay.

    They hold for the RMSE with eta alone where every sample is scored, and pay where a long
    recording is evaluated often.
    """
    if problem.objective != "rmse" or not problem.space.plain or not _pays(problem, evaluations):
        return None
    tables = []
    top = problem.space.upper[np.newaxis]
    eta = float(problem.space.candidates(problem.space.axes[0], top).table[0, 0])
    for recording in problem.streams:
        whole = [s for s in recording if isinstance(s, ErrorStream) and s.scored == len(s)]
        if len(whole) < len(recording):
            return None
        tables.append(tuple(tabulate(stream, lags_of(eta)) for stream in whole))
    return TabulatedProblem(problem=problem, tables=tuple(tables))


def _pays(problem: LaidOut, evaluations: int) -> bool:
    """Estimate both ways; the lags of an evaluation are the mean over log tau."""
    streams = [stream for recording in problem.streams for stream in recording]
    lower, upper = problem.space.lower[0], problem.space.upper[0]
    mean_tau_s = (math.exp(upper) - math.exp(lower)) / (upper - lower)
    lags = MEMORY * mean_tau_s / problem.space.period_s
    tables_ns = sum(
        TABLE_NS * len(stream) + LAG_NS * min(lags, len(stream)) * evaluations for stream in streams
    )
    return bool(tables_ns < KERNEL_NS * sum(map(len, streams)) * evaluations)
