"""The committed samples: designs, their stimulus, and where they stand."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from designs import all_parameters, design
from observing import all_counts, full_design
from vectors import against_the_limit, near_1_g

from hostkit.filters import FILTERS
from hostkit.records import FilterDesign
from hostkit.render import render_target
from hostkit.targets import TARGETS

ROOT = Path(__file__).resolve().parents[2]
GENERATED = ROOT / "generated"
MCU_NAMES = ("host", "atmega328p")
FPGA_NAME = "spartan3adsp"
VECTORS = "vectors.txt"
HEADER = "accel x y z, gyro x y z: s16 counts; roll, pitch: s32 half turns; restarted"
HIDDEN_HEADER = "; hidden words: s32"


@dataclass(frozen=True)
class Sample:
    name: str
    design: FilterDesign
    fpga_names: tuple[str, ...] = (FPGA_NAME,)

    @property
    def folder(self) -> Path:
        return GENERATED / self.name

    @property
    def header(self) -> str:
        hidden = FILTERS[self.design.filter].lower(self.design).hidden
        words = ", ".join(f"{word.name} ({word.per_unit:.6g} {word.unit})" for word in hidden)
        return f"{HEADER}{HIDDEN_HEADER} {words}" if hidden else HEADER

    @property
    def counts(self) -> np.ndarray:
        """The stimulus, and for a filter with more than eta what tries the rest of it."""
        if self.design.filter == "observer":
            return all_counts(self.design)
        if len(self.design.parameters) == 1:
            return stimulus()
        more = [near_1_g(self.design), against_the_limit(self.design, (400, 500))]
        return np.concatenate([stimulus(), *more])

    def __str__(self) -> str:
        return self.name


SAMPLES = (
    Sample("two-axis-atan2", design()),
    Sample(
        "paper-arcsin",
        design(
            axes="pitch",
            tilt="arcsin",
            eta=0.412,
            rate_hz=20.0,
            gyro_full_scale_deg_s=2000,
            low_pass_setting=5,
        ),
    ),
    Sample("observer", full_design()),
    Sample("all-parameters", all_parameters(), ("spartan3adsp", "ecp5")),
)


def target_files(sample: Sample, name: str) -> dict[str, str]:
    """Return path and content of all files of a target."""
    return {file.path: file.content for file in render_target(sample.design, TARGETS[name])}


def committed_files(sample: Sample) -> dict[str, str]:
    """Return what of the targets is committed.

    An FPGA takes some fifty files, so the first sample has all of them, and the others only those
    that are not the same there.
    """
    found = {}
    shared = {} if sample is SAMPLES[0] else target_files(SAMPLES[0], FPGA_NAME)
    for name in (*MCU_NAMES, *sample.fpga_names):
        common = {} if name in MCU_NAMES else shared
        for path, content in target_files(sample, name).items():
            if common.get(path) != content:
                found[f"{name}/{path}"] = content
    return found


def stimulus() -> np.ndarray:
    """Counts of shape ``(N, 6)``: corners, full-range noise, and a turn through +-180 deg."""
    rng = np.random.default_rng(2017)
    edges = np.array([-32768, -32767, -16384, -1, 0, 1, 16384, 32767])
    corners = rng.choice(edges, (200, 6))
    noise = rng.integers(-32768, 32768, (200, 6))
    angle = np.linspace(0.0, 4.0 * np.pi, 400)
    turn = np.zeros((400, 6))
    turn[:, 1], turn[:, 2] = 15000 * np.sin(angle), 15000 * np.cos(angle)
    turn[:, 0], turn[:, 4] = 6000 * np.sin(angle / 3), 2000 * np.cos(angle / 3)
    turn[:, 3] = 900
    turn += rng.normal(0, 60, turn.shape)
    zero = np.zeros((2, 6))
    return np.concatenate([corners, zero, noise, np.round(turn)]).astype(np.int64)
