"""From a foreign file to a recording: find the format, read, bring the reference to the samples."""

import hashlib
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from hostkit.errors import RecordingError
from hostkit.importers.decimate import decimated
from hostkit.importers.foreign import printable
from hostkit.importers.formats import find
from hostkit.importers.log import Importer, Progress, SensorLog, Vector, no_progress
from hostkit.importers.options import COMMON_OPTIONS, ImportOptions
from hostkit.importers.reference import up_at
from hostkit.importers.timebase import median_rate_hz, require_rising, resampled
from hostkit.recordings import Recording

DIGEST_SHOWN = 16
CHUNK_BYTES = 2**20
BURSTY = 1.2
"""A median rate that is this many times the mean one is said."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Imported:
    """A recording, the name of the format it came from, and what was concluded on the way."""

    recording: Recording
    format: str
    guessed: tuple[str, ...]


def import_recording(
    path: Path,
    options: ImportOptions,
    *,
    format_name: str | None = None,
    progress: Progress = no_progress,
) -> Imported:
    """Read a file of another format as a recording.

    Times start at 0 with the first sample. The recording is not checked yet: see
    `hostkit.recordings.check`.

    Parameters
    ----------
    path
        The file, or the folder of a rosbag2.
    options
        What the user said of it.
    format_name
        Name of the format; None to tell it from the content.
    progress
        Called now and then with how much is done and how much there is.

    Raises
    ------
    RecordingError
        If the file is damaged, lacks what a recording needs, or leaves something open that an
        option would settle; the message names the file.
    ToolMissingError
        If the library of the format is not installed.
    """
    importer = find(path, format_name)
    _require_known(importer, options)
    try:
        log = importer.read(path, options, progress)
        recording, guessed = to_recording(log, path, options)
    except RecordingError as error:
        raise RecordingError(f"{path} ({importer.name}): {printable(str(error))}") from error
    return Imported(
        recording=recording, format=importer.name, guessed=tuple(map(printable, guessed))
    )


def _require_known(importer: Importer, options: ImportOptions) -> None:
    strange = sorted(options.said() - COMMON_OPTIONS - importer.uses)
    if strange:
        takes = ", ".join(map(_option, sorted(importer.uses))) or "none of its own"
        raise RecordingError(
            f"{_option(strange[0])} says nothing about the format {importer.name}, which takes: "
            f"{takes}"
        )


def _option(field: str) -> str:
    return "--" + field.replace("_", "-")


def to_recording(
    log: SensorLog, path: Path, options: ImportOptions
) -> tuple[Recording, tuple[str, ...]]:
    """Make the recording of a log.

    Raises
    ------
    RecordingError
        If times repeat or fall, or too few samples are left.
    """
    if options.resample_hz is not None:
        log = resampled(log, options.resample_hz)
    require_rising(log.time_s)
    track = log.reference if options.reference else None
    valid = np.ones(log.time_s.size, dtype=np.bool_) if log.valid is None else log.valid
    recording = Recording(
        name=path.stem,
        time_s=log.time_s,
        rate_hz=median_rate_hz(log.time_s) if log.rate_hz is None else log.rate_hz,
        angular_rate_rad_s=log.angular_rate_rad_s,
        specific_force_m_s2=log.specific_force_m_s2,
        valid=valid,
        up_reference=None if track is None else up_at(track, log.time_s),
        mag_ut=log.mag_ut,
        temperature_deg_c=log.temperature_deg_c,
        sensor=log.sensor,
        origin=_origin(path),
        licence=log.licence,
    )
    guessed = log.guessed + (_bursty(log.time_s) if log.rate_hz is None else ())
    if options.decimate > 1:
        recording = decimated(recording, options.decimate)
    return recording, guessed


def _bursty(time_s: Vector) -> tuple[str, ...]:
    """Say so if the median step is far from the mean one: the nominal rate is then in doubt."""
    mean_hz = (time_s.size - 1) / float(time_s[-1] - time_s[0]) if time_s.size > 1 else np.nan
    median_hz = median_rate_hz(time_s)
    if not median_hz > BURSTY * mean_hz:
        return ()
    return (
        f"the rate is {median_hz:.4g} Hz by the median step and {mean_hz:.4g} Hz by the mean one; "
        f"if the rows came in bursts: --resample {mean_hz:.3g}",
    )


def _origin(path: Path) -> str:
    """Return the name of the source and, of a file, the digest of its bytes."""
    if not path.is_file():
        return f"imported from {path.name}"
    digest = hashlib.sha256()
    with path.open("rb") as stream:
        while chunk := stream.read(CHUNK_BYTES):
            digest.update(chunk)
    return f"imported from {path.name}, sha256 {digest.hexdigest()[:DIGEST_SHOWN]}"
