"""Importer of MAVLink telemetry logs: IMU messages, with ATTITUDE as the reference."""

from collections import defaultdict
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from hostkit.design_file import load_design
from hostkit.dialect import python_module
from hostkit.errors import DeviceError, RecordingError
from hostkit.importers.foreign import head, reading
from hostkit.importers.log import Importer, Progress, ReferenceTrack, SensorLog, Vector
from hostkit.importers.options import ImportOptions
from hostkit.importers.rotation import attitude_from_frd, from_euler, from_frd
from hostkit.importers.timebase import seconds, unwrapped
from hostkit.importers.tlog_arrival import arrived_attitude
from hostkit.importers.units import M_S2_PER, RAD_S_PER, force_scale, rate_scale
from hostkit.link.logs.tlog import MAGIC_V1, STAMP, read_stamped
from hostkit.sensors import SENSORS
from hostkit.sensors.counts import Counts, to_rate_and_force_g
from hostkit.units import STANDARD_GRAVITY_M_S2

MAGICS = (b"\xfd", b"\xfe")
FULLY_UPDATED = 0x3F
"""Bits of ``fields_updated`` for the three axes of force and of rate."""
SCALED = ("SCALED_IMU", "SCALED_IMU2", "SCALED_IMU3")
RAW_IN_MG = 0.15

Key = tuple[str, int, int]
"""Name of a message, system and component of its sender."""
Row = tuple[float, ...]


def _highres(m: Any) -> Row:
    return (m.time_usec, m.xacc, m.yacc, m.zacc, m.xgyro, m.ygyro, m.zgyro, m.fields_updated, m.id)


def _scaled(m: Any) -> Row:
    return (1000 * m.time_boot_ms, m.xacc, m.yacc, m.zacc, m.xgyro, m.ygyro, m.zgyro)


def _raw(m: Any) -> Row:
    return (m.time_usec, m.xacc, m.yacc, m.zacc, m.xgyro, m.ygyro, m.zgyro)


def _tilt(m: Any) -> Row:
    return (m.time_usec, *m.accel, *m.gyro)


def _attitude(m: Any) -> Row:
    return (1000 * m.time_boot_ms, m.roll, m.pitch, m.yaw)


ROWS: dict[str, Callable[[Any], Row]] = {
    "TILT_SAMPLE": _tilt,
    "HIGHRES_IMU": _highres,
    **dict.fromkeys(SCALED[:1], _scaled),
    "RAW_IMU": _raw,
    **dict.fromkeys(SCALED[1:], _scaled),
    "ATTITUDE": _attitude,
}
"""What is taken of each message, time in us first; the sooner it stands here the better it is."""
IMU_MESSAGES = tuple(name for name in ROWS if name != "ATTITUDE")


@dataclass(frozen=True, slots=True, kw_only=True)
class _Source:
    """The stream that is imported."""

    name: str
    system: int
    component: int
    rows: Vector
    said: str

    @property
    def key(self) -> Key:
        """What its rows are found by."""
        return self.name, self.system, self.component


def sniff(path: Path) -> bool:
    """Tell whether a MAVLink frame follows eight bytes, and the next one where it ends."""
    start = head(path)
    frame = start[STAMP.size :]
    if frame[:1] not in MAGICS or len(frame) < 3:
        return False
    length = 8 + frame[1] if frame[0] == MAGIC_V1 else 12 + frame[1] + 13 * (frame[2] & 1)
    following = frame[length + STAMP.size :][:1]
    return following in MAGICS or (not following and len(frame) >= length)


def read(path: Path, options: ImportOptions, progress: Progress) -> SensorLog:
    """Read a telemetry log.

    Raises
    ------
    RecordingError
        If it is damaged, has no IMU message, or has several senders of it.
    DesignError
        If the design file is not one.
    """
    streams, delays = _streams(path, progress)
    source = _choose(streams, options)
    start = int(source.rows[0, 0])
    if source.name == "TILT_SAMPLE":
        return _tilt_log(source, start, options, *arrived_attitude(streams, delays, source.key))
    time_s = seconds(unwrapped(source.rows[:, 0])[0].astype(np.int64), 1e6, start)
    force, rate, said = _in_si(source, time_s, options)
    reference, said_reference = _reference(streams, source, start, time_s)
    return SensorLog(
        time_s=time_s,
        angular_rate_rad_s=from_frd(rate),
        specific_force_m_s2=from_frd(force),
        reference=reference if options.reference else None,
        sensor=f"MAVLink system {source.system}, {source.name}",
        guessed=tuple(s for s in (source.said, *said, said_reference) if s),
    )


