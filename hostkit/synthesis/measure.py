"""Counts the cells of a generated system, for its report."""

import tempfile
from pathlib import Path

from hostkit.records import GeneratedFile
from hostkit.render import write
from hostkit.render.fpga_report import CellCounts
from hostkit.synthesis.convert import convert
from hostkit.synthesis.mapping import map_netlist
from hostkit.targets import Target

ENTITIES = ("hk_system", "hk_complementary")
"""The whole but for clock and pads, and the filter by itself."""


def measure(
    files: tuple[GeneratedFile, ...], target: Target, entities: tuple[str, ...] = ENTITIES
) -> tuple[CellCounts, ...]:
    """Convert and map entities of a rendered FPGA target, and count their cells.

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
