"""The subcommand ``diagnose``: what recordings show before anything is tuned."""

import json
from pathlib import Path

import click

from hostkit.cli.inputs import (
    JSON,
    RECORDINGS,
    REPORT,
    axes_option,
    mounting_option,
    read_recording,
    say,
)
from hostkit.cli.output import emit_json
from hostkit.diagnosis import Diagnosis, allan_document, findings, to_document
from hostkit.diagnosis import diagnose as run_diagnosis
from hostkit.errors import ToolMissingError
from hostkit.files import write_aside
from hostkit.mounting import Mounting
from hostkit.recordings import Recording
from hostkit.records import AxisChoice


@click.command("diagnose")
@RECORDINGS
@axes_option("Angles the filter is to give.")
@mounting_option("Body x, y, z as signed sensor axes; +z+x+y makes sensor z the roll axis.")
@REPORT
@click.option(
    "--allan-out",
    "allan_file",
    type=click.Path(dir_okay=False, path_type=Path),
    metavar="FILE.json",
    help="Also write the noise at rest, for simulate --errors-from.",
)
@JSON
def diagnose(
    recording_files: tuple[Path, ...],
    axes: AxisChoice,
    mounting: Mounting,
    report_file: Path | None,
    allan_file: Path | None,
    as_json: bool,
) -> None:
    """Say what recordings show of sensor and motion, and what to do before tuning.

    Lines that begin with ! ask for something. A reference is used where there is one, and not
    needed.

    \b
    Example:
      hostkit simulate --profile free -o flight.csv
      hostkit diagnose flight.csv --report flight.html
    """
    recordings = tuple(read_recording(path) for path in recording_files)
    required = allan_file is not None
    diagnoses = tuple(_diagnosis(r, axes, mounting, required) for r in recordings)
    pairs = tuple(zip(recording_files, diagnoses, strict=True))
    if as_json:
        emit_json(to_document(pairs))
    else:
        for path, diagnosis in pairs:
            _show(path, diagnosis)
    if allan_file is not None:
        _write_allan(pairs, allan_file)
    if report_file is not None:
        from hostkit.report.diagnosis import write_diagnosis_report

        write_diagnosis_report(recordings, diagnoses, report_file)


def _diagnosis(
    recording: Recording, axes: AxisChoice, mounting: Mounting, required: bool
) -> Diagnosis:
    """Diagnose with Allan deviations; without them if their library is missing and not required."""
    try:
        return run_diagnosis(recording, axes=axes, mounting=mounting, noise=True)
    except ToolMissingError as error:
        if required:
            raise
        say(f"left out: {error}")
        return run_diagnosis(recording, axes=axes, mounting=mounting)


def _show(path: Path, diagnosis: Diagnosis) -> None:
    click.echo(
        f"{path}: {diagnosis.samples} samples at {diagnosis.rate_hz:g} Hz, "
        f"{diagnosis.duration_s:.4g} s; axes {diagnosis.axes}, mounting {diagnosis.mounting}"
    )
    for finding in findings(diagnosis):
        click.echo(finding.line())


def _write_allan(pairs: tuple[tuple[Path, Diagnosis], ...], allan_file: Path) -> None:
    write_aside(allan_file, json.dumps(allan_document(pairs), indent=2, allow_nan=False) + "\n")
    without = [str(path) for path, diagnosis in pairs if diagnosis.noise is None]
    if without:
        say(f"{allan_file}: no noise figures of {', '.join(without)}, for lack of rest")
