"""The options of commands that speak with a device: where it is, and what is known of it."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import click

from hostkit.cli.chosen import Command
from hostkit.cli.inputs import read_design
from hostkit.design_file import digest
from hostkit.errors import VerdictError
from hostkit.link.device.device_link import DeviceLink
from hostkit.link.device.parameter_facts import ParameterFacts, parameter_facts
from hostkit.link.frames.signing import SigningKey
from hostkit.link.ports.transport import open_link
from hostkit.records import FilterDesign

CHOSEN: Final = "hostkit.link"


@dataclass(frozen=True, slots=True, kw_only=True)
class LinkChoice:
    """What was chosen on the command line.

    Attributes
    ----------
    port
        Name of a port, or ``auto``.
    system
        System id of the device; None where there is one only.
    """

    port: str = "auto"
    baud: int | None = None
    system: int | None = None
    signing_key: Path | None = None
    design: FilterDesign | None = None

    def facts(self) -> dict[str, ParameterFacts]:
        """Return what is known of the device's parameters."""
        return parameter_facts(self.design)

    def open(self) -> DeviceLink:
        """Open the port, find the device and hold it against the design, if there is one.

        Raises
        ------
        DeviceError
            If the port cannot be opened, or no device is there.
        VerdictError
            If the device runs another design.
        """
        key = None if self.signing_key is None else SigningKey.read(self.signing_key)
        transport = open_link(self.port, self.baud, reconnect=False)
        link = DeviceLink(transport, system=self.system, facts=self.facts(), signing=key)
        try:
            link.find()
            self._check_design(link)
        except BaseException:
            transport.close()
            raise
        return link

    def _check_design(self, link: DeviceLink) -> None:
        if self.design is None or link.digest is None:
            return
        if link.digest != digest(self.design):
            raise VerdictError(
                f"the device runs design {link.digest}, --design is {digest(self.design)}: its "
                "limits and values would be wrong; give the device's design, or none"
            )


def link_options(command: Command) -> Command:
    """Give a command the options of a link; see :func:`chosen_link`."""
    for option in reversed(_OPTIONS):
        command = option(command)
    return command


def chosen_link() -> LinkChoice:
    """Return what was chosen for the running command, or for the group that it belongs to.

    Raises
    ------
    DesignError
        If the design file is none.
    """
    noted: dict[str, Any] = dict(click.get_current_context().meta.get(CHOSEN, {}))
    path = noted.pop("design_file", None)
    return LinkChoice(**noted, design=None if path is None else read_design(path))


def _note(context: click.Context, parameter: click.Parameter, value: Any) -> None:
    """Note what was given; what was not leaves what the group was given."""
    if value is not None:
        context.meta.setdefault(CHOSEN, {})[str(parameter.name)] = value


def _option(*names: str, **settings: Any) -> Any:
    return click.option(*names, callback=_note, expose_value=False, default=None, **settings)


_OPTIONS = (
    _option(
        "--port",
        metavar="P",
        help="Port as for `hostkit monitor`; by default the only USB serial port there is.",
    ),
    _option(
        "--baud",
        type=click.IntRange(300, 12_000_000),
        help="Bit rate of a serial port; found out by default.",
    ),
    _option(
        "--system",
        type=click.IntRange(1, 255),
        metavar="N",
        help="System id of the device, where there are several.",
    ),
    _option(
        "--signing-key",
        type=click.Path(exists=True, dir_okay=False, path_type=Path),
        metavar="F",
        help="File with the secret of a device that knows signed messages only.",
    ),
    _option(
        "--design",
        "design_file",
        type=click.Path(exists=True, dir_okay=False, path_type=Path),
        metavar="DESIGN",
        help="What the device runs: shows limits and the design's own values.",
    ),
)
