"""A recording smoothed: cut at its gaps, put right, smoothed piece by piece, and scored."""

from dataclasses import dataclass

import numpy as np

from hostkit.attitude import inclination_rad, pitch_from_up, roll_from_up, to_body, wrap_rad
from hostkit.mounting import Mounting
from hostkit.recordings import Recording
from hostkit.records import AXES, AxisChoice
from hostkit.smoothing.known import KnownSensor
from hostkit.smoothing.pieces import ANY_SENSOR, prepare_recording
from hostkit.smoothing.rotation import Array
from hostkit.smoothing.settings import SmootherSettings
from hostkit.smoothing.smoother import Smoothed, solve

ORIGIN = "reference smoothed by hostkit"
"""Stands in the origin of a recording whose reference is no measured one."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Piece:
    """A stretch of a recording without gaps: its rows, and what was found there."""

    rows: slice
    smoothed: Smoothed


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SmoothedRecording:
    """The tilt of a recording.

    Attributes
    ----------
    up
        Up direction in sensor axes, shape ``(N, 3)``; NaN where no tilt could be found.
    pieces
        What was smoothed.
    short
        Rows between gaps that are too few to smooth.
    resampled
        Whether times were so uneven that readings were interpolated.
    doubted_s
        Time whose rate was not believed: clipped, or in a short gap.
    """

    up: Array
    pieces: tuple[Piece, ...]
    short: tuple[slice, ...]
    resampled: bool
    doubted_s: float


@dataclass(frozen=True, slots=True, kw_only=True)
class SmoothingScore:
    """RMSE against a measured reference over so many samples; None where an axis is not asked."""

    samples: int
    inclination_rad: float | None
    roll_rad: float | None
    pitch_rad: float | None

    def headline_rad(self) -> float:
        """Return the one figure: the inclination, or the error of the only axis."""
        figures = (self.inclination_rad, self.roll_rad, self.pitch_rad)
        return next(figure for figure in figures if figure is not None)


def smooth_recording(
    recording: Recording,
    settings: SmootherSettings | None = None,
    known: KnownSensor = ANY_SENSOR,
) -> SmoothedRecording:
    """Return the tilt of a recording.

    Long gaps cut it, and each piece is smoothed by itself. Where times are uneven or a few
    samples are missing, readings are interpolated at even times and the tilt comes back to the
    times of the rows; what lies in a gap is not believed. Neither are rates at the full scale, be
    it told or seen in the recording.

    Parameters
    ----------
    settings
        None to let each piece choose its own.
    known
        What a design says of the sensor.

    Raises
    ------
    RecordingError
        If no piece is long enough, or one cannot be solved.
    """
    base = known.led(SmootherSettings() if settings is None else settings)
    prepared = prepare_recording(recording, base, known)
    up = np.full((len(recording), 3), np.nan)
    pieces: list[Piece] = []
    for piece in prepared.pieces:
        found = solve(piece.prepared, base, automatic=settings is None)
        up[piece.stretch.rows] = piece.stretch.at_rows(found.up)
        pieces.append(Piece(rows=piece.stretch.rows, smoothed=found))
    return SmoothedRecording(
        up=up,
        pieces=tuple(pieces),
        short=prepared.short,
        resampled=not all(piece.stretch.is_even for piece in prepared.pieces),
        doubted_s=sum(float(p.prepared.blocks.doubted_s.sum()) for p in prepared.pieces),
    )


def measured_reference(recording: Recording) -> Array | None:
    """Return the reference of a recording, None if there is none or it is a smoothed one."""
    return None if ORIGIN in recording.origin else recording.up_reference


def score(
    recording: Recording,
    up: Array,
    axes: AxisChoice = "both",
    mounting: Mounting = Mounting(),  # noqa: B008 - frozen
) -> SmoothingScore | None:
    """Return the error of up directions, shape ``(N, 3)``; None without a measured reference.

    Parameters
    ----------
    axes, mounting
        Angles that count, and how the sensor sits in the body whose angles they are.
    """
    reference = measured_reference(recording)
    if reference is None:
        return None
    keep = recording.valid & np.isfinite(reference).all(axis=1) & np.isfinite(up).all(axis=1)
    if not keep.any():
        return None
    ours, true = to_body(mounting, up[keep]), to_body(mounting, reference[keep])
    names = AXES[axes]
    return SmoothingScore(
        samples=int(keep.sum()),
        inclination_rad=_rms(inclination_rad(ours, true)) if axes == "both" else None,
        roll_rad=_angle_rms(roll_from_up(ours) - roll_from_up(true)) if "roll" in names else None,
        pitch_rad=(
            _angle_rms(pitch_from_up(ours) - pitch_from_up(true)) if "pitch" in names else None
        ),
    )


def _angle_rms(difference_rad: Array) -> float:
    return _rms(wrap_rad(difference_rad))


def _rms(error_rad: Array) -> float:
    return float(np.sqrt(np.mean(error_rad**2)))
