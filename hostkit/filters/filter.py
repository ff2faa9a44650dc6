"""What a filter is to the rest of hostkit: its models and its lowering, by name."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from hostkit.records import FilterDesign
from hostkit.spec import FixedPointSpec

Vector = NDArray[np.float64]
IntArray = NDArray[np.int64]


class RunFloat(Protocol):
    """The float model, see :func:`hostkit.filters.complementary.run_float`."""

    def __call__(
        self,
        design: FilterDesign,
        rate_rad_s: Vector,
        force_g: Vector,
        start: Vector | None = None,
    ) -> Vector:
        """Run it."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Filter:
    """One filter: lowering, float model, integer model, and a single step of the latter.

    Models take and give states, one row a sample: first the angles of the design's axes, then the
    hidden words that the spec names.
    """

    name: str
    lower: Callable[[FilterDesign], FixedPointSpec]
    run_float: RunFloat
    run_integer: Callable[[FixedPointSpec, IntArray, IntArray], IntArray]
    step_integer: Callable[[FixedPointSpec, IntArray, IntArray, IntArray], IntArray]
