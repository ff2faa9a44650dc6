"""Real logs: what an Arduino sketch would have printed of the MPU-6050 recordings."""

from pathlib import Path

import numpy as np
import pytest

from hostkit.errors import RecordingError
from hostkit.recordings import check

DEG = np.pi / 180.0


def arduino(folder: Path, name: str, path: Path, gyro_range: int) -> tuple[np.ndarray, np.ndarray]:
    """Write micros and raw counts; give back what they mean, rad/s and m/s^2."""
    with np.load(folder / "mpu6050_hmc5883l" / f"{name}.npz") as raw:
        accel = np.round(raw["acc_g"].astype(float) * 16384.0)
        gyro = np.round(raw["gyr_dps_raw"].astype(float) * 32768.0 / gyro_range)
        rows = np.column_stack((raw["t_us"], accel, gyro)).astype(int)
    np.savetxt(path, rows, fmt="%d", delimiter="\t", comments="",
               header="micros\tAcX\tAcY\tAcZ\tGyX\tGyY\tGyZ")  # fmt: skip
    return gyro * gyro_range * DEG / 32768.0, accel * 9.80665 / 16384.0


@pytest.mark.parametrize(
    ("name", "gyro_range"),
    [
        ("full-sphere", 500),
        ("roll-and-tilt-at-45-90", 250),
        ("rotate-ccw-around-y-pointing-left", 250),
        ("rotate-ccw-around-x-pointing-forward", 1000),
    ],
)
def test_raw_counts_of_a_moving_sensor(
    data_folder: Path, tmp_path: Path, bring, name: str, gyro_range: int
) -> None:
    path = tmp_path / "serial.txt"
    rate, force = arduino(data_folder, name, path, gyro_range)
    imported = bring(path)
    np.testing.assert_allclose(imported.recording.angular_rate_rad_s, rate, atol=1e-9)
    np.testing.assert_allclose(imported.recording.specific_force_m_s2, force, atol=1e-9)
    assert any(f"counts at +-{gyro_range} deg/s" in said for said in imported.guessed)
    assert any("--resample 99" in said for said in imported.guessed)
    kinds = {f.kind for f in check(imported.recording).findings}
    assert {"gap", "jitter", "sign"} <= kinds
    even = bring(path, resample_hz=100.0)
    assert not {f.kind for f in check(even.recording).findings} & {"gap", "jitter", "rate"}


@pytest.mark.parametrize("trial", ["Test05_Trial1_Segment_3", "Test07_Trial3_Segment_1"])
def test_a_pendulum_does_not_tell_the_range(
    data_folder: Path, tmp_path: Path, bring, trial: str
) -> None:
    """The force on a pendulum shows a part of its tilt only; the range would come out wrong."""
    with np.load(data_folder / "repoimu_pendulum" / f"Pendulum_{trial}.npz") as raw:
        time_us, force = raw["time_us"].astype(float), raw["accel_m_s2"].astype(float)
        rate = raw["gyro_rad_s"].astype(float)
    path = tmp_path / "log.csv"
    counts = np.round(rate * 32768.0 / (1000.0 * DEG))
    np.savetxt(path, np.column_stack((time_us, force, counts)), fmt="%.9g", delimiter=",",
               header="t,ax,ay,az,gx,gy,gz", comments="")  # fmt: skip
    with pytest.raises(RecordingError, match="cannot be told"):
        bring(path)


def test_raw_counts_of_a_resting_sensor(data_folder: Path, tmp_path: Path, bring) -> None:
    path = tmp_path / "serial.txt"
    rate, _ = arduino(data_folder, "unmoved-with-x-pointing-forward", path, 250)
    with pytest.raises(RecordingError, match="--gyro-range"):
        bring(path)
    got = bring(path, gyro_range=250.0).recording
    np.testing.assert_allclose(got.angular_rate_rad_s, rate, atol=1e-9)
