"""A recording as filters of three dimensions are scored on it."""

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hostkit.attitude import inclination_rad, pitch_from_up, roll_from_up, to_body, wrap_rad
from hostkit.errors import RecordingError
from hostkit.mounting import Mounting
from hostkit.recordings import Recording
from hostkit.records import read_only
from hostkit.tuning.evaluation import Quantity
from hostkit.tuning.kernel.arrays import edges
from hostkit.tuning.reference import reference_up

Vector = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Track:
    """A recording with what is scored of it, sensor axes.

    Attributes
    ----------
    rate_rad_s, force_m_s2, reference
        Angular rate, specific force, and reference direction of up, each of shape ``(N, 3)``.
    scored
        Samples that count, shape ``(N,)``.
    """

    rate_rad_s: Vector
    force_m_s2: Vector
    reference: Vector
    scored: NDArray[np.bool_]

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        for array in (self.rate_rad_s, self.force_m_s2, self.reference):
            read_only(array)
        read_only(self.scored)

    def __len__(self) -> int:
        return len(self.scored)

    def deviation_rad(self, up: Vector, quantity: Quantity, mounting: Mounting) -> Vector:
        """Return the error of directions of up, shape ``(N,)``: an angle's, or the inclination."""
        if quantity == "inclination":
            return inclination_rad(up, self.reference)
        angle = roll_from_up if quantity == "roll" else pitch_from_up
        return wrap_rad(angle(to_body(mounting, up)) - angle(to_body(mounting, self.reference)))


def scored_in_blocks(tracks: tuple[Track, ...], blocks: int) -> Vector:
    """Return how many samples are scored in each block, shape ``(R, 1, blocks)``."""
    counts = [
        [int(track.scored[a:b].sum()) for a, b in pairwise(edges(len(track), blocks))]
        for track in tracks
    ]
    return np.array(counts, dtype=np.float64)[:, np.newaxis]


def scored_rms_rad(track: Track, deviation_rad: Vector, begin: int, end: int | None) -> float:
    """Return the RMSE of the scored samples of a part; NaN where there are none."""
    scored = deviation_rad[begin:end][track.scored[begin:end]]
    return math.sqrt(float(np.mean(scored**2))) if len(scored) else math.nan


def track_of(recording: Recording) -> Track:
    """Lay out a recording.

    Raises
    ------
    RecordingError
        If the recording has no reference, or no sample of it can be scored.
    """
    up = reference_up(recording)
    scored = recording.valid & np.isfinite(up).all(axis=1)
    if not scored.any():
        raise RecordingError(
            f"{recording.name}: none of its {len(recording)} samples is valid with a reference"
        )
    return Track(
        rate_rad_s=_rows(recording.angular_rate_rad_s),
        force_m_s2=_rows(recording.specific_force_m_s2),
        reference=_rows(np.where(scored[:, np.newaxis], up, [0.0, 0.0, 1.0])),
        scored=np.ascontiguousarray(scored),
    )


def _rows(array: NDArray[Any]) -> Vector:
    return np.array(array, dtype=np.float64, order="C")
