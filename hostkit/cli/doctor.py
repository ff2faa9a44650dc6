"""The subcommand ``doctor``: what is installed, what is missing, how to get it."""

from importlib.metadata import PackageNotFoundError, version

import click

from hostkit.cli.inputs import JSON
from hostkit.cli.output import emit_json
from hostkit.emulation.tools import TOOLS, Tool, ToolState, find
from hostkit.errors import ToolMissingError
from hostkit.tuning.kernel import NativeKernel, kernel

PACKAGES = (
    ("matplotlib", "reports", "report"),
    ("allantools", "Allan deviations", "allan"),
    ("vqf", "comparing with VQF", "compare"),
    ("imufusion", "comparing with Fusion", "compare"),
    ("ahrs", "comparing with Mahony's and Madgwick's filters", "compare"),
    ("distributed", "fleets on a Dask cluster", "fleet"),
    ("h5py", "importing HDF5", "import"),
    ("mcap-ros2-support", "importing MCAP", "import"),
    ("pyulog", "importing ULog", "import"),
    ("rosbags", "importing ROS bags", "import"),
    ("unicorn", "emulating the stm32f103", "stm32"),
)
"""Optional Python packages: name, what for, and the extra that brings them."""


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
    states += [_kernel(), *(_package(*package) for package in PACKAGES)]
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


def _kernel() -> ToolState:
    """Say which kernel tuning uses; the compiled one is built here if it was not yet."""
    found = isinstance(kernel(), NativeKernel)
    tool = Tool(name="kernel", purpose="fast tuning", hint="install a C compiler")
    return ToolState(
        tool=tool, found=found, version="compiled for this processor" if found else None
    )


def _package(name: str, purpose: str, extra: str) -> ToolState:
    try:
        found: str | None = version(name)
    except PackageNotFoundError:
        found = None
    tool = Tool(name=name, purpose=purpose, hint=f"pip install 'hostkit[{extra}]'")
    return ToolState(tool=tool, found=found is not None, version=found)


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
        return f"ok       {state.tool.name:<18} {state.version}"
    return f"missing  {state.tool.name:<18} for {state.tool.purpose}: {state.tool.hint}"
