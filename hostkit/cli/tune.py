"""The subcommand ``tune``: from recordings to a design."""

from dataclasses import replace
from pathlib import Path

import click

from hostkit.cli.fleet import fleet_options
from hostkit.cli.fleet import run as run_fleet
from hostkit.cli.inputs import (
    JSON,
    RECORDINGS_OR_NONE,
    REPORT,
    axes_option,
    mounting_option,
    read_for_tuning,
    say,
)
from hostkit.cli.output import emit_json
from hostkit.cli.parameter_options import AUTO_FILTER, FILTER, FIX, FREE, RANGE
from hostkit.cli.tune_filter import with_filter
from hostkit.cli.tune_output import show, tuning_document
from hostkit.design_file import load_design, save_design, with_acceptance_of
from hostkit.errors import DesignError
from hostkit.fleet import FleetOptions, GroupBy, SensorWish
from hostkit.mounting import Mounting
from hostkit.optimisers import OPTIMISERS
from hostkit.provenance import CalibrationRecord
from hostkit.records import OBJECTIVES, TILT_METHODS, AxisChoice, Objective, TiltMethod
from hostkit.sensors import SENSORS
from hostkit.tuning import AUTO, FixedParameter, FreeName, SearchRange, TuningOptions, sensor_config
from hostkit.tuning import tune as run_tuning
from hostkit.tuning.options import PRECISIONS, Precision
from hostkit.tuning.search import ONE_PARAMETER

PART = SENSORS["mpu6050"]

DESIGN_FILE, FLEET_FOLDER = Path("design.json"), Path("designs")


