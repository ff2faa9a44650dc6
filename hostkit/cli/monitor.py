"""The subcommand ``monitor``: a device held against its models."""

import contextlib
import math
import sys
from pathlib import Path

import click

from hostkit.cli.inputs import DESIGN, JSON, read_design, say
from hostkit.cli.monitor_options import MonitorChoice, chosen_monitor, monitor_options
from hostkit.cli.monitor_setup import open_outlets, open_port, open_recorders, serve_page
from hostkit.cli.output import emit_json
from hostkit.cli.stopping import stoppable
from hostkit.cli.terminal import view_for
from hostkit.emulation.comparison import FLOAT_TOLERANCE_RAD
from hostkit.errors import HostkitError, VerdictError
from hostkit.files import write_aside
from hostkit.monitor import Session, SessionOptions, SessionResult
from hostkit.monitor.document import monitor_document
from hostkit.records import FilterDesign


@click.command("monitor")
@DESIGN
@monitor_options
@JSON
def monitor(design_file: Path, as_json: bool) -> None:
    """Validate the device at a port against DESIGN and give a verdict.

    Every step is computed again from the raw counts with the integer model, which must agree bit
    for bit, and with the float model. A device that runs another design is refused.

    A device that goes away is waited for and judged on when it is back. Ctrl-C and SIGTERM end the
    session with its verdict.

    \b
    Example:
      hostkit monitor design.json --port /dev/ttyUSB0 --duration 30
      hostkit monitor design.json --web --record flight.tlog --record flight.csv
      hostkit monitor design.json --port file:flight.tlog --web --speed 4
      hostkit monitor design.json --forward udp:127.0.0.1:14550 --json-udp 127.0.0.1:9870
    """
    choice = chosen_monitor()
    design = read_design(design_file)
    result, problems = _watch(design, choice, interactive=not as_json)
    if as_json:
        emit_json(monitor_document(result))
    else:
        _show(result)
    _write_reports(result, choice)
    if result.report.verdict != "pass":
        raise VerdictError(f"verdict {result.report.verdict}: " + "; ".join(result.report.reasons))
    if problems:
        raise HostkitError("; ".join(problems))


def _watch(
    design: FilterDesign, choice: MonitorChoice, *, interactive: bool
) -> tuple[SessionResult, tuple[str, ...]]:
    """Run the session; return its result and why recordings ended early."""
    signing = choice.signing()
    with contextlib.ExitStack() as stack:
        transport = open_port(choice)
        stack.callback(transport.close)
        session = Session(
            design=design,
            transport=transport,
            thresholds=choice.thresholds(design),
            duration_s=choice.duration_s,
            recorders=open_recorders(choice.records, design, choice.system, stack),
            outlets=open_outlets(choice, design, stack),
            options=SessionOptions(
                port=choice.port,
                system=choice.system,
                tolerance_rad=FLOAT_TOLERANCE_RAD if choice.in_float else None,
                as_designed=choice.as_designed,
                passive=choice.passive,
                patient=not choice.no_reconnect,
                stays=choice.web and choice.duration_s is None,
                folder=Path.cwd(),
                signing=signing,
            ),
        )
        if choice.web:
            serve_page(session, choice, stack)
        view = view_for(sys.stderr, session.controls.info(), interactive=interactive)
        session.views.append(stack.enter_context(view))
        wish = stack.enter_context(stoppable(session.stop))
        result = session.run()
    if wish.given and not result.report.samples and not choice.web:
        raise KeyboardInterrupt
    return result, session.problems


def _write_reports(result: SessionResult, choice: MonitorChoice) -> None:
    if choice.report is not None:
        from hostkit.report.monitor import write_monitor_report

        write_monitor_report(result, choice.report)
        say(f"report: {choice.report}")
    if choice.junit is not None:
        from hostkit.report.junit import junit_xml

        write_aside(choice.junit, junit_xml(result))


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
