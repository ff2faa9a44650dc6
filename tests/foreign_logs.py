"""Logs of other programs, made from a recording whose content is known."""

import struct
from collections.abc import Callable
from pathlib import Path

import numpy as np
from pymavlink.dialects.v20 import common

from hostkit.recordings import Recording

G = 9.80665


DEG = np.pi / 180.0


Flip = Callable[[np.ndarray], np.ndarray]


def table(path: Path, header: str, *columns: np.ndarray, delimiter: str = ",") -> Path:
    rows = np.column_stack(columns)
    body = "\n".join(delimiter.join(f"{v:.10g}" for v in row) for row in rows)
    path.write_text((header + "\n" if header else "") + body + "\n", encoding="utf-8")
    return path


def counts(truth: Recording) -> tuple[np.ndarray, np.ndarray]:
    gyro = np.round(truth.angular_rate_rad_s / (500 * DEG / 32768)).astype(int)
    accel = np.round(truth.specific_force_m_s2 / (4 * G / 32768)).astype(int)
    return accel, gyro


def same(got: Recording, truth: Recording, tolerance: float = 1e-6) -> None:
    np.testing.assert_allclose(got.angular_rate_rad_s, truth.angular_rate_rad_s, atol=tolerance)
    np.testing.assert_allclose(got.specific_force_m_s2, truth.specific_force_m_s2, atol=tolerance)
    np.testing.assert_allclose(got.time_s, truth.time_s, atol=1e-9)


def tlog(path: Path, messages: list[tuple[float, bytes]]) -> Path:
    frames = sorted(messages, key=lambda message: message[0])
    path.write_bytes(
        b"".join(struct.pack(">Q", 1_700_000_000_000_000 + int(t * 1e6)) + f for t, f in frames)
    )
    return path


def link(system: int = 1, component: int = 1, module=common):  # type: ignore[no-untyped-def]
    return module.MAVLink(None, srcSystem=system, srcComponent=component)


def attitudes(truth: Recording, tilt_of, mav, every: int = 2) -> list[tuple[float, bytes]]:
    roll, pitch = tilt_of(truth)
    return [
        (t, mav.attitude_encode(round(t * 1e3), r, -p, 1.0, 0, 0, 0).pack(mav))
        for t, r, p in zip(truth.time_s[::every], roll[::every], pitch[::every], strict=True)
    ]


def highres(truth: Recording, to_frd: Flip, mav, **fields) -> list[tuple[float, bytes]]:  # type: ignore[no-untyped-def]
    force, rate = to_frd(truth.specific_force_m_s2), to_frd(truth.angular_rate_rad_s)
    return [
        (
            t,
            mav.highres_imu_encode(
                round(t * 1e6) + 5_000_000, *f, *w, 0, 0, 0, 0, 0, 0, 20, 0xFFFF, **fields
            ).pack(mav),
        )
        for t, f, w in zip(truth.time_s, force, rate, strict=True)
    ]


def close(got: Recording, truth: Recording, force: float, rate: float, time: float = 1e-9) -> None:
    np.testing.assert_allclose(got.specific_force_m_s2, truth.specific_force_m_s2, atol=force)
    np.testing.assert_allclose(got.angular_rate_rad_s, truth.angular_rate_rad_s, atol=rate)
    np.testing.assert_allclose(got.time_s, truth.time_s, atol=time)


def tilted(got: Recording, truth: Recording, rate: int = 2) -> float:
    """Largest difference of the reference, rad; where there is none, it must be at the end."""
    assert got.up_reference is not None
    known = np.isfinite(got.up_reference).all(axis=1)
    assert known[: -rate - 1].all()
    return float(np.abs(got.up_reference[known] - truth.up_reference[known]).max())


FMT = struct.Struct("<BBB BB4s16s64s")


def record_format(number: int, length: int, name: str, form: str, columns: str) -> bytes:
    return FMT.pack(
        0xA3, 0x95, 0x80, number, length, name.encode(), form.encode(), columns.encode()
    )


def dataflash(truth: Recording, to_frd: Flip, tilt_of, instances: tuple[int, ...]) -> bytes:
    imu, att = struct.Struct("<BBBQBffffff"), struct.Struct("<BBBQfff")
    out = [record_format(128, 89, "FMT", "BBnNZ", "Type,Length,Name,Format,Columns")]
    imu_columns = "TimeUS,I,GyrX,GyrY,GyrZ,AccX,AccY,AccZ"
    out.append(record_format(10, imu.size, "IMU", "QBffffff", imu_columns))
    out.append(record_format(11, att.size, "ATT", "Qfff", "TimeUS,Roll,Pitch,Yaw"))
    force, rate = to_frd(truth.specific_force_m_s2), to_frd(truth.angular_rate_rad_s)
    roll, pitch = np.degrees(tilt_of(truth))
    for n, time_s in enumerate(truth.time_s):
        ticks = round(time_s * 1e6) + 7_000_000
        for i in instances:
            sample = (*rate[n], *(force[n] * (1 + i)))
            out.append(imu.pack(0xA3, 0x95, 10, ticks, i, *sample))
        if n % 2 == 0:
            out.append(att.pack(0xA3, 0x95, 11, ticks, roll[n], -pitch[n], 77.0))
    return b"".join(out)


def ulog(truth: Recording, to_frd: Flip, tilt_of) -> bytes:
    """A ULog, its bytes by the PX4 specification of the format."""

    def message(kind: bytes, payload: bytes) -> bytes:
        return struct.pack("<HB", len(payload), kind[0]) + payload

    out = [b"ULog\x01\x12\x35\x01" + struct.pack("<Q", 0), message(b"B", bytes(40))]
    formats = (
        b"sensor_combined:uint64_t timestamp;float[3] gyro_rad;float[3] accelerometer_m_s2;",
        b"vehicle_attitude:uint64_t timestamp;uint64_t timestamp_sample;float[4] q;",
    )
    out += [message(b"F", text) for text in formats]
    for number, name in enumerate((b"sensor_combined", b"vehicle_attitude")):
        out.append(message(b"A", struct.pack("<BH", 0, number) + name))
    force, rate = to_frd(truth.specific_force_m_s2), to_frd(truth.angular_rate_rad_s)
    roll, pitch = tilt_of(truth)
    for n, time_s in enumerate(truth.time_s):
        ticks = round(time_s * 1e6) + 3_000_000
        sample = struct.pack("<HQ6f", 0, ticks, *rate[n], *force[n])
        out.append(message(b"D", sample))
        if n % 2 == 0:
            half_roll, half_pitch = roll[n] / 2, -pitch[n] / 2
            q = (
                np.cos(half_roll) * np.cos(half_pitch), np.sin(half_roll) * np.cos(half_pitch),
                np.cos(half_roll) * np.sin(half_pitch), -np.sin(half_roll) * np.sin(half_pitch),
            )  # fmt: skip
            out.append(message(b"D", struct.pack("<HQQ4f", 1, ticks + 2500, ticks, *q)))
    return b"".join(out)
