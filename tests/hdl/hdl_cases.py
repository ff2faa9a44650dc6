"""Designs and count vectors that the VHDL core is held against the integer model on."""

from dataclasses import dataclass
from itertools import product
from pathlib import Path

import numpy as np
from designs import design
from numpy.typing import NDArray

from hostkit.emulation import ghdl
from hostkit.filters.complementary import lower, run_integer
from hostkit.mounting import Mounting
from hostkit.records import AXES, AxisChoice, FilterDesign
from hostkit.render import render_target, write
from hostkit.targets import TARGETS

IntArray = NDArray[np.int64]

AXIS_CHOICES: tuple[AxisChoice, ...] = ("roll", "pitch", "both")
ETAS = (0.98, 0.286, 0.99999, 0.5, 0.995)
RATES_HZ = (250.0, 20.0, 1000.0, 100.0, 500.0)
GYRO_RANGES_DEG_S = (250, 500, 1000, 2000)
ACCEL_RANGES_G = (2, 4, 8, 16, 2)
CORNERS = (-32768, 0, 32767, 1, -1)
CORE_COLUMN = {"roll": 0, "pitch": 1}


@dataclass(frozen=True, slots=True, kw_only=True)
class Core:
    """A design and the folder its core has been analysed in."""

    design: FilterDesign
    folder: Path

    def expected(self, accel_count: IntArray, gyro_count: IntArray) -> IntArray:
        """Return roll and pitch of the integer model, 0 for an axis the design lacks."""
        angles = np.zeros((len(accel_count), 2), dtype=np.int64)
        columns = [CORE_COLUMN[axis] for axis in AXES[self.design.axes]]
        angles[:, columns] = run_integer(lower(self.design), accel_count, gyro_count)
        return angles


def varied_designs() -> tuple[FilterDesign, ...]:
    """Return one design per mounting; over them every axis choice, method and format turns up."""
    return tuple(
        design(
            axes=AXIS_CHOICES[i // 2 % 3],
            tilt=("atan2", "arcsin")[i % 2],
            mounting=str(mounting),
            eta=ETAS[i % 5],
            rate_hz=RATES_HZ[i // 5 % 5],
            gyro_full_scale_deg_s=GYRO_RANGES_DEG_S[i % 4],
            accel_full_scale_g=ACCEL_RANGES_G[i // 3 % 5],
        )
        for i, mounting in enumerate(Mounting.all())
    )


def design_name(varied: FilterDesign) -> str:
    return (
        f"{varied.tilt}{varied.mounting}-{varied.axes}-eta{varied.parameter('eta')}"
        f"-{varied.rate_hz:g}Hz-{varied.sensor.gyro_full_scale_deg_s}deg_s"
    )


def build_core(built: FilterDesign, folder: Path) -> Core:
    write(render_target(built, TARGETS["spartan3adsp"]), folder)
    ghdl.analyse(folder)
    return Core(design=built, folder=folder)


def build_broken_core(folder: Path, *, source: str, good: str, bad: str) -> Core:
    """Build the core of the default design with every `good` in one source turned into `bad`."""
    write(render_target(design(), TARGETS["spartan3adsp"]), folder)
    path = folder / source
    text = path.read_text(encoding="ascii")
    assert good in text
    path.write_text(text.replace(good, bad), encoding="ascii")
    ghdl.analyse(folder)
    return Core(design=design(), folder=folder)


def count_vectors() -> tuple[IntArray, IntArray]:
    """Return accelerometer and gyroscope counts: corners, random full range, smooth motion."""
    rng = np.random.default_rng(2017)
    corners = np.array(list(product(CORNERS, repeat=3)), dtype=np.int64)
    shuffled = rng.permutation(corners)
    noise = rng.integers(-(2**15), 2**15, size=(150, 6))
    accel, gyro = zip(
        (corners, shuffled),
        (rng.permutation(corners), rng.integers(-300, 301, size=corners.shape)),
        (noise[:, :3], noise[:, 3:]),
        *(_two_turns_about(axis) for axis in range(3)),
        strict=True,
    )
    return np.concatenate(accel), np.concatenate(gyro)


def _two_turns_about(axis: int) -> tuple[IntArray, IntArray]:
    """Turn gravity twice round a sensor axis, through +-180 deg, with a steady rate."""
    angle = np.linspace(-2.0 * np.pi, 2.0 * np.pi, 120)
    force = np.zeros((len(angle), 3))
    force[:, (axis + 1) % 3] = 16000.0 * np.sin(angle)
    force[:, (axis + 2) % 3] = 16000.0 * np.cos(angle)
    force[:, axis] = 900.0
    rate = np.zeros_like(force)
    rate[:, axis] = 12000.0
    return np.rint(force).astype(np.int64), np.rint(rate).astype(np.int64)
