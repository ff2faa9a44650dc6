"""Recordings as CSV: a header with units, one row per sample, texts in comment lines."""

import csv
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from hostkit.attitude import pitch_from_up, roll_from_up
from hostkit.errors import RecordingError
from hostkit.recordings.csv_numbers import parse_numbers
from hostkit.recordings.names import require_names, require_whole, time_name
from hostkit.recordings.recording import Recording, Vector
from hostkit.recordings.table import Table

TIMES = ("time_s", "time_us")
GYRO = ("gyro_x_rad_s", "gyro_y_rad_s", "gyro_z_rad_s")
ACCEL = ("accel_x_m_s2", "accel_y_m_s2", "accel_z_m_s2")
MAG = ("mag_x_ut", "mag_y_ut", "mag_z_ut")
TILT = ("ref_roll_rad", "ref_pitch_rad")
QUATERNION = ("ref_qw", "ref_qx", "ref_qy", "ref_qz")
MAY_BE_EMPTY = (*MAG, *TILT, *QUATERNION, "temp_c")
KNOWN = (*TIMES, *GYRO, *ACCEL, *MAY_BE_EMPTY, "valid")
TEXTS = ("sensor", "origin", "licence")


def parse_csv(content: bytes) -> Table:
    """Read the bytes of a CSV recording.

    Raises
    ------
    RecordingError
        If the text is not UTF-8, columns are missing or doubled, or a value is not a number.
    """
    lines = _decode(content).splitlines()
    rows = [n for n, line in enumerate(lines) if line.strip() and not line.startswith("#")]
    if not rows:
        raise RecordingError("it is empty: it has no header line")
    header = _header(lines[rows[0]])
    wanted = [name for name in header if name in KNOWN]
    values = parse_numbers(lines, rows[1:], header, wanted, MAY_BE_EMPTY)
    return _table(wanted, values, dict(_comments(lines)))


def _table(names: Sequence[str], values: Vector, texts: dict[str, str]) -> Table:
    def group(wanted: tuple[str, ...]) -> Vector:
        return values[:, [names.index(name) for name in wanted]]

    def one(name: str) -> Vector | None:
        return values[:, names.index(name)] if name in names else None

    return Table(
        angular_rate_rad_s=group(GYRO),
        specific_force_m_s2=group(ACCEL),
        time_s=one("time_s"),
        time_us=one("time_us"),
        rate_hz=_rate(texts.get("rate_hz")),
        quaternion_wxyz=group(QUATERNION) if QUATERNION[0] in names else None,
        tilt_rad=group(TILT) if TILT[0] in names else None,
        mag_ut=group(MAG) if MAG[0] in names else None,
        temperature_deg_c=one("temp_c"),
        valid=one("valid"),
        texts=texts,
    )


def _decode(content: bytes) -> str:
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise RecordingError(
            f"byte {error.start} is not UTF-8 text; save the file as UTF-8 (or ASCII) CSV"
        ) from error


def _header(line: str) -> list[str]:
    header = [name.strip() for name in next(csv.reader([line]))]
    if len(header) == 1:
        raise RecordingError(
            f"its header {line[:60]!r} has one column; columns are separated by commas"
        )
    doubled = sorted({name for name in header if header.count(name) > 1 and name in KNOWN})
    if doubled:
        raise RecordingError(f"the column(s) {', '.join(doubled)} stand twice in the header")
    require_names(header, (time_name(header, "column"), *GYRO, *ACCEL), "column")
    for group in (MAG, TILT, QUATERNION):
        require_whole(header, group, "column")
    return header


def _comments(lines: Sequence[str]) -> list[tuple[str, str]]:
    pairs = [line[1:].partition(":") for line in lines if line.startswith("#")]
    return [(key.strip().lower(), text.strip()) for key, colon, text in pairs if colon]


def _rate(text: str | None) -> float | None:
    if text is None:
        return None
    try:
        return float(text)
    except ValueError:
        raise RecordingError(f"the comment 'rate_hz: {text[:40]}' is not a number") from None


def render_csv(recording: Recording) -> str:
    """Return the text of a recording; every number in the fewest digits that give it back."""
    names, columns = _columns(recording)
    flags = recording.valid.astype(np.int64).tolist()
    rows = zip(*(map(repr, column.tolist()) for column in columns), map(str, flags), strict=True)
    head = [f"# {key}: {_one_line(getattr(recording, key))}" for key in TEXTS]
    head += [f"# rate_hz: {recording.rate_hz!r}", ",".join((*names, "valid"))]
    return "\n".join((*head, *map(",".join, rows), ""))


def _columns(recording: Recording) -> tuple[list[str], list[NDArray[np.float64]]]:
    names, columns = ["time_s", *GYRO, *ACCEL], [recording.time_s]
    columns += [*recording.angular_rate_rad_s.T, *recording.specific_force_m_s2.T]
    if recording.mag_ut is not None:
        names += MAG
        columns += [*recording.mag_ut.T]
    if recording.temperature_deg_c is not None:
        names.append("temp_c")
        columns.append(recording.temperature_deg_c)
    if recording.up_reference is not None:
        names += TILT
        columns += [roll_from_up(recording.up_reference), pitch_from_up(recording.up_reference)]
    return names, columns


def _one_line(text: str) -> str:
    return " ".join(text.split())
