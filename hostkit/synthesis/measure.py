"""Counts the cells of a generated system, for its report."""

import tempfile
from pathlib import Path

from hostkit.records import FilterDesign, GeneratedFile
from hostkit.render import write
from hostkit.render.fpga_report import CellCounts
from hostkit.synthesis.convert import convert
from hostkit.synthesis.mapping import map_netlist
from hostkit.targets import Target

SYSTEM = "hk_system"
"""The whole but for clock and pads."""


def measure(
    files: tuple[GeneratedFile, ...], target: Target, design: FilterDesign
) -> tuple[CellCounts, ...]:
    """Convert and map the system of a rendered FPGA target and its filter, and count their cells.

    Raises
    ------
    BuildError
        If GHDL or Yosys refuses one.
    ToolMissingError
        If GHDL or Yosys is not installed.
    """
    with tempfile.TemporaryDirectory(prefix="hostkit-measure-") as name:
        folder = Path(name)
        write(files, folder)
        entities = (SYSTEM, f"hk_{design.filter}")
        return tuple(_measured(folder, entity, target.family) for entity in entities)


def _measured(folder: Path, entity: str, family: str) -> CellCounts:
    resources = map_netlist(convert(folder, entity), family).resources
    return CellCounts(
        entity=entity,
        lut=resources.lut,
        flip_flops=resources.flip_flops,
        dsp=resources.dsp,
        block_ram=resources.block_ram,
        tool=f"Yosys {resources.yosys}, family {family}",
    )
