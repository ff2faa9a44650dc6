"""Writing a recording with its smoothed tilt, beside a measured reference or in place of none."""

import io
import zipfile
from dataclasses import replace
from pathlib import Path

import numpy as np

from hostkit import __version__
from hostkit.attitude import pitch_from_up, roll_from_up
from hostkit.files import write_aside
from hostkit.recordings import Recording, require_suffix
from hostkit.recordings.csv_file import render_csv
from hostkit.recordings.npz_file import ZIP_DATE, render_npz
from hostkit.smoothing.recording import ORIGIN, measured_reference
from hostkit.smoothing.rotation import Array

COLUMNS = ("smooth_roll_rad", "smooth_pitch_rad")
ARRAY = "smooth_tilt_rad"


def as_reference(recording: Recording, up: Array) -> Recording:
    """Return a recording whose reference is the smoothed tilt; its origin says so.

    Parameters
    ----------
    up
        Up direction in sensor axes, shape ``(N, 3)``; NaN where there is none.
    """
    origin = recording.origin.partition(ORIGIN)[0].rstrip("; ")
    said = f"{ORIGIN} {__version__}"
    return replace(recording, up_reference=up, origin=f"{origin}; {said}" if origin else said)


def save_smoothed(recording: Recording, up: Array, path: Path) -> None:
    """Write a recording with its smoothed tilt.

    Without a measured reference the smoothed one becomes the reference. With one, that stays, and
    the smoothed tilt stands in columns or in an array of its own.

    Parameters
    ----------
    up
        Up direction in sensor axes, shape ``(N, 3)``; NaN where there is none.

    Raises
    ------
    RecordingError
        If the suffix is neither ``.csv`` nor ``.npz``.
    HostkitError
        If the file cannot be written.
    """
    is_csv = require_suffix(path) == ".csv"
    if measured_reference(recording) is None:
        written = as_reference(recording, up)
        write_aside(path, render_csv(written) if is_csv else render_npz(written))
    else:
        tilt = np.column_stack((roll_from_up(up), pitch_from_up(up)))
        write_aside(path, _csv(recording, tilt) if is_csv else _npz(recording, tilt))


def _csv(recording: Recording, tilt_rad: Array) -> str:
    lines = render_csv(recording).splitlines()
    first = len(lines) - len(recording)
    lines[first - 1] = ",".join((lines[first - 1], *COLUMNS))
    rows = zip(lines[first:], tilt_rad.tolist(), strict=True)
    added = [f"{row},{roll!r},{pitch!r}" for row, (roll, pitch) in rows]
    return "\n".join((*lines[:first], *added, ""))


def _npz(recording: Recording, tilt_rad: Array) -> bytes:
    buffer = io.BytesIO(render_npz(recording))
    member = io.BytesIO()
    np.lib.format.write_array(member, tilt_rad, allow_pickle=False)
    with zipfile.ZipFile(buffer, "a") as archive:
        entry = zipfile.ZipInfo(f"{ARRAY}.npy", date_time=ZIP_DATE)
        entry.compress_type = zipfile.ZIP_DEFLATED
        entry.create_system = 3
        archive.writestr(entry, member.getvalue())
    return buffer.getvalue()
