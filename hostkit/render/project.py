"""What templates see of the other files: VHDL in the order of analysis, and a list of all."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass

from hostkit.render.vhdl_order import vhdl_order


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
    texts: Mapping[str, str], benches: Collection[str], others: Collection[str]
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
    """
    vhdl = {path: text for path, text in texts.items() if path.endswith(".vhd")}
    order = vhdl_order(vhdl)
    return ProjectContext(
        sources=tuple(path for path in order if path not in benches),
        benches=tuple(path for path in order if path in benches),
        verilog=tuple(sorted(path for path in texts if path.endswith(".v"))),
        others=tuple(sorted(others)),
    )
