"""The subcommand ``smooth``: the tilt of whole recordings, with what comes later as well."""

from pathlib import Path

import click

from hostkit.cli.inputs import (
    JSON,
    RECORDINGS,
    REPORT,
    finite,
    parse_mounting,
    read_design,
    read_recording,
    say,
)
from hostkit.cli.output import emit_json
from hostkit.cli.smooth_output import (
    SmoothedFile,
    say_pieces,
    show_smoothed,
    show_trained,
    smoothed_document,
    trained_document,
)
from hostkit.mounting import Mounting
from hostkit.recordings import Recording, require_suffix
from hostkit.records import AXES, AxisChoice, FilterDesign
from hostkit.smoothing import (
    KnownSensor,
    TrainingOptions,
    known_sensor,
    load_settings,
    measured_reference,
    save_settings,
    save_smoothed,
    score,
    smooth_recording,
    train,
)
from hostkit.smoothing.provenance import provenance
from hostkit.smoothing.settings import HIGHEST_LEAD_S, SmootherSettings


@click.command("smooth", short_help="Find the tilt of a whole recording, without lag.")
@RECORDINGS
@click.option(
    "-o",
    "--output",
    required=True,
    type=click.Path(path_type=Path),
    metavar="OUT",
    help="Recording to write, .csv or .npz, or a folder; with --train the settings, .json.",
)
@click.option(
    "--design",
    "design_file",
    type=click.Path(exists=True, dir_okay=False, path_type=Path),
    metavar="FILE",
    help="Ranges, calibration, lead, axes and mounting from a design.",
)
@click.option(
    "--settings",
    "settings_file",
    type=click.Path(exists=True, dir_okay=False, path_type=Path),
    metavar="FILE.json",
    help="Settings to use; without, each recording chooses its own.",
)
@click.option(
    "--lead-ms",
    type=click.FloatRange(0.0, HIGHEST_LEAD_S * 1e3),
    callback=finite,
    metavar="MS",
    help="How late the readings are; else the design's or the settings'.",
)
@click.option(
    "--axes",
    type=click.Choice(tuple(AXES)),
    help="Angles whose error counts; else the design's, or both.",
)
@click.option(
    "--mounting",
    callback=lambda c, o, text: None if text is None else parse_mounting(c, o, text),
    metavar="AXES",
    help="Body x, y, z as signed sensor axes; else the design's, or +x+y+z.",
)
@click.option("--train", "is_training", is_flag=True, help="Fit settings to the references of REC.")
@click.option(
    "--evaluations",
    type=click.IntRange(40, 1_000_000),
    default=TrainingOptions().evaluations,
    show_default=True,
    help="--train: settings that each search tries.",
)
@click.option("--seed", type=click.IntRange(0, 2**63 - 1), default=1, show_default=True)
@REPORT
@JSON
def smooth(
    recording_files: tuple[Path, ...],
    output: Path,
    design_file: Path | None,
    settings_file: Path | None,
    lead_ms: float | None,
    axes: AxisChoice | None,
    mounting: Mounting | None,
    is_training: bool,
    evaluations: int,
    seed: int,
    report_file: Path | None,
    as_json: bool,
) -> None:
    """Write recordings with the tilt that fits all of their samples.

    It becomes the reference of a recording that has none, so that a filter can be tuned on it;
    beside a measured reference it stands in columns of its own and is scored.

    \b
    Example:
      hostkit smooth flight.csv -o smoothed.csv
      hostkit smooth --train lab-*.npz -o cheap-imu.json
      hostkit smooth flight.csv --settings cheap-imu.json -o smoothed.csv
    """
    design = None if design_file is None else read_design(design_file)
    known = _known(design, lead_ms)
    axes = axes or (design.axes if design else "both")
    mounting = mounting or (design.mounting if design else Mounting())
    settings = None if settings_file is None else load_settings(settings_file)
    if is_training:
        if report_file is not None:
            raise click.UsageError("--train writes settings; a report is of smoothed recordings")
        options = TrainingOptions(
            evaluations=evaluations,
            seed=seed,
            axes=axes,
            mounting=mounting,
            start=settings or SmootherSettings(),
        )
        _train(recording_files, output, options, known, as_json)
        return
    outputs = _outputs(recording_files, output)
    done = []
    for source, target in zip(recording_files, outputs, strict=True):
        recording = read_recording(source)
        done.append(_smoothed(recording, source, target, settings, known, axes, mounting))
    if as_json:
        emit_json(smoothed_document(tuple(done)))
    else:
        show_smoothed(tuple(done))
    if report_file is not None:
        from hostkit.report.smoothing import write_smoothing_report

        write_smoothing_report(
            tuple(item.recording for item in done),
            tuple(item.smoothed for item in done),
            tuple(item.score for item in done),
            report_file,
        )


def _known(design: FilterDesign | None, lead_ms: float | None) -> KnownSensor:
    known = KnownSensor() if design is None else known_sensor(design)
    return known if lead_ms is None else known.delayed(lead_ms / 1e3)


def _outputs(sources: tuple[Path, ...], output: Path) -> tuple[Path, ...]:
    """Return a file for each recording: the one that is named, or one of its name in a folder.

    Raises
    ------
    click.UsageError
        If several recordings are to go to one file, or one would be overwritten.
    """
    if len(sources) == 1 and not output.is_dir():
        require_suffix(output)
        targets: tuple[Path, ...] = (output,)
    elif output.is_dir() or not output.suffix:
        output.mkdir(parents=True, exist_ok=True)
        targets = tuple(output / source.name for source in sources)
    else:
        raise click.UsageError(f"{len(sources)} recordings need a folder; {output} is a file name")
    if len(set(targets)) < len(targets):
        raise click.UsageError("two recordings have one name; smooth each into its own folder")
    read = {source.resolve() for source in sources}
    for target in targets:
        if target.resolve() in read:
            raise click.UsageError(f"{target} would overwrite the recording it is made of")
    return targets


def _smoothed(
    recording: Recording,
    source: Path,
    target: Path,
    settings: SmootherSettings | None,
    known: KnownSensor,
    axes: AxisChoice,
    mounting: Mounting,
) -> SmoothedFile:
    smoothed = smooth_recording(recording, settings, known)
    save_smoothed(recording, smoothed.up, target)
    say_pieces(source, recording, smoothed)
    return SmoothedFile(
        source=source,
        target=target,
        recording=recording,
        smoothed=smoothed,
        is_reference=measured_reference(recording) is None,
        score=score(recording, smoothed.up, axes, mounting),
    )


def _train(
    files: tuple[Path, ...],
    output: Path,
    options: TrainingOptions,
    known: KnownSensor,
    as_json: bool,
) -> None:
    if output.suffix.lower() != ".json":
        raise click.UsageError(f"{output} must end in .json: --train writes settings")
    recordings = tuple(read_recording(path) for path in files)
    searches = min(5, len(files)) + 1 if len(files) > 1 else 1
    say(f"{searches} search(es) of {options.evaluations} settings over {len(files)} recording(s)")
    trained = train(recordings, options, known)
    found = provenance(trained, options, recordings)
    save_settings(trained.settings, found, output)
    if as_json:
        emit_json(trained_document(trained, found, output))
    else:
        show_trained(trained, output)
