"""The subcommand ``generate``: from a design to code."""

from pathlib import Path

import click

from hostkit.cli.firmware_options import chosen_options, firmware_options
from hostkit.cli.inputs import DESIGN, JSON, read_design
from hostkit.cli.output import emit_json
from hostkit.design_file import digest
from hostkit.errors import RenderError
from hostkit.render import DEFAULT_OPTIONS, FirmwareOptions, read_manifest, stale_files, write
from hostkit.render import generate as render_all
from hostkit.render.link_plan import LinkPlan, link_of
from hostkit.render.manifest import MANIFEST, options_document
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
@firmware_options
@JSON
def generate(design_file: Path, target_name: str, out: Path, check: bool, as_json: bool) -> None:
    """Render the code of DESIGN for one target.

    Options of the firmware stand in its manifest.json; --check without any takes those.

    \b
    Example:
      hostkit generate design.json --target atmega328p --out firmware
      hostkit generate design.json --target atmega328p --out firmware --check
      hostkit generate design.json --target rp2040 --out pico --message RAW_IMU=50 --system-id 7
    """
    design, target = read_design(design_file), TARGETS[target_name]
    options = chosen_options() or (_written_options(out) if check else DEFAULT_OPTIONS)
    link = None if target.kind == "fpga" else link_of(design, target, options)
    files = render_all(design, target, options, folder=out)
    stale = stale_files(files, out) if check else write(files, out)
    if as_json:
        emit_json(
            {
                "schema": "hostkit.generate/1",
                "target": target_name,
                "files": [file.path for file in files],
                "digest": digest(design),
                "stale": list(stale),
                "options": link and options_document(options),
                "link": link and _link_document(link),
            }
        )
    elif not check:
        click.echo(
            f"{out}: {len(files)} files for {target_name} from design {digest(design)}, "
            f"{len(stale)} of them new or changed"
        )
        if link:
            click.echo(f"link: {link.summary}")
    elif not stale:
        click.echo(f"{out}: all {len(files)} files are as design {digest(design)} makes them")
    if check and stale:
        raise RenderError(
            f"{len(stale)} of {len(files)} files in {out} are not as the design makes them: "
            + ", ".join(stale[:5])
            + (", ..." if len(stale) > 5 else "")
        )


def _written_options(out: Path) -> FirmwareOptions:
    """Return the options that a folder was made with; one that is not there has the defaults."""
    return read_manifest(out).options if (out / MANIFEST).is_file() else DEFAULT_OPTIONS


def _link_document(link: LinkPlan) -> dict[str, object]:
    return {
        "baud": link.baud,
        "usable_bytes_per_s": link.usable_bytes_s,
        "bytes_per_s": link.bytes_per_s,
        "messages": [
            {"name": m.name, "rate_hz": m.rate_hz, "frame_bytes": m.frame_bytes}
            for m in link.running
        ],
    }
