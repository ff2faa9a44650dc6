"""The filter's error on many groups at once, for as many weights as one likes.

The filter is evaluated in its error form, which is equation 4 with the reference taken out. With w
the rate, m the measured tilt, r the reference, and v = m - r::

    c_k = w_k dt - (r_k - r_(k-1)) - v_k
    e_k = eta e_(k-1) + (eta c_k + v_k),    e_0 = v_0

A group is 30 samples: the first 20 train, the last 10 test. The filter starts anew with every group
and runs on from its training into its test part.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hostkit.records import read_only
from hostkit.reproduction.signals import GROUP_SAMPLES, TRAINING_SAMPLES, Logs

Vector = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class Groups:
    """G groups in error form: `drive` c and `start` v, each of shape ``(G, K)``."""

    drive: Vector
    start: Vector
    period_s: float

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        read_only(self.drive)
        read_only(self.start)

    def __len__(self) -> int:
        return len(self.start)

    def repeated(self, times: int) -> "Groups":
        """Return every group so many times, the copies side by side."""
        return Groups(
            drive=np.repeat(self.drive, times, axis=0),
            start=np.repeat(self.start, times, axis=0),
            period_s=self.period_s,
        )

    def one(self, index: int) -> "Groups":
        """Return one group alone."""
        chosen = slice(index, index + 1)
        return Groups(drive=self.drive[chosen], start=self.start[chosen], period_s=self.period_s)


def groups_of(logs: Logs) -> Groups:
    """Cut logs into groups of 30 samples, ten to a log, in order."""
    tilt, measured, rate = (
        array.reshape(-1, GROUP_SAMPLES)
        for array in (logs.tilt_rad, logs.measured_tilt_rad, logs.rate_rad_s)
    )
    return _in_error_form(tilt, measured, rate, logs.period_s)


def first_samples(logs: Logs, samples: int) -> Groups:
    """Return the first samples of every log as one group each."""
    tilt, measured, rate = (
        array[:, :samples] for array in (logs.tilt_rad, logs.measured_tilt_rad, logs.rate_rad_s)
    )
    return _in_error_form(tilt, measured, rate, logs.period_s)


def _in_error_form(tilt: Vector, measured: Vector, rate: Vector, period_s: float) -> Groups:
    start = measured - tilt
    drive = rate * period_s - np.diff(tilt, prepend=tilt[:, :1], axis=1) - start
    drive[:, 0] = 0.0
    return Groups(drive=drive, start=start, period_s=period_s)


def eta_of(tau_s: Vector, period_s: float) -> Vector:
    """Return ``tau / (tau + dt)``, equation 5, for an array of any shape."""
    return np.asarray(tau_s / (tau_s + period_s))


def training_cost_rad(groups: Groups, eta: Vector) -> Vector:
    """Return the mean absolute error over the training samples: equation 10, made one number.

    Parameters
    ----------
    eta
        Weights of the integrated rate, shape ``(G, N)``: N of them for each group.

    Returns
    -------
    numpy.ndarray
        Errors, rad, shape ``(G, N)``.
    """
    error = np.repeat(groups.start[:, :1], eta.shape[1], axis=1)
    total = np.abs(error)
    size = np.empty_like(error)
    for k in range(1, TRAINING_SAMPLES):
        error += groups.drive[:, k, np.newaxis]
        error *= eta
        error += groups.start[:, k, np.newaxis]
        total += np.abs(error, out=size)
    return np.asarray(total / TRAINING_SAMPLES)


def one_training_cost_rad(drive: list[float], start: list[float], eta: float) -> float:
    """Return the same for one group and one weight, in plain numbers.

    It is there for searches that ask for one point at a time, where it is some twenty times as fast
    as arrays of one element.

    Parameters
    ----------
    drive, start
        A row of each array of :class:`Groups`.
    """
    error = start[0]
    total = abs(error)
    for c, v in zip(drive[1:TRAINING_SAMPLES], start[1:TRAINING_SAMPLES], strict=True):
        error = eta * (error + c) + v
        total += abs(error)
    return total / TRAINING_SAMPLES


def test_rmse_rad(groups: Groups, eta: Vector) -> Vector:
    """Return the root mean square error over the test samples: equation 11, brackets mended.

    Parameters
    ----------
    eta
        One weight for each group, shape ``(G,)``.

    Returns
    -------
    numpy.ndarray
        Errors, rad, shape ``(G,)``.
    """
    return np.asarray(np.sqrt(np.mean(errors_rad(groups, eta)[:, TRAINING_SAMPLES:] ** 2, axis=1)))


def errors_rad(groups: Groups, eta: Vector) -> Vector:
    """Return the error at every sample, rad, shape ``(G, K)``, for one weight per group."""
    error = np.empty_like(groups.start)
    error[:, 0] = groups.start[:, 0]
    for k in range(1, error.shape[1]):
        error[:, k] = eta * (error[:, k - 1] + groups.drive[:, k]) + groups.start[:, k]
    return error
