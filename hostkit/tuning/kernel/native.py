"""The kernel in C, called through ctypes, which lets other threads run meanwhile."""

import ctypes
import functools
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hostkit.records import Objective
from hostkit.tuning.kernel.arrays import Candidates, Carry, ErrorStream, Vector, edges
from hostkit.tuning.kernel.portable import trace_plain

Array = NDArray[Any]


class Stream(ctypes.Structure):
    """``hk_stream`` of ``kernel.c``; its pointers are to float or double alike."""

    _fields_ = (
        ("samples", ctypes.c_long),
        ("run_count", ctypes.c_long),
        ("runs", ctypes.c_void_p),
        ("drive", ctypes.c_void_p),
        ("start", ctypes.c_void_p),
        ("rate_step", ctypes.c_void_p),
        ("reference_step", ctypes.c_void_p),
        ("force_deviation", ctypes.c_void_p),
        ("bias_limit", ctypes.c_double),
    )


VARIANTS = {
    (np.dtype(np.float64), np.dtype(np.float64)): "hk_sums_f64",
    (np.dtype(np.float32), np.dtype(np.float64)): "hk_sums_mixed",
    (np.dtype(np.float32), np.dtype(np.float32)): "hk_sums_f32",
}
"""Functions by the type of the stream and of the arithmetic."""

LONG, INT, REAL, ADDRESS = ctypes.c_long, ctypes.c_int, ctypes.c_double, ctypes.c_void_p
SUMS_ARGUMENTS = (ADDRESS, LONG, ADDRESS, INT, INT, LONG, ADDRESS, ADDRESS, ADDRESS, ADDRESS)


@dataclass(frozen=True, slots=True)
class LineTask:
    """A search over log tau that is done in C, on streams in float64.

    Attributes
    ----------
    bounds
        Of log tau.
    """

    streams: tuple[ErrorStream, ...]
    objective: Objective
    period_s: float
    bounds: tuple[float, float]
    weights: Vector = field(init=False)
    array: Any = field(init=False)

    def __post_init__(self) -> None:
        """Lay the streams out for C."""
        weights = np.array([1.0 / stream.scored for stream in self.streams])
        array = (Stream * len(self.streams))(*(_structure(stream) for stream in self.streams))
        object.__setattr__(self, "weights", weights)
        object.__setattr__(self, "array", array)


@dataclass(frozen=True, slots=True)
class NativeKernel:
    """The compiled kernel."""

    library: ctypes.CDLL
    name: str = "c"

    def __post_init__(self) -> None:
        """Declare the functions, so that plain integers may be passed as addresses."""
        for name in VARIANTS.values():
            getattr(self.library, name).argtypes = SUMS_ARGUMENTS
            getattr(self.library, name).restype = None
        self.library.hk_grid_brent_tau.restype = LONG

    def add_sums(
        self, stream: ErrorStream, candidates: Candidates, objective: Objective, carry: Carry
    ) -> None:
        """Run all candidates over a stream and add to their sums; see `portable.add_sums`."""
        cuts = _cuts(len(stream), len(carry.sums))
        kind = carry.error.dtype
        table = np.ascontiguousarray(candidates.table, dtype=kind)
        getattr(self.library, VARIANTS[stream.dtype, kind])(
            ctypes.addressof(_structure(stream)),
            len(carry.sums),
            _address(cuts),
            not candidates.plain,
            objective == "rmse",
            len(candidates),
            _address(table),
            _address(carry.error),
            _address(carry.bias),
            _address(carry.sums),
        )

    def trace(self, stream: ErrorStream, candidate: Candidates, carry: Carry) -> Vector:
        """Return the error of one candidate, rad, shape ``(N,)``; see `portable.trace`."""
        if candidate.plain:
            return trace_plain(stream, candidate, carry)
        wide, error = stream.widened(), np.empty(len(stream))
        table = np.ascontiguousarray(candidate.table)
        state, bias = carry.error.astype(np.float64), carry.bias.astype(np.float64)
        self.library.hk_trace(
            ctypes.byref(_structure(wide)),
            *(ADDRESS(_address(array)) for array in (table, state, bias, error)),
        )
        carry.error[:], carry.bias[:] = state, bias
        return error

    def qpso_tau(
        self,
        task: LineTask,
        particles: int,
        iterations: int,
        contraction: tuple[float, float],
        rng: np.random.Generator,
    ) -> tuple[float, Vector]:
        """Run the whole quantum-behaved swarm on log tau in C.

        The numbers are drawn as `hostkit.optimisers.qpso` draws them, so the result is the same
        but for the last digits.

        Returns
        -------
        log_tau, history
            Best point, and the best cost after each iteration, shape ``(iterations + 1,)``.
        """
        draws = rng.random((1 + 3 * iterations, particles))
        draws[2::3] = np.log(1.0 / (1.0 - draws[2::3]))
        history, best, work = np.empty(iterations + 1), np.empty(1), np.empty(8 * particles)
        self.library.hk_qpso_tau(
            *_line_arguments(task),
            LONG(particles),
            LONG(iterations),
            *(REAL(alpha) for alpha in contraction),
            *(ADDRESS(_address(one)) for one in (draws, work, history, best)),
        )
        return float(best[0]), history

    def grid_brent_tau(
        self, task: LineTask, points: int, tolerance: float, iterations: int
    ) -> tuple[float, Vector, int]:
        """Run the search of `hostkit.optimisers.grid_brent` on log tau in C.

        Returns
        -------
        log_tau, history, evaluations
            Best point, the best cost after the grid and after each step, and how many costs.
        """
        history, best, work = np.empty(iterations + 2), np.empty(1), np.empty(8 * points)
        evaluations = LONG()
        steps = self.library.hk_grid_brent_tau(
            *_line_arguments(task),
            LONG(points),
            REAL(tolerance),
            LONG(iterations),
            *(ADDRESS(_address(one)) for one in (work, history, best)),
            ctypes.byref(evaluations),
        )
        return float(best[0]), history[:steps], int(evaluations.value)


def _line_arguments(task: LineTask) -> tuple[Any, ...]:
    """Return what both searches over log tau begin with; the task owns what is pointed to."""
    return (
        task.array,
        LONG(len(task.streams)),
        ADDRESS(_address(task.weights)),
        INT(task.objective == "rmse"),
        REAL(task.period_s),
        *(REAL(bound) for bound in task.bounds),
    )


@functools.lru_cache(maxsize=64)
def _cuts(samples: int, blocks: int) -> NDArray[np.int64]:
    return np.array(edges(samples, blocks), dtype=np.int64)


def _structure(stream: ErrorStream) -> Stream:
    """Return the stream for C, made once; the stream owns the arrays that it points to."""
    if not stream.handle:
        arrays = (
            stream.runs,
            stream.drive,
            stream.start,
            stream.rate_step,
            stream.reference_step,
            stream.force_deviation,
        )
        addresses = [None if array is None else _address(array) for array in arrays]
        stream.handle.append(
            Stream(len(stream), len(stream.runs), *addresses, stream.bias_limit_rad)
        )
    found: Stream = stream.handle[0]
    return found


def _address(array: Array) -> int:
    address: int = array.__array_interface__["data"][0]
    return address
