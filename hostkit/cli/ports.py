"""The subcommand ``ports``: the serial ports of this machine, and what is behind them."""

from dataclasses import dataclass
from pathlib import Path

import click

from hostkit.cli.inputs import JSON, say
from hostkit.cli.output import emit_json
from hostkit.errors import DeviceError
from hostkit.link.clock import SystemClock
from hostkit.link.ports.baud_scan import RATES, BaudScan, scan_baud
from hostkit.link.ports.finder import PortInfo, list_ports, pick_port, port_info, with_use
from hostkit.link.ports.serial_port import SerialTransport


@dataclass(frozen=True, slots=True, kw_only=True)
class Probe:
    """What listening at a port gave: a scan, or why there is none."""

    scan: BaudScan | None = None
    error: str = ""

    def text(self) -> str:
        """Return it in one clause."""
        return self.scan.explain() if self.scan is not None else self.error


@click.command("ports")
@click.argument("names", metavar="[PORT...]", nargs=-1)
@click.option(
    "--probe",
    is_flag=True,
    help="Open each port that is on USB or named, and say what comes out of it; this resets "
    "some boards. Takes 3 s at a silent port, up to 10 s at one that cannot be understood.",
)
@JSON
def ports(names: tuple[str, ...], probe: bool, as_json: bool) -> None:
    """List serial ports and what is behind them; with PORT only those.

    Without --probe no port is opened, so no board is disturbed. A star marks the ports among
    which `--port auto` chooses.

    The document of --json is hostkit.ports/1: "ports", a list of "device", "description", "vid"
    and "pid" (four hex digits or null), "serial_number", "manufacturer", "known_as", "candidate",
    "access" (ok, forbidden, unknown), "used_by", and "probe": null, or "finding" (mavlink2,
    mavlink1, text, bytes, nothing, or error), "baud", "received_bytes", "sample", "system",
    "component", "digest" and "text", which says it all in words.

    \b
    Example:
      hostkit ports --probe
    """
    named = tuple(port_info(pick_port(name)) for name in names)
    found = tuple(with_use(port) for port in named or list_ports())
    probes = [_probe(port) if probe and (names or port.candidate) else None for port in found]
    if as_json:
        rows = [_document(port, result) for port, result in zip(found, probes, strict=True)]
        emit_json({"schema": "hostkit.ports/1", "ports": rows})
        return
    for port, result in zip(found, probes, strict=True):
        click.echo(_line(port))
        if result is not None:
            click.echo(f"    {result.text()}")
    if not found:
        click.echo("no serial port is here")


def _probe(port: PortInfo) -> Probe:
    if port.used_by:
        return Probe(error=f"not opened: in use by {port.used_by}")
    say(f"listening at {port.device}")
    try:
        opened = SerialTransport(port.device, RATES[0])
    except DeviceError as error:
        return Probe(error=str(error))
    try:
        return Probe(scan=scan_baud(opened, clock=SystemClock()))
    except DeviceError as error:
        return Probe(error=str(error))
    finally:
        opened.close()


def _line(port: PortInfo) -> str:
    notes = [port.known_as or port.description or Path(port.device).name, port.usb_id]
    notes += [f"serial number {port.serial_number}" if port.serial_number else ""]
    notes += ["may not be opened: join its group" if port.access == "forbidden" else ""]
    notes += [f"in use by {port.used_by}" if port.used_by else ""]
    return f"{'*' if port.candidate else ' '} {port.device:<16} {'; '.join(filter(None, notes))}"


def _document(port: PortInfo, probe: Probe | None) -> dict[str, object]:
    vid, pid = port.usb_id.split(":") if port.usb_id else (None, None)
    return {
        "device": port.device,
        "description": port.description,
        "vid": vid,
        "pid": pid,
        "serial_number": port.serial_number,
        "manufacturer": port.manufacturer,
        "known_as": port.known_as,
        "candidate": port.candidate,
        "access": port.access,
        "used_by": port.used_by,
        "probe": None if probe is None else _probe_document(probe),
    }


def _probe_document(probe: Probe) -> dict[str, object]:
    scan = probe.scan
    return {
        "finding": "error" if scan is None else scan.finding,
        "baud": scan and scan.baud,
        "received_bytes": 0 if scan is None else scan.received_bytes,
        "sample": "" if scan is None else scan.sample,
        "system": scan and scan.system,
        "component": scan and scan.component,
        "digest": scan and scan.digest,
        "text": probe.text(),
    }