@click.command("tune")
@RECORDINGS_OR_NONE
@click.option(
    "-o",
    "--output",
    type=click.Path(path_type=Path),
    metavar="FILE",
    help=f"Design to write, by default {DESIGN_FILE}; with --fleet a folder, by default "
    f"{FLEET_FOLDER}.",
)
@click.option(
    "--fleet",
    "fleet_folder",
    type=click.Path(exists=True, file_okay=False, path_type=Path),
    metavar="DIR",
    help="Tune one design for each device of DIR instead.",
)
@FILTER
@axes_option("Angles the filter gives.")
@mounting_option("Body x, y, z as signed sensor axes; +z+x+y makes sensor z the roll axis.")
@click.option(
    "--tilt",
    type=click.Choice(TILT_METHODS),
    default="atan2",
    show_default=True,
    help="Tilt from specific force; arcsin is the paper's.",
)
@click.option(
    "--objective",
    type=click.Choice(OBJECTIVES),
    default="rmse",
    show_default=True,
    help="What is made small, mean over recordings; mae is the paper's.",
)
@FREE
@FIX
@RANGE
@click.option(
    "--optimiser",
    type=click.Choice((AUTO, *OPTIMISERS.names())),
    default=AUTO,
    show_default=True,
    help="How to search; auto is grid-brent for one parameter, which needs no swarm, else qpso.",
)
@click.option("--particles", type=click.IntRange(1, 100_000), default=20, show_default=True)
@click.option("--iterations", type=click.IntRange(1, 100_000), default=100, show_default=True)
@click.option(
    "--restarts",
    type=click.IntRange(1, 10_000),
    default=1,
    show_default=True,
    help="Swarms with seeds of their own; the best is kept.",
)
@click.option("--seed", type=click.IntRange(0, 2**63 - 1), default=1, show_default=True)
@click.option(
    "--precision",
    type=click.Choice(PRECISIONS),
    default="float64",
    show_default=True,
    help="Arithmetic of the search; float32 takes half the memory and time.",
)
@click.option(
    "--held-out/--no-held-out",
    default=True,
    show_default=True,
    help="Leave recordings out in turn, for an error on data that was not tuned on.",
)
@click.option(
    "--resamples",
    type=click.IntRange(0, 100_000),
    default=40,
    show_default=True,
    help="Tunings on resampled recordings, for the intervals; 0 for none.",
)
@click.option(
    "--calibration",
    "calibration_file",
    type=click.Path(exists=True, dir_okay=False, path_type=Path),
    metavar="DESIGN",
    help="Take over the calibration of a design (see hostkit calibrate imu); it is not tuned.",
)
@click.option(
    "--gyro-range",
    type=click.Choice([str(r.full_scale) for r in PART.gyro_ranges]),
    help="Full scale in deg/s; by default from the recordings.",
)
@click.option(
    "--accel-range",
    type=click.Choice([str(r.full_scale) for r in PART.accel_ranges]),
    help="Full scale in g; by default from the recordings.",
)
@click.option(
    "--low-pass",
    type=click.Choice([str(lp.setting) for lp in PART.low_passes]),
    help="Setting of the sensor's low-pass filter; by default from the rate.",
)
@REPORT
@fleet_options
@JSON
def tune(
    recording_files: tuple[Path, ...],
    output: Path | None,
    fleet_folder: Path | None,
    filter_name: str,
    axes: AxisChoice,
    mounting: Mounting,
    tilt: TiltMethod,
    objective: Objective,
    free: tuple[FreeName, ...],
    fixed: tuple[FixedParameter, ...],
    ranges: tuple[SearchRange, ...],
    optimiser: str,
    particles: int,
    iterations: int,
    restarts: int,
    seed: int,
    jobs: int | None,
    scheduler: str | None,
    group_by: GroupBy,
    redo: bool,
    precision: Precision,
    held_out: bool,
    resamples: int,
    calibration_file: Path | None,
    gyro_range: str | None,
    accel_range: str | None,
    low_pass: str | None,
    report_file: Path | None,
    as_json: bool,
) -> None:
    """Find the filter that fits recordings with a reference, and write it as a design.

    \b
    Example:
      hostkit simulate --profile sine-sweep -o sweep.csv
      hostkit tune sweep.csv --axes both --seed 1 -o design.json
    """
    options = TuningOptions(
        filter=filter_name,
        axes=axes,
        mounting=mounting,
        tilt=tilt,
        objective=objective,
        optimiser=optimiser,
        particles=particles,
        iterations=iterations,
        free=tuple(name for name in free if name not in {f.name for f in fixed}),
        fixed=fixed,
        ranges=ranges,
        restarts=restarts,
        seed=seed,
        jobs=1 if jobs is None or fleet_folder else jobs,
        precision=precision,
        held_out=held_out,
        resamples=resamples,
        calibration=None if calibration_file is None else _calibration(calibration_file),
    )
    wish = SensorWish(
        gyro_full_scale_deg_s=None if gyro_range is None else int(gyro_range),
        accel_full_scale_g=None if accel_range is None else int(accel_range),
        low_pass_setting=None if low_pass is None else int(low_pass),
    )
    if (fleet_folder is None) == (not recording_files):
        raise click.UsageError("name recordings, or a folder of devices with --fleet")
    if fleet_folder is not None and filter_name == AUTO_FILTER:
        raise click.UsageError("a fleet has one filter: name it with --filter")
    if fleet_folder is None:
        _tune_one(recording_files, output or DESIGN_FILE, options, wish, report_file, as_json)
    else:
        run_fleet(
            fleet_folder,
            output or FLEET_FOLDER,
            FleetOptions(tuning=options, wish=wish, group_by=group_by, redo=redo),
            jobs=jobs,
            scheduler=scheduler,
            report_file=report_file,
            as_json=as_json,
        )


def _calibration(path: Path) -> CalibrationRecord:
    found = load_design(path).calibration
    if found is None:
        raise DesignError(f"{path} has no calibration; hostkit calibrate imu puts one into it")
    return found


def _tune_one(
    files: tuple[Path, ...],
    output: Path,
    options: TuningOptions,
    wish: SensorWish,
    report_file: Path | None,
    as_json: bool,
) -> None:
    recordings = tuple(read_for_tuning(path) for path in files)
    options = with_filter(recordings, options)
    sensor = sensor_config(
        recordings,
        recordings[0].rate_hz,
        gyro_full_scale_deg_s=wish.gyro_full_scale_deg_s,
        accel_full_scale_g=wish.accel_full_scale_g,
        low_pass_setting=wish.low_pass_setting,
    )
    result = run_tuning(recordings, replace(options, sensor=sensor))
    save_design(with_acceptance_of(result.design, output), output)
    for remark in result.remarks:
        say(remark)
    if len(result.intervals) == 1 and options.optimiser not in (AUTO, ONE_PARAMETER):
        say(f"one parameter needs no swarm: {ONE_PARAMETER} finds the same in some 40 evaluations")
    if as_json:
        emit_json(tuning_document(result, output))
    else:
        show(result, output)
    if report_file is not None:
        from hostkit.report import write_tuning_report

        write_tuning_report(result, report_file)
