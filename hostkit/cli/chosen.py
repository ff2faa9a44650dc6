"""What was chosen on the command line of the code to render, checked as it is read."""

from collections.abc import Callable, Mapping
from dataclasses import fields
from typing import Any, Final, TypeVar

import click

from hostkit.errors import RenderError
from hostkit.render import FirmwareOptions, FpgaOptions, MessageRate, Options
from hostkit.targets import Target

Command = TypeVar("Command", bound=Callable[..., object])
CHOSEN: Final = "hostkit.chosen"
FIRMWARE_FIELDS: Final = frozenset(field.name for field in fields(FirmwareOptions))
FPGA_FIELDS: Final = frozenset(field.name for field in fields(FpgaOptions))


def option(*names: str, **settings: Any) -> Callable[[Command], Command]:
    """Return a click option that is noted instead of passed on."""
    return click.option(*names, callback=_choose, expose_value=False, default=None, **settings)


def chosen_options(target: Target) -> Options | None:
    """Return the options that were given to the running subcommand; None if none was.

    Raises
    ------
    click.UsageError
        If one of them is for targets of another kind.
    """
    chosen = _chosen(click.get_current_context())
    if not chosen:
        return None
    known = FPGA_FIELDS if target.kind == "fpga" else FIRMWARE_FIELDS
    foreign = [flag for name, (flag, _) in chosen.items() if name not in known]
    if foreign:
        kind = "runs no firmware" if target.kind == "fpga" else "is no FPGA"
        raise click.UsageError(f"{target.name} {kind}; it takes no {', '.join(foreign)}")
    values = {name: value for name, (_, value) in chosen.items()}
    try:
        return FpgaOptions(**values) if target.kind == "fpga" else FirmwareOptions(**values)
    except RenderError as error:
        raise click.UsageError(str(error)) from error


def _chosen(context: click.Context) -> dict[str, tuple[str, Any]]:
    """Return field, flag and value of all that was given."""
    noted: dict[str, tuple[str, Any]] = context.meta.setdefault(CHOSEN, {})
    return noted


def _choose(context: click.Context, parameter: click.Parameter, value: Any) -> None:
    """Note what was given; what was not leaves the field as it is."""
    if value is None or value == ():
        return
    name = str(parameter.name)
    if name == "message_rates":
        value = tuple(_message_rate(text) for text in value)
    _check({name: value})
    _chosen(context)[name] = (parameter.opts[0], value)


def _check(values: Mapping[str, Any]) -> None:
    try:
        if values.keys() <= FIRMWARE_FIELDS:
            FirmwareOptions(**values)
        else:
            FpgaOptions(**values)
    except RenderError as error:
        raise click.BadParameter(str(error)) from error


def _message_rate(text: str) -> MessageRate:
    name, _, rate = text.partition("=")
    try:
        return MessageRate(name=name.strip().upper().replace("-", "_"), rate_hz=float(rate))
    except ValueError as error:
        raise click.BadParameter(f"{text!r} is not NAME=HZ") from error
    except RenderError as error:
        raise click.BadParameter(str(error)) from error
