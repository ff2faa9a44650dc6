"""Scoring a design on recordings: what the device would say, held against the reference."""

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from hostkit.attitude import apart_rad, inclination_rad, up_from_tilt, wrap_rad
from hostkit.errors import RecordingError
from hostkit.filters import FILTERS
from hostkit.recordings import LargeRecording, Recording
from hostkit.records import AXES, FilterDesign, read_only
from hostkit.sensors import SENSORS
from hostkit.sensors.counts import at_full_scale, to_counts, to_rate_and_force_g
from hostkit.tuning.reference import reference_rad
from hostkit.units import RAD_PER_HALF_TURN_LSB

Vector = NDArray[np.float64]
Quantity = Literal["roll", "pitch", "inclination"]
QUANTITIES: tuple[Quantity, ...] = ("roll", "pitch", "inclination")

RATE_TOLERANCE = 0.01
"""Relative difference between the rate of a recording and of a design that is let through."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Score:
    """Error of one quantity over the scored samples, in rad."""

    quantity: Quantity
    rms_rad: float
    max_rad: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Evaluation:
    """A design on one recording.

    Attributes
    ----------
    scores
        One for each axis of the design, and the inclination if it has both; empty without a
        reference.
    integer_vs_float_max_rad
        Largest difference between integer and float model on the same counts: of the angle, or of
        the up direction where the design has both angles.
    angle_rad
        Angles of the integer model, shape ``(N, A)``.
    reference_rad
        Reference angles, NaN where there is none, shape ``(N, A)``; or None.
    scored
        Samples that count, shape ``(N,)``.
    clipped_samples
        Samples with a reading beyond the design's full scale.
    """

    recording: str
    samples: int
    scored_samples: int
    scores: tuple[Score, ...]
    integer_vs_float_max_rad: float
    time_s: Vector
    angle_rad: Vector
    reference_rad: Vector | None
    scored: NDArray[np.bool_]
    clipped_samples: int

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        read_only(self.angle_rad)
        read_only(self.scored)

    def score(self, quantity: Quantity) -> Score | None:
        """Return the score of one quantity, or None where the design does not have it."""
        return next((s for s in self.scores if s.quantity == quantity), None)


def evaluate(design: FilterDesign, recording: Recording) -> Evaluation:
    """Run both models of a design on the counts its sensor would give, and score the integer one.

    Raises
    ------
    RecordingError
        If the recording's rate is not the design's within 1 %.
    """
    require_rate(design.rate_hz, recording)
    filter_, part = FILTERS[design.filter], SENSORS[design.sensor.part]
    counts = to_counts(
        part, design.sensor, recording.angular_rate_rad_s, recording.specific_force_m_s2
    )
    axes = len(AXES[design.axes])
    raw = filter_.run_integer(filter_.lower(design), counts.accel, counts.gyro)[:, :axes]
    angle = raw * RAD_PER_HALF_TURN_LSB
    exact = filter_.run_float(design, *to_rate_and_force_g(part, design.sensor, counts))[:, :axes]
    reference, scored = _reference(design, recording)
    return Evaluation(
        recording=recording.name,
        samples=len(recording),
        scored_samples=int(scored.sum()),
        scores=() if reference is None else _scores(design, angle, reference, scored),
        integer_vs_float_max_rad=float(apart_rad(angle, exact).max()),
        time_s=recording.time_s,
        angle_rad=angle,
        reference_rad=reference,
        scored=scored,
        clipped_samples=int((at_full_scale(counts.accel) | at_full_scale(counts.gyro)).sum()),
    )


def require_rate(rate_hz: float, recording: Recording | LargeRecording) -> None:
    """Refuse a recording whose sample rate is not `rate_hz` within 1 %.

    Raises
    ------
    RecordingError
        With both rates.
    """
    if abs(recording.rate_hz / rate_hz - 1.0) > RATE_TOLERANCE:
        raise RecordingError(
            f"{recording.name} was sampled at {recording.rate_hz:g} Hz, the design is for "
            f"{rate_hz:g} Hz; a design holds for one rate only: tune at the rate of the recording"
        )


def mean_rms_rad(evaluations: tuple[Evaluation, ...], quantity: Quantity) -> float | None:
    """Return the mean over recordings of the RMSE, or None if no recording has it."""
    scores = [score for e in evaluations if (score := e.score(quantity)) is not None]
    return float(np.mean([score.rms_rad for score in scores])) if scores else None


def _reference(
    design: FilterDesign, recording: Recording
) -> tuple[Vector | None, NDArray[np.bool_]]:
    if recording.up_reference is None:
        return None, np.zeros(len(recording), dtype=np.bool_)
    columns = [reference_rad(recording, axis, design.mounting) for axis in AXES[design.axes]]
    reference = np.stack(columns, axis=-1)
    return reference, recording.valid & np.isfinite(reference).all(axis=1)


def _scores(
    design: FilterDesign, angle: Vector, reference: Vector, scored: NDArray[np.bool_]
) -> tuple[Score, ...]:
    if not scored.any():
        return ()
    residual = wrap_rad(angle - reference)[scored]
    scores = [_score(axis, residual[:, i]) for i, axis in enumerate(AXES[design.axes])]
    if len(scores) == 2:
        estimated = up_from_tilt(angle[scored, 0], angle[scored, 1])
        wanted = up_from_tilt(reference[scored, 0], reference[scored, 1])
        scores.append(_score("inclination", inclination_rad(estimated, wanted)))
    return tuple(scores)


def _score(quantity: Quantity, residual: Vector) -> Score:
    return Score(
        quantity=quantity,
        rms_rad=math.sqrt(float(np.mean(residual * residual))),
        max_rad=float(np.abs(residual).max()),
    )
