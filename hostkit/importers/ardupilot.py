"""Importer of ArduPilot's onboard logs (DataFlash, ``.bin``): IMU, with ATT as the reference."""

import contextlib
import os
import struct
from collections import defaultdict
from collections.abc import Generator
from pathlib import Path
from typing import Any

import numpy as np

from hostkit.errors import RecordingError
from hostkit.importers.foreign import head, reading
from hostkit.importers.log import Importer, Progress, ReferenceTrack, SensorLog
from hostkit.importers.options import ImportOptions
from hostkit.importers.rotation import attitude_from_frd, from_euler, from_frd
from hostkit.importers.timebase import seconds
from hostkit.units import RAD_PER_DEG

MAGIC = b"\xa3\x95\x80"
"""Begin of a record, and the type of the records that describe the others."""
IMU_NAMES = ("IMU", "IMU2", "IMU3")
"""Newer logs number the sensors in a field ``I``; older ones have a message for each."""
FIELDS = ("AccX", "AccY", "AccZ", "GyrX", "GyrY", "GyrZ")
HEADER_BYTES = 3
INDEXER = "PYMAVLINK_FAST_INDEX"
"""Environment variable with which pymavlink chooses between its two indexers."""
Row = tuple[float, ...]


def sniff(path: Path) -> bool:
    """Tell whether a file begins with the description of a record."""
    return head(path).startswith(MAGIC)


def read(path: Path, options: ImportOptions, progress: Progress) -> SensorLog:
    """Read an onboard log.

    Raises
    ------
    RecordingError
        If it is damaged, or has no such IMU.
    """
    imus, attitude = _messages(path, progress)
    wanted = min(imus, default=0) if options.instance is None else options.instance
    if wanted not in imus:
        had = ", ".join(map(str, sorted(imus))) or "none"
        raise RecordingError(f"it has no samples of IMU {wanted}; it has IMU: {had}")
    rows = np.array(imus[wanted], dtype=np.float64)
    start = int(rows[0, 0])
    others = ", ".join(str(number) for number in sorted(imus) if number != wanted)
    track = _reference(attitude, start) if options.reference else None
    said = [f"the samples are IMU {wanted}, not {others}"] if others else []
    if track is not None:
        said.append("the reference is ATT, the autopilot's own estimate")
    return SensorLog(
        time_s=seconds(rows[:, 0].astype(np.int64), 1e6, start),
        angular_rate_rad_s=from_frd(rows[:, 4:7]),
        specific_force_m_s2=from_frd(rows[:, 1:4]),
        reference=track,
        sensor=f"ArduPilot IMU {wanted}",
        guessed=tuple(said),
    )


def _messages(path: Path, progress: Progress) -> tuple[dict[int, list[Row]], list[Row]]:
    """Return the rows of each IMU, time in us first, and of the attitude in degrees."""
    imus: dict[int, list[Row]] = defaultdict(list)
    attitude: list[Row] = []
    with reading("DataFlash log"), _indexed(path) as log:
        for kind, name in log.id_to_name.items():
            layout = log.formats[kind]
            if name == "ATT":
                attitude += _rows(log, layout, ("TimeUS", "Roll", "Pitch", "Yaw"), progress)
            elif name in IMU_NAMES and "I" in layout.columns:
                for row in _rows(log, layout, ("I", "TimeUS", *FIELDS), progress):
                    imus[int(row[0])].append(row[1:])
            elif name in IMU_NAMES:
                number = IMU_NAMES.index(name)
                imus[number] += _rows(log, layout, ("TimeUS", *FIELDS), progress)
    return {number: rows for number, rows in imus.items() if rows}, attitude


@contextlib.contextmanager
def _indexed(path: Path) -> Generator[Any, None, None]:
    """Open a log and find its records, by pymavlink's indexer in Python.

    The compiled indexer prints what it dislikes past every redirection; the search for GPS time
    is left out: it reads all messages, and only the time since start is wanted.
    """
    from pymavlink.DFReader import DFReader_binary

    before = os.environ.get(INDEXER)
    os.environ[INDEXER] = "0"
    try:
        without_clock = type("Log", (DFReader_binary,), {"init_clock": lambda self: None})
        log = without_clock(str(path))
    finally:
        os.environ.pop(INDEXER)
        if before is not None:
            os.environ[INDEXER] = before
    with log:
        yield log


def _rows(log: Any, layout: Any, fields: tuple[str, ...], progress: Progress) -> list[Row]:
    """Return some fields of all whole records of one kind, scaled as their format says."""
    record = struct.Struct(layout.msg_struct)
    places = [layout.colhash[field] for field in fields]
    weights = [layout.msg_mults[place] or 1.0 for place in places]
    last = log.data_len - HEADER_BYTES - record.size
    rows = []
    for offset in log.offsets[layout.type]:
        if offset <= last:
            cells = record.unpack_from(log.data_map, offset + HEADER_BYTES)
            rows.append(tuple(cells[p] * w for p, w in zip(places, weights, strict=True)))
            progress(offset, log.data_len)
    return rows


def _reference(attitude: list[Row], start: int) -> ReferenceTrack | None:
    if len(attitude) < 2:
        return None
    values = np.array(attitude, dtype=np.float64)
    return ReferenceTrack(
        time_s=seconds(values[:, 0].astype(np.int64), 1e6, start),
        quaternion_wxyz=attitude_from_frd(from_euler(*(values[:, 1:4] * RAD_PER_DEG).T)),
    )


IMPORTER = Importer(
    name="ardupilot",
    title="ArduPilot onboard log, DataFlash",
    suffixes=(".bin",),
    sniff=sniff,
    read=read,
    uses=frozenset({"instance"}),
)
