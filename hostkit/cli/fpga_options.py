"""The options of an FPGA on the command line, and those of every kind of target together."""

from typing import get_args

import click

from hostkit.cli.chosen import Command
from hostkit.cli.chosen import option as _option
from hostkit.cli.firmware_options import FIRMWARE_OPTIONS
from hostkit.render.fpga_options import TOP_NAME, Bus

FPGA_OPTIONS = (
    _option(
        "--bus",
        type=click.Choice(get_args(Bus)),
        help="FPGA: bus of the registers; none by default.",
    ),
    _option(
        "--channels",
        type=int,
        metavar="N",
        help="FPGA: sensors that one filter serves; 1 by default.",
    ),
    _option(
        "--pipelined",
        is_flag=True,
        help="FPGA: a filter that takes a sample every clock, instead of a small one.",
    ),
    _option(
        "--oscillator-hz",
        type=int,
        metavar="N",
        help="FPGA: clock that the board gives, Hz; that of the target's first board by default.",
    ),
    _option("--clock-hz", type=int, metavar="N", help="FPGA: clock of the system, Hz."),
    _option(
        "--top-name",
        metavar="NAME",
        help=f"FPGA: entity of the top; {TOP_NAME} by default.",
    ),
)

SYNTHESISE = click.option(
    "--synthesise",
    is_flag=True,
    help="FPGA: synthesise with GHDL and Yosys, and put the resources into the README; takes "
    "minutes.",
)


def target_options(command: Command) -> Command:
    """Give a subcommand all options of what it renders; see :func:`chosen_options`."""
    for option in reversed((*FIRMWARE_OPTIONS, *FPGA_OPTIONS)):
        command = option(command)
    return command
