"""Importer of CSV and other text tables: Arduino sketches, phone apps, gyroflow, spreadsheets."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from hostkit.attitude import pitch_from_up, roll_from_up
from hostkit.errors import RecordingError
from hostkit.importers.csv_columns import NEEDED, Assignment, Column, assign
from hostkit.importers.csv_names import (
    ANGLE_UNITS,
    FIELD_UNITS,
    FORCE_UNITS,
    RATE_UNITS,
    TIME_UNITS,
)
from hostkit.importers.csv_text import TextTable, decode, parse_table, read_lines
from hostkit.importers.foreign import head
from hostkit.importers.log import Importer, Progress, ReferenceTrack, SensorLog, Vector
from hostkit.importers.options import ImportOptions
from hostkit.importers.rotation import from_euler
from hostkit.importers.timebase import unwrapped
from hostkit.importers.units import (
    TICKS_PER_S,
    Scale,
    force_scale,
    rate_scale,
    tilt_factor,
    time_unit,
)
from hostkit.recordings.csv_numbers import parse_numbers
from hostkit.units import STANDARD_GRAVITY_M_S2

FORCE, RATE, FIELD = ("ax", "ay", "az"), ("gx", "gy", "gz"), ("mx", "my", "mz")
QUATERNION, TILT = ("qw", "qx", "qy", "qz"), ("roll", "pitch")
MAY_BE_EMPTY = (*FIELD, *QUATERNION, *TILT, "temp")
TEMPERATURE_LIMITS_DEG_C = (-60.0, 150.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class _Numbers:
    """The numbers of the columns that are read."""

    columns: Assignment
    values: Vector

    def group(self, roles: Sequence[str]) -> Vector | None:
        """Return the columns of some roles, shape ``(N, len(roles))``, None if one is missing."""
        order = [column.role for column in self.columns.columns]
        if not set(roles) <= set(order):
            return None
        signs = {c.role: -1.0 if c.negated else 1.0 for c in self.columns.columns}
        places = [order.index(role) for role in roles]
        found: Vector = self.values[:, places] * np.array([signs[role] for role in roles])
        return found

    def needed(self, roles: Sequence[str]) -> Vector:
        """Return the columns of roles that are always there."""
        found = self.group(roles)
        assert found is not None
        return found


def sniff(path: Path) -> bool:
    """Tell whether a file is text with a line of six numbers."""
    try:
        lines = decode(head(path)).splitlines()
        parse_table(lines[:-1] if len(lines) > 1 else lines)
    except RecordingError:
        return False
    return True


def read(path: Path, options: ImportOptions, progress: Progress) -> SensorLog:
    """Read a text table.

    Raises
    ------
    RecordingError
        If it is no table of six or more columns, a cell is not a number, or a column or a unit
        cannot be told; the message says which option settles it.
    """
    table = parse_table(read_lines(path))
    progress(1, 3)
    columns = assign(table, options.columns, None if table.names else _all_numbers(table))
    numbers = _Numbers(columns=columns, values=_read(table, columns))
    progress(2, 3)
    time_s, said_time = _time(table, numbers, options)
    force, said_force = _force(table, numbers, options)
    rate, said_rate = _rate(table, numbers, options, time_s, force)
    reference, said_reference = _reference(numbers, options, time_s, force)
    field, said_field = _field(numbers)
    heat, said_heat = _temperature(numbers)
    progress(3, 3)
    said = (*table.remarks, *columns.guessed, said_time, said_force, said_rate)
    return SensorLog(
        time_s=time_s,
        angular_rate_rad_s=rate,
        specific_force_m_s2=force,
        rate_hz=options.rate_hz,
        reference=reference,
        mag_ut=field,
        temperature_deg_c=heat,
        valid=_valid(numbers),
        guessed=tuple(text for text in (*said, said_reference, said_field, said_heat) if text),
    )


def _all_numbers(table: TextTable) -> Vector:
    names = [f"column {place + 1}" for place in range(table.width)]
    return parse_numbers(table.lines, table.rows, names, names, names)


def _read(table: TextTable, columns: Assignment) -> Vector:
    """Read the wanted columns; what stands in others does not matter."""
    header = [f"{place + 1}" for place in range(table.width)]
    for column in columns.columns:
        header[column.place] = f"{column.place + 1} ({column.name[:40]})"
    wanted = [header[column.place] for column in columns.columns]
    empty = [header[c.place] for c in columns.columns if c.role in MAY_BE_EMPTY]
    return parse_numbers(table.lines, table.rows, header, wanted, empty)


def _time(table: TextTable, numbers: _Numbers, options: ImportOptions) -> tuple[Vector, str]:
    ticks = numbers.group(("t",))
    if ticks is None:
        if options.rate_hz is None:
            raise RecordingError(
                "it has no time column; say --rate-hz HZ, the rate at which it was sampled, or "
                "name the column: --columns t=NAME_OR_NUMBER"
            )
        return np.arange(len(numbers.values)) / options.rate_hz, ""
    told = TIME_UNITS.get(numbers.columns.unit(("t",)))
    scale = table.setting("tscale")
    stated = options.time_unit or told
    if stated is None and scale is not None and scale > 0.0:
        return (ticks[:, 0] - ticks[0, 0]) * scale, ""
    unit, said = time_unit(ticks[:, 0], stated)
    whole, turns = unwrapped(ticks[:, 0]) if unit in ("us", "ms") else (ticks[:, 0], 0)
    if turns:
        said = f"{said}; " if said else ""
        said += f"the 32-bit {unit} counter overflowed {turns} time(s) and goes on"
    return (whole - whole[0]) / TICKS_PER_S[unit], said


def _force(table: TextTable, numbers: _Numbers, options: ImportOptions) -> tuple[Vector, str]:
    values = _finite(numbers.needed(FORCE), "force")
    scale = table.setting("ascale")
    told = FORCE_UNITS.get(numbers.columns.unit(FORCE))
    stated = options.accel_unit or told
    if stated is None and options.accel_range is None and scale is not None:
        return values * scale * STANDARD_GRAVITY_M_S2, ""
    found = force_scale(values, stated, options.accel_range)
    return values * found.factor, found.guessed


def _rate(
    table: TextTable, numbers: _Numbers, options: ImportOptions, time_s: Vector, force: Vector
) -> tuple[Vector, str]:
    values = _finite(numbers.needed(RATE), "rate")
    scale = table.setting("gscale")
    told = RATE_UNITS.get(numbers.columns.unit(RATE))
    stated = options.gyro_unit or told
    if stated is None and options.gyro_range is None and scale is not None:
        return values * scale, ""
    found: Scale = rate_scale(time_s, values, force, stated, options.gyro_range)
    return values * found.factor, found.guessed


def _finite(values: Vector, name: str) -> Vector:
    wrong = np.argwhere(~np.isfinite(values))
    if len(wrong):
        row, axis = wrong[0]
        raise RecordingError(
            f"row {row + 1}: the {name} {'xyz'[axis]} is {values[row, axis]}; every sample needs "
            "it: leave such rows out"
        )
    return values


def _reference(
    numbers: _Numbers, options: ImportOptions, time_s: Vector, force: Vector
) -> tuple[ReferenceTrack | None, str]:
    quaternion, angles = numbers.group(QUATERNION), numbers.group(TILT)
    if not options.reference or (quaternion is None and angles is None):
        return None, ""
    if quaternion is None:
        assert angles is not None
        quaternion, said = _from_tilt(numbers, angles, options, force)
    else:
        said = ""
    taken = _taken(numbers, QUATERNION if numbers.group(QUATERNION) is not None else TILT)
    remark = f"the reference is {taken}; if that is the device's own filter: --no-reference"
    track = ReferenceTrack(time_s=time_s.copy(), quaternion_wxyz=quaternion)
    return track, f"{remark}; {said}" if said else remark


def _taken(numbers: _Numbers, roles: Sequence[str]) -> str:
    names = [c.name for c in map(numbers.columns.column, roles) if isinstance(c, Column)]
    return ", ".join(names)


def _from_tilt(
    numbers: _Numbers, angles: Vector, options: ImportOptions, force: Vector
) -> tuple[Vector, str]:
    told = ANGLE_UNITS.get(numbers.columns.unit(TILT))
    measured = np.column_stack((roll_from_up(force), pitch_from_up(force)))
    found = tilt_factor(angles, measured, options.angle_unit or told)
    if found is None:
        raise RecordingError(
            "the unit of the reference angles cannot be told from the force; say --angle-unit "
            "rad|deg, or --no-reference to leave them out"
        )
    factor, said = found
    roll, pitch = angles.T * factor
    return from_euler(roll, pitch, np.zeros_like(roll)), said


def _field(numbers: _Numbers) -> tuple[Vector | None, str]:
    values = numbers.group(FIELD)
    if values is None:
        return None, ""
    weight = FIELD_UNITS.get(numbers.columns.unit(FIELD))
    if weight is None:
        return None, "the magnetic field states no unit and is left out"
    return values * weight, ""


def _temperature(numbers: _Numbers) -> tuple[Vector | None, str]:
    values = numbers.group(("temp",))
    if values is None:
        return None, ""
    low, high = TEMPERATURE_LIMITS_DEG_C
    known = values[np.isfinite(values)]
    if known.size and (known.min() < low or known.max() > high):
        return None, "the temperature is not in degrees Celsius and is left out"
    return values[:, 0], ""


def _valid(numbers: _Numbers) -> NDArray[np.bool_] | None:
    values = numbers.group(("valid",))
    return None if values is None else values[:, 0] != 0.0


IMPORTER = Importer(
    name="csv",
    title="text table",
    suffixes=(".csv", ".txt", ".tsv", ".log", ".gcsv"),
    sniff=sniff,
    read=read,
    uses=frozenset(
        {"columns", "time_unit", "gyro_unit", "accel_unit", "angle_unit"}
        | {"gyro_range", "accel_range", "rate_hz"}
    ),
    generic=True,
)

assert set(NEEDED) == {*FORCE, *RATE}
