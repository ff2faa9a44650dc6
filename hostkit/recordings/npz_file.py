"""Recordings as ``.npz``: the arrays of a recording in a zip file, read without trust."""

import io
import zipfile
import zlib
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from hostkit.attitude import pitch_from_up, roll_from_up
from hostkit.errors import RecordingError
from hostkit.recordings.names import require_names, time_name
from hostkit.recordings.npy_member import read_member
from hostkit.recordings.recording import Recording, Vector
from hostkit.recordings.table import Table

WIDTHS = {
    "time_s": 0,
    "time_us": 0,
    "gyro_rad_s": 3,
    "accel_m_s2": 3,
    "mag_ut": 3,
    "ref_quat_wxyz": 4,
    "ref_tilt_rad": 2,
    "temp_c": 0,
    "valid": 0,
}
"""Columns of each array; 0 for one of shape ``(N,)``."""

TEXTS = ("sensor", "origin", "licence")
ZIP_DATE = (1980, 1, 1, 0, 0, 0)
UNREADABLE = (
    zipfile.BadZipFile,
    zlib.error,
    ValueError,
    EOFError,
    OSError,
    KeyError,
    NotImplementedError,
    RuntimeError,
    OverflowError,
    MemoryError,
)
"""What the zip and npy readers raise on damaged files."""


def parse_npz(content: bytes) -> Table:
    """Read the bytes of an ``.npz`` recording; pickled objects are never loaded.

    Raises
    ------
    RecordingError
        If the file is damaged, claims more than it holds, or arrays are missing or have the
        wrong type or shape.
    """
    arrays = _members(content)
    require_names(arrays, (time_name(arrays, "array"), "gyro_rad_s", "accel_m_s2"), "array")
    _require_shapes(arrays)
    return Table(
        angular_rate_rad_s=_numbers(arrays, "gyro_rad_s"),
        specific_force_m_s2=_numbers(arrays, "accel_m_s2"),
        time_s=_optional(arrays, "time_s"),
        time_us=_optional(arrays, "time_us"),
        rate_hz=_rate(arrays),
        quaternion_wxyz=_optional(arrays, "ref_quat_wxyz"),
        tilt_rad=_optional(arrays, "ref_tilt_rad"),
        mag_ut=_optional(arrays, "mag_ut"),
        temperature_deg_c=_optional(arrays, "temp_c"),
        valid=_optional(arrays, "valid"),
        texts={key: _text(arrays, key) for key in TEXTS},
    )


def _members(content: bytes) -> dict[str, NDArray[np.generic]]:
    wanted = {*WIDTHS, *TEXTS, "rate_hz"}
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            names = [name.removesuffix(".npy") for name in archive.namelist()]
            found: dict[str, NDArray[np.generic]] = dict.fromkeys(names, np.empty(0))
            for name in wanted.intersection(names):
                found[name] = read_member(archive, name)
            return found
    except UNREADABLE as error:
        raise RecordingError(f"it is not an .npz file or is damaged: {error}") from error


def _require_shapes(arrays: Mapping[str, NDArray[np.generic]]) -> None:
    time = "time_us" if "time_us" in arrays else "time_s"
    samples = arrays[time].size
    for name, width in WIDTHS.items():
        expected = (samples, width) if width else (samples,)
        if name in arrays and arrays[name].shape != expected:
            raise RecordingError(
                f"{name} has shape {arrays[name].shape}; with {samples} values in {time} it must "
                f"be {expected}"
            )


def _numbers(arrays: Mapping[str, NDArray[np.generic]], name: str) -> Vector:
    array = arrays[name]
    if array.dtype.kind not in "biuf":
        raise RecordingError(f"{name} holds {array.dtype}, not real numbers")
    return array.astype(np.float64)


def _optional(arrays: Mapping[str, NDArray[np.generic]], name: str) -> Vector | None:
    return _numbers(arrays, name) if name in arrays else None


def _rate(arrays: Mapping[str, NDArray[np.generic]]) -> float | None:
    if "rate_hz" not in arrays:
        return None
    rate = _numbers(arrays, "rate_hz")
    if rate.size != 1:
        raise RecordingError(f"rate_hz has shape {rate.shape}; it must be one number")
    return float(rate.item())


def _text(arrays: Mapping[str, NDArray[np.generic]], name: str) -> str:
    array = arrays.get(name)
    if array is None:
        return ""
    if array.size != 1 or array.dtype.kind not in "US":
        raise RecordingError(f"{name} holds {array.dtype} of shape {array.shape}, not one text")
    value = array.item()
    return value.decode("utf-8", "replace") if isinstance(value, bytes) else str(value)


def render_npz(recording: Recording) -> bytes:
    """Return the bytes of a recording; the same recording gives the same bytes."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        for name, array in _arrays(recording).items():
            entry = zipfile.ZipInfo(f"{name}.npy", date_time=ZIP_DATE)
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.create_system = 3
            archive.writestr(entry, _npy(array))
    return buffer.getvalue()


def _npy(array: NDArray[np.generic]) -> bytes:
    buffer = io.BytesIO()
    np.lib.format.write_array(buffer, array, allow_pickle=False)
    return buffer.getvalue()


def _arrays(recording: Recording) -> dict[str, NDArray[np.generic]]:
    arrays: dict[str, NDArray[np.generic] | None] = {
        "time_s": recording.time_s,
        "rate_hz": np.asarray(recording.rate_hz),
        "gyro_rad_s": recording.angular_rate_rad_s,
        "accel_m_s2": recording.specific_force_m_s2,
        "mag_ut": recording.mag_ut,
        "temp_c": recording.temperature_deg_c,
        "ref_tilt_rad": _tilt(recording.up_reference),
        "valid": recording.valid,
    }
    arrays |= {key: np.asarray(getattr(recording, key)) for key in TEXTS}
    return {name: array for name, array in arrays.items() if array is not None}


def _tilt(up: Vector | None) -> Vector | None:
    return None if up is None else np.column_stack((roll_from_up(up), pitch_from_up(up)))