def _streams(path: Path, progress: Progress) -> tuple[dict[Key, list[Row]], dict[Key, float]]:
    """Return the rows of every message that is of use, and the shortest delay, by its sender."""
    from pymavlink.dialects.v20 import common

    own = python_module()
    wanted = {getattr(common, f"MAVLINK_MSG_ID_{n}"): common for n in ROWS if n != "TILT_SAMPLE"}
    wanted[own.MAVLINK_MSG_ID_TILT_SAMPLE] = own
    parsers = {module: module.MAVLink(None) for module in (common, own)}
    for parser in parsers.values():
        parser.robust_parsing = True
    streams: dict[Key, list[Row]] = defaultdict(list)
    delays: dict[Key, float] = {}
    done, total = 0, path.stat().st_size
    try:
        with reading("tlog"):
            for arrived_us, frame in read_stamped(path):
                done += len(frame) + STAMP.size
                module = wanted.get(_message_id(frame))
                if module is not None:
                    progress(done, total)
                    key = _take(parsers[module], frame, streams)
                    if key is not None:
                        delay_us = arrived_us - streams[key][-1][0]
                        delays[key] = min(delays.get(key, delay_us), delay_us)
    except DeviceError as error:
        raise RecordingError(str(error).removeprefix(f"{path} ")) from error
    return streams, delays


def _message_id(frame: bytes) -> int:
    return frame[5] if frame[0] == MAGIC_V1 else int.from_bytes(frame[7:10], "little")


def _take(parser: Any, frame: bytes, streams: dict[Key, list[Row]]) -> Key | None:
    """Decode one frame and return whose it is; what fails its checksum is left out."""
    taken = None
    for message in parser.parse_buffer(frame) or []:
        name = message.get_type()
        if name in ROWS:
            taken = (name, message.get_srcSystem(), message.get_srcComponent())
            streams[taken].append(ROWS[name](message))
    return taken


def _choose(streams: dict[Key, list[Row]], options: ImportOptions) -> _Source:
    found = [k for k in streams if k[0] in IMU_MESSAGES]
    if options.design is None and options.message is None:
        found = [k for k in found if k[0] != "TILT_SAMPLE"] or found
    if options.message is not None:
        found = [k for k in found if k[0] == options.message]
    if options.system is not None:
        found = [k for k in found if k[1] == options.system]
    if not found:
        had = sorted({f"{name} of system {system}" for name, system, _ in streams})
        raise RecordingError(
            f"it has no such IMU message ({', '.join(IMU_MESSAGES)}); of use it has: "
            f"{', '.join(had) or 'nothing'}"
        )
    best = min(found, key=lambda key: IMU_MESSAGES.index(key[0]))
    rivals = sorted(k[1:] for k in found if k[0] == best[0])
    if len(rivals) > 1:
        listed = ", ".join(f"{system} (component {component})" for system, component in rivals)
        raise RecordingError(f"{best[0]} comes from several systems: {listed}; say --system N")
    others = sorted({k[0] for k in found} - {best[0]})
    said = f"the samples are {best[0]}, not {', '.join(others)}" if others else ""
    name, system, component = best
    rows = np.array(streams[best], dtype=np.float64)
    if name == "HIGHRES_IMU":
        rows, also = _one_sensor(rows, options.instance)
        said = "; ".join(text for text in (said, also) if text)
    return _Source(name=name, system=system, component=component, rows=rows, said=said)


