"""What a search of the complementary filter needs of its problem beside the cost."""

from typing import Protocol

from numpy.typing import DTypeLike

from hostkit.records import Objective
from hostkit.tuning.complementary.space import SearchSpace
from hostkit.tuning.kernel import Kernel, StreamSource


class LaidOut(Protocol):
    """Recordings laid out for the kernel, see `hostkit.tuning.complementary.problem.Problem`."""

    @property
    def space(self) -> SearchSpace:
        """Return the box of the search."""

    @property
    def streams(self) -> tuple[tuple[StreamSource, ...], ...]:
        """Return for each recording a stream for each axis."""

    @property
    def objective(self) -> Objective:
        """Return whether squares or magnitudes count."""

    @property
    def dtype(self) -> DTypeLike:
        """Return the type of the arithmetic."""

    @property
    def kernel(self) -> Kernel:
        """Return what computes the cost."""
