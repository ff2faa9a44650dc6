"""A recording ready to be solved: cut at its gaps, readings put right, doubtful rates marked."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hostkit.errors import RecordingError
from hostkit.recordings import Recording
from hostkit.recordings.sanity.clipping import BLURRED, NARROWEST_GYRO_RAD_S, clips
from hostkit.smoothing.known import KnownSensor
from hostkit.smoothing.settings import SmootherSettings
from hostkit.smoothing.smoother import Prepared, fewest_samples, prepare
from hostkit.smoothing.stretches import LONGEST_GAP_S, Stretch, stretches

ANY_SENSOR = KnownSensor()


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PreparedPiece:
    """A stretch of a recording without gaps, and its readings as blocks."""

    stretch: Stretch
    prepared: Prepared


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PreparedRecording:
    """The pieces of a recording, and the rows between gaps that are too few."""

    pieces: tuple[PreparedPiece, ...]
    short: tuple[slice, ...]


def prepare_recording(
    recording: Recording, settings: SmootherSettings, known: KnownSensor = ANY_SENSOR
) -> PreparedRecording:
    """Cut a recording at its gaps and gather its readings in blocks.

    Raises
    ------
    RecordingError
        If no piece is long enough.
    """
    clipped = _clipped(recording, known)
    parts = stretches(recording.time_s)
    long = [p for p in parts if len(p.grid_s) >= fewest_samples(settings, p.period_s)]
    if not long:
        raise _too_short(recording, parts, settings)
    return PreparedRecording(
        pieces=tuple(
            PreparedPiece(stretch=p, prepared=_prepared(recording, p, clipped, settings, known))
            for p in long
        ),
        short=tuple(part.rows for part in parts if part not in long),
    )


def _prepared(
    recording: Recording,
    part: Stretch,
    clipped: NDArray[np.bool_],
    settings: SmootherSettings,
    known: KnownSensor,
) -> Prepared:
    return prepare(
        part.at_grid(known.correction.rate_rad_s(recording.angular_rate_rad_s[part.rows])),
        part.at_grid(known.correction.force_m_s2(recording.specific_force_m_s2[part.rows])),
        part.period_s,
        settings,
        part.doubted | part.any_at_grid(clipped[part.rows]),
    )


def _clipped(recording: Recording, known: KnownSensor) -> NDArray[np.bool_]:
    """Return which readings are at the end of the range, of the design or of the recording."""
    rate = recording.angular_rate_rad_s
    found = np.any(np.abs(rate) >= known.gyro_full_scale_rad_s, axis=1)
    for clip in clips(rate, NARROWEST_GYRO_RAD_S):
        outward = np.sign(clip.value) * rate[:, clip.axis]
        found |= outward >= (1.0 - BLURRED.width) * abs(clip.value)
    return np.asarray(found)


def _too_short(
    recording: Recording, parts: tuple[Stretch, ...], settings: SmootherSettings
) -> RecordingError:
    longest = max(parts, key=lambda part: len(part.grid_s))
    needed_s = fewest_samples(settings, longest.period_s) * longest.period_s
    length_s = len(longest.grid_s) * longest.period_s
    return RecordingError(
        f"recording {recording.name!r} has {len(parts)} piece(s) between gaps, the longest of "
        f"{length_s:.3g} s; smoothing takes {needed_s:.3g} s without a gap of more than "
        f"{LONGEST_GAP_S:g} s. If the rows came in bursts, import with --resample HZ"
    )
