"""What is searched of a peer: its parameters, and the scale of the gyroscope that it reads."""

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from hostkit.comparison.peer import Peer
from hostkit.filters.sensor_terms import SENSOR_AXES
from hostkit.records import Parameter
from hostkit.tuning.dimension import Dimension
from hostkit.tuning.sensor_terms import SENSOR_RANGES, preference

Vector = NDArray[np.float64]

SCALE: Final = "gyro_scale"


@dataclass(frozen=True, slots=True, kw_only=True)
class PeerSpace:
    """The box of a peer's parameters.

    Attributes
    ----------
    is_scaled
        Whether the scale of the gyroscope is searched with them, as it is for hostkit's observer:
        from three constants of the sensor any filter gains, not only ours.
    """

    peer: Peer
    is_scaled: bool = False

    @property
    def dimensions(self) -> tuple[Dimension, ...]:
        """Return what is searched."""
        own = [
            Dimension(
                name=p.name,
                axis=None,
                lower=math.log(p.lowest) if p.is_log else p.lowest,
                upper=math.log(p.highest) if p.is_log else p.highest,
                is_log=p.is_log,
                shown_unit=p.unit,
            )
            for p in self.peer.parameters
        ]
        return (*own, *(_scale(axis) for axis in SENSOR_AXES if self.is_scaled))

    @property
    def lower(self) -> Vector:
        """Lower corner of the box, shape ``(D,)``."""
        return np.array([d.lower for d in self.dimensions])

    @property
    def upper(self) -> Vector:
        """Upper corner of the box, shape ``(D,)``."""
        return np.array([d.upper for d in self.dimensions])

    @property
    def start(self) -> Vector:
        """Return the peer's own values as a point, shape ``(D,)``."""
        pairs = zip(self.peer.parameters, self.peer.defaults, strict=True)
        own = [math.log(value) if p.is_log else value for p, value in pairs]
        return np.array(own + [0.0] * (len(self.dimensions) - len(own)))

    def values(self, x: Vector) -> tuple[float, ...]:
        """Return the parameters at a point, shape ``(D,)``: the peer's own, then the scales."""
        return tuple(d.value(float(c)) for d, c in zip(self.dimensions, x, strict=True))

    def preference(self, points: Vector) -> Vector:
        """Return the factors that hold scales near zero, as for hostkit's observer, ``(P,)``."""
        own = len(self.peer.parameters)
        return preference(self.dimensions[own:], points[:, own:])

    def design_parameters(self, x: Vector) -> tuple[Parameter, ...]:
        """Return a point as named parameters."""
        return tuple(
            Parameter(
                name=d.name if d.axis is None else f"{d.name}_{d.axis}",
                value=value,
                unit=d.shown_unit or "1",
            )
            for d, value in zip(self.dimensions, self.values(x), strict=True)
        )


def _scale(axis: str) -> Dimension:
    search = next(r for r in SENSOR_RANGES if r.name == SCALE)
    return Dimension(name=SCALE, axis=axis, lower=search.lowest, upper=search.highest, is_log=False)
