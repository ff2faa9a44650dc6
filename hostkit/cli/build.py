"""The subcommand ``build``: generated code compiled or analysed."""

from pathlib import Path

import click

from hostkit.cli.inputs import JSON
from hostkit.cli.output import emit_json
from hostkit.emulation.board import BuildResult
from hostkit.emulation.ghdl import analyse
from hostkit.emulation.run import build as run_build
from hostkit.render import FpgaOptions, read_manifest, target_of


@click.command("build")
@click.argument(
    "folder", metavar="DIR", type=click.Path(exists=True, file_okay=False, path_type=Path)
)
@JSON
def build(folder: Path, as_json: bool) -> None:
    """Compile the C, or analyse the VHDL, that `hostkit generate` wrote to DIR.

    \b
    Example:
      hostkit generate design.json --target atmega328p --out firmware
      hostkit build firmware
    """
    target = target_of(folder)
    result = _analysed(folder) if target.kind == "fpga" else run_build(folder, target)
    if as_json:
        emit_json({"schema": "hostkit.build/1", "target": target.name, **_document(result)})
    elif isinstance(result, BuildResult):
        sizes = ""
        if result.flash_bytes is not None:
            sizes = f", {result.flash_bytes} bytes of flash, {result.ram_bytes} bytes of static RAM"
        click.echo(f"{target.name}: {result.artifact}{sizes}")
    else:
        click.echo(f"{target.name}: analysed {', '.join(result)}")


def _analysed(folder: Path) -> tuple[str, ...]:
    """Analyse the filter with its bench and, in folders that have one, the top of the board."""
    options = read_manifest(folder).options
    top = options.top_name if isinstance(options, FpgaOptions) else ""
    return analyse(folder, top=top if (folder / f"{top}.vhd").is_file() else None)


def _document(result: BuildResult | tuple[str, ...]) -> dict[str, object]:
    if isinstance(result, BuildResult):
        return {
            "artifact": str(result.artifact),
            "flash_bytes": result.flash_bytes,
            "ram_bytes": result.ram_bytes,
        }
    return {"analysed": list(result)}
