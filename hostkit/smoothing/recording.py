"""A recording smoothed: cut at its gaps, put right, smoothed piece by piece, and scored."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from hostkit.attitude import inclination_rad, pitch_from_up, roll_from_up, to_body, wrap_rad
from hostkit.errors import RecordingError
from hostkit.mounting import Mounting
from hostkit.recordings import Recording
from hostkit.recordings.sanity.clipping import BLURRED, NARROWEST_GYRO_RAD_S, clips
from hostkit.records import AXES, AxisChoice
from hostkit.smoothing.known import KnownSensor
from hostkit.smoothing.rotation import Array
from hostkit.smoothing.settings import HIGHEST, SmootherSettings
from hostkit.smoothing.smoother import Smoothed, fewest_samples, smooth
from hostkit.smoothing.stretches import Stretch, stretches

ORIGIN = "reference smoothed by hostkit"
"""Stands in the origin of a recording whose reference is no measured one."""
ANY_SENSOR = KnownSensor()


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
    doubted_samples
        Samples whose rate was not believed: clipped, or put into a short gap.
    """

    up: Array
    pieces: tuple[Piece, ...]
    short: tuple[slice, ...]
    resampled: bool
    doubted_samples: int


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
    base = _settings(settings, known)
    clipped = _clipped(recording, known)
    up = np.full((len(recording), 3), np.nan)
    pieces: list[Piece] = []
    short: list[slice] = []
    parts = stretches(recording.time_s)
    doubted = 0
    for part in parts:
        if len(part.grid_s) < fewest_samples(base, part.period_s):
            short.append(part.rows)
            continue
        unknown = part.doubted | _near(part, clipped)
        found = smooth(
            part.at_grid(known.rate_rad_s(recording.angular_rate_rad_s[part.rows])),
            part.at_grid(known.force_m_s2(recording.specific_force_m_s2[part.rows])),
            part.period_s,
            base,
            automatic=settings is None,
            doubted=unknown,
        )
        doubted += int(unknown.sum())
        up[part.rows] = part.at_rows(found.up)
        pieces.append(Piece(rows=part.rows, smoothed=found))
    if not pieces:
        raise _too_short(recording, parts, base)
    return SmoothedRecording(
        up=up,
        pieces=tuple(pieces),
        short=tuple(short),
        resampled=not all(part.is_even for part in parts),
        doubted_samples=doubted,
    )


def _settings(settings: SmootherSettings | None, known: KnownSensor) -> SmootherSettings:
    """Return settings with the lead of the design; readings are judged for clipping as they are."""
    base = SmootherSettings() if settings is None else settings
    return base if known.lead_s is None else replace(base, lead_s=known.lead_s)


def _clipped(recording: Recording, known: KnownSensor) -> NDArray[np.bool_]:
    """Return which readings are at the end of the range, of the design or of the recording."""
    rate = recording.angular_rate_rad_s
    found = np.any(np.abs(rate) >= min(known.gyro_full_scale_rad_s, HIGHEST), axis=1)
    for clip in clips(rate, NARROWEST_GYRO_RAD_S):
        outward = np.sign(clip.value) * rate[:, clip.axis]
        found |= outward >= (1.0 - BLURRED.width) * abs(clip.value)
    return np.asarray(found)


def _near(part: Stretch, clipped: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Return which points of the grid rest on a clipped row."""
    rows = clipped[part.rows]
    if part.is_even or not rows.any():
        return rows if part.is_even else np.zeros(len(part.grid_s), dtype=np.bool_)
    return np.asarray(np.interp(part.grid_s, part.time_s, rows.astype(np.float64)) > 0.0)


def _too_short(
    recording: Recording, parts: tuple[Stretch, ...], settings: SmootherSettings
) -> RecordingError:
    longest = max(parts, key=lambda part: len(part.grid_s))
    needed_s = fewest_samples(settings, longest.period_s) * longest.period_s
    length_s = len(longest.grid_s) * longest.period_s
    return RecordingError(
        f"recording {recording.name!r} has {len(parts)} piece(s) between gaps, the longest of "
        f"{length_s:.3g} s; smoothing takes {needed_s:.3g} s without a gap of "
        "more than 0.25 s. If the rows came in bursts, import with --resample HZ"
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
