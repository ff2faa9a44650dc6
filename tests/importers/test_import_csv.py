from pathlib import Path

import numpy as np
import pytest
from foreign_logs import DEG, G, counts, same, table

from hostkit.errors import RecordingError
from hostkit.importers.options import parse_columns
from hostkit.recordings import Recording


@pytest.mark.parametrize(
    ("header", "delimiter", "time", "force", "rate"),
    [
        ("timestamp,accX,accY,accZ,gyrX,gyrY,gyrZ", ",", 1e3, 1.0, 1 / DEG),
        ("time_us;acc_x;acc_y;acc_z;gyr_x;gyr_y;gyr_z", ";", 1e6, 1 / G, 1.0),
        ("t\tax\tay\taz\tgx\tgy\tgz", "\t", 1.0, 1.0, 1.0),
        ("Time (s),Accel. X,Accel. Y,Accel. Z,Gyro. X,Gyro. Y,Gyro. Z", ",", 1.0, 1e3 / G, 1 / DEG),
        ("millis|AcX|AcY|AcZ|GyX|GyY|GyZ", "|", 1e3, 1 / G, 1 / DEG),
        ("time_ns xacc yacc zacc xgyro ygyro zgyro", " ", 1e9, 1.0, 1.0),
        ("# t ax ay az gx gy gz", " ", 1.0, 1.0, 1.0),
        ("", ",", 1e3, 1 / G, 1 / DEG),
    ],
)
def test_units_and_columns_are_told(
    tmp_path: Path, truth: Recording, bring, header, delimiter, time, force, rate
) -> None:
    path = table(
        tmp_path / "log.csv",
        header,
        truth.time_s * time,
        truth.specific_force_m_s2 * force,
        truth.angular_rate_rad_s * rate,
        delimiter=delimiter,
    )
    imported = bring(path)
    assert imported.format == "csv"
    same(imported.recording, truth)
    assert imported.recording.rate_hz == pytest.approx(100.0)


def test_delimiter_behind_the_last_column(tmp_path: Path, truth: Recording, bring) -> None:
    path = table(
        tmp_path / "log.csv",
        "t;ax;ay;az;gx;gy;gz",
        truth.time_s,
        truth.specific_force_m_s2,
        truth.angular_rate_rad_s,
        delimiter=";",
    )
    path.write_text(path.read_text().replace("\n", ";\n"))
    same(bring(path).recording, truth)


def test_every_guess_is_said(tmp_path: Path, truth: Recording, bring) -> None:
    path = table(
        tmp_path / "log.csv",
        "timestamp,accX,accY,accZ,gyrX,gyrY,gyrZ",
        truth.time_s * 1e3,
        truth.specific_force_m_s2,
        truth.angular_rate_rad_s / DEG,
    )
    time, force, rate = bring(path).guessed
    assert time == "time is in ms: its median step 10 makes 100 Hz"
    assert force.startswith("force is in m/s2: its median is 9.8")
    assert rate.startswith("rate is in deg/s: times 0.01745")


def test_stated_units_are_no_guess_and_win(tmp_path: Path, truth: Recording, bring) -> None:
    path = table(
        tmp_path / "log.csv",
        "Time [ms],acc_x_g,acc_y_g,acc_z_g,gyro_x [deg/s],gyro_y [deg/s],gyro_z [deg/s],mag_x_uT,"
        "mag_y_uT,mag_z_uT,temp",
        truth.time_s * 1e3,
        truth.specific_force_m_s2 / G,
        truth.angular_rate_rad_s / DEG,
        truth.specific_force_m_s2,
        truth.time_s + 20.0,
    )
    imported = bring(path)
    same(imported.recording, truth)
    assert imported.guessed == ()
    np.testing.assert_allclose(imported.recording.mag_ut, truth.specific_force_m_s2, atol=1e-8)
    np.testing.assert_allclose(imported.recording.temperature_deg_c, truth.time_s + 20.0)


def test_i2cdevlib_lines(tmp_path: Path, truth: Recording, bring) -> None:
    lines = ["Initializing I2C devices...", "MPU6050 connection successful"]
    for force, rate in zip(*counts(truth), strict=True):
        lines.append("a/g:\t" + "\t".join(map(str, (*force, *rate))))
    path = tmp_path / "monitor.txt"
    path.write_text("\r\n".join(lines) + "\r\n")
    imported = bring(path, rate_hz=100.0)
    same(imported.recording, truth, 1e-9)
    assert any("2 line(s) are no samples" in said for said in imported.guessed)
    assert any("counts at +-500 deg/s" in said for said in imported.guessed)
    assert any("counts at +-4 g" in said for said in imported.guessed)
    with pytest.raises(RecordingError, match="--rate-hz HZ"):
        bring(path)


def test_labelled_values(tmp_path: Path, truth: Recording, bring) -> None:
    path = tmp_path / "serial.log"
    with path.open("w") as stream:
        for (ax, ay, az), (gx, gy, gz) in zip(*counts(truth), strict=True):
            stream.write(
                f"AcX = {ax} | AcY = {ay} | AcZ = {az} | Tmp = 25.1 | GyX = {gx} | GyY = {gy} | "
                f"GyZ = {gz}\n"
            )
    imported = bring(path, rate_hz=100.0)
    same(imported.recording, truth, 1e-9)
    np.testing.assert_allclose(imported.recording.temperature_deg_c, 25.1)


def test_gyroflow_scales(tmp_path: Path, truth: Recording, bring) -> None:
    force, rate = counts(truth)
    head = f"GYROFLOW IMU LOG\nversion,1.3\ntscale,0.001\ngscale,{500 * DEG / 32768!r}\n"
    head += f"ascale,{4 / 32768!r}\nt,gx,gy,gz,ax,ay,az"
    path = table(tmp_path / "log.gcsv", head, truth.time_s * 1e3, rate, force)
    imported = bring(path)
    same(imported.recording, truth, 1e-9)
    assert imported.guessed == ()


