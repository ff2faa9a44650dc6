"""What the three-dimensional filter costs: on this machine against VQF, on boards, in an FPGA."""

import tempfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from benchmarks.device_cost import COLUMNS, Contender, costs_of
from benchmarks.table import MISSING, Table, figure
from hostkit.comparison import CompareOptions, Cost, costs
from hostkit.errors import HostkitError
from hostkit.mounting import Mounting
from hostkit.recordings import Recording
from hostkit.records import FilterDesign, SensorConfig
from hostkit.render import render_target, write
from hostkit.simulation import SensorErrors, simulate
from hostkit.synthesis import convert, map_netlist
from hostkit.targets import TARGETS
from hostkit.tuning import TUNERS

SENSOR = SensorConfig(
    part="mpu6050", gyro_full_scale_deg_s=500, accel_full_scale_g=4, low_pass_setting=3
)
PEERS = ("vqf-online", "vqf-basic")
AIM = 8.0
"""An update shall cost at most one of so many parts of VQF's."""
LUT_AIM, DSP_AIM = 2500, 4
RATE_HZ, DURATION_S = 100.0, 40.0


def tables() -> Iterator[Table]:
    """Return the cost on this machine, on the emulated boards, and in cells of an FPGA."""
    yield on_this_machine()
    yield on_boards()
    yield in_an_fpga()


def observer_design() -> FilterDesign:
    """Return a design of the observer that was not tuned."""
    return FilterDesign(
        filter="observer",
        axes="both",
        tilt="atan2",
        mounting=Mounting(),
        rate_hz=RATE_HZ,
        sensor=SENSOR,
        parameters=TUNERS["observer"].default(),
    )


def on_this_machine() -> Table:
    """Time our generated C and VQF's C++ in turns."""
    found = costs(_motion(), CompareOptions(peers=PEERS))
    vqf = next((c.ns_per_sample for c in found if c.name == PEERS[0]), None)
    return Table(
        title=f"An update on this machine, {DURATION_S:g} s of simulated free motion",
        columns=("filter", "ns a sample", "VQF / this"),
        rows=tuple(_timed(cost, vqf) for cost in found),
        remarks=(
            f"The aim of the observer in floats is {AIM:g}. Ours is compiled with -O2, as by its "
            "own Makefile; VQF is the wheel from PyPI.",
            *(f"{c.title}, {c.timed}: {c.reason}" for c in found if c.reason),
        ),
    )


def _motion() -> Recording:
    return simulate(
        "free",
        duration_s=DURATION_S,
        rate_hz=RATE_HZ,
        sensor=SENSOR,
        errors=SensorErrors(),
        rng=np.random.default_rng(1),
    )


def _timed(cost: Cost, vqf_ns: float | None) -> tuple[str, ...]:
    words, ns = f"{cost.title}: {cost.timed}", cost.ns_per_sample
    if ns is None:
        return (words, MISSING, MISSING)
    return (words, figure(ns), MISSING if vqf_ns is None else figure(vqf_ns / ns))


def on_boards() -> Table:
    """Count cycles of an update on the emulated boards."""
    design = observer_design()
    contenders = (
        Contender(title="observer in integers", arithmetic="fixed"),
        Contender(title="observer in floats"),
    )
    rows, remarks = [], []
    for one in contenders:
        try:
            rows.append((one.title, *costs_of(one, design)))
        except HostkitError as error:
            rows.append((one.title, *[MISSING] * (len(COLUMNS) - 1)))
            remarks.append(f"{one.title}: {error}")
    return Table(
        title=f"One update with both angles, mean, max, {RATE_HZ:g} Hz, wild motion",
        columns=COLUMNS,
        rows=tuple(rows),
        remarks=tuple(remarks),
    )


def in_an_fpga() -> Table:
    """Count the cells of the core in a Spartan-3A DSP."""
    try:
        row, remark = _cells(), f"The aims are {LUT_AIM} LUT and {DSP_AIM} DSP48A."
    except HostkitError as error:
        row, remark = (MISSING,) * 4, str(error)
    return Table(
        title="Cells of the Spartan-3A DSP, one channel",
        columns=("core", "LUT", "flip-flops", "DSP48A", "block RAM"),
        rows=(("observer", *row),),
        remarks=(remark,),
    )


def _cells() -> tuple[str, ...]:
    with tempfile.TemporaryDirectory(prefix="hostkit-fpga-") as name:
        folder = Path(name)
        write(render_target(observer_design(), TARGETS["spartan3adsp"]), folder)
        found = map_netlist(convert(folder, "hk_observer"), "xc3sda").resources
    return tuple(map(str, (found.lut, found.flip_flops, found.dsp, found.block_ram)))
