"""The subcommand ``monitor``: a device held against its models."""

import contextlib
import math
from pathlib import Path

import click

from hostkit.cli.inputs import DESIGN, JSON, finite, read_design
from hostkit.cli.output import emit_json
from hostkit.errors import VerdictError
from hostkit.link.tlog import TlogWriter
from hostkit.link.transport import open_transport
from hostkit.monitor import Session, SessionResult
from hostkit.targets.atmega328p import ATMEGA328P
from hostkit.validation import DEFAULT_MAX_LOST_SHARE, DEFAULT_MAX_RMS_DEG, Thresholds


@click.command("monitor")
@DESIGN
@click.option(
    "--port",
    required=True,
    metavar="P",
    help="/dev/ttyUSB0, COM3, a pty, tcp:HOST:PORT, udp:HOST:PORT or file:FLIGHT.tlog.",
)
@click.option(
    "--duration",
    "duration_s",
    type=click.FloatRange(min=0.0, min_open=True),
    callback=finite,
    metavar="S",
    help="Seconds to look at the device; without it until Ctrl-C or the end of a file.",
)
@click.option(
    "--baud",
    type=click.IntRange(300, 12_000_000),
    default=ATMEGA328P.baud,
    show_default=True,
    help="Bit rate of a serial port.",
)
@click.option(
    "--max-rms-deg",
    type=click.FloatRange(min=0.0),
    callback=finite,
    default=DEFAULT_MAX_RMS_DEG,
    show_default=True,
    metavar="X",
    help="Largest residual against the float model that passes.",
)
@click.option(
    "--max-lost-percent",
    type=click.FloatRange(0.0, 100.0),
    callback=finite,
    default=100.0 * DEFAULT_MAX_LOST_SHARE,
    show_default=True,
    metavar="X",
    help="Largest share of lost samples that passes.",
)
@click.option(
    "--record",
    type=click.Path(dir_okay=False, path_type=Path),
    metavar="F",
    help="Keep everything that is received in a tlog.",
)
@JSON
def monitor(
    design_file: Path,
    port: str,
    duration_s: float | None,
    baud: int,
    max_rms_deg: float,
    max_lost_percent: float,
    record: Path | None,
    as_json: bool,
) -> None:
    """Validate the device at a port against DESIGN and give a verdict.

    Every step is computed again from the raw counts with the integer model, which must agree bit
    for bit, and with the float model. A device that runs another design is refused.

    \b
    Example:
      hostkit monitor design.json --port /dev/ttyUSB0 --duration 30
    """
    design = read_design(design_file)
    with contextlib.ExitStack() as stack:
        transport = open_transport(port, baud)
        stack.callback(transport.close)
        recorder = None
        if record is not None:
            recorder = TlogWriter(record)
            stack.callback(recorder.close)
        session = Session(
            design=design,
            transport=transport,
            thresholds=Thresholds(max_rms_deg=max_rms_deg, max_lost_share=max_lost_percent / 100.0),
            duration_s=duration_s,
            recorder=recorder,
        )
        result = session.run()
    if as_json:
        emit_json(monitor_document(result))
    else:
        _show(result)
    if result.report.verdict != "pass":
        raise VerdictError(f"verdict {result.report.verdict}: " + "; ".join(result.report.reasons))


def monitor_document(result: SessionResult) -> dict[str, object]:
    """Return the result of a session as the document ``hostkit.monitor/1``."""
    report, link = result.report, result.link
    return {
        "schema": "hostkit.monitor/1",
        "samples": report.samples,
        "checked": report.checked,
        "lost": report.lost,
        "lost_frames": link.lost_frames,
        "bad": link.bad,
        "bad_bytes": link.bad_bytes,
        "unknown": link.unknown,
        "rms_deg": None if report.rms_rad is None else math.degrees(report.rms_rad),
        "max_deg": None if report.max_rad is None else math.degrees(report.max_rad),
        "mismatches": report.mismatches,
        "digest_ok": report.digest_ok,
        "duration_s": result.duration_s,
        "verdict": report.verdict,
        "reasons": list(report.reasons),
    }


def _show(result: SessionResult) -> None:
    report, link = result.report, result.link
    residual = "no residual"
    if report.rms_rad is not None and report.max_rad is not None:
        residual = (
            f"residual {math.degrees(report.rms_rad):.6f} deg rms, "
            f"{math.degrees(report.max_rad):.6f} deg max"
        )
    click.echo(
        f"{report.samples} samples in {result.duration_s:.1f} s, {report.lost} lost, "
        f"{link.bad} bad, {link.unknown} unknown\n"
        f"{report.mismatches} of {report.checked} steps differ from the integer model; {residual}\n"
        f"verdict: {report.verdict}"
    )
