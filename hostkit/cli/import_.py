"""The subcommand ``import``: a file of another format as a recording."""

import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import TextIO

import click

from hostkit.cli.inputs import JSON, finite, say
from hostkit.cli.output import emit_json
from hostkit.errors import RecordingError
from hostkit.importers import (
    IMPORTERS,
    ColumnChoice,
    Imported,
    ImportOptions,
    Progress,
    import_recording,
    parse_columns,
)
from hostkit.importers.options import (
    ANGLE_UNITS,
    FORCE_UNITS,
    RATE_UNITS,
    TIME_UNITS,
    AngleUnit,
    ForceUnit,
    RateUnit,
    TimeUnit,
)
from hostkit.recordings import SUFFIXES, SanityCard, check, save

PROGRESS_EVERY_S = 1.0
POSITIVE = click.FloatRange(min=0.0, min_open=True)


def _suffixed(context: click.Context, option: click.Parameter, path: Path) -> Path:
    if path.suffix.lower() not in SUFFIXES:
        raise click.BadParameter(f"{path} must end in {' or '.join(SUFFIXES)}")
    return path


def _columns(
    context: click.Context, option: click.Parameter, text: str | None
) -> tuple[ColumnChoice, ...]:
    if text is None:
        return ()
    try:
        return parse_columns(text)
    except RecordingError as error:
        raise click.BadParameter(str(error)) from error


def terminal_progress(stream: TextIO, clock: Callable[[], float]) -> Progress:
    """Return what shows progress on a terminal once a second, and nothing elsewhere.

    Parameters
    ----------
    stream
        Where it is shown.
    clock
        Gives the time in s.
    """
    live = stream.isatty()
    shown_s = clock()

    def show(done: int, total: int) -> None:
        nonlocal shown_s
        if live and clock() - shown_s >= PROGRESS_EVERY_S:
            shown_s = clock()
            stream.write(f"\r{100 * done // max(1, total):3d} % read\r")
            stream.flush()

    return show


@click.command("import", short_help="Turn another format into a recording.")
@click.argument("source", metavar="SRC", type=click.Path(exists=True, path_type=Path))
@click.option(
    "-o",
    "--output",
    required=True,
    callback=_suffixed,
    type=click.Path(dir_okay=False, path_type=Path),
    metavar="REC",
    help="Recording to write, .csv or .npz.",
)
@click.option(
    "--format",
    "format_name",
    type=click.Choice(IMPORTERS.names()),
    help="What SRC is; by default told from its content.",
)
@click.option(
    "--columns",
    callback=_columns,
    metavar="t=1,ax=accX,...",
    help="csv: which column, by name or number, is what; ax=-accX turns the sign.",
)
@click.option("--time-unit", type=click.Choice(TIME_UNITS), help="csv: unit of the time column.")
@click.option("--gyro-unit", type=click.Choice(RATE_UNITS), help="Unit of the angular rate.")
@click.option("--accel-unit", type=click.Choice(FORCE_UNITS), help="Unit of the specific force.")
@click.option("--angle-unit", type=click.Choice(ANGLE_UNITS), help="csv: unit of roll and pitch.")
@click.option("--gyro-range", type=POSITIVE, callback=finite, metavar="DEG_S")
@click.option("--accel-range", type=POSITIVE, callback=finite, metavar="G")
@click.option(
    "--rate-hz",
    type=POSITIVE,
    callback=finite,
    metavar="HZ",
    help="csv: nominal sample rate; needed where there is no time column.",
)
@click.option("--message", metavar="NAME", help="tlog: which IMU message.")
@click.option("--system", type=click.IntRange(1, 255), metavar="N", help="tlog: whose messages.")
@click.option("--instance", type=click.IntRange(min=0), metavar="N", help="Which of several IMUs.")
@click.option("--topic", metavar="NAME", help="mcap, rosbag: which topic.")
@click.option(
    "--design",
    type=click.Path(exists=True, dir_okay=False, path_type=Path),
    metavar="FILE",
    help="tlog of a hostkit device: the design it ran.",
)
@click.option("--no-reference", is_flag=True, help="Leave out the attitude that SRC holds.")
@click.option(
    "--resample",
    "resample_hz",
    type=POSITIVE,
    callback=finite,
    metavar="HZ",
    help="Bring a bursty log to a uniform grid.",
)
@click.option(
    "--decimate",
    type=click.IntRange(min=1),
    default=1,
    show_default=True,
    metavar="N",
    help="Turn N samples into one by composing their rotations.",
)
@JSON
def import_(
    source: Path,
    output: Path,
    format_name: str | None,
    columns: tuple[ColumnChoice, ...],
    time_unit: TimeUnit | None,
    gyro_unit: RateUnit | None,
    accel_unit: ForceUnit | None,
    angle_unit: AngleUnit | None,
    gyro_range: float | None,
    accel_range: float | None,
    rate_hz: float | None,
    message: str | None,
    system: int | None,
    instance: int | None,
    topic: str | None,
    design: Path | None,
    no_reference: bool,
    resample_hz: float | None,
    decimate: int,
    as_json: bool,
) -> None:
    """Turn SRC, a log of another program, into a recording.

    What SRC does not say is concluded from its numbers where they leave no doubt, and said on
    standard error; else the message names the option that settles it.

    \b
    Example:
      hostkit import mpu.txt -o swing.csv --gyro-range 250
      hostkit import flight.tlog -o flight.npz --system 1
    """
    options = ImportOptions(
        columns=columns,
        time_unit=time_unit,
        gyro_unit=gyro_unit,
        accel_unit=accel_unit,
        angle_unit=angle_unit,
        gyro_range=gyro_range,
        accel_range=accel_range,
        rate_hz=rate_hz,
        message=message,
        system=system,
        instance=instance,
        topic=topic,
        design=design,
        reference=not no_reference,
        resample_hz=resample_hz,
        decimate=decimate,
    )
    progress = terminal_progress(sys.stderr, time.monotonic)
    imported = import_recording(source, options, format_name=format_name, progress=progress)
    try:
        card = check(imported.recording)
    except RecordingError as error:
        _say_guessed(source, imported)
        raise RecordingError(f"{source}: {error}") from error
    save(imported.recording, output)
    _say(source, imported, card)
    _show(output, imported, card, as_json)


def _say(source: Path, imported: Imported, card: SanityCard) -> None:
    _say_guessed(source, imported)
    say(f"{source}: sanity card")
    for line in card.lines():
        say(f"  {line}")


def _say_guessed(source: Path, imported: Imported) -> None:
    for sentence in imported.guessed:
        say(f"{source}: {sentence}")


def _show(output: Path, imported: Imported, card: SanityCard, as_json: bool) -> None:
    recording = imported.recording
    if as_json:
        emit_json(
            {
                "schema": "hostkit.import/1",
                "recording": str(output),
                "samples": len(recording),
                "rate_hz": recording.rate_hz,
                "warnings": [f"{finding.kind}: {finding.message}" for finding in card.findings],
                "format": imported.format,
                "guessed": list(imported.guessed),
            }
        )
        return
    click.echo(
        f"{output}: {len(recording)} samples at {recording.rate_hz:.6g} Hz, from {imported.format}"
    )
