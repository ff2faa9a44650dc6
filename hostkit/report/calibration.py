"""The report of a calibration."""

from pathlib import Path

import numpy as np

from hostkit.calibration import Calibration, rms, tilt_worth
from hostkit.design_file import digest
from hostkit.provenance import TERM_UNITS
from hostkit.recordings.recording import Vector
from hostkit.records import FilterDesign
from hostkit.report.canvas import BLUE, GREY, ORANGE, new_figure, svg_text
from hostkit.report.page import Fact, Page, Plot, Table, write_page
from hostkit.units import DEG_PER_RAD


def write_calibration_report(
    calibration: Calibration, design: FilterDesign, warnings: tuple[str, ...], path: Path
) -> None:
    """Write the report of a calibration as one HTML file.

    Raises
    ------
    ToolMissingError
        If matplotlib is not installed.
    HostkitError
        If the file cannot be written.
    """
    page = Page(
        title="Calibration",
        subtitle=", ".join(recording.name for recording in calibration.recordings),
        facts=_facts(calibration),
        sections=(_terms(calibration), *_warnings(warnings), *_plots(calibration)),
        provenance=(
            ("design", f"{digest(design)}, {design.filter}"),
            ("gravity", f"{calibration.gravity_m_s2:g} m/s^2"),
            *(
                (f"recording {r.name}", f"{r.samples} samples, sha256 {r.sha256 or 'not a file'}")
                for r in calibration.recordings
            ),
        ),
    )
    write_page(page, path)


def _facts(calibration: Calibration) -> tuple[Fact, ...]:
    accel, gyro, temperature = calibration.accel, calibration.gyro, calibration.temperature
    facts = [
        Fact(label="poses", value=f"{np.count_nonzero(accel.used)} of {len(accel.used)}"),
        Fact(label="turns", value=f"{np.count_nonzero(gyro.used)} of {len(gyro.used)}"),
    ]
    if accel.determined:
        worth = tilt_worth(accel, calibration.gravity_m_s2)
        facts.append(
            Fact(
                label="tilt at rest",
                value=f"{worth.after_rms_rad * DEG_PER_RAD:.2f} deg",
                note=f"rms; {worth.before_rms_rad * DEG_PER_RAD:.2f} deg before",
            )
        )
    if gyro.determined.any():
        facts.append(
            Fact(
                label="gravity through a turn",
                value=f"{rms(gyro.after_rad[gyro.used]) * DEG_PER_RAD:.2f} deg",
                note=f"rms; {rms(gyro.before_rad[gyro.used]) * DEG_PER_RAD:.2f} deg before",
            )
        )
    if temperature is not None:
        note = f"{temperature.lowest_c:.1f} to {temperature.highest_c:.1f}"
        facts.append(Fact(label="degC at rest", value=f"{temperature.mean_c:.1f}", note=note))
    return tuple(facts)


def _terms(calibration: Calibration) -> Table:
    rows = tuple(
        (term.name, f"{term.value:.6f}", f"{term.standard_error:.6f}", TERM_UNITS[term.kind])
        for term in calibration.terms
    )
    return Table(
        title="Terms",
        header=("name", "value", "standard error", "unit"),
        rows=rows,
        note="Sensor axes; true value = (1 + scale) (reading - offset).",
    )


def _warnings(warnings: tuple[str, ...]) -> tuple[Table, ...]:
    if not warnings:
        return ()
    rows = tuple((warning,) for warning in warnings)
    return (Table(title="Notes", header=("note",), rows=rows, is_text=True),)


def _plots(calibration: Calibration) -> tuple[Plot, ...]:
    accel, gyro = calibration.accel, calibration.gyro
    after = accel.after_m_s2 if accel.determined else None
    plots = [
        Plot(
            title="Force at rest",
            caption="Magnitude of the mean force of each pose less gravity.",
            svg=_pairs(accel.before_m_s2, after, "pose", "m/s^2"),
        )
    ]
    if gyro.before_rad.size:
        after = gyro.after_rad * DEG_PER_RAD if gyro.determined.any() else None
        plots.append(
            Plot(
                title="Turns",
                caption="Angle between gravity as carried on by the gyroscope and as measured.",
                svg=_pairs(gyro.before_rad * DEG_PER_RAD, after, "turn", "deg"),
            )
        )
    return tuple(plots)


def _pairs(before: Vector, after: Vector | None, what: str, unit: str) -> str:
    figure, axes, mpl = new_figure()
    number = np.arange(len(before)) + 1
    axes.axhline(0.0, color=GREY)
    axes.plot(number, before, "o", color=ORANGE, label="before")
    if after is not None:
        axes.plot(number, after, "o", color=BLUE, label="after")
    axes.set(xlabel=what, ylabel=unit)
    axes.legend()
    return svg_text(figure, mpl)
