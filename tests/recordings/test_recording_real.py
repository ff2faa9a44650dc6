"""The checks on real recordings: all usable sets load, and no false alarm about sign or unit."""

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from hostkit.errors import RecordingError
from hostkit.recordings import Recording, check, load
from hostkit.recordings.sanity.agreement import agreement
from hostkit.units import DEG_PER_RAD, STANDARD_GRAVITY_M_S2

USABLE = ("broad", "repoimu_*", "robot_mpu*", "upenn_arduimu", "static")
MOVED = (
    "broad/01_undisturbed_slow_rotation_A.npz",
    "repoimu_tstick/TStick_Test11_Trial1.npz",
    "robot_mpu/MPU6050RM3100_V_300_seq4.npz",
    "robot_mpu/MPU9150_eV50p_seq3.npz",
    "upenn_arduimu/set03.npz",
)


def files(folder: Path) -> Iterator[Path]:
    for pattern in USABLE:
        yield from sorted(folder.glob(f"{pattern}/*.npz"))


def kinds(recording: Recording) -> set[str]:
    return {finding.kind for finding in check(recording).findings}


def test_every_usable_set_loads_without_alarm_about_sign_unit_or_reference(
    data_folder: Path,
) -> None:
    paths = list(files(data_folder))
    assert len(paths) >= 100
    for path in paths:
        alarms = kinds(load(path)) & {"sign", "bias", "force", "gap", "jitter", "rate"}
        assert not alarms, path.name


def test_clipping_is_found_where_the_sensor_clips(data_folder: Path) -> None:
    clipped = {path.parent.name for path in files(data_folder) if "clipping" in kinds(load(path))}
    assert clipped == {"repoimu_tstick_saturated", "robot_mpu_fast"}


@pytest.mark.parametrize("name", MOVED)
@pytest.mark.parametrize("axis", [0, 1, 2])
def test_flipped_axis_is_found(data_folder: Path, name: str, axis: int) -> None:
    recording = load(data_folder / name)
    sign = np.ones(3)
    sign[axis] = -1.0
    flipped = replace(recording, angular_rate_rad_s=recording.angular_rate_rad_s * sign)
    expected = [False, False, False]
    expected[axis] = True
    assert agreement(flipped).flipped == tuple(expected)
    assert "sign" in kinds(flipped)


@pytest.mark.parametrize("name", MOVED)
def test_wrong_units_are_refused(data_folder: Path, name: str) -> None:
    recording = load(data_folder / name)
    with pytest.raises(RecordingError, match="deg/s"):
        check(replace(recording, angular_rate_rad_s=recording.angular_rate_rad_s * DEG_PER_RAD))
    with pytest.raises(RecordingError, match="twice"):
        check(replace(recording, angular_rate_rad_s=recording.angular_rate_rad_s / DEG_PER_RAD))
    in_g = recording.specific_force_m_s2 / STANDARD_GRAVITY_M_S2
    with pytest.raises(RecordingError, match=r"looks like g: multiply it by 9\.80665"):
        check(replace(recording, specific_force_m_s2=in_g))


@pytest.mark.parametrize("folder", ["mpu6050_hmc5883l", "imutk_xsens_multipos", "xio_sensor_data"])
def test_raw_layouts_are_refused_with_help(data_folder: Path, folder: str) -> None:
    paths = sorted((data_folder / folder).glob("*.npz"))
    assert paths
    for path in paths:
        with pytest.raises(
            RecordingError, match=r"lacks the array\(s\) time_s, gyro_rad_s"
        ) as caught:
            load(path)
        assert "it has " in str(caught.value)


def test_raw_layout_hints(data_folder: Path) -> None:
    with pytest.raises(RecordingError) as caught:
        load(data_folder / "mpu6050_hmc5883l" / "full-sphere.npz")
    text = str(caught.value)
    assert "acc_g is in g: multiply by 9.80665 and call it accel_m_s2" in text
    assert "gyr_dps_raw is in deg/s: multiply by pi/180 (0.01745329) and call it gyro_rad_s" in text
    assert "t_us is in us: divide by 1e6 and call it time_s" in text


def test_raw_mpu6050_brought_into_the_layout_shows_its_faults(data_folder: Path) -> None:
    """Bursty time, axes of opposite sign, and 4.5 deg/s of bias on x: what users' logs are like."""
    folder = data_folder / "mpu6050_hmc5883l"
    moved = converted(folder / "full-sphere.npz")
    assert {"sign", "gap", "jitter"} <= kinds(moved)
    assert agreement(moved).flipped[0]
    assert agreement(moved).scale == pytest.approx(1.0, abs=0.02)
    assert {"bias", "force"} <= kinds(converted(folder / "unmoved-with-x-pointing-forward.npz"))


def converted(path: Path) -> Recording:
    raw = np.load(path)
    first = np.concatenate(([True], np.diff(raw["t_us"]) > 0))
    time_s = raw["t_us"][first] / 1e6
    return Recording(
        name=path.stem,
        time_s=time_s,
        rate_hz=1.0 / float(np.median(np.diff(time_s))),
        angular_rate_rad_s=raw["gyr_dps_raw"][first] / DEG_PER_RAD,
        specific_force_m_s2=raw["acc_g"][first] * STANDARD_GRAVITY_M_S2,
        valid=np.ones(len(time_s), dtype=np.bool_),
    )
