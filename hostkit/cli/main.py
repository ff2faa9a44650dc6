"""The entry point: finds the subcommand, reads the project file, turns errors into one line."""

import importlib
import keyword
import sys
from pathlib import Path
from typing import Any

import click

from hostkit import __version__
from hostkit.errors import HostkitError

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

COMMANDS = {
    "demo": "The whole loop without hardware, ending in a report.",
    "simulate": "Make a recording from a motion profile.",
    "import": "Turn another format into a recording.",
    "diagnose": "Say what a recording shows of sensor and motion.",
    "tune": "Find the filter for recordings; write a design.",
    "smooth": "Find the tilt of whole recordings, without lag.",
    "calibrate": "Measure what a sensor reads wrong and put it into a design.",
    "evaluate": "Score a design on recordings.",
    "generate": "Render a design to C or VHDL.",
    "build": "Compile or analyse generated code.",
    "flash": "Load generated code into a board.",
    "emulate": "Run the generated code on an emulated board or simulator.",
    "ports": "List serial ports and what is behind them.",
    "monitor": "Watch a device live and judge it against its models.",
    "record": "Keep what a device sends.",
    "params": "Read, set, save, load and compare the parameters of a device.",
    "reproduce": "The tilt paper's table and figures beside ours.",
    "doctor": "Show what is installed and how to get what is missing.",
}
PROJECT_FILE = Path("hostkit.toml")
INTERRUPTED = 130


class Commands(click.Group):
    """Subcommands that are imported only when they are called."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Return the names in the order in which one uses them."""
        return list(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Import one subcommand."""
        if cmd_name not in COMMANDS:
            return None
        name = f"{cmd_name}_" if keyword.iskeyword(cmd_name) else cmd_name
        command: click.Command = getattr(importlib.import_module(f"hostkit.cli.{name}"), name)
        return command

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """List the subcommands without importing them."""
        with formatter.section("Commands"):
            formatter.write_dl(list(COMMANDS.items()))


@click.group(cls=Commands, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(__version__, prog_name="hostkit")
@click.pass_context
def cli(ctx: click.Context) -> None:
    """Tune a tilt filter, render it to C and VHDL, prove the device equals the model.

    Defaults for a project stand in hostkit.toml, a table per command; HOSTKIT_COMMAND_OPTION in
    the environment wins over the file, the command line over both.
    """
    if ctx.invoked_subcommand is not None and PROJECT_FILE.is_file():
        table = _project_table(ctx.invoked_subcommand)
        command = cli.get_command(ctx, ctx.invoked_subcommand)
        if table and command is not None:
            ctx.default_map = {ctx.invoked_subcommand: _by_parameter(command, table)}


def _project_table(command: str) -> dict[str, Any]:
    """Return what the project file says of one command.

    Raises
    ------
    HostkitError
        If the file is not TOML, or has something that is no table of a command.
    """
    try:
        tables = tomllib.loads(PROJECT_FILE.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise HostkitError(f"{PROJECT_FILE} cannot be read: {error}") from error
    for name, table in tables.items():
        if name not in COMMANDS or not isinstance(table, dict):
            raise HostkitError(
                f"{PROJECT_FILE} has {name!r}; it may have one table per command: "
                + ", ".join(COMMANDS)
            )
    found: dict[str, Any] = tables.get(command, {})
    return found


def _by_parameter(command: click.Command, table: dict[str, Any]) -> dict[str, Any]:
    """Turn option names into click's parameter names; refuse those the command does not have.

    A group may have tables for its subcommands, such as ``[calibrate.imu]``.
    """
    subcommands = command.commands if isinstance(command, click.Group) else {}
    inner = {
        key: _by_parameter(subcommands[key], value)
        for key, value in table.items()
        if key in subcommands and isinstance(value, dict)
    }
    parameters = {
        option.removeprefix("--").replace("-", "_"): str(parameter.name)
        for parameter in command.params
        for option in parameter.opts
        if option.startswith("--")
    }
    own = {key: value for key, value in table.items() if key not in inner}
    for key in own:
        if key.replace("-", "_") not in parameters:
            raise HostkitError(
                f"{PROJECT_FILE} has {key!r} in [{command.name}]; it may have: "
                + ", ".join(parameters)
            )
    return {parameters[key.replace("-", "_")]: value for key, value in own.items()} | inner


def main() -> None:
    """Run the command line and leave with its documented exit code."""
    sys.exit(run(sys.argv[1:]))


def run(arguments: list[str]) -> int:
    """Run one command line and return its exit code.

    0 ok, 1 failure, 2 wrong use, 3 validation failed, 4 device or port, 5 a tool is missing.
    """
    try:
        cli.main(
            args=arguments,
            prog_name="hostkit",
            auto_envvar_prefix="HOSTKIT",
            standalone_mode=False,
        )
    except HostkitError as error:
        click.echo(f"hostkit: {error}", err=True)
        return error.exit_code
    except click.ClickException as error:
        error.show()
        return error.exit_code
    except (click.Abort, KeyboardInterrupt):
        click.echo("hostkit: interrupted", err=True)
        return INTERRUPTED
    return 0
