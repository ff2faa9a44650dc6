"""Telemetry logs, whose frames pymavlink packs."""

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from foreign_logs import G, attitudes, close, highres, link, tilted, tlog
from pymavlink.dialects.v10 import common as common_v1

from hostkit.cli.main import run
from hostkit.design_file import save_design
from hostkit.dialect import python_module
from hostkit.errors import RecordingError
from hostkit.mounting import Mounting
from hostkit.records import FilterDesign, Parameter, SensorConfig
from hostkit.sensors import SENSORS
from hostkit.sensors.counts import quantise


def test_highres_imu_and_attitude(tmp_path: Path, truth, bring, to_frd, tilt_of) -> None:
    mav = link()
    later = [(t + 5.0, mav_frame) for t, mav_frame in highres(truth, to_frd, mav)]
    roll, pitch = tilt_of(truth)
    later += [
        (t + 5.0, mav.attitude_encode(round(t * 1e3) + 5000, r, -p, 1.0, 0, 0, 0).pack(mav))
        for t, r, p in zip(truth.time_s[::2], roll[::2], pitch[::2], strict=True)
    ]
    imported = bring(tlog(tmp_path / "flight.tlog", later))
    assert imported.format == "tlog"
    close(imported.recording, truth, 1e-5, 1e-6)
    assert tilted(imported.recording, truth) < 2e-3
    assert any("autopilot's own estimate" in said for said in imported.guessed)


def test_scaled_imu_of_protocol_1(tmp_path: Path, truth, bring, to_frd) -> None:
    mav = link(module=common_v1)
    force = np.round(to_frd(truth.specific_force_m_s2) / G * 1e3).astype(int)
    rate = np.round(to_frd(truth.angular_rate_rad_s) * 1e3).astype(int)
    frames = [
        (t, mav.scaled_imu_encode(round(t * 1e3), *map(int, (*f, *w, 0, 0, 0))).pack(mav))
        for t, f, w in zip(truth.time_s, force, rate, strict=True)
    ]
    got = bring(tlog(tmp_path / "a.tlog", frames))
    close(got.recording, truth, 0.51e-3 * G, 0.51e-3)
    assert got.recording.up_reference is None


@pytest.mark.parametrize("style", ["ardupilot", "counts"])
def test_raw_imu(tmp_path: Path, truth, bring, to_frd, style: str) -> None:
    mav = link()
    scale_f, scale_w = (
        (1e3 / G, 1e3) if style == "ardupilot" else (8192 / G, 32768 / np.radians(500.0))
    )
    force = np.round(to_frd(truth.specific_force_m_s2) * scale_f).astype(int)
    rate = np.round(to_frd(truth.angular_rate_rad_s) * scale_w).astype(int)
    frames = [
        (t, mav.raw_imu_encode(round(t * 1e6), *map(int, (*f, *w, 0, 0, 0))).pack(mav))
        for t, f, w in zip(truth.time_s, force, rate, strict=True)
    ]
    imported = bring(tlog(tmp_path / "a.tlog", frames))
    close(imported.recording, truth, 0.51 / scale_f, 0.51 / scale_w)
    words = "mg and mrad/s" if style == "ardupilot" else "counts at +-500 deg/s"
    assert any(words in said for said in imported.guessed)


def test_better_message_wins_and_can_be_chosen(tmp_path: Path, truth, bring, to_frd) -> None:
    mav = link()
    frames = highres(truth, to_frd, mav)
    frames += [
        (t, mav.scaled_imu_encode(round(t * 1e3), 0, 0, -1000, 5, 0, 0, 0, 0, 0).pack(mav))
        for t in truth.time_s
    ]
    path = tlog(tmp_path / "a.tlog", frames)
    imported = bring(path)
    close(imported.recording, truth, 1e-5, 1e-6)
    assert "the samples are HIGHRES_IMU, not SCALED_IMU" in imported.guessed
    still = bring(path, message="SCALED_IMU").recording
    np.testing.assert_allclose(still.specific_force_m_s2, [[0.0, 0.0, G]] * len(truth), atol=1e-9)
    with pytest.raises(RecordingError, match="no such IMU message"):
        bring(path, message="RAW_IMU")


def test_several_systems(tmp_path: Path, truth, bring, to_frd) -> None:
    other = truth.specific_force_m_s2[::-1]
    frames = highres(truth, to_frd, link(1))
    upside_down = SimpleNamespace(
        time_s=truth.time_s, specific_force_m_s2=other,
        angular_rate_rad_s=truth.angular_rate_rad_s,
    )  # fmt: skip
    frames += highres(upside_down, to_frd, link(7))  # type: ignore[arg-type]
    path = tlog(tmp_path / "a.tlog", frames)
    with pytest.raises(RecordingError, match=r"1 \(component 1\), 7 \(component 1\); say --system"):
        bring(path)
    got = bring(path, system=7).recording
    np.testing.assert_allclose(got.specific_force_m_s2, other, atol=1e-5)
    with pytest.raises(RecordingError, match="HIGHRES_IMU of system 7"):
        bring(path, system=9)


def test_several_sensors_and_stale_samples(tmp_path: Path, truth, bring, to_frd) -> None:
    mav = link()
    frames = highres(truth, to_frd, mav)
    frames += [
        (t, mav.highres_imu_encode(int(t * 1e6), *[0.1] * 13, 0xFFFF, id=1).pack(mav))
        for t in truth.time_s
    ]
    frames += [
        (t, mav.highres_imu_encode(int(t * 1e6), *[0.1] * 13, 0x1C0, id=0).pack(mav))
        for t in truth.time_s
    ]
    path = tlog(tmp_path / "a.tlog", frames)
    imported = bring(path)
    close(imported.recording, truth, 1e-5, 1e-6)
    assert any("sensor 0 of [0, 1]" in said for said in imported.guessed)
    second = bring(path, instance=1).recording
    np.testing.assert_allclose(second.specific_force_m_s2[:, 0], 0.1, atol=1e-7)
    with pytest.raises(RecordingError, match="of sensor 4; there are: 0, 1"):
        bring(path, instance=4)


