"""The options of ``emulate`` that run a whole FPGA system."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import click

from hostkit.cli.chosen import Command
from hostkit.emulation.comparison import EmulationResult
from hostkit.emulation.fault import Fault
from hostkit.emulation.fpga_system import emulate_system
from hostkit.emulation.system_bench import build_system
from hostkit.recordings import Recording
from hostkit.records import FilterDesign
from hostkit.targets import Target

CHOSEN: Final = "hostkit.system"
SAMPLES: Final = 100
"""Rows that are played unless more are asked for; GHDL takes some seconds for them."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SystemChoice:
    """How many rows of the recording to play, and where the frames go."""

    samples: int = SAMPLES
    record: Path | None = None


def system_options(command: Command) -> Command:
    """Give a subcommand the options of a run of the whole system; see :func:`chosen_system`."""
    for option in reversed(_OPTIONS):
        command = option(command)
    return command


def chosen_system(target: Target) -> SystemChoice | None:
    """Return how the whole system is to be run; None if it is not.

    Raises
    ------
    click.UsageError
        If the target is no FPGA, or an option is of no use without ``--system``.
    """
    noted: dict[str, Any] = click.get_current_context().meta.get(CHOSEN, {})
    others = {name: value for name, value in noted.items() if name != "system"}
    if "system" not in noted:
        if others:
            raise click.UsageError(f"--{next(iter(others))} is of use with --system only")
        return None
    if target.kind != "fpga":
        raise click.UsageError(f"{target.name} is no FPGA; it always runs as a whole")
    return SystemChoice(**others)


def run_system_of(
    folder: Path,
    target: Target,
    design: FilterDesign,
    recording: Recording,
    choice: SystemChoice,
    faults: tuple[Fault, ...],
) -> EmulationResult:
    """Build the system of a folder, run it and compare."""
    build_system(folder)
    return emulate_system(
        folder,
        target,
        design,
        recording,
        samples=choice.samples,
        faults=faults,
        record=choice.record,
    )


def _note(context: click.Context, parameter: click.Parameter, value: Any) -> None:
    """Note what was given."""
    if value:
        context.meta.setdefault(CHOSEN, {})[str(parameter.name)] = value


_OPTIONS = (
    click.option(
        "--system",
        is_flag=True,
        callback=_note,
        expose_value=False,
        help="FPGA: simulate the whole system, from the bus of the sensor to the serial line.",
    ),
    click.option(
        "--samples",
        type=click.IntRange(min=2),
        callback=_note,
        expose_value=False,
        metavar="N",
        help=f"With --system: play the first N rows; {SAMPLES} by default.",
    ),
    click.option(
        "--record",
        type=click.Path(dir_okay=False, path_type=Path),
        callback=_note,
        expose_value=False,
        metavar="FILE",
        help="With --system: write the frames to a tlog, for `hostkit monitor --port file:FILE`.",
    ),
)