def test_units_row_and_decimal_commas(tmp_path: Path, truth: Recording, bring) -> None:
    path = table(
        tmp_path / "log.csv",
        "Zeit time;acc x;acc y;acc z;gyr x;gyr y;gyr z\ns;g;g;g;deg/s;deg/s;deg/s",
        truth.time_s,
        truth.specific_force_m_s2 / G,
        truth.angular_rate_rad_s / DEG,
        delimiter=";",
    )
    path.write_text(path.read_text().replace(".", ","))
    imported = bring(path, columns=parse_columns("t=1"))
    same(imported.recording, truth)
    assert imported.guessed == ()


@pytest.mark.parametrize("unit", ["deg", "rad"])
def test_reference_angles(tmp_path: Path, truth: Recording, bring, tilt_of, unit: str) -> None:
    roll, pitch = tilt_of(truth)
    factor = 1 / DEG if unit == "deg" else 1.0
    path = table(
        tmp_path / "log.csv",
        "t,ax,ay,az,gx,gy,gz,roll,pitch",
        truth.time_s,
        truth.specific_force_m_s2,
        truth.angular_rate_rad_s,
        roll * factor,
        pitch * factor,
    )
    imported = bring(path)
    np.testing.assert_allclose(imported.recording.up_reference, truth.up_reference, atol=1e-8)
    assert any(f"reference angles are in {unit}" in said for said in imported.guessed)
    assert any("--no-reference" in said for said in imported.guessed)
    assert bring(path, reference=False).recording.up_reference is None


def test_reference_quaternion(tmp_path: Path, truth: Recording, bring) -> None:
    x, y, z = truth.up_reference.T
    w = np.sqrt((1 + z) / 2)
    quaternion = np.column_stack((w, y / (2 * w), -x / (2 * w), np.zeros_like(w)))
    path = table(
        tmp_path / "log.csv",
        "t,ax,ay,az,gx,gy,gz,q0,q1,q2,q3",
        truth.time_s,
        truth.specific_force_m_s2,
        truth.angular_rate_rad_s,
        quaternion,
    )
    got = bring(path).recording.up_reference
    np.testing.assert_allclose(got, truth.up_reference, atol=1e-8)


def test_betaflight_export(tmp_path: Path, truth: Recording, bring) -> None:
    path = table(
        tmp_path / "blackbox.csv",
        '"loopIteration","time","gyroADC[0]","gyroADC[1]","gyroADC[2]","accSmooth[0]",'
        '"accSmooth[1]","accSmooth[2]"',
        np.arange(len(truth)),
        truth.time_s * 1e6,
        np.round(truth.angular_rate_rad_s / DEG),
        np.round(truth.specific_force_m_s2 / G * 2048),
    )
    imported = bring(path)
    same(imported.recording, truth, 0.51 * DEG)
    assert any(said.startswith("rate is in deg/s") for said in imported.guessed)
    assert any(said.startswith("force is in counts at +-16 g") for said in imported.guessed)


def test_resting_sensor_leaves_the_unit_open(tmp_path: Path, resting: Recording, bring) -> None:
    path = table(
        tmp_path / "log.csv",
        "t,ax,ay,az,gx,gy,gz",
        resting.time_s,
        resting.specific_force_m_s2,
        resting.angular_rate_rad_s / DEG,
    )
    with pytest.raises(RecordingError, match=r"unit of the rate cannot be told.*--gyro-unit"):
        bring(path)
    same(bring(path, gyro_unit="deg/s").recording, resting)


def test_counts_need_a_range_at_rest(tmp_path: Path, resting: Recording, bring) -> None:
    force, rate = counts(resting)
    path = table(
        tmp_path / "log.csv", "t,ax_raw,ay_raw,az_raw,gx_raw,gy_raw,gz_raw",
        resting.time_s, force, rate,
    )  # fmt: skip
    with pytest.raises(RecordingError, match=r"range of the rate's counts.*--gyro-range"):
        bring(path)
    same(bring(path, gyro_range=500.0).recording, resting, 1e-9)


@pytest.mark.parametrize("factor", [0.3, 3.2, 0.0])
def test_force_of_no_unit(tmp_path: Path, truth: Recording, bring, factor: float) -> None:
    path = table(
        tmp_path / "log.csv",
        "t,ax,ay,az,gx,gy,gz",
        truth.time_s,
        truth.specific_force_m_s2 * factor,
        truth.angular_rate_rad_s,
    )
    with pytest.raises(RecordingError, match=r"unit of the force cannot be told.*--accel-unit"):
        bring(path)


def test_row_numbers_are_not_taken_for_time(tmp_path: Path, truth: Recording, bring) -> None:
    path = table(
        tmp_path / "log.csv",
        "t,ax,ay,az,gx,gy,gz",
        np.arange(len(truth)),
        truth.specific_force_m_s2,
        truth.angular_rate_rad_s,
    )
    with pytest.raises(RecordingError, match="--time-unit ms"):
        bring(path)


def test_counter_that_overflowed(tmp_path: Path, truth: Recording, bring) -> None:
    ticks = (truth.time_s * 1e6 + 2**32 - 5e6) % 2**32
    path = table(
        tmp_path / "log.csv",
        "time_us,ax,ay,az,gx,gy,gz",
        np.round(ticks),
        truth.specific_force_m_s2,
        truth.angular_rate_rad_s,
    )
    imported = bring(path, gyro_unit="rad/s")
    same(imported.recording, truth)
    assert any("overflowed 1 time(s)" in said for said in imported.guessed)
