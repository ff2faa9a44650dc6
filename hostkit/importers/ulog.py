"""Importer of PX4's onboard logs (ULog): sensor_combined, with vehicle_attitude as reference."""

from pathlib import Path
from typing import Any

import numpy as np

from hostkit.errors import RecordingError
from hostkit.importers.foreign import head, need, reading
from hostkit.importers.log import Importer, Progress, ReferenceTrack, SensorLog, Vector
from hostkit.importers.options import ImportOptions
from hostkit.importers.rotation import attitude_from_frd, from_frd
from hostkit.importers.timebase import seconds

MAGIC = b"ULog\x01\x12\x35"
SAMPLES, ATTITUDE = "sensor_combined", "vehicle_attitude"


def sniff(path: Path) -> bool:
    """Tell whether a file begins as a ULog does."""
    return head(path).startswith(MAGIC)


def read(path: Path, options: ImportOptions, progress: Progress) -> SensorLog:
    """Read an onboard log.

    Raises
    ------
    RecordingError
        If it is damaged, or has no samples of such a sensor.
    ToolMissingError
        If pyulog is not installed.
    """
    core = need("pyulog.core", "ULog")
    progress(0, 1)
    with reading("ULog"):
        log = core.ULog(str(path), [SAMPLES, ATTITUDE])
        instance = options.instance or 0
        samples = _topic(log, SAMPLES, instance)
        if samples is None:
            raise RecordingError(_lack(log, instance))
        ticks = samples["timestamp"].astype(np.int64)
        rate = _stacked(samples, "gyro_rad", 3)
        force = _stacked(samples, "accelerometer_m_s2", 3)
        track = _reference(log, int(ticks[0])) if options.reference else None
    progress(1, 1)
    said = ["the file is damaged in places; what could be read is taken"] * log.file_corruption
    if track is not None:
        said.append(f"the reference is {ATTITUDE}, the autopilot's own estimate")
    return SensorLog(
        time_s=seconds(ticks, 1e6, int(ticks[0])),
        angular_rate_rad_s=from_frd(rate),
        specific_force_m_s2=from_frd(force),
        reference=track,
        sensor=f"PX4 {SAMPLES}",
        guessed=tuple(said),
    )


def _topic(log: Any, name: str, instance: int) -> Any:
    found = [d for d in log.data_list if d.name == name and d.multi_id == instance]
    return found[0].data if found else None


def _lack(log: Any, instance: int) -> str:
    had = sorted(f"{d.name} {d.multi_id}" for d in log.data_list)
    return (
        f"it has no samples of {SAMPLES} {instance}; of use it has: {', '.join(had) or 'nothing'}"
    )


def _stacked(data: Any, name: str, width: int) -> Vector:
    return np.column_stack([data[f"{name}[{i}]"] for i in range(width)]).astype(np.float64)


def _reference(log: Any, start: int) -> ReferenceTrack | None:
    """Return the attitude, forward-right-down to north-east-down in the file."""
    data = _topic(log, ATTITUDE, 0)
    if data is None or len(data["timestamp"]) < 2:
        return None
    sampled = data.get("timestamp_sample", np.zeros(1))
    ticks = sampled if np.all(sampled > 0) else data["timestamp"]
    return ReferenceTrack(
        time_s=seconds(ticks.astype(np.int64), 1e6, start),
        quaternion_wxyz=attitude_from_frd(_stacked(data, "q", 4)),
    )


IMPORTER = Importer(
    name="ulog",
    title="PX4 onboard log, ULog",
    suffixes=(".ulg", ".ulog"),
    sniff=sniff,
    read=read,
    uses=frozenset({"instance"}),
)
