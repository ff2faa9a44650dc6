"""The report of a tuning, and the parts of it that other reports show too."""

import math
from pathlib import Path

from hostkit.design_file import digest
from hostkit.filters.complementary import crossover_hz, tau_from_eta
from hostkit.records import AXES, FilterDesign
from hostkit.report import figures
from hostkit.report.page import Fact, Page, Plot, Table, write_page
from hostkit.tuning import QUANTITIES, TuningResult


def write_tuning_report(result: TuningResult, path: Path) -> None:
    """Write the report of a tuning as one HTML file.

    Raises
    ------
    ToolMissingError
        If matplotlib is not installed.
    HostkitError
        If the file cannot be written.
    """
    page = Page(
        title="Tuning report",
        subtitle=f"design {digest(result.design)}, {result.design.filter} filter",
        facts=tuning_facts(result),
        sections=(*tuning_plots(result), score_table(result)),
        provenance=provenance(result.design),
    )
    write_page(page, path)


def tuning_facts(result: TuningResult) -> tuple[Fact, ...]:
    """Return eta with what it means, and the error on the training recordings."""
    design = result.design
    eta, period_s = design.parameter("eta"), design.period_s
    what = "inclination" if design.axes == "both" else design.axes
    return (
        Fact(label="eta", value=f"{eta:.5f}", note=f"at {design.rate_hz:g} Hz"),
        Fact(label="time constant", value=f"{tau_from_eta(eta, period_s):.3g} s", note="tau"),
        Fact(
            label="crossover",
            value=f"{crossover_hz(eta, period_s):.3g} Hz",
            note="below it force decides, above it rate",
        ),
        Fact(
            label=f"RMSE of {what}",
            value=f"{math.degrees(result.rms_rad):.3f} deg",
            note=f"mean over {len(result.evaluations)} training recording(s)",
        ),
    )


def tuning_plots(result: TuningResult) -> tuple[Plot, ...]:
    """Return convergence, fit, residual histogram and frequency response."""
    design, evaluations = result.design, result.evaluations
    names = AXES[design.axes]
    assert design.tuning is not None
    return (
        Plot(
            title="Convergence",
            caption=(
                f"Best cost of the swarm above its final one ({design.tuning.optimiser}, "
                f"{design.tuning.particles} particles, seed {design.tuning.seed}); the line ends "
                "where the swarm improves no more."
            ),
            svg=figures.convergence(result.swarm.history),
        ),
        Plot(
            title="Fit",
            caption=f"Recording {evaluations[0].recording}: filter, reference and error.",
            svg=figures.fit(evaluations[0], names),
        ),
        Plot(
            title="Residuals",
            caption="Filter minus reference over all scored samples of the training recordings.",
            svg=figures.residual_histogram(evaluations, names),
        ),
        Plot(
            title="Frequency response",
            caption="How the filter weighs its two sensors; the dashed line is the crossover.",
            svg=figures.frequency_response(design.parameter("eta"), design.period_s),
        ),
    )


def score_table(result: TuningResult) -> Table:
    """Return the error of every training recording."""
    shown = [q for q in QUANTITIES if any(e.score(q) for e in result.evaluations)]
    rows = []
    for e in result.evaluations:
        scores = [s for q in shown if (s := e.score(q)) is not None]
        errors = [
            text
            for s in scores
            for text in (f"{math.degrees(s.rms_rad):.4f}", f"{math.degrees(s.max_rad):.3f}")
        ]
        difference = f"{math.degrees(e.integer_vs_float_max_rad):.6f}"
        rows.append((e.recording, str(e.samples), *errors, difference))
    columns = [f"{q} {kind}, deg" for q in shown for kind in ("rms", "max")]
    return Table(
        title="Training recordings",
        header=("recording", "samples", *columns, "integer - float, deg"),
        rows=tuple(rows),
        note="Errors of the integer model, that is, of what a device says, on training data.",
    )


def provenance(design: FilterDesign) -> tuple[tuple[str, str], ...]:
    """Return where a design comes from, for the end of a report."""
    sensor = design.sensor
    facts = [
        ("design", digest(design)),
        ("axes", f"{design.axes}, mounting {design.mounting}, tilt by {design.tilt}"),
        (
            "sensor",
            f"{sensor.part}, +-{sensor.gyro_full_scale_deg_s} deg/s, "
            f"+-{sensor.accel_full_scale_g} g, low-pass setting {sensor.low_pass_setting}",
        ),
    ]
    if design.tuning is not None:
        facts += [("seed", str(design.tuning.seed)), ("objective", design.tuning.objective)]
        facts += [(f"{name} version", value) for name, value in design.tuning.versions]
        facts += [
            (f"recording {r.name}", f"{r.samples} samples, sha256 {r.sha256 or 'not from a file'}")
            for r in design.tuning.recordings
        ]
    return tuple(facts)
