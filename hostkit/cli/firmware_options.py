"""The options of the firmware on the command line, for every subcommand that renders it."""

import dataclasses
from collections.abc import Callable
from typing import Any, TypeVar, get_args

import click

from hostkit.errors import RenderError
from hostkit.render.options import (
    DEFAULT_OPTIONS,
    STREAMED_MESSAGES,
    Acquisition,
    Arithmetic,
    FirmwareOptions,
    MessageRate,
    Profile,
)

Command = TypeVar("Command", bound=Callable[..., object])
CHOSEN = "hostkit.firmware_options"


def chosen_options() -> FirmwareOptions | None:
    """Return the options that were given to the running subcommand; None if none was."""
    options: FirmwareOptions | None = click.get_current_context().meta.get(CHOSEN)
    return options


def firmware_options(command: Command) -> Command:
    """Give a subcommand the options of the firmware; it asks :func:`chosen_options` for them."""
    for option in reversed(_OPTIONS):
        command = option(command)
    return command


def _choose(context: click.Context, option: click.Parameter, value: Any) -> None:
    """Note what was given; what was not leaves the field as it is."""
    if value is None or value == ():
        return
    chosen = context.meta.get(CHOSEN, DEFAULT_OPTIONS)
    try:
        if option.name == "message_rates":
            value = tuple(_message_rate(text) for text in value)
        context.meta[CHOSEN] = dataclasses.replace(chosen, **{str(option.name): value})
    except RenderError as error:
        raise click.BadParameter(str(error)) from error


def _message_rate(text: str) -> MessageRate:
    name, _, rate = text.partition("=")
    try:
        return MessageRate(name=name.strip().upper().replace("-", "_"), rate_hz=float(rate))
    except ValueError as error:
        raise click.BadParameter(f"{text!r} is not NAME=HZ") from error


def _option(*names: str, **settings: Any) -> Callable[[Command], Command]:
    return click.option(*names, callback=_choose, expose_value=False, default=None, **settings)


_OPTIONS = (
    _option(
        "--profile",
        type=click.Choice(get_args(Profile)),
        help="Who the device says it is: a vehicle that ground stations show (gcs, the default), "
        "or a component on board of one.",
    ),
    _option("--system-id", type=int, metavar="N", help="MAVLink system id; 1 by default."),
    _option("--baud", type=int, metavar="N", help="Rate of the link, bit/s."),
    _option(
        "--message",
        "message_rates",
        multiple=True,
        metavar="NAME=HZ",
        help="How often a message goes out, 0 is never; may be repeated. Names: "
        + ", ".join(STREAMED_MESSAGES)
        + ".",
    ),
    _option(
        "--arithmetic",
        type=click.Choice(get_args(Arithmetic)),
        help="Compute in integers that equal the model bit for bit (fixed, the default), or in "
        "float.",
    ),
    _option(
        "--acquisition",
        type=click.Choice(get_args(Acquisition)),
        help="Read sample by sample (burst, the default), or out of the sensor's FIFO.",
    ),
    _option(
        "--calibrate-at-start",
        is_flag=True,
        help="Measure the gyroscope's bias after each start, at rest.",
    ),
    _option("--signing", is_flag=True, help="Sign the messages."),
)
