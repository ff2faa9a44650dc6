"""Optimisers: one module per rule, one signature."""

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from hostkit.optimisers import (
    adaptive_pso,
    differential_evolution,
    grid_brent,
    pso,
    qpso,
    rdpso,
)
from hostkit.optimisers.result import Cost, ManyCost, SwarmBatch, SwarmResult
from hostkit.optimisers.swarm import Rule, minimise_many
from hostkit.registry import Registry

__all__ = [
    "OPTIMISERS",
    "Cost",
    "ManyCost",
    "Optimiser",
    "Rule",
    "SwarmBatch",
    "SwarmResult",
    "minimise_many",
]


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
        bounce: bool = ...,
        patience: int | None = ...,
    ) -> SwarmResult:
        """Minimise `cost` over a box."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Optimiser:
    """One rule by name.

    Attributes
    ----------
    name, title
        What it is called, and what it is in one line.
    minimise
        Runs it.
    one_dimension
        Whether it takes one parameter only.
    """

    name: str
    title: str
    minimise: Minimise
    one_dimension: bool = False


OPTIMISERS: Registry[Optimiser] = Registry(
    "optimiser",
    (
        Optimiser(name=qpso.NAME, title=qpso.TITLE, minimise=qpso.minimise),
        Optimiser(name=pso.NAME, title=pso.TITLE, minimise=pso.minimise),
        Optimiser(name=pso.LDW_NAME, title=pso.LDW_TITLE, minimise=pso.minimise_ldw),
        Optimiser(name=rdpso.NAME, title=rdpso.TITLE, minimise=rdpso.minimise),
        Optimiser(
            name=rdpso.ARTICLE_NAME, title=rdpso.ARTICLE_TITLE, minimise=rdpso.minimise_article
        ),
        Optimiser(name=adaptive_pso.NAME, title=adaptive_pso.TITLE, minimise=adaptive_pso.minimise),
        Optimiser(
            name=adaptive_pso.AWP_NAME,
            title=adaptive_pso.AWP_TITLE,
            minimise=adaptive_pso.minimise_awp,
        ),
        Optimiser(
            name=grid_brent.NAME,
            title=grid_brent.TITLE,
            minimise=grid_brent.minimise,
            one_dimension=True,
        ),
        Optimiser(
            name=differential_evolution.NAME,
            title=differential_evolution.TITLE,
            minimise=differential_evolution.minimise,
        ),
    ),
)
