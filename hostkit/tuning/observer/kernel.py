"""The observer for many sets of parameters over a recording: in C, or the float model in turn."""

import ctypes
import math
from dataclasses import dataclass
from pathlib import Path
from typing import Final, Protocol

import numpy as np
from numpy.typing import NDArray

from hostkit.filters.observer.limits import (
    ACCELERATION_LIMIT_M_S2,
    CLIP_GAIN,
    FIRST_FORCE_G,
    FIRST_ROUNDS,
    LEAD_LIMIT_RAD,
    REST_RATE_LIMIT_RAD_S,
    START_GAIN,
    START_LIMIT_RAD,
    correction_limit_rad,
    mean_shift,
    rest_samples,
)
from hostkit.filters.observer.parameters import BIAS_LIMIT_RAD_S, BY_NAME
from hostkit.filters.sensor_terms import SENSOR_AXES
from hostkit.mounting import Mounting
from hostkit.records import Objective
from hostkit.tuning.evaluation import Quantity
from hostkit.tuning.kernel.arrays import edges
from hostkit.tuning.track import Track
from hostkit.units import STANDARD_GRAVITY_M_S2

Vector = NDArray[np.float64]

SOURCES: Final = (Path(__file__).with_name("kernel.c"),)
LANES: Final = 8

QUANTITY_NUMBER: Final[dict[Quantity, int]] = {"inclination": 0, "roll": 1, "pitch": 2}

GAINS: Final = ("kt", "kv", "kb")
NEVER: Final = -1.0
"""A threshold that nothing stays below: rest is not looked for."""


class _Track(ctypes.Structure):
    """``hk_track`` of ``kernel.c``."""

    _fields_ = (
        ("samples", ctypes.c_long),
        ("rate_rad_s", ctypes.c_void_p),
        ("force_m_s2", ctypes.c_void_p),
        ("reference", ctypes.c_void_p),
        ("scored", ctypes.c_void_p),
    )


