"""The evaluation kernel: the error of the filter for many candidates over a recording."""

import functools
from typing import Protocol

from hostkit.records import Objective
from hostkit.tuning.kernel.arrays import (
    Candidates,
    Carry,
    ErrorStream,
    StreamSource,
    Vector,
    runs_of,
    within,
)
from hostkit.tuning.kernel.library import library
from hostkit.tuning.kernel.native import NativeKernel
from hostkit.tuning.kernel.portable import PortableKernel, scored_mask

__all__ = [
    "Candidates",
    "Carry",
    "ErrorStream",
    "Kernel",
    "NativeKernel",
    "PortableKernel",
    "StreamSource",
    "kernel",
    "runs_of",
    "scored_mask",
    "within",
]


class Kernel(Protocol):
    """What both kernels do, see `hostkit.tuning.kernel.portable`."""

    @property
    def name(self) -> str:
        """``c`` or ``numpy``."""

    def add_sums(
        self, stream: ErrorStream, candidates: Candidates, objective: Objective, carry: Carry
    ) -> None:
        """Run all candidates over a stream and add to their sums."""

    def trace(self, stream: ErrorStream, candidate: Candidates, carry: Carry) -> Vector:
        """Return the error of one candidate, sample by sample."""


@functools.lru_cache(maxsize=1)
def kernel() -> NativeKernel | PortableKernel:
    """Return the compiled kernel, or the one in NumPy where there is no C compiler."""
    compiled = library()
    return PortableKernel() if compiled is None else NativeKernel(compiled)
