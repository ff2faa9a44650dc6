"""Designs and count vectors that the VHDL core is held against the integer model on."""

from dataclasses import dataclass
from itertools import product
from pathlib import Path

import numpy as np
from designs import all_parameters, design, more_parameters
from numpy.typing import NDArray
from vectors import against_the_limit, near_1_g

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


@dataclass(frozen=True, slots=True, kw_only=True)
class Core:
    """A design and the folder its core has been analysed in."""

    design: FilterDesign
    folder: Path

    def expected(self, accel_count: IntArray, gyro_count: IntArray) -> IntArray:
        """Return roll, pitch and their biases of the integer model, 0 for what the design lacks."""
        states = np.zeros((len(accel_count), 4), dtype=np.int64)
        columns = [ghdl.COLUMN[axis] for axis in AXES[self.design.axes]]
        columns += [2 + column for column in columns]
        found = run_integer(lower(self.design), accel_count, gyro_count)
        states[:, columns[: found.shape[1]]] = found
        return states


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


def option_designs() -> tuple[FilterDesign, ...]:
    """Return designs with the parameters beside eta: alone, together, and at their limits."""
    widest = {"bias_deg_s": (20.0, -20.0), "scale": (0.25, -0.25), "offset_deg": (30.0, -30.0)}
    return (
        all_parameters(),
        all_parameters(tilt="arcsin", mounting="-y-x-z", rate_hz=250.0),
        all_parameters("roll", tilt="arcsin", accel_full_scale_g=8),
        all_parameters("pitch", mounting="+z+x+y", rate_hz=20.0, eta=0.98),
        design(rate_hz=500.0, more=more_parameters(**widest)),
        design(tilt="arcsin", more=more_parameters(**widest, integral_gain=10.0)),
        design(axes="roll", accel_full_scale_g=16, more=more_parameters(gate_g=1.0)),
        design(axes="pitch", tilt="arcsin", more=more_parameters(gate_g=0.001)),
        design(axes="pitch", rate_hz=20.0, eta=0.98, more=more_parameters(integral_gain=10.0)),
        design(rate_hz=500.0, eta=0.5, more=more_parameters(gate_g=0.2, integral_gain=1e-6)),
    )


def design_name(varied: FilterDesign) -> str:
    return (
        f"{varied.tilt}{varied.mounting}-{varied.axes}-eta{varied.parameter('eta')}"
        f"-{varied.rate_hz:g}Hz-{varied.sensor.gyro_full_scale_deg_s}deg_s"
        + "".join(f"-{name}" for name in _names(varied))
    )


def _names(varied: FilterDesign) -> list[str]:
    """Return the short names of the parameters beside eta."""
    kinds = {p.name.removesuffix("_rad_s").removesuffix("_rad") for p in varied.parameters}
    return sorted({name.rsplit("_roll")[0].rsplit("_pitch")[0] for name in kinds} - {"eta"})


def build_core(built: FilterDesign, folder: Path) -> Core:
    write(render_target(built, TARGETS["spartan3adsp"]), folder)
    ghdl.analyse(folder)
    return Core(design=built, folder=folder)


def answer(run: ghdl.HdlRun) -> IntArray:
    """Return what the core answered, laid out as :meth:`Core.expected` is."""
    return np.hstack([run.angle_raw, run.hidden_raw])


def build_broken_core(
    folder: Path, *, source: str, good: str, bad: str, built: FilterDesign | None = None
) -> Core:
    """Build the core of a design with every `good` in one source turned into `bad`."""
    built = built or design()
    write(render_target(built, TARGETS["spartan3adsp"]), folder)
    path = folder / source
    text = path.read_text(encoding="ascii")
    assert good in text
    path.write_text(text.replace(good, bad), encoding="ascii")
    ghdl.analyse(folder)
    return Core(design=built, folder=folder)


def count_vectors() -> tuple[IntArray, IntArray]:
    """Return accelerometer and gyroscope counts.

    Corners, random full range, smooth motion, a force in every turn of the arc tangent.
    """
    rng = np.random.default_rng(2017)
    corners = np.array(list(product(CORNERS, repeat=3)), dtype=np.int64)
    shuffled = rng.permutation(corners)
    noise = rng.integers(-(2**15), 2**15, size=(150, 6))
    accel, gyro = zip(
        (corners, shuffled),
        (rng.permutation(corners), rng.integers(-300, 301, size=corners.shape)),
        (noise[:, :3], noise[:, 3:]),
        *(_two_turns_about(axis) for axis in range(3)),
        _every_turn(),
        strict=True,
    )
    return np.concatenate(accel), np.concatenate(gyro)


def option_vectors(varied: FilterDesign) -> tuple[IntArray, IntArray]:
    """Return those after a sample at rest, forces about the gate, a rate like a large bias."""
    limit = against_the_limit(varied, (60, 90))
    counts = np.vstack([limit[:1], np.hstack(count_vectors()), near_1_g(varied), limit])
    return counts[:, :3], counts[:, 3:]


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


def _every_turn() -> tuple[IntArray, IntArray]:
    """Point the force into the middle of each of the 64 turns of the first octant of y and z."""
    force = np.full((64, 3), 16000)
    force[:, 0] = 9000
    force[:, 1] = 16000 * (2 * np.arange(64) + 1) // 128
    return force, np.zeros_like(force)
