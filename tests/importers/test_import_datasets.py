"""BROAD and RepoIMU files, written by h5py, scipy and by hand."""

from pathlib import Path

import h5py
import numpy as np
import pytest
from scipy.io import savemat
from scipy.spatial.transform import Rotation

from hostkit.errors import RecordingError
from hostkit.importers.repoimu import sniff as is_repoimu
from hostkit.recordings import Recording

RATE_HZ = 2000.0 / 7.0


def attitudes(truth: Recording) -> Rotation:
    """Attitudes with the reference's up direction and some heading."""
    x, y, z = truth.up_reference.T
    w = np.sqrt((1 + z) / 2)
    tilt = Rotation.from_quat(np.column_stack((y / (2 * w), -x / (2 * w), 0 * w, w)))
    return Rotation.from_euler("z", 0.3 * truth.time_s[:, None]) * tilt


def wxyz(rotation: Rotation) -> np.ndarray:
    return np.roll(rotation.as_quat(), 1, axis=1)


def trial(truth: Recording) -> dict[str, np.ndarray]:
    quat = wxyz(attitudes(truth))
    quat[100:120] = np.nan
    return {
        "imu_gyr": truth.angular_rate_rad_s,
        "imu_acc": truth.specific_force_m_s2,
        "imu_mag": 5.0 * truth.specific_force_m_s2,
        "opt_quat": quat,
        "opt_pos": np.zeros((len(truth), 3)),
        "movement": np.arange(len(truth)) >= 50,
        "sampling_rate": np.array(RATE_HZ),
    }


def write_hdf5(path: Path, arrays: dict[str, np.ndarray], *, lying: bool = False) -> None:
    with h5py.File(path, "w", userblock_size=512 if lying else 0) as file:
        for name, array in arrays.items():
            standing = array.reshape(-1, 1) if array.ndim == 1 else array
            file[name] = np.atleast_2d(standing.T) if lying else array
    if lying:
        with path.open("r+b") as stream:
            stream.write(b"MATLAB 7.3 MAT-file, Platform: GLNXA64".ljust(124) + b"\x00\x02IM")


@pytest.mark.parametrize("kind", ["hdf5", "mat 5", "mat 5 compressed", "mat 7.3"])
def test_broad(tmp_path: Path, truth, bring, kind: str) -> None:
    path = tmp_path / ("01_trial.hdf5" if kind == "hdf5" else "01_trial.mat")
    if kind.startswith("mat 5"):
        savemat(path, trial(truth), do_compression="compressed" in kind)
    else:
        write_hdf5(path, trial(truth), lying=kind == "mat 7.3")
    imported = bring(path)
    got = imported.recording
    assert imported.format == "broad"
    assert got.rate_hz == RATE_HZ
    np.testing.assert_allclose(got.time_s, np.arange(len(truth)) / RATE_HZ, rtol=1e-15)
    np.testing.assert_array_equal(got.angular_rate_rad_s, truth.angular_rate_rad_s)
    np.testing.assert_array_equal(got.specific_force_m_s2, truth.specific_force_m_s2)
    np.testing.assert_array_equal(got.mag_ut, 5.0 * truth.specific_force_m_s2)
    known = np.isfinite(got.up_reference).all(axis=1)
    assert np.flatnonzero(~known).tolist() == list(range(100, 120))
    np.testing.assert_allclose(got.up_reference[known], truth.up_reference[known], atol=1e-12)
    assert np.flatnonzero(~got.valid).tolist() == [*range(50), *range(100, 120)]


def test_broad_without_reference(tmp_path: Path, truth, bring) -> None:
    path = tmp_path / "a.hdf5"
    write_hdf5(path, trial(truth))
    assert bring(path, reference=False).recording.up_reference is None
    few = bring(path, decimate=2).recording
    assert few.rate_hz == RATE_HZ / 2
    assert len(few) == len(truth) // 2


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"imu_acc": None}, "lacks the array.s. imu_acc"),
        ({"sampling_rate": np.array(0.0)}, "sampling_rate = 0.0"),
        ({"sampling_rate": np.array(np.nan)}, "sampling_rate = nan"),
        ({"imu_acc": np.zeros((4, 2))}, r"imu_acc has shape \(4, 2\)"),
        ({"imu_acc": np.zeros((7, 3))}, "imu_acc has 7 samples"),
        ({"imu_gyr": np.array([[b"x"] * 3] * 9)}, "damaged"),
    ],
)
@pytest.mark.parametrize("suffix", [".hdf5", ".mat"])
def test_broad_faults(tmp_path: Path, truth, bring, change, message: str, suffix: str) -> None:
    arrays = {k: v for k, v in (trial(truth) | change).items() if v is not None}
    path = tmp_path / f"a{suffix}"
    if suffix == ".mat":
        savemat(path, arrays)
    else:
        write_hdf5(path, arrays)
    with pytest.raises(RecordingError, match=message):
        bring(path)


def test_claimed_sizes_are_not_believed(tmp_path: Path, truth, bring) -> None:
    path = tmp_path / "a.hdf5"
    with h5py.File(path, "w") as file:
        file.create_dataset("imu_gyr", shape=(10**12, 3), dtype="f8", chunks=(1024, 3))
    assert path.stat().st_size < 10_000
    with pytest.raises(RecordingError, match=r"imu_gyr claims shape \(1000000000000, 3\)"):
        bring(path)


