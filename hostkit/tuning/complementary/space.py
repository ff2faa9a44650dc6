"""What is searched: free parameters, their ranges, their way into candidates and designs."""

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from hostkit.errors import DesignError
from hostkit.filters.complementary import BY_NAME, eta_from_tau, parameter, parameters
from hostkit.records import AXES, Axis, AxisChoice, Parameter
from hostkit.tuning.dimension import (
    Dimension,
    FixedParameter,
    FreeName,
    Limits,
    SearchRange,
    check_fixed,
    check_range,
)
from hostkit.tuning.kernel import Candidates
from hostkit.units import RAD_PER_DEG

Vector = NDArray[np.float64]

RANGES: Final[tuple[SearchRange, ...]] = (
    SearchRange(name="tau", lowest=0.02, highest=100.0, is_log=True),
    SearchRange(
        name="gyro_bias", lowest=-5.0 * RAD_PER_DEG, highest=5.0 * RAD_PER_DEG, is_log=False
    ),
    SearchRange(name="gyro_scale", lowest=-0.1, highest=0.1, is_log=False),
    SearchRange(
        name="tilt_offset", lowest=-3.0 * RAD_PER_DEG, highest=3.0 * RAD_PER_DEG, is_log=False
    ),
    SearchRange(name="gate", lowest=0.005, highest=1.0, is_log=True),
    SearchRange(name="integral_gain", lowest=1e-5, highest=0.1, is_log=True),
)
"""The range of tau is the paper's; scales are searched as logarithms. An integral gain above 0.1
would learn a bias within three seconds, that is, follow the motion."""

RANGE_BY_NAME: Final[dict[FreeName, SearchRange]] = {r.name: r for r in RANGES}


@dataclass(frozen=True, slots=True, kw_only=True)
class SearchSpace:
    """The box of the search, and what is held fixed beside it."""

    axes: tuple[Axis, ...]
    period_s: float
    dimensions: tuple[Dimension, ...]
    fixed: tuple[FixedParameter, ...] = ()

    @property
    def lower(self) -> Vector:
        """Lower corner of the box, shape ``(D,)``."""
        return np.array([d.lower for d in self.dimensions])

    @property
    def upper(self) -> Vector:
        """Upper corner of the box, shape ``(D,)``."""
        return np.array([d.upper for d in self.dimensions])

    @property
    def plain(self) -> bool:
        """Whether eta is the only parameter, searched or fixed."""
        names = {d.name for d in self.dimensions} | {f.name for f in self.fixed}
        return names <= {"tau"}

    def column(self, name: FreeName, axis: Axis, points: Vector) -> Vector | None:
        """Return the values of one parameter at points, or None where it is not there.

        Parameters
        ----------
        points
            Coordinates, shape ``(P, D)``.

        Returns
        -------
        numpy.ndarray
            In the unit of a design, shape ``(P,)``.
        """
        for i, dimension in enumerate(self.dimensions):
            if dimension.name == name and dimension.axis in (None, axis):
                return np.exp(points[:, i]) if dimension.is_log else points[:, i]
        for fixed in self.fixed:
            if fixed.name == name and fixed.axis in (None, axis):
                return np.full(len(points), fixed.value)
        return None

    def candidates(self, axis: Axis, points: Vector) -> Candidates:
        """Return points of shape ``(P, D)`` as candidates of one axis."""

        def of(name: FreeName, neutral: float) -> Vector:
            found = self.column(name, axis, points)
            return np.full(len(points), neutral) if found is None else found

        tau_s = of("tau", math.nan)
        table = np.stack(
            [
                tau_s / (tau_s + self.period_s),
                1.0 + of("gyro_scale", 0.0),
                of("tilt_offset", 0.0),
                of("gate", math.inf),
                of("integral_gain", 0.0) * self.period_s**2,
            ]
        )
        bias_step = of("gyro_bias", 0.0) * self.period_s
        return Candidates(table=table, bias_step_rad=bias_step, plain=self.plain)

    def design_parameters(self, x: Vector) -> tuple[Parameter, ...]:
        """Return a point, shape ``(D,)``, as the parameters of a design."""
        found: list[Parameter] = []
        for search in RANGES[1:]:
            kind = BY_NAME[search.name]
            for axis in self.axes if kind.per_axis else (None,):
                column = self.column(search.name, axis or self.axes[0], x[np.newaxis])
                if column is not None:
                    found.append(parameter(kind.name, float(column[0]), axis))
        tau_s = self.column("tau", self.axes[0], x[np.newaxis])
        assert tau_s is not None
        return parameters(eta_from_tau(float(tau_s[0]), self.period_s), *found)


def search_space(
    axes: AxisChoice,
    period_s: float,
    free: tuple[FreeName, ...],
    fixed: tuple[FixedParameter, ...] = (),
    ranges: tuple[SearchRange, ...] = (),
) -> SearchSpace:
    """Return the box of the free parameters, one dimension an axis where they are per axis.

    Parameters
    ----------
    free
        Names of what is searched; tau is searched unless it is fixed.
    fixed
        What the user sets.
    ranges
        Ranges in place of those of `RANGES`.

    Raises
    ------
    DesignError
        If a parameter is both free and fixed, nothing is free, or a value or range is not
        possible.
    """
    fixed_names = {f.name for f in fixed}
    names: tuple[FreeName, ...] = tuple(
        r.name for r in RANGES if r.name in free or (r.name == "tau" and "tau" not in fixed_names)
    )
    _check(axes, names, fixed)
    own = {**RANGE_BY_NAME, **{r.name: r for r in ranges}}
    dimensions = [dimension for name in names for dimension in _dimensions(own[name], AXES[axes])]
    return SearchSpace(
        axes=AXES[axes], period_s=period_s, dimensions=tuple(dimensions), fixed=fixed
    )


def _dimensions(search: SearchRange, axes: tuple[Axis, ...]) -> list[Dimension]:
    limits = _limits(search.name)
    check_range(search, limits)
    low, high = search.lowest, search.highest
    if search.is_log:
        low, high = math.log(low), math.log(high)
    kind = None if search.name == "tau" else BY_NAME[search.name]
    return [
        Dimension(
            name=search.name,
            axis=axis,
            lower=low,
            upper=high,
            is_log=search.is_log,
            shown_unit=limits.shown_unit,
            shown_per_unit=limits.shown_per_unit,
        )
        for axis in (axes if kind is not None and kind.per_axis else (None,))
    ]


def _limits(name: FreeName) -> Limits:
    if name == "tau":
        return Limits(lowest=1e-6, highest=1e6, shown_unit="s")
    kind = BY_NAME[name]
    return Limits(
        lowest=kind.lowest,
        highest=kind.highest,
        shown_unit=kind.shown_unit,
        shown_per_unit=kind.shown_per_unit,
    )


def _check(
    axes: AxisChoice, names: tuple[FreeName, ...], fixed: tuple[FixedParameter, ...]
) -> None:
    for one in fixed:
        check_fixed(one, names, _limits(one.name))
        if one.axis is not None and one.axis not in AXES[axes]:
            raise DesignError(f"{one.name} is fixed for {one.axis}, which the design has not")
    if not names:
        raise DesignError("every parameter is fixed; there is nothing to tune")
