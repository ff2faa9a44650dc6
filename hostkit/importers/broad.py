"""Importer of the BROAD data set's own files, ``.hdf5`` and ``.mat``.

Facts: D. Laidig, M. Caruso, A. Cereatti, T. Seel, "BROAD - A Benchmark for Robust Inertial
Orientation Estimation", Data 6(7):72, 2021, doi 10.3390/data6070072. Rates are in rad/s, forces in
m/s^2, fields in microtesla; ``opt_quat`` turns sensor axes into an east-north-up world and is NaN
where the cameras lost the object; ``movement`` marks the samples that the benchmark scores.
"""

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from hostkit.errors import RecordingError
from hostkit.importers.foreign import head, need, reading
from hostkit.importers.log import (
    MAX_SAMPLES,
    Importer,
    Progress,
    ReferenceTrack,
    SensorLog,
    Vector,
)
from hostkit.importers.options import ImportOptions

HDF5_MAGIC = b"\x89HDF\r\n\x1a\n"
HDF5_OFFSETS = (0, 512)
"""Where the signature may stand; MATLAB's version 7.3 puts a header of 512 bytes before it."""
MAT5_MAGIC = b"MATLAB 5.0 MAT-file"
WIDTHS = {
    "imu_gyr": 3,
    "imu_acc": 3,
    "imu_mag": 3,
    "opt_quat": 4,
    "movement": 1,
    "sampling_rate": 1,
}
NEEDED = ("imu_gyr", "imu_acc", "sampling_rate")
LICENCE = "CC BY 4.0"

Arrays = Mapping[str, Vector]


def sniff(path: Path) -> bool:
    """Tell whether a file is HDF5 or a MATLAB file."""
    start = head(path)
    hdf5 = any(start[at:].startswith(HDF5_MAGIC) for at in HDF5_OFFSETS)
    return hdf5 or start.startswith(MAT5_MAGIC)


def read(path: Path, options: ImportOptions, progress: Progress) -> SensorLog:
    """Read one trial.

    Raises
    ------
    RecordingError
        If the file is damaged, lacks an array, or an array has another shape than it should.
    ToolMissingError
        If h5py is not installed.
    """
    progress(0, 1)
    is_mat5 = head(path).startswith(MAT5_MAGIC)
    arrays = _read_mat5(path) if is_mat5 else _read_hdf5(path)
    progress(1, 1)
    missing = [name for name in NEEDED if name not in arrays]
    if missing:
        raise RecordingError(
            f"it lacks the array(s) {', '.join(missing)} of a BROAD trial; of those it has: "
            f"{', '.join(arrays) or 'none'}"
        )
    rate_hz = float(arrays["sampling_rate"].flat[0])
    if not (np.isfinite(rate_hz) and rate_hz > 0.0):
        raise RecordingError(f"sampling_rate = {rate_hz}; it must be a rate above 0 Hz")
    samples = len(arrays["imu_gyr"])
    time_s = np.arange(samples) / rate_hz
    attitude = arrays.get("opt_quat")
    track = None
    if attitude is not None and options.reference:
        track = ReferenceTrack(time_s=time_s.copy(), quaternion_wxyz=attitude)
    return SensorLog(
        time_s=time_s,
        angular_rate_rad_s=arrays["imu_gyr"],
        specific_force_m_s2=arrays["imu_acc"],
        rate_hz=rate_hz,
        reference=track,
        mag_ut=arrays.get("imu_mag"),
        valid=_valid(arrays, samples),
        sensor="myon aktos-t",
        licence=LICENCE,
    )


def _valid(arrays: Arrays, samples: int) -> NDArray[np.bool_]:
    """Return the samples in movement whose reference is known."""
    valid = np.ones(samples, dtype=np.bool_)
    if "movement" in arrays:
        valid &= arrays["movement"][:, 0] != 0.0
    if "opt_quat" in arrays:
        valid &= np.isfinite(arrays["opt_quat"]).all(axis=1)
    return valid


def _read_hdf5(path: Path) -> Arrays:
    h5py = need("h5py", "BROAD")
    with reading("HDF5 file"), h5py.File(path, "r") as file:
        found = {}
        for name in WIDTHS:
            if name in file:
                _require_size(name, file[name].shape)
                found[name] = np.asarray(file[name][()], dtype=np.float64)
    return _shaped(found)


def _read_mat5(path: Path) -> Arrays:
    with reading("MATLAB file"):
        from scipy.io import loadmat, whosmat

        for name, shape, _ in whosmat(path):
            if name in WIDTHS:
                _require_size(name, shape)
        loaded = loadmat(path, variable_names=list(WIDTHS))
        found = {n: np.asarray(loaded[n], dtype=np.float64) for n in WIDTHS if n in loaded}
    return _shaped(found)


def _require_size(name: str, shape: tuple[int, ...]) -> None:
    cells = int(np.prod(shape, dtype=np.float64)) if shape else 1
    if cells > MAX_SAMPLES * WIDTHS[name]:
        raise RecordingError(f"{name} claims shape {shape}; the limit is {MAX_SAMPLES} samples")


def _shaped(found: Mapping[str, Vector]) -> Arrays:
    """Return every array with one row per sample; MATLAB's version 7.3 has them lying."""
    arrays = {}
    for name, array in found.items():
        width = WIDTHS[name]
        standing = array.reshape(-1, 1) if width == 1 else array
        if standing.ndim == 2 and standing.shape[0] == width != standing.shape[1]:
            standing = standing.T
        if standing.ndim != 2 or standing.shape[1] != width or not standing.size:
            raise RecordingError(f"{name} has shape {array.shape}; it must be (samples, {width})")
        arrays[name] = standing
    samples = len(arrays["imu_gyr"]) if "imu_gyr" in arrays else 0
    for name, array in arrays.items():
        if name != "sampling_rate" and len(array) != samples:
            raise RecordingError(f"{name} has {len(array)} samples, imu_gyr has {samples}")
    return arrays


IMPORTER = Importer(
    name="broad",
    title="trial of the BROAD data set, HDF5 or MATLAB",
    suffixes=(".hdf5", ".h5", ".mat"),
    sniff=sniff,
    read=read,
)
