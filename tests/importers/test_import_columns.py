from pathlib import Path

import pytest
from foreign_logs import same, table

from hostkit.errors import RecordingError
from hostkit.importers.csv_names import meaning
from hostkit.importers.options import parse_columns
from hostkit.recordings import Recording


def test_chosen_columns_by_number_name_and_sign(tmp_path: Path, truth: Recording, bring) -> None:
    path = table(
        tmp_path / "log.csv",
        "a,b,c,d,e,f,g",
        truth.angular_rate_rad_s,
        truth.specific_force_m_s2 * (1.0, -1.0, 1.0),
        truth.time_s,
    )
    chosen = parse_columns("t=g,ax=4,ay=-e,az=6,gx=a,gy=2,gz=c")
    same(bring(path, columns=chosen, time_unit="s").recording, truth)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("ax", "is not ROLE=COLUMN"),
        ("ax=", "is not ROLE=COLUMN"),
        ("ax=-", "is not ROLE=COLUMN"),
        ("up=1", "no role of a column"),
        ("ax=1,ax=2", "names ax twice"),
    ],
)
def test_bad_choices(text: str, message: str) -> None:
    with pytest.raises(RecordingError, match=message):
        parse_columns(text)


def test_time_that_states_its_unit_is_preferred(tmp_path: Path, truth: Recording, bring) -> None:
    path = table(
        tmp_path / "phone.csv",
        '"time","seconds_elapsed","ax","ay","az","gx","gy","gz"',
        7.0 + 0.0 * truth.time_s,
        truth.time_s,
        truth.specific_force_m_s2,
        truth.angular_rate_rad_s,
    )
    same(bring(path).recording, truth)


@pytest.mark.parametrize(
    ("name", "role", "unit"),
    [
        ("accX", "ax", ""),
        ("GyX", "gx", ""),
        ("GyY", "gy", ""),
        ("gyro_x [deg/s]", "gx", "degs"),
        ("Gyroscope z (rad/s)", "gz", "rads"),
        ("gyroADC[1]", "gy", ""),
        ("accelerometer_m_s2[2]", "az", "ms2"),
        ("gyro_rad[0]", "gx", "rad"),
        ("angular_velocity.x", "gx", ""),
        ("linear_acceleration.z", "az", ""),
        ("orientation.w", "qw", ""),
        ("zgyro", "gz", ""),
        ("Acceleration X (m/s²)", "ax", "ms2"),
        ("gx(°/s)", "gx", "degs"),
        ("Angular rate y (degrees per second)", "gy", "degreespers"),
        ("magX(uT)", "mx", "ut"),
        ("Timestamp_ms", "t", "ms"),
        ("seconds_elapsed", "t", "s"),
        ("micros()", "t", "us"),
        ("ref_pitch_rad", "pitch", "rad"),
        ("q3", "qz", ""),
    ],
)
def test_names(name: str, role: str, unit: str) -> None:
    found = meaning(name)
    assert found is not None
    assert (found.role, found.unit) == (role, unit)


@pytest.mark.parametrize("name", ["", "yaw", "loopIteration", "label", "rcCommand[0]", "vbat"])
def test_names_of_nothing(name: str) -> None:
    assert meaning(name) is None


def test_names_are_shown_without_control_characters(tmp_path: Path, truth, bring) -> None:
    path = table(
        tmp_path / "log.csv",
        "t,\x1b[31mevil,ay,az,gx,gy,gz",
        truth.time_s,
        truth.specific_force_m_s2,
        truth.angular_rate_rad_s,
    )
    with pytest.raises(RecordingError, match=r"it has t, \?\[31mevil, ay") as caught:
        bring(path)
    assert str(caught.value).isprintable()


def test_two_sensors_are_ambiguous(tmp_path: Path, truth: Recording, bring) -> None:
    path = table(
        tmp_path / "log.csv",
        "t,acc1_x,acc2_x,ay,az,gx,gy,gz",
        truth.time_s,
        truth.specific_force_m_s2[:, :1],
        truth.specific_force_m_s2,
        truth.angular_rate_rad_s,
    )
    with pytest.raises(RecordingError, match="acc1_x, acc2_x; say which: --columns ax=NAME"):
        bring(path)
    same(bring(path, columns=parse_columns("ax=acc2_x")).recording, truth)


def test_plainest_column_wins(tmp_path: Path, truth: Recording, bring) -> None:
    path = table(
        tmp_path / "log.csv",
        "t,userAccX,userAccY,userAccZ,accX,accY,accZ,gx,gy,gz",
        truth.time_s,
        0.01 * truth.specific_force_m_s2,
        truth.specific_force_m_s2,
        truth.angular_rate_rad_s,
    )
    same(bring(path).recording, truth)
