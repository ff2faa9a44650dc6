"""Loading and saving recordings, by the suffix of the file."""

import hashlib
from pathlib import Path

from hostkit.errors import RecordingError
from hostkit.files import write_aside
from hostkit.recordings.csv_file import parse_csv, render_csv
from hostkit.recordings.npz_file import parse_npz, render_npz
from hostkit.recordings.recording import Recording
from hostkit.recordings.sanity.soundness import require_sound
from hostkit.recordings.table import to_recording

SUFFIXES = (".csv", ".npz")


def load(path: Path) -> Recording:
    """Read a recording and refuse one that cannot be right.

    Parameters
    ----------
    path
        A ``.csv`` or ``.npz`` file in the layout of ``docs/recordings.md``.

    Raises
    ------
    RecordingError
        If the file cannot be read, is not in the layout, or has a hard fault: missing columns,
        values that are not finite, time that does not rise, or units that cannot be.
    """
    suffix = require_suffix(path)
    try:
        content = path.read_bytes()
    except OSError as error:
        raise RecordingError(f"{path} cannot be read: {error.strerror or error}") from error
    try:
        table = parse_csv(content) if suffix == ".csv" else parse_npz(content)
        digest = hashlib.sha256(content).hexdigest()
        recording = to_recording(table, name=path.stem, sha256=digest)
        require_sound(recording)
    except RecordingError as error:
        raise RecordingError(f"{path}: {error}") from error
    return recording


def save(recording: Recording, path: Path) -> None:
    """Write a recording: everything in it but its name and the digest.

    Times and measured values come back to the last bit. The reference is written as roll and
    pitch and comes back within 1e-15.

    Raises
    ------
    RecordingError
        If the suffix is neither ``.csv`` nor ``.npz``.
    HostkitError
        If the file cannot be written.
    """
    suffix = require_suffix(path)
    write_aside(path, render_csv(recording) if suffix == ".csv" else render_npz(recording))


def require_suffix(path: Path) -> str:
    """Return the suffix of a recording file in small letters.

    Raises
    ------
    RecordingError
        If it is not one that hostkit reads and writes.
    """
    suffix = path.suffix.lower()
    if suffix not in SUFFIXES:
        raise RecordingError(
            f"{path} ends in {suffix or 'no suffix'}; recordings end in {' or '.join(SUFFIXES)}"
        )
    return suffix
