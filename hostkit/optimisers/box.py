"""The box that is searched: its check, and what happens to a particle that leaves it."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hostkit.errors import HostkitError

Vector = NDArray[np.float64]

ON_THE_BOUND = 1e-6
"""Distance from a bound, as a share of the width, within which a point counts as on it."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Box:
    """Bounds of the parameters, each of shape ``(D,)``, in the units of the parameters.

    Raises
    ------
    HostkitError
        If the bounds are not finite or reversed, or their shapes differ.
    """

    lower: Vector
    upper: Vector

    def __post_init__(self) -> None:
        """Refuse what is no box."""
        lower, upper = self.lower, self.upper
        if lower.ndim != 1 or lower.shape != upper.shape or lower.size == 0:
            raise HostkitError(
                f"bounds of shapes {lower.shape} and {upper.shape}: both must be (D,), D at least 1"
            )
        if not (np.isfinite(lower).all() and np.isfinite(upper).all() and (lower < upper).all()):
            raise HostkitError(
                f"bounds {lower} to {upper}: each lower one must be below its upper one"
            )

    @property
    def width(self) -> Vector:
        """Upper minus lower bound, shape ``(D,)``."""
        return self.upper - self.lower

    def scatter(self, shape: tuple[int, ...], rng: np.random.Generator) -> Vector:
        """Return points evenly spread over the box, shape ``(*shape, D)``, in one draw."""
        return self.lower + self.width * rng.random((*shape, len(self.lower)))

    def mirror(self, position: Vector, velocity: Vector) -> tuple[Vector, Vector]:
        """Mirror positions at the bounds until they are inside, in one step.

        A velocity is turned round in every dimension in which its particle was mirrored an odd
        number of times.
        """
        width = self.width
        offset = np.mod(position - self.lower, 2.0 * width)
        turned = offset > width
        inside = self.lower + np.minimum(offset, 2.0 * width - offset)
        return np.minimum(inside, self.upper), np.where(turned, -velocity, velocity)

    def clip(self, position: Vector) -> Vector:
        """Put positions outside onto the nearest bound."""
        return np.clip(position, self.lower, self.upper)

    def touches(self, position: Vector) -> NDArray[np.bool_]:
        """Tell per dimension whether points, shape ``(..., D)``, lie on a bound."""
        slack = ON_THE_BOUND * self.width
        return np.asarray((position - self.lower <= slack) | (self.upper - position <= slack))
