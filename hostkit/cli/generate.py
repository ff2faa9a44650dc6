"""The subcommand ``generate``: from a design to code."""

from dataclasses import asdict
from pathlib import Path

import click

from hostkit.cli.chosen import chosen_options
from hostkit.cli.fpga_options import SYNTHESISE, target_options
from hostkit.cli.inputs import DESIGN, JSON, read_design, say
from hostkit.cli.output import emit_json
from hostkit.design_file import digest
from hostkit.errors import RenderError
from hostkit.records import FilterDesign
from hostkit.render import (
    FirmwareOptions,
    Options,
    default_options,
    read_manifest,
    stale_files,
    write,
)
from hostkit.render import generate as render_all
from hostkit.render.fpga_report import CellCounts
from hostkit.render.link_plan import LinkPlan, link_of
from hostkit.render.manifest import MANIFEST, Manifest, options_document
from hostkit.synthesis import measure
from hostkit.targets import TARGETS, Target

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
@SYNTHESISE
@target_options
@JSON
def generate(
    design_file: Path, target_name: str, out: Path, check: bool, synthesise: bool, as_json: bool
) -> None:
    """Render the code of DESIGN for one target.

    Options stand in the manifest.json of the folder; --check without any takes those.

    \b
    Example:
      hostkit generate design.json --target atmega328p --out firmware
      hostkit generate design.json --target atmega328p --out firmware --check
      hostkit generate design.json --target rp2040 --out pico --message RAW_IMU=50 --system-id 7
      hostkit generate design.json --target spartan3adsp --out fpga --bus axi4lite
      hostkit generate design.json --target ecp5 --out ulx3s --synthesise
    """
    design, target = read_design(design_file), TARGETS[target_name]
    standing = _standing(out, target) if check else None
    options = chosen_options(target) or (standing.options if standing else default_options(target))
    link = link_of(design, target, options) if isinstance(options, FirmwareOptions) else None
    if synthesise:
        cells = _measured(design, target, options)
    else:
        cells = standing.cells if standing else ()
    files = render_all(design, target, options, folder=out, cells=cells)
    stale = stale_files(files, out) if check else write(files, out)
    if as_json:
        emit_json(
            {
                "schema": "hostkit.generate/1",
                "target": target_name,
                "files": [file.path for file in files],
                "digest": digest(design),
                "stale": list(stale),
                "options": options_document(options),
                "cells": [asdict(counts) for counts in cells],
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


def _standing(out: Path, target: Target) -> Manifest | None:
    """Return what a folder says of itself; None if it was not made for the target."""
    if not (out / MANIFEST).is_file():
        return None
    written = read_manifest(out)
    return written if written.target == target.name else None


def _measured(design: FilterDesign, target: Target, options: Options) -> tuple[CellCounts, ...]:
    if target.kind != "fpga":
        raise click.UsageError(f"{target.name} is no FPGA; it takes no --synthesise")
    say(f"{target.name}: synthesising, which takes minutes")
    return measure(render_all(design, target, options), target, design)


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