@pytest.mark.parametrize("keep", [10, 600, 5000])
@pytest.mark.parametrize("suffix", [".hdf5", ".mat"])
def test_cut_files(tmp_path: Path, truth, bring, suffix: str, keep: int) -> None:
    path = tmp_path / f"a{suffix}"
    if suffix == ".mat":
        savemat(path, trial(truth))
    else:
        write_hdf5(path, trial(truth))
    path.write_bytes(path.read_bytes()[:keep])
    with pytest.raises(RecordingError) as caught:
        bring(path)
    assert "\n" not in str(caught.value)


TSTICK = (
    "Time (s);Vicon Orientation;;;;IMU Acceleration;;;IMU Gyroscope;;;IMU Magnetometer;;;\n"
    ";W;X;Y;Z;X;Y;Z;X;Y;Z;X;Y;Z;\n"
)
PENDULUM = (
    "Time;Vicon Orientation;;;;IMU Acceleration;;;IMU Gyroscope;;;IMU Magnetometer;;\n"
    "s;W;X;Y;Z;X;Y;Z;X;Y;Z;X;Y;Z\n"
)


def repoimu(path: Path, truth: Recording, header: str, camera: Rotation) -> Path:
    """A trial whose camera world is turned: its axes are not those of gravity."""
    rows = np.column_stack(
        (
            truth.time_s + 0.01,
            wxyz(camera * attitudes(truth)),
            9.81 * truth.up_reference,
            truth.angular_rate_rad_s,
            np.zeros((len(truth), 3)),
        )
    )
    lines = [";".join(f"{value:.12g}" for value in row) for row in rows]
    path.write_text(header + "\n".join(lines) + "\n")
    return path


@pytest.mark.parametrize("header", [TSTICK, PENDULUM], ids=["tstick", "pendulum"])
@pytest.mark.parametrize(
    "camera",
    [(0.0, 0.0, 0.0), (0.0, -np.pi / 2, 0.0), (1.0, 2.0, -0.5), (np.pi, 0.0, 0.0)],
)
def test_repoimu(tmp_path: Path, truth, bring, header: str, camera) -> None:  # type: ignore[no-untyped-def]
    turned = Rotation.from_rotvec(camera)
    imported = bring(repoimu(tmp_path / "Trial1.csv", truth, header, turned))
    got = imported.recording
    assert imported.format == "repoimu"
    np.testing.assert_allclose(got.time_s, truth.time_s, atol=1e-9)
    np.testing.assert_allclose(got.angular_rate_rad_s, truth.angular_rate_rad_s, atol=1e-9)
    np.testing.assert_allclose(got.specific_force_m_s2, 9.81 * truth.up_reference, atol=1e-9)
    np.testing.assert_allclose(got.up_reference, truth.up_reference, atol=1e-9)
    x, y, z = turned.apply((0.0, 0.0, 1.0)) + 0.0
    (up, _) = imported.guessed
    shown = [float(n) for n in up.partition("(")[2].partition(")")[0].split(",")]
    np.testing.assert_allclose(shown, (x, y, z), atol=1e-4)


def test_repoimu_where_the_cameras_lost_the_object(tmp_path: Path, truth, bring) -> None:
    path = repoimu(tmp_path / "a.csv", truth, TSTICK, Rotation.identity())
    lines = path.read_text().splitlines()
    cells = lines[12].split(";")
    lines[12] = ";".join([cells[0], "", "", "", "", *cells[5:]])
    path.write_text("\n".join(lines))
    got = bring(path).recording
    assert np.flatnonzero(~np.isfinite(got.up_reference).all(axis=1)).tolist() == [10]
    assert np.flatnonzero(~got.valid).tolist() == [10]


def test_repoimu_faults(tmp_path: Path, truth, bring) -> None:
    path = repoimu(tmp_path / "a.csv", truth, TSTICK, Rotation.identity())
    text = path.read_text()
    path.write_text(text.replace(";", ";oops;", 20))
    assert not is_repoimu(tmp_path / "nothing.csv")
    path.write_text(text[: len(TSTICK)] + "0.01;1;0\n")
    with pytest.raises(RecordingError, match="line 3 has 3 cells"):
        bring(path)
    path.write_text(text.replace("Vicon", "Optitrack"))
    with pytest.raises(RecordingError, match="not the header of a RepoIMU file"):
        bring(path, "repoimu")


def test_repoimu_orientation_of_another_trial(tmp_path: Path, truth, bring) -> None:
    path = repoimu(tmp_path / "a.csv", truth, TSTICK, Rotation.identity())
    lines = path.read_text().splitlines()
    rng = np.random.default_rng(5)
    mixed = wxyz(Rotation.random(len(truth), rng=rng))
    rows = [line.split(";") for line in lines[2:]]
    lines[2:] = [
        ";".join([row[0], *(f"{v:.9g}" for v in q), *row[5:]])
        for row, q in zip(rows, mixed, strict=True)
    ]
    path.write_text("\n".join(lines))
    with pytest.raises(RecordingError, match=r"mean force.*--no-reference"):
        bring(path)
    assert bring(path, reference=False).recording.up_reference is None