class _Terms(ctypes.Structure):
    """``hk_terms`` of ``kernel.c``."""

    _fields_ = (
        ("period_s", ctypes.c_double),
        ("mean_weight", ctypes.c_double),
        ("rest_s", ctypes.c_double),
        ("start_gain", ctypes.c_double),
        ("clip_gain", ctypes.c_double),
        ("bias_limit", ctypes.c_double),
        ("rest_rate_limit", ctypes.c_double),
        ("acceleration_limit", ctypes.c_double),
        ("correction_limit", ctypes.c_double),
        ("start_limit", ctypes.c_double),
        ("lead_limit", ctypes.c_double),
        ("gravity", ctypes.c_double),
        ("first_force", ctypes.c_double),
        ("body", ctypes.c_double * 9),
        ("first_rounds", ctypes.c_int),
        ("quantity", ctypes.c_int),
        ("squared", ctypes.c_int),
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class Terms:
    """What all candidates have in common."""

    period_s: float
    mounting: Mounting
    quantity: Quantity
    objective: Objective

    def structure(self) -> _Terms:
        """Return them for C."""
        body = np.zeros((3, 3))
        for row, (source, sign) in enumerate(
            zip(self.mounting.source, self.mounting.sign, strict=True)
        ):
            body[row, source] = sign
        period_s = self.period_s
        return _Terms(
            period_s=period_s,
            mean_weight=2.0 ** -mean_shift(period_s),
            rest_s=rest_samples(period_s) * period_s,
            start_gain=START_GAIN,
            clip_gain=CLIP_GAIN,
            bias_limit=BIAS_LIMIT_RAD_S,
            rest_rate_limit=REST_RATE_LIMIT_RAD_S,
            acceleration_limit=ACCELERATION_LIMIT_M_S2,
            correction_limit=correction_limit_rad(period_s),
            start_limit=START_LIMIT_RAD,
            lead_limit=LEAD_LIMIT_RAD,
            gravity=STANDARD_GRAVITY_M_S2,
            first_force=FIRST_FORCE_G,
            body=(ctypes.c_double * 9)(*body.ravel()),
            first_rounds=FIRST_ROUNDS,
            quantity=QUANTITY_NUMBER[self.quantity],
            squared=self.objective == "rmse",
        )


def candidate_table(values: dict[str, Vector], count: int, period_s: float) -> Vector:
    """Return parameters by their names in a design as the kernel has them, ``(K, P)``."""

    def of(name: str, axis: str | None, missing: float) -> Vector:
        kind = BY_NAME[name]
        key = next(kind.key(a) for a in SENSOR_AXES if axis in (None, a))
        return values.get(key, np.full(count, missing))

    start_s = of("start", None, 0.0)
    with np.errstate(divide="ignore"):
        start_end = np.minimum(np.where(start_s > 0.0, period_s / start_s, 1.0), 1.0)
    rows = [of(name, None, 0.0) for name in GAINS]
    rows += [start_end, of("rest_rate", None, NEVER), of("rest_force", None, NEVER)]
    rows += [of("rest_gain", None, 0.0), of("lead", None, 0.0), of("clip_rate", None, math.inf)]
    for name in ("gyro_bias", "gyro_scale", "accel_offset", "accel_scale"):
        rows += [of(name, axis, 0.0) for axis in SENSOR_AXES]
    return np.stack(rows)


class Kernel(Protocol):
    """What the compiled observer does."""

    def sums(self, track: Track, terms: Terms, table: Vector, blocks: int) -> Vector:
        """Return sums of squares or magnitudes of candidates ``(K, P)``: ``(blocks, P)``."""

    def ups(self, track: Track, terms: Terms, candidate: Vector) -> Vector:
        """Return the directions of up of one candidate, shape ``(N, 3)``."""


@dataclass(frozen=True, slots=True)
class CompiledObserver:
    """The observer in C; ctypes lets other threads run meanwhile."""

    library: ctypes.CDLL

    def __post_init__(self) -> None:
        """Declare the function."""
        self.library.hk_observer_run.restype = None

    def sums(self, track: Track, terms: Terms, table: Vector, blocks: int) -> Vector:
        """Return sums of squares or magnitudes of candidates ``(K, P)``: ``(blocks, P)``."""
        count = table.shape[1]
        out = np.zeros((blocks, -(-count // LANES) * LANES))
        for first in range(0, count, LANES):
            columns = np.minimum(np.arange(first, first + LANES), count - 1)
            out[:, first : first + LANES] = self._run(track, terms, table[:, columns], blocks)
        return out[:, :count]

    def ups(self, track: Track, terms: Terms, candidate: Vector) -> Vector:
        """Return the directions of up of one candidate, shape ``(N, 3)``."""
        ups = np.empty((len(track), 3))
        self._run(track, terms, np.repeat(candidate[:, np.newaxis], LANES, axis=1), 1, ups)
        return ups

    def _run(
        self, track: Track, terms: Terms, table: Vector, blocks: int, ups: Vector | None = None
    ) -> Vector:
        lanes, sums = np.ascontiguousarray(table), np.zeros((blocks, LANES))
        ends = np.array(edges(len(track), blocks), dtype=np.dtype("long"))
        read = _Track(
            samples=len(track),
            rate_rad_s=track.rate_rad_s.ctypes.data,
            force_m_s2=track.force_m_s2.ctypes.data,
            reference=track.reference.ctypes.data,
            scored=track.scored.ctypes.data,
        )
        self.library.hk_observer_run(
            ctypes.byref(read),
            ctypes.byref(terms.structure()),
            ctypes.c_void_p(lanes.ctypes.data),
            ctypes.c_void_p(ends.ctypes.data),
            ctypes.c_long(blocks),
            ctypes.c_void_p(sums.ctypes.data),
            ctypes.c_void_p(None if ups is None else ups.ctypes.data),
        )
        return sums