def _one_sensor(rows: Vector, wanted: int | None) -> tuple[Vector, str]:
    """Keep the HIGHRES_IMU of one sensor that bring force and rate anew."""
    numbers = sorted({int(number) for number in rows[:, 8]})
    number = numbers[0] if wanted is None else wanted
    if number not in numbers:
        raise RecordingError(
            f"no HIGHRES_IMU is of sensor {number}; there are: {', '.join(map(str, numbers))}"
        )
    said = f"the samples are sensor {number} of {numbers}" if len(numbers) > 1 else ""
    rows = rows[rows[:, 8] == number]
    fresh = (rows[:, 7].astype(np.int64) & FULLY_UPDATED) == FULLY_UPDATED
    return (rows[fresh] if fresh.any() else rows), said


def _in_si(
    source: _Source, time_s: Vector, options: ImportOptions
) -> tuple[Vector, Vector, tuple[str, ...]]:
    """Return force, m/s^2, and rate, rad/s, still forward-right-down."""
    force, rate = source.rows[:, 1:4], source.rows[:, 4:7]
    if source.name in SCALED:
        return force * M_S2_PER["mg"], rate * RAD_S_PER["mrad/s"], ()
    if source.name == "HIGHRES_IMU":
        return force, rate, ()
    median = float(np.median(np.linalg.norm(force, axis=1))) / 1000.0
    accel_unit, gyro_unit = options.accel_unit, options.gyro_unit
    said: tuple[str, ...] = ()
    if accel_unit is None and gyro_unit is None and abs(median - 1.0) < RAW_IN_MG:
        accel_unit, gyro_unit = "mg", "mrad/s"
        said = (
            "RAW_IMU is in mg and mrad/s, as ArduPilot sends it: its median force is near 1000",
        )
    found = force_scale(force, accel_unit, options.accel_range)
    force = force * found.factor
    turned = rate_scale(time_s, rate, force, gyro_unit, options.gyro_range)
    return force, rate * turned.factor, (*said, found.guessed, turned.guessed)


def _tilt_log(
    source: _Source,
    start: int,
    options: ImportOptions,
    reference: ReferenceTrack | None,
    said: str,
) -> SensorLog:
    """Scale raw counts by the ranges of the design; they are in sensor axes already."""
    if options.design is None:
        raise RecordingError(
            "TILT_SAMPLE holds raw counts; say --design FILE, the design the device ran: it has "
            "the ranges"
        )
    sensor = load_design(options.design).sensor
    counts = Counts(
        accel=source.rows[:, 1:4].astype(np.int64), gyro=source.rows[:, 4:7].astype(np.int64)
    )
    rate, force_g = to_rate_and_force_g(SENSORS[sensor.part], sensor, counts)
    return SensorLog(
        time_s=seconds(source.rows[:, 0].astype(np.int64), 1e6, start),
        angular_rate_rad_s=rate,
        specific_force_m_s2=force_g * STANDARD_GRAVITY_M_S2,
        sensor=SENSORS[sensor.part].title,
        reference=reference if options.reference else None,
        guessed=(
            "the device's own angles are no reference and are left out",
            *([said] * bool(said)),
        ),
    )


def _reference(
    streams: dict[Key, list[Row]], source: _Source, start: int, time_s: Vector
) -> tuple[ReferenceTrack | None, str]:
    """Return the ATTITUDE of the same system, if it is on the same clock."""
    rows = [
        r
        for (name, system, _), r in streams.items()
        if name == "ATTITUDE" and system == source.system
    ]
    if not rows:
        return None, ""
    if len(rows) > 1:
        return None, "several components send ATTITUDE: none is taken as the reference"
    values = np.array(rows[0], dtype=np.float64)
    track_s = seconds(values[:, 0].astype(np.int64), 1e6, start)
    if track_s[-1] < time_s[0] or track_s[0] > time_s[-1]:
        return None, f"ATTITUDE is on another clock than {source.name}: it is no reference"
    said = "the reference is ATTITUDE, the autopilot's own estimate"
    if len(values) < 2:
        return None, ""
    attitude = attitude_from_frd(from_euler(*values[:, 1:4].T))
    return ReferenceTrack(time_s=track_s, quaternion_wxyz=attitude), said


IMPORTER = Importer(
    name="tlog",
    title="MAVLink telemetry log",
    suffixes=(".tlog",),
    sniff=sniff,
    read=read,
    uses=frozenset(
        {"message", "system", "instance", "design"}
        | {"gyro_unit", "accel_unit", "gyro_range", "accel_range"}
    ),
)
