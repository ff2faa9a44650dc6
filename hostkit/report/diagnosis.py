"""The report of a diagnosis."""

from pathlib import Path

from hostkit.diagnosis import Diagnosis, findings
from hostkit.recordings import Recording
from hostkit.report import diagnosis_figures as figures
from hostkit.report.page import Fact, Page, Plot, Table, write_page
from hostkit.units import DEG_PER_RAD


def write_diagnosis_report(
    recordings: tuple[Recording, ...], diagnoses: tuple[Diagnosis, ...], path: Path
) -> None:
    """Write the report of diagnoses, one for each recording, as one HTML file.

    Raises
    ------
    ToolMissingError
        If matplotlib is not installed.
    HostkitError
        If the file cannot be written.
    """
    pairs = tuple(zip(recordings, diagnoses, strict=True))
    page = Page(
        title="Diagnosis",
        subtitle=", ".join(diagnosis.name for diagnosis in diagnoses),
        facts=_facts(diagnoses),
        sections=tuple(section for r, d in pairs for section in _sections(r, d)),
        provenance=tuple(
            (
                f"recording {r.name}",
                f"{len(r)} samples, axes {d.axes}, mounting {d.mounting}, "
                f"sha256 {r.sha256 or 'not from a file'}",
            )
            for r, d in pairs
        ),
    )
    write_page(page, path)


def _facts(diagnoses: tuple[Diagnosis, ...]) -> tuple[Fact, ...]:
    """Return the worst over the recordings of what decides about a filter."""
    hard = [d for d in diagnoses if d.planarity.verdict == "needs a three-dimensional filter"]
    extra = max(d.planarity.errors.extra_rad for d in diagnoses) * DEG_PER_RAD
    looks = sum(f.level == "look" for d in diagnoses for f in findings(d))
    return (
        Fact(label="recordings", value=str(len(diagnoses))),
        Fact(
            label="need three dimensions",
            value=str(len(hard)),
            note="a per-axis filter falls short",
        ),
        Fact(label="most from neglected rates", value=f"{extra:.2f} deg", note="rms, after tuning"),
        Fact(label="findings to act on", value=str(looks)),
    )


def _sections(recording: Recording, diagnosis: Diagnosis) -> tuple[Table | Plot, ...]:
    return (_findings(diagnosis), *_plots(recording, diagnosis))


def _findings(diagnosis: Diagnosis) -> Table:
    return Table(
        title=f"{diagnosis.name}: findings",
        header=("about", "found", "what to do"),
        rows=tuple((f.topic, f.sentence, f.action or "-") for f in findings(diagnosis)),
        note=(
            f"{diagnosis.samples} samples at {diagnosis.rate_hz:g} Hz, {diagnosis.duration_s:.4g} s"
        ),
        is_text=True,
    )


def _plots(recording: Recording, diagnosis: Diagnosis) -> tuple[Plot, ...]:
    name, force = diagnosis.name, diagnosis.force
    plots = [
        Plot(
            title=f"{name}: time steps",
            caption="Steps up to 2.5 times the median; longer ones are gaps.",
            svg=figures.step_histogram(diagnosis.timing),
        ),
        Plot(
            title=f"{name}: rest",
            caption="Magnitudes of angular rate and specific force.",
            svg=figures.rest_over_time(recording, diagnosis.rest),
        ),
        Plot(
            title=f"{name}: distance to 1 g",
            caption="What a gate acts on; what lies outside is in the outermost bars.",
            svg=figures.force_deviation(force),
        ),
    ]
    if force.spectrum is not None:
        caption = "Specific force in sensor axes; vibration is counted right of the dashed line."
        svg = figures.force_spectrum(force.spectrum)
        plots.insert(2, Plot(title=f"{name}: spectrum", caption=caption, svg=svg))
    if diagnosis.noise is not None:
        plots.append(
            Plot(
                title=f"{name}: Allan deviation",
                caption=f"Overlapping, from {diagnosis.noise.duration_s:.4g} s of rest.",
                svg=figures.allan_deviation(diagnosis.noise),
            )
        )
    return tuple(plots)
