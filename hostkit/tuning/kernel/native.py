"""The kernel in C, called through ctypes, which lets other threads run meanwhile."""

import ctypes
from collections.abc import Sequence
from dataclasses import dataclass
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


@dataclass(frozen=True, slots=True)
class NativeKernel:
    """The compiled kernel."""

    library: ctypes.CDLL
    name: str = "c"

    def add_sums(
        self, stream: ErrorStream, candidates: Candidates, objective: Objective, carry: Carry
    ) -> None:
        """Run all candidates over a stream and add to their sums; see `portable.add_sums`."""
        cuts = np.array(edges(len(stream), len(carry.sums)), dtype=np.int64)
        kind = carry.error.dtype
        table = np.ascontiguousarray(candidates.table, dtype=kind)
        getattr(self.library, VARIANTS[stream.dtype, kind])(
            ctypes.byref(_structure(stream)),
            ctypes.c_long(len(carry.sums)),
            _address(cuts),
            ctypes.c_int(not candidates.plain),
            ctypes.c_int(objective == "rmse"),
            ctypes.c_long(len(candidates)),
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
            _address(table),
            _address(state),
            _address(bias),
            _address(error),
        )
        carry.error[:], carry.bias[:] = state, bias
        return error

    def qpso_tau(
        self,
        streams: Sequence[ErrorStream],
        objective: Objective,
        period_s: float,
        bounds: tuple[float, float],
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
        array = (Stream * len(streams))(*(_structure(stream) for stream in streams))
        weights = np.array([1.0 / stream.scored for stream in streams])
        history, best = np.empty(iterations + 1), np.empty(1)
        work = np.empty(8 * particles)
        self.library.hk_qpso_tau(
            array,
            ctypes.c_long(len(streams)),
            _address(weights),
            ctypes.c_int(objective == "rmse"),
            ctypes.c_double(period_s),
            *(ctypes.c_double(bound) for bound in bounds),
            ctypes.c_long(particles),
            ctypes.c_long(iterations),
            *(ctypes.c_double(alpha) for alpha in contraction),
            _address(draws),
            _address(work),
            _address(history),
            _address(best),
        )
        return float(best[0]), history


def _structure(stream: ErrorStream) -> Stream:
    return Stream(
        len(stream),
        len(stream.runs),
        *(
            None if array is None else array.ctypes.data
            for array in (
                stream.runs,
                stream.drive,
                stream.start,
                stream.rate_step,
                stream.reference_step,
                stream.force_deviation,
            )
        ),
        stream.bias_limit_rad,
    )


def _address(array: Array) -> ctypes.c_void_p:
    return ctypes.c_void_p(array.ctypes.data)
