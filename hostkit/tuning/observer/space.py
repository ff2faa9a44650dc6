"""What is searched of the observer: its parameters, their ranges, their way into a design."""

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from hostkit.errors import DesignError
from hostkit.filters.observer.lowering import largest_that_fits
from hostkit.filters.observer.parameters import (
    BY_NAME,
    KINDS,
    ParameterKind,
    parameters,
)
from hostkit.filters.sensor_terms import SENSOR_AXES
from hostkit.records import Parameter
from hostkit.tuning.dimension import (
    Dimension,
    FixedParameter,
    FreeName,
    Limits,
    SearchRange,
    check_fixed,
    check_range,
)
from hostkit.tuning.sensor_terms import HOLD, SENSOR_RANGES, preference
from hostkit.tuning.tuner import Tunable

Vector = NDArray[np.float64]

RANGES: Final[tuple[SearchRange, ...]] = (
    SearchRange(name="kt", lowest=3e-3, highest=12.0, is_log=True),
    SearchRange(name="kv", lowest=0.05, highest=60.0, is_log=True),
    SearchRange(name="kb", lowest=1e-5, highest=0.2, is_log=True),
    SearchRange(name="start", lowest=0.05, highest=10.0, is_log=True),
    SearchRange(name="rest_rate", lowest=3e-3, highest=0.1, is_log=True),
    SearchRange(name="rest_force", lowest=0.05, highest=3.0, is_log=True),
    SearchRange(name="rest_gain", lowest=0.03, highest=3.0, is_log=True),
    *SENSOR_RANGES,
)
"""Where tuned values on public recordings lie, with room around them; rates of decay and gains are
searched as logarithms."""

REST_NAMES: Final = ("rest_rate", "rest_force", "rest_gain")
REST_USUAL: Final = math.log(2.0)
"""How far what rest is told by is from its default in ordinary sensors: a factor of two."""

RANGE_BY_NAME: Final[dict[FreeName, SearchRange]] = {r.name: r for r in RANGES}


@dataclass(frozen=True, slots=True, kw_only=True)
class ObserverSpace:
    """The box of the search, and the parameters that are held beside it."""

    dimensions: tuple[Dimension, ...]
    held: tuple[Parameter, ...]

    @property
    def lower(self) -> Vector:
        """Lower corner of the box, shape ``(D,)``."""
        return np.array([d.lower for d in self.dimensions])

    @property
    def upper(self) -> Vector:
        """Upper corner of the box, shape ``(D,)``."""
        return np.array([d.upper for d in self.dimensions])

    def preference(self, points: Vector) -> Vector:
        """Return the factors that hold points of shape ``(P, D)`` to what is usual, ``(P,)``.

        The scale of an axis that the recordings do not turn about would be anything else, and a
        threshold of rest would be where it happens to suit one moment of them.
        """
        factor = preference(self.dimensions, points)
        for i, dimension in enumerate(self.dimensions):
            if dimension.name in REST_NAMES:
                away = points[:, i] - math.log(BY_NAME[dimension.name].default)
                factor += HOLD * (away / REST_USUAL) ** 2
        return factor

    def values(self, points: Vector) -> dict[str, Vector]:
        """Return every parameter of points of shape ``(P, D)`` by its name in a design."""
        columns = {p.name: np.full(len(points), p.value) for p in self.held}
        for i, dimension in enumerate(self.dimensions):
            column = np.exp(points[:, i]) if dimension.is_log else points[:, i]
            key = parameter_key(dimension.name, dimension.axis)
            columns[key] = np.minimum(column, dimension.largest)
        return columns

    def design_parameters(self, x: Vector) -> tuple[Parameter, ...]:
        """Return a point, shape ``(D,)``, as the parameters of a design."""
        units = {key: kind.unit for kind in KINDS for key in kind.names()}
        values = self.values(x[np.newaxis])
        return parameters(
            *(
                Parameter(name=name, value=float(column[0]), unit=units[name])
                for name, column in values.items()
            )
        )


def observer_space(
    rate_hz: float,
    free: tuple[FreeName, ...],
    fixed: tuple[FixedParameter, ...] = (),
    ranges: tuple[SearchRange, ...] = (),
) -> ObserverSpace:
    """Return the box of the free parameters, a dimension an axis where they are per axis.

    What is neither free nor fixed keeps its default.

    Raises
    ------
    DesignError
        If a parameter is both free and fixed, nothing is free, or a value or range is not
        possible.
    """
    for one in fixed:
        check_fixed(one, free, _limits(BY_NAME[one.name]))
    if not free:
        raise DesignError("every parameter is fixed; there is nothing to tune")
    own = {**RANGE_BY_NAME, **{r.name: r for r in ranges}}
    dimensions = [d for r in RANGES if r.name in free for d in _dimensions(own[r.name], rate_hz)]
    return ObserverSpace(dimensions=tuple(dimensions), held=_held(free, fixed))


def parameter_key(name: FreeName, axis: str | None) -> str:
    """Return the name in a design of a kind of parameter, of an axis where it has several."""
    kind = BY_NAME[name]
    return next(kind.key(a) for a in SENSOR_AXES if not kind.per_axis or a == axis)


def _dimensions(search: SearchRange, rate_hz: float) -> list[Dimension]:
    kind = BY_NAME[search.name]
    check_range(search, _limits(kind))
    low, high = search.lowest, min(search.highest, _highest(kind, rate_hz))
    if search.is_log:
        low, high = math.log(low), math.log(high)
    return [
        Dimension(
            name=search.name,
            axis=axis,
            lower=low,
            upper=high,
            is_log=search.is_log,
            largest=largest_that_fits(search.name, 1.0 / rate_hz),
            shown_unit=kind.shown_unit,
            shown_per_unit=kind.shown_per_unit,
        )
        for axis in (SENSOR_AXES if kind.per_axis else (None,))
    ]


def _limits(kind: ParameterKind) -> Limits:
    return Limits(
        lowest=kind.lowest,
        highest=kind.highest,
        shown_unit=kind.shown_unit,
        shown_per_unit=kind.shown_per_unit,
    )


def _highest(kind: ParameterKind, rate_hz: float) -> float:
    """Return what a design of a sample rate takes: the velocity may not decay in two samples."""
    return 0.49 * rate_hz if kind.name == "kv" else kind.highest


def _held(free: tuple[FreeName, ...], fixed: tuple[FixedParameter, ...]) -> tuple[Parameter, ...]:
    """Return what the user fixed, and the defaults of what is neither free nor fixed."""
    named = {one.name for one in fixed}
    held = [
        Parameter(name=kind.key(), value=kind.default, unit=kind.unit)
        for kind in KINDS
        if kind.name not in free and kind.name not in named and _is_used(kind)
    ]
    for one in fixed:
        kind = BY_NAME[one.name]
        axes = [a for a in SENSOR_AXES if one.axis in (None, a)]
        keys = [kind.key(axis) for axis in axes] if kind.per_axis else [kind.key()]
        held += [Parameter(name=key, value=one.value, unit=kind.unit) for key in keys]
    return tuple(held)


def _is_used(kind: ParameterKind) -> bool:
    """Return whether a design has the parameter unless something else is said."""
    return not kind.per_axis and kind.neutral is None


def tunable(search: SearchRange) -> Tunable:
    """Return one kind of parameter as the command line names it."""
    kind = BY_NAME[search.name]
    return Tunable(
        search=search,
        shown_unit=kind.shown_unit,
        shown_per_unit=kind.shown_per_unit,
        axes=SENSOR_AXES if kind.per_axis else (),
    )
