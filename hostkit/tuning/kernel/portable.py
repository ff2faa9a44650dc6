"""The kernel in NumPy and SciPy, for machines without a C compiler: same numbers, much slower."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hostkit.records import Objective
from hostkit.tuning.kernel.arrays import (
    ETA,
    GATE,
    INTEGRAL,
    OFFSET,
    SCALE,
    Candidates,
    Carry,
    ErrorStream,
    Vector,
)


@dataclass(frozen=True, slots=True)
class PortableKernel:
    """The kernel without a compiler."""

    name: str = "numpy"

    def add_sums(
        self, stream: ErrorStream, candidates: Candidates, objective: Objective, carry: Carry
    ) -> None:
        """Run all candidates over a stream and add to their sums.

        Parameters
        ----------
        stream
            A recording, or the next part of one.
        candidates
            Sets of parameters.
        objective
            Whether squares (``rmse``) or magnitudes (``mae``) are summed over the scored samples.
        carry
            State before the stream; afterwards the state behind it. The stream is cut into as
            many blocks as its sums have rows, and each block is added to its row.
        """
        run = _add_plain if candidates.plain else _add_full
        for row, (block,) in enumerate(stream.blocks(len(carry.sums))):
            run(block, candidates, objective, carry, carry.sums[row])

    def trace(self, stream: ErrorStream, candidate: Candidates, carry: Carry) -> Vector:
        """Return the error of one candidate, rad, shape ``(N,)``.

        Parameters
        ----------
        carry
            State before the stream; afterwards the state behind it.
        """
        if candidate.plain:
            return trace_plain(stream, candidate, carry)
        return np.array([error[0] for error in _steps(stream, candidate, carry)])


def trace_plain(stream: ErrorStream, candidate: Candidates, carry: Carry) -> Vector:
    """Return the error of one candidate where eta is the only parameter."""
    from scipy.signal import lfilter  # takes half a second to import

    kind = carry.error.dtype
    eta, one = candidate.table[ETA, 0].astype(kind), kind.type(1)
    driven = eta * stream.drive.astype(kind) + stream.start.astype(kind)
    error = np.asarray(lfilter([one], [one, -eta], driven, zi=[eta * carry.error[0]])[0])
    carry.error[0] = error[-1]
    return np.asarray(error, dtype=np.float64)


def _add_plain(
    stream: ErrorStream,
    candidates: Candidates,
    objective: Objective,
    carry: Carry,
    sums: Vector,
) -> None:
    scored = scored_mask(stream)
    for i in range(len(candidates)):
        lane = Carry(error=carry.error[i : i + 1], bias=carry.bias[i : i + 1], sums=carry.sums)
        error = trace_plain(stream, candidates.one(i), lane)[scored]
        sums[i] += np.square(error).sum() if objective == "rmse" else np.abs(error).sum()


def _add_full(
    stream: ErrorStream,
    candidates: Candidates,
    objective: Objective,
    carry: Carry,
    sums: Vector,
) -> None:
    scored = scored_mask(stream)
    for k, error in enumerate(_steps(stream, candidates, carry)):
        if scored[k]:
            sums += error * error if objective == "rmse" else np.abs(error)


def _steps(
    stream: ErrorStream, candidates: Candidates, carry: Carry
) -> Iterator[NDArray[np.floating[Any]]]:
    """Step through the filter with all its parameters; yields the errors, shape ``(P,)``."""
    assert stream.rate_step is not None
    assert stream.reference_step is not None
    assert stream.force_deviation is not None
    table, limit = candidates.table.astype(carry.error.dtype), stream.bias_limit_rad
    kind = carry.error.dtype
    named = (stream.rate_step, stream.reference_step, stream.start, stream.force_deviation)
    columns = [column.astype(kind) for column in named]
    for rate, reference, start, deviation in zip(*columns, strict=True):
        predicted = carry.error + (table[SCALE] * rate - carry.bias) - reference
        innovation = np.where(deviation < table[GATE], start - table[OFFSET] - predicted, 0.0)
        carry.error = predicted + (1.0 - table[ETA]) * innovation
        carry.bias = np.clip(carry.bias - table[INTEGRAL] * innovation, -limit, limit)
        yield carry.error


def scored_mask(stream: ErrorStream) -> NDArray[np.bool_]:
    """Return which samples are scored, shape ``(N,)``."""
    edges = np.zeros(len(stream) + 1, dtype=np.int64)
    np.add.at(edges, stream.runs[:, 0], 1)
    np.add.at(edges, stream.runs[:, 1], -1)
    mask: NDArray[np.bool_] = np.cumsum(edges[:-1]) > 0
    return mask
