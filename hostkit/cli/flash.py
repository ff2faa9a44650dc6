"""The subcommand ``flash``: generated code into a board."""

import shlex
from pathlib import Path

import click

from hostkit.cli.inputs import JSON, say
from hostkit.cli.output import emit_json
from hostkit.flashing import PROGRAMMERS, FlashPlan, plan_flash
from hostkit.flashing import flash as run_flash
from hostkit.flashing.loading import BOOT_BAUD
from hostkit.link.ports.lease import borrow_port
from hostkit.render import target_of
from hostkit.targets import Target

NAMES = tuple(dict.fromkeys(way.name for way in PROGRAMMERS))


@click.command("flash")
@click.argument(
    "folder", metavar="DIR", type=click.Path(exists=True, file_okay=False, path_type=Path)
)
@click.option("--port", metavar="P", help="Serial port of the board, or drive of a Pico.")
@click.option(
    "--programmer",
    type=click.Choice(NAMES),
    help="What loads the board; by default the first that is installed.",
)
@click.option(
    "--boot-baud",
    type=click.IntRange(min=1),
    default=BOOT_BAUD,
    show_default=True,
    metavar="N",
    help="Rate of an Arduino's boot loader, bit/s; 57600 for an old Nano.",
)
@click.option("--no-build", is_flag=True, help="Load the image as it stands in DIR.")
@click.option("--dry-run", is_flag=True, help="Say what would be run, and do nothing.")
@JSON
def flash(
    folder: Path,
    port: str | None,
    programmer: str | None,
    boot_baud: int,
    no_build: bool,
    dry_run: bool,
    as_json: bool,
) -> None:
    """Load the code that `hostkit generate` wrote to DIR into a board.

    \b
    Example:
      hostkit flash firmware --port /dev/ttyACM0
      hostkit flash pico --programmer uf2
      hostkit flash bluepill --dry-run
    """
    target = target_of(folder)
    plan = plan_flash(folder, target, port=port, programmer=programmer, boot_baud=boot_baud)
    say(f"in {folder}: {shlex.join(plan.command)}")
    if not dry_run:
        _load(plan, target, build_first=not no_build)
    if as_json:
        emit_json(
            {
                "schema": "hostkit.flash/1",
                "target": target.name,
                "programmer": plan.programmer.name,
                "command": list(plan.command),
                "flashed": not dry_run,
            }
        )
    elif not dry_run:
        click.echo(f"{target.name}: loaded by {plan.programmer.name}")


def _load(plan: FlashPlan, target: Target, *, build_first: bool) -> None:
    """Load the board, with its port to oneself if another hostkit process is watching it."""
    if plan.port is None or plan.programmer.port_use == "drive":
        run_flash(plan, target, build_first=build_first)
        return
    with borrow_port(plan.port) as borrowed:
        if borrowed:
            say(f"another hostkit process has released {plan.port} and takes it again afterwards")
        run_flash(plan, target, build_first=build_first)
