"""The calibration on real recordings: raw counts of an Xsens, and of MPU-6050 boards."""

from pathlib import Path

import numpy as np
import pytest

from hostkit.calibration import calibrate, fit_accelerometer
from hostkit.recordings import Recording, load
from hostkit.units import RAD_PER_DEG, STANDARD_GRAVITY_M_S2

G = STANDARD_GRAVITY_M_S2
REST = (
    "unmoved-with-x-pointing-forward",
    "unmoved-with-z-pointing-front-and-x-up",
    "unmoved-with-z-pointing-front-and-y-down",
)


def xsens(folder: Path) -> Recording:
    """38 positions by hand; counts at a guess of 4096 a g and 0.0122 deg/s a count."""
    with np.load(folder / "imutk_xsens_multipos" / "xsens.npz") as raw:
        accel, gyro = (raw[name].astype(float) - 32768.0 for name in ("acc_counts", "gyr_counts"))
        time_s = raw["t_us"] * 1e-6
    return Recording(
        name="xsens",
        time_s=time_s,
        rate_hz=100.0,
        angular_rate_rad_s=gyro * 0.0122 * RAD_PER_DEG,
        specific_force_m_s2=accel * G / 4096.0,
        valid=np.ones(len(time_s), dtype=np.bool_),
    )


def mpu6050(folder: Path, name: str) -> Recording:
    """Its axes as hostkit has them: the force upwards, the x axis of the gyroscope turned round."""
    with np.load(folder / "mpu6050_hmc5883l" / f"{name}.npz") as raw:
        first = np.concatenate(([True], np.diff(raw["t_us"]) > 0))
        time_s = raw["t_us"][first] * 1e-6
        return Recording(
            name=name,
            time_s=time_s,
            rate_hz=(len(time_s) - 1) / float(time_s[-1] - time_s[0]),
            angular_rate_rad_s=raw["gyr_dps_raw"][first] * (-RAD_PER_DEG, RAD_PER_DEG, RAD_PER_DEG),
            specific_force_m_s2=-G * raw["acc_g"][first],
            valid=np.ones(len(time_s), dtype=np.bool_),
            temperature_deg_c=raw["temp_raw"][first],
        )


def test_raw_counts_in_many_positions(data_folder: Path) -> None:
    found = calibrate((xsens(data_folder),))
    assert len(found.poses) == 38
    assert found.accel.used.all()
    assert found.accel.determined
    assert found.gyro.determined.all()
    assert np.sqrt(np.mean(found.accel.before_m_s2**2)) > 1.0
    assert np.sqrt(np.mean(found.accel.after_m_s2**2)) < 0.04
    assert np.sqrt(np.mean(found.accel.model_m_s2**2)) < 0.002
    assert np.sqrt(np.mean(found.gyro.before_rad**2)) > 5.0 * RAD_PER_DEG
    assert np.sqrt(np.mean(found.gyro.after_rad**2)) < 3.6 * RAD_PER_DEG
    assert np.sqrt(np.mean(found.gyro.model_rad**2)) < 0.9 * RAD_PER_DEG


def test_one_half_of_the_positions_holds_for_the_other(data_folder: Path) -> None:
    force = calibrate((xsens(data_folder),)).force_m_s2
    first, second = (fit_accelerometer(force[i::2], G) for i in (0, 1))
    left = np.linalg.norm(first.corrected(force[1::2]), axis=1) - G
    assert np.sqrt(np.mean(left**2)) < 0.05
    assert first.determined
    assert not second.determined, "+x points up once only, and not well"
    both = np.hypot(first.offset_error_m_s2, second.offset_error_m_s2)
    assert (np.abs(first.offset_m_s2 - second.offset_m_s2) < 2.0 * both).all()
    both = np.hypot(first.scale_error, second.scale_error)
    assert (np.abs(first.scale - second.scale) < 2.0 * both).all()
    assert np.abs(first.offset_m_s2 - second.offset_m_s2)[1:].max() < 0.003
    assert np.abs(first.scale - second.scale)[1:].max() < 3e-4


def test_a_large_bias_and_three_faces_of_six(data_folder: Path) -> None:
    found = calibrate(tuple(mpu6050(data_folder, name) for name in REST))
    np.testing.assert_allclose(found.gyro.bias_rad_s / RAD_PER_DEG, (-4.54, 0.06, 1.115), atol=0.02)
    assert found.gyro.bias_error_rad_s.max() < 0.02 * RAD_PER_DEG
    assert set(found.missing) == {"-x up", "+y up", "-z up"}
    assert found.accel.before_m_s2.max() == pytest.approx(0.0346 * G, abs=0.01)
    assert found.temperature is not None
    assert 20.0 < found.temperature.mean_c < 40.0


def test_the_scale_of_an_mpu6050_on_a_robot(data_folder: Path) -> None:
    """The arm turns it about all axes; it never points -x up, so the accelerometer is refused."""
    paths = sorted((data_folder / "robot_mpu").glob("MPU6050*.npz"))
    found = calibrate(tuple(load(path) for path in paths))
    assert found.gyro.determined.all()
    assert found.gyro.scale[0] == pytest.approx(0.0133, abs=0.003)
    assert np.sqrt(np.mean(found.gyro.after_rad[found.gyro.used] ** 2)) < 0.9 * np.sqrt(
        np.mean(found.gyro.before_rad[found.gyro.used] ** 2)
    )
    assert "-x up" in found.missing
