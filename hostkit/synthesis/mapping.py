"""Maps converted Verilog to the cells of a family with Yosys, and counts them."""

import re
import tempfile
from dataclasses import dataclass
from pathlib import Path

from hostkit.emulation.tools import require
from hostkit.errors import BuildError
from hostkit.render.environment import template_root
from hostkit.synthesis.convert import Converted
from hostkit.synthesis.process import run_tool

TIMEOUT_S = 600.0
ECP5_PRODUCT = template_root("fpga") / "ecp5" / "hk_product.v"
_ROW = re.compile(r"^ +(?:(\S+) +(\d+)|(\d+) +(\S+))$", re.MULTILINE)
_VERSION = re.compile(r"Yosys (\d+\.\d+)")


@dataclass(frozen=True, slots=True, kw_only=True)
class Family:
    """How Yosys maps to a family, and which of its cells are counted as what.

    Attributes
    ----------
    command
        The mapping; ``{top}`` is the top module.
    latch
        Pattern of the cells that must not turn up.
    lut, flip_flop, dsp, block_ram
        Patterns of cell types; memory in tables counts as tables.
    """

    command: str
    latch: str
    lut: str
    flip_flop: str
    dsp: str
    block_ram: str


# xilinx_dsp of Yosys 0.23 takes a register with the product into the DSP48A even if it holds the
# sign twice, and leaves the second sign without a driver: wreduce removes such bits before.
_XC3SDA = """
    synth_xilinx -family xc3sda -flatten -top {top} -run begin:map_dsp
    wreduce
    opt_clean
    synth_xilinx -family xc3sda -flatten -top {top} -run map_dsp:
"""

FAMILIES = {
    "xc3sda": Family(
        command=_XC3SDA,
        latch="t:LD*",
        lut=r"LUT\d|RAM\d+X\d\w*|SRL\w+",
        flip_flop=r"FD\w+",
        dsp=r"DSP48A",
        block_ram=r"RAMB16\w+",
    ),
    "ecp5": Family(
        command="synth_ecp5 -top {top} -json netlist.json",
        latch="t:$_DLATCH*",
        lut=r"LUT4|TRELLIS_DPR16X4",
        flip_flop=r"TRELLIS_FF",
        dsp=r"MULT18X18D",
        block_ram=r"DP16KD|PDPW16KD",
    ),
}
"""The families by name; ``xc3sda`` is the Spartan-3A DSP."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Resources:
    """Cells of a mapped core.

    Attributes
    ----------
    lut
        Look-up tables of any size, those that Yosys uses as feed-throughs to carry chains included.
    cells
        Pairs of cell type and number, sorted by type.
    yosys
        Version of Yosys.
    """

    lut: int
    flip_flops: int
    dsp: int
    block_ram: int
    cells: tuple[tuple[str, int], ...]
    yosys: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Mapped:
    """A core in the cells of a family: the netlist as Verilog and, for ECP5, as JSON."""

    entity: str
    resources: Resources
    netlist: str
    netlist_json: str


def map_netlist(converted: Converted, family: str, *, dsp: int | None = None) -> Mapped:
    """Map a converted entity.

    Parameters
    ----------
    family
        A name in :data:`FAMILIES`.
    dsp
        The number of multiplier blocks it must have; any if None.

    Raises
    ------
    BuildError
        If Yosys refuses it, or finds a latch or another number of multiplier blocks.
    ToolMissingError
        If Yosys is not installed.
    """
    require("yosys")
    chosen = FAMILIES[family]
    blocks = family == "ecp5" and re.search(r"^module hk_product$", converted.text, re.MULTILINE)
    script = [
        "read_verilog converted.v",
        *([f"read_verilog -overwrite {ECP5_PRODUCT.name}"] if blocks else []),
        *chosen.command.format(top=converted.entity).strip().splitlines(),
        "tee -q -o cells.txt stat",
        f"select -assert-none {chosen.latch}",
        *([] if dsp is None else [f"select -assert-count {dsp} t:{chosen.dsp}"]),
        "write_verilog -noattr netlist.v",
    ]
    with tempfile.TemporaryDirectory(prefix="hostkit-map-") as name:
        build = Path(name)
        (build / ECP5_PRODUCT.name).write_bytes(ECP5_PRODUCT.read_bytes())
        (build / "converted.v").write_text(converted.text, encoding="utf-8")
        command = ["yosys", "-q", "-p", "; ".join(script)]
        run_tool(command, build, timeout_s=TIMEOUT_S)
        json_file = build / "netlist.json"
        return Mapped(
            entity=converted.entity,
            resources=_counted((build / "cells.txt").read_text("utf-8"), chosen),
            netlist=(build / "netlist.v").read_text(encoding="utf-8"),
            netlist_json=json_file.read_text(encoding="utf-8") if json_file.exists() else "",
        )


def yosys_version() -> str:
    """Return the version of the installed Yosys, such as ``0.23``.

    Raises
    ------
    BuildError
        If it does not say.
    ToolMissingError
        If Yosys is not installed.
    """
    require("yosys")
    said = run_tool(["yosys", "-V"], Path.cwd(), timeout_s=TIMEOUT_S)
    found = _VERSION.search(said)
    if found is None:
        raise BuildError(f"yosys gave no version but {said[:40]!r}")
    return found.group(1)


def _counted(report: str, family: Family) -> Resources:
    """Read the table of cells, in which later versions put the number first."""
    table = report[report.rindex("cells") :]
    cells = {
        name or later_name: int(number or later_number)
        for name, number, later_number, later_name in _ROW.findall(table)
    }

    def total(pattern: str) -> int:
        return sum(number for name, number in cells.items() if re.fullmatch(pattern, name))

    return Resources(
        lut=total(family.lut),
        flip_flops=total(family.flip_flop),
        dsp=total(family.dsp),
        block_ram=total(family.block_ram),
        cells=tuple(sorted(cells.items())),
        yosys=yosys_version(),
    )
