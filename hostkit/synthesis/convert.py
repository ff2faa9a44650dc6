"""Turns an entity of a generated folder into Verilog that other tools read."""

import tempfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from hostkit.emulation.tools import require
from hostkit.errors import BuildError
from hostkit.synthesis.process import run_tool
from hostkit.synthesis.repair import check, repair

STANDARD = "--std=93"
TIMEOUT_S = 300.0

Generic = int | bool | str


@dataclass(frozen=True, slots=True, kw_only=True)
class Converted:
    """An entity as Verilog.

    Attributes
    ----------
    entity
        Its name; the module of that name is the top.
    text
        All modules.
    products
        Signed products that have been repaired, over all modules.
    """

    entity: str
    text: str
    products: int


def convert(
    folder: Path,
    entity: str,
    generics: Mapping[str, Generic] | None = None,
    *,
    repaired: bool = True,
) -> Converted:
    """Convert an entity and what it uses.

    Parameters
    ----------
    folder
        Folder that `hostkit generate` wrote for an FPGA target.
    entity
        The top; it must have a value for every generic, from here or as a default.
    generics
        Values of its generics.
    repaired
        False leaves out repair and checks and returns what GHDL wrote, to show what they are for.

    Raises
    ------
    BuildError
        If GHDL refuses a source, or writes something that is known to be wrong.
    ToolMissingError
        If GHDL is not installed.
    """
    require("ghdl")
    folder = folder.resolve()
    options = [f"-g{name}={_literal(value)}" for name, value in (generics or {}).items()]
    with tempfile.TemporaryDirectory(prefix="hostkit-convert-") as build:
        sources = needed_sources(folder, entity)
        command = ["ghdl", "--synth", STANDARD, f"--workdir={build}", "--out=verilog", *options]
        output = run_tool([*command, *sources, "-e", entity], folder, timeout_s=TIMEOUT_S)
    text = output[: output.rindex("endmodule\n") + len("endmodule\n")]
    if not repaired:
        return Converted(entity=entity, text=text, products=0)
    check(text)
    mended = repair(text)
    return Converted(entity=entity, text=mended.text, products=mended.products)


def needed_sources(folder: Path, entity: str) -> tuple[str, ...]:
    """Return the sources of a folder that an entity needs, in the order GHDL finds.

    Raises
    ------
    BuildError
        If there is no source, or GHDL refuses one.
    """
    folder = folder.resolve()
    names = sorted(path.relative_to(folder).as_posix() for path in folder.rglob("*.vhd"))
    if not names:
        raise BuildError(f"{folder} holds no VHDL source; generate it for an FPGA target first")
    with tempfile.TemporaryDirectory(prefix="hostkit-order-") as build:
        work = f"--workdir={build}"
        run_tool(["ghdl", "-i", STANDARD, work, *names], folder, timeout_s=TIMEOUT_S)
        order = ["ghdl", "--elab-order", STANDARD, work, entity]
        found = run_tool(order, folder, timeout_s=TIMEOUT_S).splitlines()
    return tuple(line for line in found if line in names)


def _literal(value: Generic) -> str:
    return str(value).lower() if isinstance(value, bool) else str(value)
