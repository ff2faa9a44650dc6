"""Optimisers: one module per rule, one signature."""

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from hostkit.optimisers import qpso
from hostkit.optimisers.result import Cost, SwarmResult
from hostkit.registry import Registry

__all__ = ["OPTIMISERS", "Cost", "Optimiser", "SwarmResult"]


class Minimise(Protocol):
    """The shared signature, see :func:`hostkit.optimisers.qpso.minimise`."""

    def __call__(
        self,
        cost: Cost,
        lower: NDArray[np.float64],
        upper: NDArray[np.float64],
        *,
        particles: int = ...,
        iterations: int = ...,
        rng: np.random.Generator,
    ) -> SwarmResult:
        """Minimise `cost` over a box."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Optimiser:
    """One rule by name."""

    name: str
    minimise: Minimise


OPTIMISERS: Registry[Optimiser] = Registry(
    "optimiser", (Optimiser(name=qpso.NAME, minimise=qpso.minimise),)
)
