"""What one update costs on a device: our filter in integers and in floats, and its peers."""

import shutil
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np

from benchmarks.peer_models import MODELS
from benchmarks.table import MISSING, Table
from hostkit.emulation import avr_board, rp2040_board, stm32_board
from hostkit.emulation.board import Stimulus
from hostkit.errors import ToolMissingError
from hostkit.records import FilterDesign
from hostkit.render import generate, write
from hostkit.render.options import FirmwareOptions
from hostkit.sensors.mpu6050 import settle_samples
from hostkit.targets import TARGETS

SOURCES = Path(__file__).with_name("firmware")
COMMON = ("hk_filter.c", "peer.h", "quaternion.h")
SAMPLES = 400
BOARDS = {"atmega328p": avr_board, "rp2040": rp2040_board, "stm32f103": stm32_board}
COLUMNS = ("filter", "ATmega328P, cycles", "RP2040, cycles", "STM32F103, instructions")


@dataclass(frozen=True, slots=True, kw_only=True)
class Contender:
    """A filter: ours in one arithmetic, or a peer by the name of its C file."""

    title: str
    arithmetic: Literal["fixed", "float"] = "float"
    peer: str | None = None


CONTENDERS = (
    Contender(title="ours in integers: two angles", arithmetic="fixed"),
    Contender(title="ours in floats: two angles"),
    Contender(title="Kalman: two angles and biases", peer="kalman"),
    Contender(title="Mahony: quaternion and bias", peer="mahony"),
    Contender(title="Madgwick: quaternion", peer="madgwick"),
)


def cost_table(design: FilterDesign) -> Table:
    """Measure every filter on every board, on the same wild motion."""
    return Table(
        title=f"One update, mean, max: two axes, {design.tilt}, {design.rate_hz:g} Hz, {SAMPLES} "
        "samples of wild motion",
        columns=COLUMNS,
        rows=tuple((one.title, *costs_of(one, design)) for one in CONTENDERS),
        remarks=(
            "All floats are of 32 bits and computed by the compilers' libraries. Quaternions are "
            "not turned into angles within the update; counts are turned into floats.",
        ),
    )


def code(contender: Contender, target: str, design: FilterDesign, folder: Path) -> None:
    """Write the firmware that runs a filter."""
    options = FirmwareOptions(arithmetic=contender.arithmetic)
    write(generate(design, TARGETS[target], options), folder)
    if contender.peer is not None:
        assert contender.peer in MODELS
        for name in (*COMMON, f"{contender.peer}.c"):
            shutil.copyfile(SOURCES / name, folder / name)


def wild_motion(design: FilterDesign) -> Stimulus:
    """Return rates and forces without any order."""
    rng = np.random.default_rng(3)
    return Stimulus(
        angular_rate_rad_s=rng.normal(0.0, 3.0, (SAMPLES, 3)),
        specific_force_m_s2=rng.normal(0.0, 8.0, (SAMPLES, 3)),
        temperature_deg_c=np.full(SAMPLES, 25.0),
        settle_samples=settle_samples(design.sensor, design.rate_hz),
    )


def costs_of(contender: Contender, design: FilterDesign) -> Iterator[str]:
    """Return mean and most of an update on each board, as text."""
    for target, board in BOARDS.items():
        with tempfile.TemporaryDirectory() as text:
            folder = Path(text)
            code(contender, target, design, folder)
            try:
                board.build(folder)
                run = board.run(folder, wild_motion(design))
            except ToolMissingError:
                yield MISSING
                continue
        yield f"{run.cycles_mean:.0f}, {run.cycles_max:.0f}"
