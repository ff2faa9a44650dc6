"""What templates see of the other files: VHDL in the order of analysis, and a list of all."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass

from hostkit.errors import RenderError
from hostkit.render.vhdl_order import units, vhdl_order


@dataclass(frozen=True, slots=True, kw_only=True)
class ProjectContext:
    """The files of an FPGA target.

    Attributes
    ----------
    sources, benches
        Paths of the VHDL to synthesise and of the VHDL to simulate only, each after what it needs.
    verilog
        Paths of Verilog that holds primitives of the vendor.
    others
        Paths of all else that comes from templates.
    """

    sources: tuple[str, ...]
    benches: tuple[str, ...]
    verilog: tuple[str, ...] = ()
    others: tuple[str, ...] = ()


def project_context(
    texts: Mapping[str, str], benches: Collection[str], others: Collection[str], top_name: str
) -> ProjectContext:
    """Sort rendered sources.

    Parameters
    ----------
    texts
        Path and text of every VHDL and Verilog source.
    benches
        Paths of those that are for simulation only.
    others
        Paths of what is no source.

    Raises
    ------
    RenderError
        If two of them declare one unit, above all if the top is called like another entity.
    """
    vhdl = {path: text for path, text in texts.items() if path.endswith(".vhd")}
    _require_free(vhdl, top_name)
    order = vhdl_order(vhdl)
    return ProjectContext(
        sources=tuple(path for path in order if path not in benches),
        benches=tuple(path for path in order if path in benches),
        verilog=tuple(sorted(path for path in texts if path.endswith(".v"))),
        others=tuple(sorted(others)),
    )


def _require_free(vhdl: Mapping[str, str], top_name: str) -> None:
    """Refuse a top that is called like another unit."""
    own = f"{top_name}.vhd"
    taken = [path for path, text in vhdl.items() if top_name.lower() in units(text)]
    others = [path for path in taken if path != own]
    if others:
        raise RenderError(
            f"top_name = {top_name!r} is already the name of a unit in {others[0]}; take another"
        )
