"""The subcommand ``generate``: from a design to code."""

from pathlib import Path

import click

from hostkit.cli.inputs import DESIGN, JSON, read_design
from hostkit.cli.output import emit_json
from hostkit.design_file import digest
from hostkit.errors import RenderError
from hostkit.render import generate as render_all
from hostkit.render import stale_files, write
from hostkit.targets import TARGETS

TARGET = click.option(
    "--target",
    "target_name",
    type=click.Choice(TARGETS.names()),
    required=True,
    help="Where the code runs.",
)


@click.command("generate")
@DESIGN
@TARGET
@click.option(
    "--out",
    type=click.Path(file_okay=False, path_type=Path),
    required=True,
    metavar="DIR",
    help="Folder to write to.",
)
@click.option("--check", is_flag=True, help="Write nothing; exit 1 if a file in DIR differs.")
@JSON
def generate(design_file: Path, target_name: str, out: Path, check: bool, as_json: bool) -> None:
    """Render the code of DESIGN for one target.

    \b
    Example:
      hostkit generate design.json --target atmega328p --out firmware
      hostkit generate design.json --target atmega328p --out firmware --check
    """
    design = read_design(design_file)
    files = render_all(design, TARGETS[target_name])
    stale = stale_files(files, out) if check else write(files, out)
    if as_json:
        emit_json(
            {
                "schema": "hostkit.generate/1",
                "target": target_name,
                "files": [file.path for file in files],
                "digest": digest(design),
                "stale": list(stale),
            }
        )
    elif not check:
        click.echo(
            f"{out}: {len(files)} files for {target_name} from design {digest(design)}, "
            f"{len(stale)} of them new or changed"
        )
    elif not stale:
        click.echo(f"{out}: all {len(files)} files are as design {digest(design)} makes them")
    if check and stale:
        raise RenderError(
            f"{len(stale)} of {len(files)} files in {out} are not as the design makes them: "
            + ", ".join(stale[:5])
            + (", ..." if len(stale) > 5 else "")
        )
