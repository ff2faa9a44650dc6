"""Designs and count vectors that the observer's core is held against its integer model on."""

from itertools import product
from pathlib import Path

import designs
import numpy as np
from numpy.typing import NDArray

from hostkit.filters.observer import BY_NAME, parameter, parameters
from hostkit.records import AxisChoice, FilterDesign, Parameter
from hostkit.render import render_target, write
from hostkit.targets import TARGETS

IntArray = NDArray[np.int64]

CORNERS = (-32768, -32767, -1, 0, 1, 32767)
REST = tuple(parameter(n, BY_NAME[n].default) for n in ("rest_rate", "rest_force", "rest_gain"))
START = (parameter("start", 0.5),)
CLIP = (parameter("clip_rate", 8.0),)
CALIBRATION = (
    parameter("gyro_bias", 0.2, "x"),
    parameter("gyro_bias", -0.3, "z"),
    parameter("gyro_scale", 0.2, "y"),
    parameter("accel_offset", -1.5, "z"),
    parameter("accel_scale", 0.1, "x"),
)
GAINS = (parameter("kt", 1.2), parameter("kv", 12.4), parameter("kb", 0.1))


def lead(seconds: float) -> tuple[Parameter, ...]:
    return (parameter("lead", seconds),)


def design(
    *chosen: Parameter,
    rate_hz: float = 100.0,
    mounting: str = "+x+y+z",
    axes: AxisChoice = "both",
    gyro_full_scale_deg_s: int = 500,
    accel_full_scale_g: int = 2,
) -> FilterDesign:
    own = designs.design(
        rate_hz=rate_hz,
        mounting=mounting,
        axes=axes,
        gyro_full_scale_deg_s=gyro_full_scale_deg_s,
        accel_full_scale_g=accel_full_scale_g,
    )
    return FilterDesign(
        filter="observer",
        axes=own.axes,
        tilt=own.tilt,
        mounting=own.mounting,
        rate_hz=own.rate_hz,
        sensor=own.sensor,
        parameters=parameters(*chosen),
    )


def varied_designs() -> tuple[FilterDesign, ...]:
    """Return designs over which every part, and extreme ranges and rates turn up."""
    return (
        design(),
        design(*REST, *START, rate_hz=25.0, mounting="-y+z-x", accel_full_scale_g=4),
        design(
            *(*REST, *START, *CLIP, *lead(0.05), *CALIBRATION, *GAINS),
            rate_hz=25.0,
            mounting="+z+x+y",
        ),
        design(
            *(*CLIP, *lead(-0.02)),
            rate_hz=1000.0,
            gyro_full_scale_deg_s=2000,
            accel_full_scale_g=16,
        ),
        design(*START, rate_hz=200.0, axes="pitch", accel_full_scale_g=8),
    )


def design_name(varied: FilterDesign) -> str:
    own = sorted({p.name for p in varied.parameters} - {"kt_rad_m", "kv_per_s", "kb_per_s"})
    return f"{varied.rate_hz:g}Hz{varied.mounting}-{varied.axes}-" + "-".join(own)


def build(built: FilterDesign, folder: Path) -> Path:
    write(render_target(built, TARGETS["spartan3adsp"]), folder)
    return folder


def count_vectors(rests: bool = True) -> tuple[IntArray, IntArray]:
    """Return counts: at rest, shaken out of it and at rest again; corners; any; smooth motion."""
    rng = np.random.default_rng(1905)
    held = np.array([3000, -2000, 7000, 250, -220, 40])
    still = held + rng.integers(-2, 3, (32 if rests else 3, 6))
    corners = rng.choice(np.array(list(product(CORNERS, repeat=3))), (6, 2)).reshape(-1, 6)
    ends = np.array([[-32768] * 6, [32767] * 6, [-32768] * 3 + [32767] * 3, [0] * 6])
    noise = rng.integers(-(2**15), 2**15, (10, 6))
    turn = np.linspace(-np.pi, np.pi, 10)[:, None]
    smooth = np.hstack([np.sin(turn + k) for k in range(6)]) * 16000
    parts = (still, held + rng.integers(-600, 600, (3, 6)), still, noise)
    counts = np.vstack([*parts, np.rint(smooth), corners, np.repeat(ends, 2, axis=0)])
    return counts[:, :3].astype(np.int64), counts[:, 3:].astype(np.int64)
