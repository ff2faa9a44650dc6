"""Importer of RepoIMU's own CSV files, T-stick and pendulum.

Facts: A. Szczesna et al., "Reference Data Set for Accuracy Evaluation of Orientation Estimation
Algorithms for Inertial Motion Capture Systems", ICCVG 2016, and the files themselves. Cells are
separated by semicolons under two header lines; a row is time in s, the Vicon orientation w, x, y,
z, acceleration in m/s^2, angular rate in rad/s, and a normalised field. The paper says that the
axes of cameras and sensor are not aligned: the orientation starts as unity whatever the sensor's
attitude. So the camera world's up direction is found from the data, as the mean of the specific
force in that world: the accelerations of a motion that stays in one place average to nothing.
"""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from hostkit.errors import RecordingError
from hostkit.importers.csv_text import decode, read_lines
from hostkit.importers.foreign import head
from hostkit.importers.log import Importer, Progress, ReferenceTrack, SensorLog, Vector
from hostkit.importers.options import ImportOptions
from hostkit.importers.rotation import multiply, to_world
from hostkit.recordings.csv_numbers import parse_numbers

HEADER_WORDS = ("time", "vicon orientation", "imu acceleration", "imu gyroscope")
COLUMNS = (
    *("time", "vicon w", "vicon x", "vicon y", "vicon z"),
    *("acceleration x", "acceleration y", "acceleration z"),
    *("gyroscope x", "gyroscope y", "gyroscope z"),
    *("magnetometer x", "magnetometer y", "magnetometer z"),
)
ORIENTATION = COLUMNS[1:5]
READ = COLUMNS[:11]
MIN_MEAN_FORCE_M_S2 = 5.0
"""Shorter mean forces do not point up: the orientation does not belong to the samples."""


def sniff(path: Path) -> bool:
    """Tell whether the first line is the header of such a file."""
    return _is_header(decode_head(path))


def decode_head(path: Path) -> str:
    """Return the first line of a file, nothing if it is no text."""
    try:
        lines = decode(head(path)).splitlines()
    except RecordingError:
        return ""
    return lines[0] if lines else ""


def _is_header(line: str) -> bool:
    cells = [cell.strip().lower() for cell in line.split(";")]
    return all(any(cell.startswith(word) for cell in cells) for word in HEADER_WORDS)


def read(path: Path, options: ImportOptions, progress: Progress) -> SensorLog:
    """Read one trial.

    Raises
    ------
    RecordingError
        If it is not such a file, a row is damaged, or no up direction can be found.
    """
    values = _values(read_lines(path))
    progress(1, 1)
    time_s, force, rate = values[:, 0] - values[0, 0], values[:, 5:8], values[:, 8:11]
    track: ReferenceTrack | None = None
    said: tuple[str, ...] = ()
    if options.reference:
        attitude, up = _aligned(values[:, 1:5], force)
        track = ReferenceTrack(time_s=time_s.copy(), quaternion_wxyz=attitude)
        x, y, z = up
        said = (f"up in the camera's axes is ({x:.4f}, {y:.4f}, {z:.4f}): the mean force there",)
    return SensorLog(
        time_s=time_s,
        angular_rate_rad_s=rate,
        specific_force_m_s2=force,
        reference=track,
        valid=np.asarray(np.isfinite(values[:, 1:5]).all(axis=1)),
        sensor="Xsens MTi",
        guessed=(*said, "the magnetic field has no unit and is left out"),
    )


def _values(lines: Sequence[str]) -> Vector:
    if not lines or not _is_header(lines[0]):
        raise RecordingError(
            "its first line is not the header of a RepoIMU file: Time; Vicon Orientation; IMU "
            "Acceleration; IMU Gyroscope; IMU Magnetometer"
        )
    with_commas = [line.rstrip(";").replace(";", ",") for line in lines]
    rows = [number for number in range(2, len(lines)) if lines[number].strip()]
    return parse_numbers(with_commas, rows, COLUMNS, READ, ORIENTATION)


def _aligned(quaternion: Vector, force: Vector) -> tuple[Vector, Vector]:
    """Return attitudes in a world with z up, shape ``(N, 4)``, and up in the camera's axes."""
    norm = np.linalg.norm(quaternion, axis=1)
    known = np.abs(norm - 1.0) < 0.1
    if not known.any():
        raise RecordingError("no row has a Vicon orientation; --no-reference leaves it out")
    unit = np.where(known[:, None], quaternion / np.where(known, norm, 1.0)[:, None], np.nan)
    mean = to_world(unit[known], force[known]).mean(axis=0)
    length = float(np.linalg.norm(mean))
    if length < MIN_MEAN_FORCE_M_S2:
        raise RecordingError(
            f"the mean force in the camera's axes is {length:.3g} m/s^2, not about 9.81: the "
            "orientation does not belong to the samples; --no-reference leaves it out"
        )
    up = mean / length
    return multiply(np.tile(_raising(up), (len(unit), 1)), unit), up


def _raising(up: Vector) -> Vector:
    """Return the quaternion of the shortest rotation that brings a unit vector to z."""
    half = up + np.array((0.0, 0.0, 1.0))
    if np.linalg.norm(half) < 1e-9:
        return np.array((0.0, 1.0, 0.0, 0.0))
    half /= np.linalg.norm(half)
    return np.array((half[2], half[1], -half[0], 0.0))


IMPORTER = Importer(
    name="repoimu",
    title="trial of the RepoIMU data set",
    suffixes=(),
    sniff=sniff,
    read=read,
)
