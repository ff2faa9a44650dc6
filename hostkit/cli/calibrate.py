"""The subcommand ``calibrate``: what a sensor reads wrong, measured and put into a design."""

from dataclasses import replace
from pathlib import Path
from typing import Final, Literal

import click

from hostkit.calibration import Calibration, rms, tilt_worth, to_record
from hostkit.calibration import calibrate as run_calibration
from hostkit.calibration.document import to_document
from hostkit.calibration.remarks import remarks, require_accelerometer
from hostkit.cli.inputs import DESIGN, JSON, RECORDINGS, REPORT, finite, read_design, say
from hostkit.cli.output import emit_json
from hostkit.design_file import digest, save_design
from hostkit.filters import FILTERS
from hostkit.filters.sensor_terms import Calibrated
from hostkit.provenance import TERM_UNITS, CalibrationTerm
from hostkit.recordings import Recording, check, load
from hostkit.records import FilterDesign
from hostkit.units import DEG_PER_RAD, STANDARD_GRAVITY_M_S2

Sensors = Literal["both", "gyro", "accel"]
SENSORS: Final[tuple[Sensors, ...]] = ("both", "gyro", "accel")
NO_TERMS: Final = tuple(
    CalibrationTerm(kind=kind, axis=axis, value=0.0, standard_error=0.0)
    for kind in TERM_UNITS
    for axis in range(3)
)
"""One of each kind and axis, to ask a filter what it has a place for."""


@click.group("calibrate")
def calibrate() -> None:
    """Measure what a sensor reads wrong and put it into a design.

    \b
    Example:
      hostkit calibrate imu design.json six-positions.csv -o calibrated.json
    """


@calibrate.command("imu")
@DESIGN
@RECORDINGS
@click.option(
    "-o",
    "--output",
    required=True,
    type=click.Path(dir_okay=False, path_type=Path),
    metavar="OUT",
    help="Design to write.",
)
@click.option(
    "--gravity-m-s2",
    type=click.FloatRange(min=9.0, max=10.0),
    callback=finite,
    default=STANDARD_GRAVITY_M_S2,
    show_default=True,
    metavar="G",
    help="Magnitude of gravity where the recordings were made.",
)
@click.option(
    "--sensors",
    type=click.Choice(SENSORS),
    default="both",
    show_default=True,
    help="What to put into the design.",
)
@REPORT
@JSON
def imu(
    design_file: Path,
    recording_files: tuple[Path, ...],
    output: Path,
    gravity_m_s2: float,
    sensors: Sensors,
    report_file: Path | None,
    as_json: bool,
) -> None:
    """Calibrate accelerometer and gyroscope from recordings of the sensor in several positions.

    Put the sensor on each of its six faces in turn, or into a dozen positions of any kind, and
    leave it alone for three seconds in each. Turn it by hand from one to the next while the
    recording runs, and the scale of the gyroscope is found too.

    \b
    Example:
      hostkit import poses.txt -o poses.csv --gyro-range 500
      hostkit calibrate imu design.json poses.csv -o calibrated.json --report poses.html
    """
    design = read_design(design_file)
    recordings = tuple(_read(path) for path in recording_files)
    calibration = run_calibration(recordings, gravity_m_s2=gravity_m_s2)
    places = _calibrated(design, NO_TERMS).taken
    if sensors != "gyro" and any(name.startswith("accel") for name in places):
        require_accelerometer(calibration)
    offered = tuple(t for t in calibration.terms if sensors == "both" or t.kind.startswith(sensors))
    taken = _calibrated(design, offered)
    new = replace(taken.design, calibration=to_record(calibration))
    FILTERS[new.filter].lower(new)
    save_design(new, output)
    warnings = (*remarks(calibration), *_left_out(design, offered, taken))
    for warning in warnings:
        say(f"note: {warning}")
    if report_file is not None:
        from hostkit.report.calibration import write_calibration_report

        write_calibration_report(calibration, new, warnings, report_file)
    if as_json:
        head = {"schema": "hostkit.calibrate/1", "design": str(output), "digest": digest(new)}
        parameters = {p.name: p.value for p in new.parameters}
        body = {"filter": new.filter, "parameters": parameters, "taken": list(taken.taken)}
        emit_json({**head, **body, "warnings": list(warnings), **to_document(calibration)})
    else:
        _show(calibration, taken, output, digest(new))


def _read(path: Path) -> Recording:
    """Load a recording and say what its sanity card finds beside what a calibration mends."""
    recording = load(path)
    for finding in check(recording).findings:
        if finding.kind not in ("bias", "force", "reference"):
            say(f"{path}: {finding.message}")
    return recording


def _calibrated(design: FilterDesign, terms: tuple[CalibrationTerm, ...]) -> Calibrated:
    return FILTERS[design.filter].calibrated(design, terms)


def _left_out(
    design: FilterDesign, offered: tuple[CalibrationTerm, ...], taken: Calibrated
) -> tuple[str, ...]:
    names = [term.name for term in offered if term.name not in taken.taken]
    if not names:
        return ()
    title = FILTERS[design.filter].title
    return (f"the {title} of this design has no place for {', '.join(names)}; left out",)


def _show(calibration: Calibration, taken: Calibrated, output: Path, name: str) -> None:
    accel, gyro, temperature = calibration.accel, calibration.gyro, calibration.temperature
    click.echo(
        f"poses {len(calibration.poses)}, turns {len(calibration.turns)}, recordings "
        f"{len(calibration.recordings)}; gravity {calibration.gravity_m_s2:g} m/s^2"
    )
    if temperature is not None:
        low, high = temperature.lowest_c, temperature.highest_c
        click.echo(f"temperature at rest {temperature.mean_c:.1f} degC, {low:.1f} to {high:.1f}")
    for term in calibration.terms:
        click.echo(term_line(term) + ("" if term.name in taken.taken else "   not used"))
    if accel.determined:
        worth = tilt_worth(accel, calibration.gravity_m_s2)
        click.echo(
            f"force at rest less gravity: {rms(accel.before_m_s2[accel.used]):.3f} -> "
            f"{rms(accel.after_m_s2[accel.used]):.3f} m/s^2 rms; tilt at rest "
            f"{worth.before_rms_rad * DEG_PER_RAD:.2f} -> "
            f"{worth.after_rms_rad * DEG_PER_RAD:.2f} deg rms"
        )
    if gyro.determined.any():
        click.echo(
            f"gravity carried through a turn: {rms(gyro.before_rad[gyro.used]) * DEG_PER_RAD:.2f} "
            f"-> {rms(gyro.after_rad[gyro.used]) * DEG_PER_RAD:.2f} deg rms"
        )
    click.echo(f"{output}: design {name}")


def term_line(term: CalibrationTerm) -> str:
    """Return a term with its standard error, as on the screen: rates in deg/s, scales in %."""
    factor, unit = {
        "rad/s": (DEG_PER_RAD, "deg/s"),
        "1": (100.0, "%"),
    }.get(TERM_UNITS[term.kind], (1.0, TERM_UNITS[term.kind]))
    return (
        f"  {term.name:<15}{term.value * factor:+9.4f} +- {term.standard_error * factor:.4f} {unit}"
    )
