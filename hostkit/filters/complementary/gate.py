"""The gate: a specific force that is not near 1 g does not say where up is.

The condition ``| |f| - 1 g | < gate`` is lowered to bounds of the sum of the squared counts. The
float model compares with the middle between two such integers, so that on counts both models
decide alike, a force exactly on a bound included; it is then shut out, as the condition says.
"""

import math
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from hostkit.filters.complementary.spec import ForceGate

Vector = NDArray[np.float64]
IntArray = NDArray[np.int64]


def force_gate(gate_g: float, gravity_count: int) -> ForceGate:
    """Return the sums of squared counts that a gate lets through.

    Parameters
    ----------
    gate_g
        Largest difference to 1 g, above 0 and up to 1.
    gravity_count
        Accelerometer count of 1 g.
    """
    below, above = (((1 + sign * Fraction(gate_g)) * gravity_count) ** 2 for sign in (-1, 1))
    return ForceGate(lowest=math.floor(below) + 1, highest=math.ceil(above) - 1)


def corrects_float(gate: ForceGate | None, gravity_count: int, force_g: Vector) -> Vector:
    """Return 1 for each force, shape ``(N, 3)`` in g, that the gate lets through, else 0."""
    if gate is None:
        return np.ones(len(force_g))
    square = np.einsum("ni,ni->n", force_g, force_g) * float(gravity_count) ** 2
    open_ = (square > gate.lowest - 0.5) & (square < gate.highest + 0.5)
    return np.asarray(open_, dtype=np.float64)


def corrects_integer(gate: ForceGate | None, accel_count: IntArray) -> IntArray:
    """Return 1 for each sample of counts, shape ``(N, 3)``, that the gate lets through, else 0."""
    if gate is None:
        return np.ones(len(accel_count), dtype=np.int64)
    square = np.einsum("ni,ni->n", accel_count, accel_count)
    open_ = (square >= gate.lowest) & (square <= gate.highest)
    return np.asarray(open_, dtype=np.int64)
