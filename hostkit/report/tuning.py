"""The report of a tuning, and the parts of it that other reports show too."""

import math
from pathlib import Path

from hostkit.design_file import digest
from hostkit.filters import FILTERS
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
        sections=(
            *remark_tables(result),
            parameter_table(result),
            *tuning_plots(result),
            score_table(result),
        ),
        provenance=provenance(result.design),
    )
    write_page(page, path)


def tuning_facts(result: TuningResult) -> tuple[Fact, ...]:
    """Return the filter's own facts, and the error on the training recordings."""
    design = result.design
    what = "inclination" if design.axes == "both" else design.axes
    return (
        *(
            Fact(label=fact.label, value=f"{fact.value:.5g} {fact.unit}".rstrip(), note=fact.note)
            for fact in FILTERS[design.filter].facts(design)
        ),
        Fact(
            label=f"RMSE of {what}",
            value=f"{math.degrees(result.rms_rad):.3f} deg",
            note=f"mean over {len(result.evaluations)} training recording(s)",
        ),
        *_held_out_fact(result, what),
    )


def _held_out_fact(result: TuningResult, what: str) -> tuple[Fact, ...]:
    held_out = result.held_out
    if held_out is None:
        return ()
    return (
        Fact(
            label=f"RMSE of {what}, held out",
            value=f"{math.degrees(held_out.rms_rad):.3f} deg",
            note=f"{held_out.unit} left out in turn, {held_out.folds} folds",
        ),
    )


def remark_tables(result: TuningResult) -> tuple[Table, ...]:
    """Return what the recordings do not determine, if there is anything."""
    if not result.remarks:
        return ()
    return (
        Table(
            title="What the recordings do not determine",
            header=("remark",),
            rows=tuple((remark,) for remark in result.remarks),
            is_text=True,
        ),
    )


def parameter_table(result: TuningResult) -> Table:
    """Return the tuned parameters with their intervals."""
    rows = []
    for interval in result.intervals:
        value, unit = interval.dimension.shown(interval.value)
        ends = [
            "" if end is None else f"{interval.dimension.shown(end)[0]:.4g}"
            for end in (interval.low, interval.high)
        ]
        rows.append((interval.dimension.label, f"{value:.5g}", *ends, unit))
    return Table(
        title="Parameters",
        header=("parameter", "value", "2.5 %", "97.5 %", "unit"),
        rows=tuple(rows),
        note="The interval holds the middle 95 % of tunings on recordings drawn with replacement.",
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
                f"Best cost so far above the final one ({design.tuning.optimiser}, "
                f"{result.swarm.evaluations} evaluations, seed {design.tuning.seed}); the line "
                "ends where the search improves no more."
            ),
            svg=figures.convergence(result.swarm.history),
        ),
        Plot(
            title="Cost along each parameter",
            caption=(
                "The others held at their tuned values; the line is the tuned value, the band its "
                "interval. A flat curve is a parameter that the recordings do not determine."
            ),
            svg=figures.cost_profiles(result.profiles, result.intervals),
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
            svg=figures.frequency_response(design),
        ),
    )


def score_table(result: TuningResult) -> Table:
    """Return the error of every training recording, and that while it was left out."""
    shown = [q for q in QUANTITIES if any(e.score(q) for e in result.evaluations)]
    held_out = result.held_out
    with_held_out = held_out is not None and held_out.unit == "recordings"
    rows = []
    for i, e in enumerate(result.evaluations):
        scores = [s for q in shown if (s := e.score(q)) is not None]
        errors = [
            text
            for s in scores
            for text in (f"{math.degrees(s.rms_rad):.4f}", f"{math.degrees(s.max_rad):.3f}")
        ]
        if held_out is not None and with_held_out:
            errors.append(f"{math.degrees(held_out.each_rad[i]):.4f}")
        difference = f"{math.degrees(e.integer_vs_float_max_rad):.6f}"
        rows.append((e.recording, str(e.samples), *errors, difference))
    columns = [f"{q} {kind}, deg" for q in shown for kind in ("rms", "max")]
    columns += ["rms left out, deg"] if with_held_out else []
    return Table(
        title="Training recordings",
        header=("recording", "samples", *columns, "integer - float, deg"),
        rows=tuple(rows),
        note=(
            "Errors of the integer model, that is, of what a device says, on training data; left "
            "out: of a filter tuned without the recording."
        ),
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
