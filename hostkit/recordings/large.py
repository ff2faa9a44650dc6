"""Recordings that do not fit the memory: an ``.npz`` file read part by part."""

import functools
import hashlib
import math
import zipfile
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from hostkit.errors import RecordingError
from hostkit.recordings.names import require_names, time_name
from hostkit.recordings.npy_member import Member, open_member
from hostkit.recordings.npz_file import TEXTS, UNREADABLE, WIDTHS
from hostkit.recordings.recording import MIN_SAMPLES, Recording
from hostkit.recordings.sanity.soundness import require_sound
from hostkit.recordings.table import Table, to_recording

LARGE_SAMPLES = 2_000_000
"""From so many samples on a recording is read part by part; as a whole it would take 0.5 GB."""

PART_SAMPLES = 200_000
HASH_BYTES = 2**20
NEEDED = ("gyro_rad_s", "accel_m_s2")
KEPT = ("time_s", "time_us", *NEEDED, "ref_quat_wxyz", "ref_tilt_rad", "valid")
"""Arrays that are read: what tuning asks for."""


@dataclass(frozen=True, slots=False, kw_only=True)
class LargeRecording:
    """A recording on disk.

    Attributes
    ----------
    path, name
        The ``.npz`` file, and its name without folder and suffix.
    samples
        Number of samples that its arrays say they hold; each part is checked when it is read.
    rate_hz
        Nominal sample rate.
    """

    path: Path
    name: str
    samples: int
    rate_hz: float

    def __len__(self) -> int:
        return self.samples

    @functools.cached_property
    def sha256(self) -> str:
        """Digest of the bytes of the file, hexadecimal."""
        digest = hashlib.sha256()
        with self.path.open("rb") as stream:
            while block := stream.read(HASH_BYTES):
                digest.update(block)
        return digest.hexdigest()

    @functools.cached_property
    def head(self) -> Recording:
        """The first samples, as a recording of their own."""
        return next(self.parts())

    @functools.cached_property
    def largest(self) -> tuple[float, float]:
        """Largest angular rate, rad/s, and specific force, m/s^2, on any axis."""
        with _open_members(self, NEEDED) as members:
            rate, force = (_largest(member, self.samples) for member in members.values())
        return rate, force

    def parts(self) -> Iterator[Recording]:
        """Yield the recording in parts of at least two samples, each checked.

        The units are checked on the first part only.

        Raises
        ------
        RecordingError
            If the file is damaged or a part has a hard fault.
        """
        with _open_members(self, KEPT) as members:
            yield from _parts(self, members)


def open_large(path: Path) -> LargeRecording | None:
    """Return a recording to be read part by part, or None if it fits the memory.

    Raises
    ------
    RecordingError
        If the file is no ``.npz`` recording, or an array claims another size than it holds.
    """
    if path.suffix.lower() != ".npz":
        return None
    try:
        with zipfile.ZipFile(path) as archive:
            return _open(path, archive)
    except UNREADABLE as error:
        raise RecordingError(f"{path} is not an .npz file or is damaged: {error}") from error


def _open(path: Path, archive: zipfile.ZipFile) -> LargeRecording | None:
    names = {name.removesuffix(".npy") for name in archive.namelist()}
    time = time_name(names, "array")
    if time not in names:
        return None
    with open_member(archive, time) as member:
        samples = member.shape[0] if member.shape else 0
    if samples < LARGE_SAMPLES:
        return None
    require_names(names, (time, *NEEDED), "array")
    return LargeRecording(
        path=path, name=path.stem, samples=samples, rate_hz=_rate(archive, names, time)
    )


def _rate(archive: zipfile.ZipFile, names: set[str], time: str) -> float:
    if "rate_hz" in names:
        with open_member(archive, "rate_hz") as member:
            return float(member.read(1).reshape(-1)[0])
    with open_member(archive, time) as member:
        steps = np.diff(member.read(PART_SAMPLES).astype(np.float64))
    step_s = float(np.median(steps)) * (1e-6 if time == "time_us" else 1.0)
    return float(f"{1.0 / step_s:.9g}") if step_s > 0.0 else math.nan


@contextmanager
def _open_members(
    recording: LargeRecording, wanted: tuple[str, ...]
) -> Iterator[dict[str, Member]]:
    """Open those arrays of a file that it has."""
    try:
        with ExitStack() as stack:
            archive = stack.enter_context(zipfile.ZipFile(recording.path))
            names = {name.removesuffix(".npy") for name in archive.namelist()}
            members = {
                name: stack.enter_context(open_member(archive, name))
                for name in wanted
                if name in names
            }
            _require_shapes(recording, members)
            yield members
    except UNREADABLE as error:
        raise RecordingError(f"{recording.path}: it is damaged: {error}") from error


def _largest(member: Member, samples: int) -> float:
    parts = (member.read(end - begin) for begin, end in _ranges(samples))
    return max(float(np.abs(part.astype(np.float64)).max()) for part in parts)


def _parts(recording: LargeRecording, members: dict[str, Member]) -> Iterator[Recording]:
    before_s = -math.inf
    for begin, end in _ranges(recording.samples):
        part = _part(recording, members, begin, end)
        if part.time_s[0] <= before_s:
            raise RecordingError(
                f"{recording.path}: row {begin + 1}: time {part.time_s[0]:.6f} s is not after "
                f"the row before it, at {before_s:.6f} s"
            )
        before_s = float(part.time_s[-1])
        yield part


def _ranges(samples: int) -> Iterator[tuple[int, int]]:
    """Cut into parts; a last one that is too short for a recording goes with the one before."""
    begin = 0
    while begin < samples:
        end = begin + PART_SAMPLES
        end = samples if samples - end < MIN_SAMPLES else end
        yield begin, end
        begin = end


def _part(recording: LargeRecording, members: dict[str, Member], begin: int, end: int) -> Recording:
    arrays = {name: member.read(end - begin) for name, member in members.items()}

    def values(name: str) -> NDArray[np.float64] | None:
        return None if name not in arrays else arrays[name].astype(np.float64)

    rate, force = values("gyro_rad_s"), values("accel_m_s2")
    assert rate is not None
    assert force is not None
    table = Table(
        angular_rate_rad_s=rate,
        specific_force_m_s2=force,
        time_s=values("time_s"),
        time_us=values("time_us"),
        rate_hz=recording.rate_hz,
        quaternion_wxyz=values("ref_quat_wxyz"),
        tilt_rad=values("ref_tilt_rad"),
        valid=values("valid"),
        texts=dict.fromkeys(TEXTS, ""),
    )
    try:
        part = to_recording(table, name=recording.name, sha256="")
        require_sound(part, units=begin == 0)
    except RecordingError as error:
        raise RecordingError(
            f"{recording.path}: in the rows {begin + 1} to {end}, counted from there: {error}"
        ) from error
    return part


def _require_shapes(recording: LargeRecording, members: dict[str, Member]) -> None:
    for name, member in members.items():
        width = WIDTHS[name]
        expected = (recording.samples, width) if width else (recording.samples,)
        if member.shape != expected:
            raise RecordingError(
                f"{recording.path}: {name} has shape {member.shape}; with {recording.samples} "
                f"times it must be {expected}"
            )
        if member.dtype.kind not in "biuf":
            raise RecordingError(f"{recording.path}: {name} holds {member.dtype}, not numbers")
