"""The subcommand ``tune``: from recordings to a design."""

import math
from pathlib import Path

import click

from hostkit.cli.inputs import JSON, RECORDINGS, read_recording, say
from hostkit.cli.output import emit_json
from hostkit.design_file import digest, save_design
from hostkit.errors import DesignError
from hostkit.filters.complementary import crossover_hz, tau_from_eta
from hostkit.mounting import Mounting
from hostkit.optimisers import OPTIMISERS
from hostkit.records import AXES, OBJECTIVES, TILT_METHODS, AxisChoice, Objective, TiltMethod
from hostkit.sensors import SENSORS
from hostkit.tuning import TuningOptions, TuningResult, sensor_config
from hostkit.tuning import tune as run_tuning
from hostkit.units import DEG_PER_RAD

PART = SENSORS["mpu6050"]


def parse_mounting(context: click.Context, option: click.Parameter, text: str) -> Mounting:
    """Read a mounting; what is wrong with it is wrong use."""
    try:
        return Mounting.parse(text)
    except DesignError as error:
        raise click.BadParameter(str(error)) from error


@click.command("tune")
@RECORDINGS
@click.option(
    "-o",
    "--output",
    type=click.Path(dir_okay=False, path_type=Path),
    default=Path("design.json"),
    show_default=True,
    metavar="FILE",
    help="Design to write.",
)
@click.option(
    "--filter",
    "filter_name",
    type=click.Choice(["complementary"]),
    default="complementary",
    show_default=True,
    help="Filter to tune.",
)
@click.option(
    "--axes",
    type=click.Choice(tuple(AXES)),
    default="both",
    show_default=True,
    help="Angles the filter gives.",
)
@click.option(
    "--mounting",
    default="+x+y+z",
    show_default=True,
    callback=parse_mounting,
    metavar="AXES",
    help="Body x, y, z as signed sensor axes; +z+x+y makes sensor z the roll axis.",
)
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
@click.option(
    "--optimiser",
    type=click.Choice(OPTIMISERS.names()),
    default="qpso",
    show_default=True,
    help="Rule of the swarm.",
)
@click.option("--particles", type=click.IntRange(1, 100_000), default=20, show_default=True)
@click.option("--iterations", type=click.IntRange(1, 100_000), default=100, show_default=True)
@click.option("--seed", type=click.IntRange(0, 2**63 - 1), default=1, show_default=True)
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
@click.option(
    "--report",
    "report_file",
    type=click.Path(dir_okay=False, path_type=Path),
    metavar="FILE.html",
    help="Also write a report with plots.",
)
@JSON
def tune(
    recording_files: tuple[Path, ...],
    output: Path,
    filter_name: str,
    axes: AxisChoice,
    mounting: Mounting,
    tilt: TiltMethod,
    objective: Objective,
    optimiser: str,
    particles: int,
    iterations: int,
    seed: int,
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
    recordings = tuple(read_recording(path) for path in recording_files)
    sensor = sensor_config(
        recordings,
        recordings[0].rate_hz,
        gyro_full_scale_deg_s=None if gyro_range is None else int(gyro_range),
        accel_full_scale_g=None if accel_range is None else int(accel_range),
        low_pass_setting=None if low_pass is None else int(low_pass),
    )
    options = TuningOptions(
        axes=axes,
        mounting=mounting,
        tilt=tilt,
        objective=objective,
        optimiser=optimiser,
        particles=particles,
        iterations=iterations,
        seed=seed,
        sensor=sensor,
    )
    result = run_tuning(recordings, options)
    save_design(result.design, output)
    if result.swarm.at_bound.any():
        say("tau lies on the edge of its range: the recordings do not determine it")
    if as_json:
        emit_json(tuning_document(result, output))
    else:
        _show(result, output)
    if report_file is not None:
        from hostkit.report import write_tuning_report

        write_tuning_report(result, report_file)


def tuning_document(result: TuningResult, output: Path) -> dict[str, object]:
    """Return the result of a tuning as the document ``hostkit.tune/1``."""
    design = result.design
    eta = design.parameter("eta")
    assert design.tuning is not None
    return {
        "schema": "hostkit.tune/1",
        "design": str(output),
        "digest": digest(design),
        "filter": design.filter,
        "parameters": {p.name: p.value for p in design.parameters},
        "eta": eta,
        "tau_s": tau_from_eta(eta, design.period_s),
        "crossover_hz": crossover_hz(eta, design.period_s),
        "rate_hz": design.rate_hz,
        "rmse_deg": result.rms_rad * DEG_PER_RAD,
        "evaluations": result.swarm.evaluations,
        "optimiser": design.tuning.optimiser,
        "seed": design.tuning.seed,
        "at_bound": bool(result.swarm.at_bound.any()),
    }


def _show(result: TuningResult, output: Path) -> None:
    design = result.design
    eta = design.parameter("eta")
    tau_s = tau_from_eta(eta, design.period_s)
    what = "inclination" if design.axes == "both" else design.axes
    sensor = design.sensor
    click.echo(
        f"eta {eta:.6f}  =  tau {tau_s:.4g} s  =  crossover "
        f"{crossover_hz(eta, design.period_s):.4g} Hz  at  {design.rate_hz:g} Hz\n"
        f"RMSE of {what}, mean over {len(result.evaluations)} training recording(s): "
        f"{math.degrees(result.rms_rad):.4f} deg\n"
        f"sensor: +-{sensor.gyro_full_scale_deg_s} deg/s, +-{sensor.accel_full_scale_g} g, "
        f"low-pass setting {sensor.low_pass_setting}\n"
        f"{output}: design {digest(design)}, {result.swarm.evaluations} evaluations"
    )
