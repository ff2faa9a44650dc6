"""The subcommand ``record``: what a device sends, kept in files."""

import contextlib
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path

import click

from hostkit.cli.inputs import JSON, read_design
from hostkit.cli.monitor_options import PORT_OPTIONS, chosen_monitor
from hostkit.cli.monitor_setup import open_port, open_recorders
from hostkit.cli.output import emit_json
from hostkit.cli.stopping import stoppable
from hostkit.errors import HostkitError
from hostkit.monitor.recording.capture import Capture, CaptureResult
from hostkit.monitor.recording.recordings import Recorder


def _port_options(command: click.decorators.FC) -> click.decorators.FC:
    for option in reversed(PORT_OPTIONS):
        command = option(command)
    return command


@click.command("record")
@click.option(
    "-o",
    "--output",
    "outputs",
    multiple=True,
    required=True,
    type=click.Path(dir_okay=False, path_type=Path),
    metavar="F",
    help="F.tlog for everything that comes, F.csv or F.npz for the samples; may be given again.",
)
@click.option(
    "--design",
    "design_file",
    type=click.Path(exists=True, dir_okay=False, path_type=Path),
    metavar="DESIGN",
    help="What the device runs: .csv and .npz need the ranges of its sensor.",
)
@_port_options
@JSON
def record(outputs: tuple[Path, ...], design_file: Path | None, as_json: bool) -> None:
    """Keep what a device sends, without judging it; nothing is sent to it.

    Until it is complete a file is called F.part; what came up to a second before a crash is in it.

    \b
    Example:
      hostkit record --port /dev/ttyUSB0 -o flight.tlog --duration 600
      hostkit record -o flight.csv -o flight.tlog --design design.json
      hostkit record --port file:flight.tlog -o flight.csv --design design.json
    """
    choice = chosen_monitor()
    design = None if design_file is None else read_design(design_file)
    signing = choice.signing()
    with contextlib.ExitStack() as stack:
        transport = open_port(choice)
        stack.callback(transport.close)
        recorders = open_recorders(outputs, design, choice.system, stack)
        capture = Capture(
            transport,
            recorders,
            duration_s=choice.duration_s,
            patient=not choice.no_reconnect,
            signing=signing,
        )
        wish = stack.enter_context(stoppable(capture.stop))
        result = capture.run()
    if wish.given and not result.link.frames:
        raise KeyboardInterrupt
    if as_json:
        emit_json(record_document(result, outputs, recorders))
    else:
        _show(result, outputs, recorders)
    if result.problems:
        raise HostkitError("; ".join(result.problems))


def record_document(
    result: CaptureResult, paths: Sequence[Path], recorders: Sequence[Recorder]
) -> dict[str, object]:
    """Return the account of a recording as the document ``hostkit.record/1``."""
    link = asdict(result.link)
    link["sources"] = [asdict(source) for source in result.link.sources]
    return {
        "schema": "hostkit.record/1",
        "files": [
            {"file": str(path), "frames": r.frames, "bytes": r.written_bytes}
            for path, r in zip(paths, recorders, strict=True)
        ],
        "duration_s": result.duration_s,
        "samples": result.samples,
        "reconnects": result.reconnects,
        "link": link,
        "notices": [asdict(notice) for notice in result.notices],
        "problems": list(result.problems),
    }


def _show(result: CaptureResult, paths: Sequence[Path], recorders: Sequence[Recorder]) -> None:
    link = result.link
    for notice in result.notices:
        click.echo(f"{notice.level}: {notice.text}", err=True)
    click.echo(
        f"{link.frames} messages in {result.duration_s:.1f} s, {result.samples} of them samples; "
        f"{link.lost_frames} lost, {link.bad} bad, {link.unknown} unknown"
    )
    for path, recorder in zip(paths, recorders, strict=True):
        click.echo(f"{path}: {recorder.frames} frames, {recorder.written_bytes} bytes")
