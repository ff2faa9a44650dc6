"""The hand-written loop of ``best_loop.c``, compiled for this machine."""

import ctypes
import functools
import shutil
import subprocess
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from hostkit.errors import ToolMissingError
from hostkit.records import Objective
from hostkit.tuning.kernel import ErrorStream
from hostkit.tuning.kernel.library import COMPILERS

Vector = NDArray[np.float64]

LANES = 32
FLAGS = ("-O3", "-march=native", "-shared", "-fPIC")
WAYS = ("off_chain", "on_chain")


@dataclass(frozen=True, slots=True, kw_only=True)
class BestLoop:
    """The compiled loops."""

    library: ctypes.CDLL

    def ways(
        self, stream: ErrorStream, eta: Vector, objective: Objective
    ) -> tuple[Callable[[], Vector], ...]:
        """Return each way to run 32 candidates over a stream; a call returns their sums.

        `eta`, shape ``(32,)``, is read at every call, and the sums are the same array each time.
        """
        return tuple(self._way(f"{objective}_{way}", stream, eta) for way in WAYS)

    def _way(self, name: str, stream: ErrorStream, eta: Vector) -> Callable[[], Vector]:
        assert eta.shape == (LANES,)
        assert stream.dtype == np.float64
        sums = np.empty(LANES)
        arrays = (stream.drive, stream.start, eta, sums)
        arguments = (ctypes.c_long(len(stream)), *map(_address, arrays))
        function = getattr(self.library, name)

        def run() -> Vector:
            function(*arguments)
            assert arrays
            return sums

        return run


@functools.lru_cache(maxsize=1)
def best_loop() -> BestLoop:
    """Compile the loops.

    Raises
    ------
    ToolMissingError
        If there is no C compiler.
    """
    compiler = next((found for name in COMPILERS if (found := shutil.which(name))), None)
    if compiler is None:
        raise ToolMissingError(f"no C compiler for best_loop.c; one of {', '.join(COMPILERS)}")
    source = Path(__file__).with_name("best_loop.c")
    with tempfile.TemporaryDirectory(prefix="hostkit-") as folder:
        library = Path(folder) / "best_loop.so"
        subprocess.run([compiler, *FLAGS, "-o", str(library), str(source)], check=True, timeout=60)
        return BestLoop(library=ctypes.CDLL(str(library)))


def _address(array: NDArray[np.floating]) -> ctypes.c_void_p:
    return ctypes.c_void_p(array.ctypes.data)
