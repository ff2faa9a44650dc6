"""Size of the core in the cells of two FPGA families, speed after place and route, throughput."""

import tempfile
from collections.abc import Iterator
from pathlib import Path

from benchmarks.table import MISSING, Table, figure
from hostkit.errors import ToolMissingError
from hostkit.filters.complementary import parameters
from hostkit.mounting import Mounting
from hostkit.records import AxisChoice, FilterDesign, SensorConfig, TiltMethod
from hostkit.render import render_target, write
from hostkit.synthesis import Mapped, convert, map_netlist
from hostkit.synthesis.place import place_seeds
from hostkit.targets import TARGETS

TOP = "hk_complementary_fixed"
SEEDS = (1, 2, 3)
ASKED_MHZ = {False: 100.0, True: 170.0}
CLOCKS_A_SAMPLE = {("atan2", False): 55, ("atan2", True): 1}
"""Counted in ``tests/hdl``; a pipelined core with many channels takes a sample a clock."""

DESIGNS: tuple[tuple[TiltMethod, AxisChoice], ...] = (
    ("atan2", "both"),
    ("atan2", "roll"),
    ("atan2", "pitch"),
    ("arcsin", "both"),
)
SIZES = ((1, False), (4, False), (64, False), (512, False), (1024, False), (64, True))


def tables() -> Iterator[Table]:
    """Return the sizes, then the speeds."""
    with tempfile.TemporaryDirectory(prefix="hostkit-fpga-") as name:
        yield _sizes(Path(name))
        yield _speeds(Path(name))


def _design(tilt: TiltMethod, axes: AxisChoice) -> FilterDesign:
    sensor = SensorConfig(
        part="mpu6050", gyro_full_scale_deg_s=500, accel_full_scale_g=2, low_pass_setting=3
    )
    return FilterDesign(
        filter="complementary",
        axes=axes,
        tilt=tilt,
        mounting=Mounting.parse("+x+y+z"),
        rate_hz=250.0,
        sensor=sensor,
        parameters=parameters(0.98),
    )


def _mapped(
    root: Path, family: str, case: tuple[TiltMethod, AxisChoice], size: tuple[int, bool]
) -> Mapped:
    folder = root / "-".join(case)
    if not folder.exists():
        write(render_target(_design(*case), TARGETS["spartan3adsp"]), folder)
    channels, pipelined = size
    return map_netlist(convert(folder, TOP, {"CHANNELS": channels, "PIPELINED": pipelined}), family)


def _sizes(root: Path) -> Table:
    cases = [(case, (1, False)) for case in DESIGNS] + [(DESIGNS[0], size) for size in SIZES[1:]]
    rows = []
    for case, size in cases:
        found = _mapped(root, "xc3sda", case, size).resources
        numbers = (size[0], found.lut, found.flip_flops, found.dsp, found.block_ram)
        kind = "pipelined" if size[1] else "iterative"
        rows.append((f"{case[0]}, {case[1]}, {kind}", *map(str, numbers)))
    return Table(
        title="Cells of the Spartan-3A DSP; settings of the design, eta alone.",
        columns=("core", "channels", "LUT", "flip-flops", "DSP48A", "block RAM"),
        rows=tuple(rows),
        remarks=("LUT counts LUT1 to LUT4 and memory in tables.",),
    )


def _speeds(root: Path) -> Table:
    rows = []
    for size in ((1, False), (16, True), (64, True)):
        mapped = _mapped(root, "ecp5", DESIGNS[0], size)
        try:
            found = [
                placed.fmax_mhz
                for placed in place_seeds(mapped, SEEDS, target_mhz=ASKED_MHZ[size[1]])
            ]
        except ToolMissingError:
            found = []
        clocks = CLOCKS_A_SAMPLE["atan2", size[1]]
        least, most = (figure(f(found)) if found else MISSING for f in (min, max))
        rate = figure(min(found) / clocks) if found else MISSING
        kind = "pipelined" if size[1] else "iterative"
        numbers = (str(size[0]), str(mapped.resources.lut), least, most, str(clocks), rate)
        rows.append((f"atan2, both, {kind}", *numbers))
    return Table(
        title=f"Place and route for the ECP5, speed grade 6, seeds {SEEDS}.",
        columns=("core", "channels", "LUT4", "least MHz", "most MHz", "clocks", "MS/s"),
        rows=tuple(rows),
        remarks=("MS/s: million samples a second at the least frequency.",),
    )