def test_attitude_on_another_clock_is_no_reference(
    tmp_path: Path, truth, bring, to_frd, tilt_of
) -> None:
    mav = link()
    frames = highres(truth, to_frd, mav)
    roll, pitch = tilt_of(truth)
    frames += [
        (t, mav.attitude_encode(int(t * 1e3) + 9_000_000, r, -p, 0, 0, 0, 0).pack(mav))
        for t, r, p in zip(truth.time_s, roll, pitch, strict=True)
    ]
    imported = bring(tlog(tmp_path / "a.tlog", frames))
    assert imported.recording.up_reference is None
    assert any("another clock" in said for said in imported.guessed)


def test_damaged_frames_are_left_out(tmp_path: Path, truth, bring, to_frd) -> None:
    path = tlog(tmp_path / "a.tlog", highres(truth, to_frd, link()))
    content = bytearray(path.read_bytes())
    content[8 + 30] ^= 0xFF
    path.write_bytes(bytes(content[:-10]))
    got = bring(path).recording
    assert len(got) == len(truth) - 2
    np.testing.assert_allclose(got.specific_force_m_s2, truth.specific_force_m_s2[1:-1], atol=1e-5)


DESIGN = FilterDesign(
    filter="complementary", axes="both", tilt="atan2", mounting=Mounting(), rate_hz=100.0,
    sensor=SensorConfig(
        part="mpu6050", gyro_full_scale_deg_s=500, accel_full_scale_g=4, low_pass_setting=3
    ),
    parameters=(Parameter(name="eta", value=0.98, unit="1"),),
)  # fmt: skip


def tilt_samples(truth) -> list[tuple[float, bytes]]:
    sensor, part = DESIGN.sensor, SENSORS["mpu6050"]
    force = quantise(truth.specific_force_m_s2, part.m_s2_per_count(sensor))
    rate = quantise(truth.angular_rate_rad_s, part.rad_s_per_count(sensor))
    mav = python_module().MAVLink(None, srcSystem=1, srcComponent=1)
    frames = []
    for n, (t, f, w) in enumerate(zip(truth.time_s, force, rate, strict=True)):
        message = mav.tilt_sample_encode(
            round(t * 1e6), n, 0, 0, list(map(int, f)), list(map(int, w)), 0, 0, [0] * 6, 0
        )
        frames.append((t, message.pack(mav)))
        mav.seq = (mav.seq + 1) % 256
    return frames


def test_tilt_samples_need_the_design(tmp_path: Path, truth, bring) -> None:
    path = tlog(tmp_path / "device.tlog", tilt_samples(truth))
    with pytest.raises(RecordingError, match="--design FILE"):
        bring(path)
    save_design(DESIGN, tmp_path / "design.json")
    close(bring(path, design=tmp_path / "design.json").recording, truth, 1e-9, 1e-9)


def other_attitudes(truth, tilt_of, system: int) -> list[tuple[float, bytes]]:
    """ATTITUDE of an autopilot that has run for 50 s longer; some take 15 ms to arrive."""
    mav = link(system=system)
    roll, pitch = tilt_of(truth)
    rows = list(zip(truth.time_s, roll, pitch, strict=True))[::2]
    return [
        (
            t + (0.015 if n % 3 else 0.0),
            mav.attitude_encode(round(t * 1e3) + 50_000, r, -p, 1.0, 0, 0, 0).pack(mav),
        )
        for n, (t, r, p) in enumerate(rows)
    ]


def test_attitude_of_another_system_is_a_reference(tmp_path, truth, bring, tilt_of) -> None:
    save_design(DESIGN, tmp_path / "design.json")
    frames = tilt_samples(truth) + other_attitudes(truth, tilt_of, 9)
    imported = bring(tlog(tmp_path / "a.tlog", frames), design=tmp_path / "design.json")
    close(imported.recording, truth, 1e-9, 1e-9)
    assert tilted(imported.recording, truth) < 2e-3
    assert any("ATTITUDE of system 9" in said for said in imported.guessed)
    frames += other_attitudes(truth, tilt_of, 10)
    imported = bring(tlog(tmp_path / "b.tlog", frames), design=tmp_path / "design.json")
    assert imported.recording.up_reference is None
    assert any("systems 9, 10" in said for said in imported.guessed)


def test_such_a_log_can_be_diagnosed_and_tuned_on(tmp_path, truth, tilt_of, capsys) -> None:
    save_design(DESIGN, tmp_path / "design.json")
    frames = tilt_samples(truth) + other_attitudes(truth, tilt_of, 9)
    path, recording = str(tlog(tmp_path / "a.tlog", frames)), str(tmp_path / "a.csv")
    assert run(["import", path, "--design", str(tmp_path / "design.json"), "-o", recording]) == 0
    assert run(["diagnose", recording]) == 0
    assert run(["tune", recording, "-o", str(tmp_path / "tuned.json")]) == 0
    assert "ATTITUDE of system 9" in capsys.readouterr().err


def test_tlog_without_an_imu(tmp_path: Path, truth, bring, tilt_of) -> None:
    path = tlog(tmp_path / "a.tlog", attitudes(truth, tilt_of, link()))
    with pytest.raises(RecordingError, match="of use it has: ATTITUDE of system 1"):
        bring(path)
