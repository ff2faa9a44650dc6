"""What both file formats hold before it becomes a recording: named arrays and texts."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hostkit.attitude import up_from_quaternion, up_from_tilt
from hostkit.errors import RecordingError
from hostkit.recordings.recording import MIN_SAMPLES, Recording, Vector

MICROSECONDS_PER_SECOND = 1e6


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Table:
    """The content of a recording file, by meaning, before it is checked.

    Shapes are those of `Recording`; `quaternion_wxyz` is ``(N, 4)`` and `tilt_rad` ``(N, 2)``,
    roll then pitch. Exactly one of `time_s` and `time_us` is given.
    """

    angular_rate_rad_s: Vector
    specific_force_m_s2: Vector
    time_s: Vector | None = None
    time_us: Vector | None = None
    rate_hz: float | None = None
    quaternion_wxyz: Vector | None = None
    tilt_rad: Vector | None = None
    mag_ut: Vector | None = None
    temperature_deg_c: Vector | None = None
    valid: Vector | None = None
    texts: Mapping[str, str]


def to_recording(table: Table, *, name: str, sha256: str) -> Recording:
    """Make a recording from the content of a file.

    Raises
    ------
    RecordingError
        If there are fewer than two samples, two or no time columns, or `valid` is not 0 or 1.
    """
    time_s = _time(table)
    if time_s.size < MIN_SAMPLES:
        raise RecordingError(
            f"it has {time_s.size} sample(s); a recording needs at least {MIN_SAMPLES}"
        )
    return Recording(
        name=name,
        time_s=time_s,
        rate_hz=_median_rate(time_s) if table.rate_hz is None else table.rate_hz,
        angular_rate_rad_s=table.angular_rate_rad_s,
        specific_force_m_s2=table.specific_force_m_s2,
        valid=_valid(table.valid, time_s.size),
        up_reference=_up_reference(table),
        mag_ut=table.mag_ut,
        temperature_deg_c=table.temperature_deg_c,
        sensor=table.texts.get("sensor", ""),
        origin=table.texts.get("origin", ""),
        licence=table.texts.get("licence", ""),
        sha256=sha256,
    )


def _time(table: Table) -> Vector:
    if table.time_s is not None and table.time_us is not None:
        raise RecordingError("it has both time_s and time_us; keep one of them")
    if table.time_us is not None:
        return table.time_us / MICROSECONDS_PER_SECOND
    if table.time_s is None:
        raise RecordingError("it has neither time_s nor time_us")
    return table.time_s


def _median_rate(time_s: Vector) -> float:
    """Return the rate of the median time step to nine digits, NaN if it makes none."""
    step_s = float(np.median(np.diff(time_s)))
    return float(f"{1.0 / step_s:.9g}") if step_s > 0.0 else float("nan")


def _valid(flags: Vector | None, samples: int) -> NDArray[np.bool_]:
    if flags is None:
        return np.ones(samples, dtype=np.bool_)
    wrong = np.flatnonzero(~np.isin(flags, (0.0, 1.0)))
    if wrong.size:
        row = int(wrong[0])
        raise RecordingError(f"row {row + 1}: valid = {flags.flat[row]:g}; it must be 0 or 1")
    return flags.astype(np.bool_)


def _up_reference(table: Table) -> Vector | None:
    if table.quaternion_wxyz is not None and table.tilt_rad is not None:
        raise RecordingError("it has the reference twice, as quaternion and as tilt; keep one")
    if table.quaternion_wxyz is not None:
        return up_from_quaternion(table.quaternion_wxyz)
    if table.tilt_rad is None:
        return None
    up = up_from_tilt(table.tilt_rad[:, 0], table.tilt_rad[:, 1])
    up[np.isnan(up).any(axis=1)] = np.nan
    return up
