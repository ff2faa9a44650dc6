"""The subcommand ``simulate``: a recording without hardware."""

from dataclasses import replace
from pathlib import Path

import click
import numpy as np

from hostkit.cli.inputs import finite, say
from hostkit.cli.output import emit_json
from hostkit.diagnosis import load_measured_errors
from hostkit.errors import HostkitError
from hostkit.recordings import SUFFIXES, Recording, check, save
from hostkit.records import SensorConfig
from hostkit.sensors import SENSORS
from hostkit.simulation import PROFILES, SensorErrors
from hostkit.simulation import simulate as run_simulation
from hostkit.units import RAD_PER_DEG

PART = SENSORS["mpu6050"]
GYRO_RANGES = tuple(str(r.full_scale) for r in PART.gyro_ranges)
ACCEL_RANGES = tuple(str(r.full_scale) for r in PART.accel_ranges)
LOW_PASSES = tuple(str(lp.setting) for lp in PART.low_passes)
MAX_GYRO_BIAS_DEG_S = 20.0
MAX_VIBRATION_M_S2 = 10.0
MAX_SEED = 2**63 - 1


def _suffixed(context: click.Context, option: click.Parameter, path: Path) -> Path:
    if path.suffix.lower() not in SUFFIXES:
        raise click.BadParameter(f"{path} must end in {' or '.join(SUFFIXES)}")
    return path


@click.command("simulate", short_help="Make a recording from a motion profile.")
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
    "--profile",
    type=click.Choice(PROFILES.names()),
    default="free",
    show_default=True,
    help="How the sensor is moved.",
)
@click.option(
    "--duration",
    "duration_s",
    type=click.FloatRange(min=0.0, min_open=True),
    callback=finite,
    default=60.0,
    show_default=True,
    metavar="S",
    help="Length in seconds.",
)
@click.option(
    "--rate",
    "rate_hz",
    type=click.FloatRange(min=0.0, max=PART.sample_base_rate_hz, min_open=True),
    callback=finite,
    default=100.0,
    show_default=True,
    metavar="HZ",
    help="Sample rate; the sensor makes 1000 Hz divided by 1 to 256.",
)
@click.option(
    "--seed",
    type=click.IntRange(0, MAX_SEED),
    default=1,
    show_default=True,
    help="Start of the random numbers.",
)
@click.option(
    "--gyro-range",
    type=click.Choice(GYRO_RANGES),
    default="500",
    show_default=True,
    help="Full scale in deg/s.",
)
@click.option(
    "--accel-range",
    type=click.Choice(ACCEL_RANGES),
    default="4",
    show_default=True,
    help="Full scale in g.",
)
@click.option(
    "--low-pass",
    type=click.Choice(LOW_PASSES),
    default="3",
    show_default=True,
    help="Setting of the sensor's low-pass filter (DLPF_CFG).",
)
@click.option(
    "--gyro-bias",
    "gyro_bias_deg_s",
    type=click.FloatRange(-MAX_GYRO_BIAS_DEG_S, MAX_GYRO_BIAS_DEG_S),
    callback=finite,
    metavar="DEG_S",
    help="Gyroscope offset on all axes, instead of some tenths of a deg/s.",
)
@click.option(
    "--vibration",
    "vibration_m_s2",
    type=click.FloatRange(0.0, MAX_VIBRATION_M_S2),
    callback=finite,
    default=0.0,
    show_default=True,
    metavar="M_S2",
    help="Vibration along each axis, m/s^2 rms, 20 to 120 Hz.",
)
@click.option(
    "--errors-from",
    "errors_file",
    type=click.Path(exists=True, dir_okay=False, path_type=Path),
    metavar="FILE.json",
    help="Bias and noise as hostkit diagnose measured them (--allan-out or --json).",
)
@click.option("--ideal", is_flag=True, help="An exact sensor: no noise, delay, range or counts.")
@click.option("--json", "as_json", is_flag=True, help="Print one JSON document.")
def simulate(
    output: Path,
    profile: str,
    duration_s: float,
    rate_hz: float,
    seed: int,
    gyro_range: str,
    accel_range: str,
    low_pass: str,
    gyro_bias_deg_s: float | None,
    vibration_m_s2: float,
    errors_file: Path | None,
    ideal: bool,
    as_json: bool,
) -> None:
    """Make a recording from a motion profile and the noise model of the MPU-6050.

    \b
    Example:
      hostkit simulate --profile free --duration 60 --rate 100 --seed 1 -o flight.csv
    """
    sensor = SensorConfig(
        part=PART.name,
        gyro_full_scale_deg_s=int(gyro_range),
        accel_full_scale_g=int(accel_range),
        low_pass_setting=int(low_pass),
    )
    errors = _errors(ideal, gyro_bias_deg_s, vibration_m_s2, errors_file)
    recording = _simulated(profile, duration_s, rate_hz, sensor, errors, seed)
    card = check(recording)
    save(recording, output)
    for line in card.lines():
        click.echo(line, err=True)
    _report(output, recording, profile, seed, as_json)


def _errors(
    ideal: bool, gyro_bias_deg_s: float | None, vibration_m_s2: float, errors_file: Path | None
) -> SensorErrors:
    if ideal and (gyro_bias_deg_s or vibration_m_s2 or errors_file is not None):
        raise click.UsageError(
            "--ideal has no error; leave out --gyro-bias, --vibration and --errors-from"
        )
    if ideal:
        return SensorErrors.none()
    errors = SensorErrors() if errors_file is None else _measured(errors_file)
    errors = replace(errors, vibration_m_s2=vibration_m_s2)
    if gyro_bias_deg_s is None:
        return errors
    return replace(errors, gyro_bias_rad_s=(gyro_bias_deg_s * RAD_PER_DEG,) * 3)


def _measured(errors_file: Path) -> SensorErrors:
    measured = load_measured_errors(errors_file)
    for remark in measured.remarks:
        say(f"{errors_file}: {remark}")
    return measured.errors


def _simulated(
    profile: str,
    duration_s: float,
    rate_hz: float,
    sensor: SensorConfig,
    errors: SensorErrors,
    seed: int,
) -> Recording:
    """Simulate; what the simulation refuses are values from the command line."""
    try:
        return run_simulation(
            profile,
            duration_s=duration_s,
            rate_hz=rate_hz,
            sensor=sensor,
            errors=errors,
            rng=np.random.default_rng(seed),
        )
    except HostkitError as error:
        raise click.UsageError(str(error)) from error


def _report(output: Path, recording: Recording, profile: str, seed: int, as_json: bool) -> None:
    if as_json:
        emit_json(
            {
                "schema": "hostkit.simulate/1",
                "recording": str(output),
                "samples": len(recording),
                "rate_hz": recording.rate_hz,
                "seed": seed,
            }
        )
        return
    click.echo(
        f"{output}: {len(recording)} samples at {recording.rate_hz:g} Hz, profile {profile}, "
        f"seed {seed}"
    )
