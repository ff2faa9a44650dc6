"""The subcommand ``doctor``: what is installed, what is missing, how to get it."""

import click

from hostkit.cli.inputs import JSON
from hostkit.cli.output import emit_json
from hostkit.emulation.tools import TOOLS, ToolState, find
from hostkit.errors import ToolMissingError


@click.command("doctor")
@click.option("--strict", is_flag=True, help="Exit 5 if anything is missing.")
@JSON
def doctor(strict: bool, as_json: bool) -> None:
    """Show which toolchains are installed and how to install those that are not.

    Tuning, generating and the host target need only Python and a C compiler.

    \b
    Example:
      hostkit doctor
    """
    states = [find(tool) for tool in TOOLS]
    missing = [state for state in states if not state.found]
    if as_json:
        emit_json({"schema": "hostkit.doctor/1", "tools": [_document(state) for state in states]})
    else:
        for state in states:
            click.echo(_line(state))
        click.echo(
            "everything is installed"
            if not missing
            else "in a checkout `make setup` installs what is missing, where it may"
        )
    if strict and missing:
        names = ", ".join(state.tool.name for state in missing)
        raise ToolMissingError(f"missing: {names}")


def _document(state: ToolState) -> dict[str, object]:
    return {
        "name": state.tool.name,
        "found": state.found,
        "version": state.version,
        "purpose": state.tool.purpose,
        "hint": None if state.found else state.tool.hint,
    }


def _line(state: ToolState) -> str:
    if state.found:
        return f"ok       {state.tool.name:<10} {state.version}"
    return f"missing  {state.tool.name:<10} for {state.tool.purpose}: {state.tool.hint}"
