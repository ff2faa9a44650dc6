"""The errors that filters of single angles and a three-dimensional filter make on a recording."""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hostkit.attitude import inclination_rad, to_body, up_from_tilt, wrap_rad
from hostkit.diagnosis.coupling import ANGLE, AxisMotion
from hostkit.diagnosis.strapdown import IntArray, Strapdown
from hostkit.mounting import Mounting
from hostkit.recordings.recording import Vector
from hostkit.records import AXES, AxisChoice

TAU_GRID_S = np.geomspace(0.02, 100.0, 13)
"""Time constants that are tried: the range of the tuning, in steps of a factor of two."""
SEARCH_ROWS = 10_000
"""Samples that are enough to compare time constants on."""


@dataclass(frozen=True, slots=True, kw_only=True)
class FilterErrors:
    """Errors of filters on a recording, rms: of the angle for one axis, of the inclination for two.

    Attributes
    ----------
    predicted_rad
        Of the filters of single angles, at the time constant that is best for them.
    spatial_rad
        Of a three-dimensional filter of the same kind, at the time constant that is best for it.
    neglect_rad
        What the neglected rates alone would make at that second time constant.
    tau_s, spatial_tau_s
        Those time constants, from `TAU_GRID_S`.
    """

    predicted_rad: float
    spatial_rad: float
    neglect_rad: float
    tau_s: float
    spatial_tau_s: float

    @property
    def extra_rad(self) -> float:
        """What the neglect adds, rms, after tuning has made the best of it.

        Errors of different origin add in squares, so what the tilt itself is wrong by drops out
        of ``predicted^2 - spatial^2``. The neglect is a second bound: filters of single angles
        could stay at the time constant of the other and be worse by no more than that.
        """
        added = math.sqrt(max(0.0, self.predicted_rad**2 - self.spatial_rad**2))
        return min(added, self.neglect_rad)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Case:
    """A recording ready to be judged.

    `up` is the tilt in sensor axes, `body_up` in body axes; `scored` says which samples count.
    """

    axes: AxisChoice
    mounting: Mounting
    frame: Strapdown
    up: Vector
    body_up: Vector
    motions: tuple[AxisMotion, ...]
    scored: NDArray[np.bool_]
    period_s: float


def filter_errors(case: Case) -> FilterErrors:
    """Return what the filters make of a recording, each with the time constant best for it."""
    eta, spatial_eta = _tuned(case), _tuned_spatial(case)
    return FilterErrors(
        predicted_rad=_rms(case, [m.wrapped_error_rad(eta) for m in case.motions]),
        spatial_rad=_spatial_error(case, spatial_eta),
        neglect_rad=_rms(case, [m.neglect_rad(spatial_eta) for m in case.motions]),
        tau_s=_tau_s(case, eta),
        spatial_tau_s=_tau_s(case, spatial_eta),
    )


def _etas(case: Case) -> list[float]:
    etas: list[float] = (TAU_GRID_S / (TAU_GRID_S + case.period_s)).tolist()
    return etas


def _tau_s(case: Case, eta: float) -> float:
    return case.period_s * eta / (1.0 - eta)


def _rows(case: Case) -> IntArray:
    """Return scored rows, evenly taken, enough of them to compare time constants."""
    rows = np.flatnonzero(case.scored)
    return rows[:: 1 + len(rows) // SEARCH_ROWS]


def _tuned(case: Case) -> float:
    """Return the eta with the least error, mean over the angles as in the tuning."""
    rows = _rows(case)

    def cost(eta: float) -> float:
        errors = (m.error_rad(eta)[rows] for m in case.motions)
        return sum(math.sqrt(float(np.square(error).sum())) for error in errors)

    return _least(cost, _etas(case))


def _tuned_spatial(case: Case) -> float:
    """Return the eta with which a three-dimensional filter has the least error."""
    rows = _rows(case)
    true = case.frame.to_frame(case.up)[rows]

    def cost(eta: float) -> float:
        chord = case.frame.filtered_up(eta, rows) - true
        return float(np.square(chord).sum())

    return _least(cost, _etas(case))


def _least(cost: Callable[[float], float], etas: list[float]) -> float:
    """Return the eta of least cost: of every other one first, then of its neighbours."""
    costs = {k: cost(etas[k]) for k in range(0, len(etas), 2)}
    best = min(costs, key=costs.__getitem__)
    costs |= {k: cost(etas[k]) for k in (best - 1, best + 1) if 0 <= k < len(etas)}
    return etas[min(costs, key=costs.__getitem__)]


def _spatial_error(case: Case, eta: float) -> float:
    body_up = to_body(case.mounting, case.frame.to_sensor(case.frame.filtered_up(eta)))
    errors = [wrap_rad(ANGLE[a](body_up) - ANGLE[a](case.body_up)) for a in AXES[case.axes]]
    return _rms(case, errors)


def _rms(case: Case, errors: list[Vector]) -> float:
    """Return the rms of one angle's error, or of the inclination that two of them make."""
    if len(errors) == 1:
        wrong = wrap_rad(errors[0][case.scored])
    else:
        up = case.body_up[case.scored]
        roll = ANGLE["roll"](up) + errors[0][case.scored]
        pitch = ANGLE["pitch"](up) + errors[1][case.scored]
        wrong = inclination_rad(up_from_tilt(roll, pitch), up)
    return math.sqrt(float(np.mean(np.square(wrong))))
