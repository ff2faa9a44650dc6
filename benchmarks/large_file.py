"""Writes a recording that does not fit the memory, array by array and part by part."""

import sys
import zipfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

RATE_HZ = 1000.0
PART = 1_000_000
GRAVITY_M_S2 = 9.80665
BIAS_RAD_S = 0.005
Array = NDArray[np.float32]


def roll_rad(k: NDArray[np.int64]) -> NDArray[np.float64]:
    """The motion: three sines."""
    t = k / RATE_HZ
    return 0.4 * np.sin(0.7 * t) + 0.2 * np.sin(2.3 * t) + 0.05 * np.sin(11.0 * t)


def gyro(k: NDArray[np.int64], rng: np.random.Generator) -> NDArray[np.float64]:
    t = k / RATE_HZ
    rate = 0.28 * np.cos(0.7 * t) + 0.46 * np.cos(2.3 * t) + 0.55 * np.cos(11.0 * t)
    noise = 0.002 * rng.standard_normal((len(k), 3))
    return noise + np.stack([rate + BIAS_RAD_S, 0 * t, 0 * t], axis=-1)


def accel(k: NDArray[np.int64], rng: np.random.Generator) -> NDArray[np.float64]:
    roll = roll_rad(k)
    up = np.stack([0 * roll, np.sin(roll), np.cos(roll)], axis=-1)
    return GRAVITY_M_S2 * up + 0.4 * rng.standard_normal((len(k), 3))


def reference(k: NDArray[np.int64], rng: np.random.Generator) -> NDArray[np.float64]:
    return np.stack([roll_rad(k), np.zeros(len(k))], axis=-1)


def time_s(k: NDArray[np.int64], rng: np.random.Generator) -> NDArray[np.float64]:
    return k / RATE_HZ


MEMBERS: tuple[tuple[str, int, str, Callable[..., NDArray[np.float64]]], ...] = (
    ("time_s", 0, "<f8", time_s),
    ("gyro_rad_s", 3, "<f4", gyro),
    ("accel_m_s2", 3, "<f4", accel),
    ("ref_tilt_rad", 2, "<f4", reference),
)


def write_large(path: Path, samples: int) -> None:
    """Write an uncompressed ``.npz`` recording; memory stays at one part."""
    with zipfile.ZipFile(path, "w", zipfile.ZIP_STORED, allowZip64=True) as archive:
        for name, width, kind, values in MEMBERS:
            rng = np.random.default_rng(1)
            shape = (samples, width) if width else (samples,)
            with archive.open(f"{name}.npy", "w", force_zip64=True) as stream:
                np.lib.format.write_array_header_1_0(
                    stream, {"descr": kind, "fortran_order": False, "shape": shape}
                )
                for begin in range(0, samples, PART):
                    k = np.arange(begin, min(begin + PART, samples))
                    stream.write(values(k, rng).astype(kind).tobytes())


if __name__ == "__main__":
    write_large(Path(sys.argv[1]), int(float(sys.argv[2])))
