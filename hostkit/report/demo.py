"""The report of the demo: the tuning, and every device held against its models."""

import math
from dataclasses import dataclass
from pathlib import Path

from hostkit.design_file import digest
from hostkit.emulation.board import BuildResult
from hostkit.emulation.run import EmulationResult
from hostkit.filters import FILTERS
from hostkit.monitor import SessionResult
from hostkit.report import figures
from hostkit.report.page import Fact, Page, Plot, Table, write_page
from hostkit.report.tuning import provenance, score_table, tuning_facts, tuning_plots
from hostkit.tuning import Evaluation, TuningResult


@dataclass(frozen=True, slots=True, kw_only=True)
class Step:
    """One step of the demo: whether it went well, and what came out."""

    name: str
    ok: bool
    detail: str


@dataclass(frozen=True, slots=True, kw_only=True)
class DemoResult:
    """Everything the demo found out.

    Attributes
    ----------
    held_out
        The design on a recording that it was not tuned on.
    emulations
        What each target answered, with its build where it is an image.
    session
        The live session on an emulated board, or None where it could not be run.
    """

    verdict: str
    steps: tuple[Step, ...]
    tuning: TuningResult
    held_out: Evaluation
    emulations: tuple[tuple[EmulationResult, BuildResult | None], ...]
    session: SessionResult | None


def write_demo_report(result: DemoResult, path: Path) -> None:
    """Write the report of the demo as one HTML file.

    Raises
    ------
    ToolMissingError
        If matplotlib is not installed.
    HostkitError
        If the file cannot be written.
    """
    design = result.tuning.design
    page = Page(
        title="hostkit demo",
        subtitle=(
            "A simulated MPU-6050 recording tuned with QPSO, rendered to C and VHDL, run on an "
            f"emulated microcontroller and a simulated FPGA. Design {digest(design)}."
        ),
        verdict=result.verdict,
        facts=(*tuning_facts(result.tuning), *_device_facts(result)),
        sections=(
            _device_table(result),
            *_device_plot(result),
            *tuning_plots(result.tuning),
            score_table(result.tuning),
            _steps_table(result.steps),
        ),
        provenance=provenance(design),
    )
    write_page(page, path)


def _device_facts(result: DemoResult) -> tuple[Fact, ...]:
    scores = result.held_out.scores
    facts = [
        Fact(
            label=f"held-out RMSE of {scores[-1].quantity}",
            value=f"{math.degrees(scores[-1].rms_rad):.3f} deg",
            note="on a recording the tuning did not see",
        ),
        Fact(
            label="mismatches",
            value=str(sum(e.mismatches for e, _ in result.emulations)),
            note=f"in {sum(e.samples for e, _ in result.emulations)} emulated samples",
        ),
    ]
    if result.session is not None:
        facts.append(
            Fact(
                label="live session",
                value=f"{result.session.report.samples} samples",
                note=f"{result.session.report.lost} lost, verdict {result.session.report.verdict}",
            )
        )
    return tuple(facts)


def _device_table(result: DemoResult) -> Table:
    rows = []
    for emulation, build in result.emulations:
        error = emulation.max_abs_error_rad
        rows.append(
            (
                emulation.target,
                str(emulation.samples),
                str(emulation.mismatches),
                "-" if error is None else f"{math.degrees(error):.6f}",
                _number(emulation.cycles_mean),
                _number(emulation.cycles_max),
                _number(build.flash_bytes if build else None),
                _number(build.ram_bytes if build else None),
            )
        )
    return Table(
        title="Device against model",
        header=(
            "target",
            "samples",
            "mismatches",
            "max error, deg",
            "cost, mean",
            "max",
            "flash, bytes",
            "RAM, bytes",
        ),
        rows=tuple(rows),
        note=(
            "Mismatches are against the integer model, bit for bit; the error is against the float "
            "model on the same counts. The cost is that of one filter update: clock "
            "cycles, or instructions on the stm32f103."
        ),
    )


def _number(value: float | None) -> str:
    return "-" if value is None else f"{value:.0f}"


def _device_plot(result: DemoResult) -> tuple[Plot, ...]:
    if not result.emulations:
        return ()
    design = result.tuning.design
    residuals = [(e.target, e.residual_rad[:, 0]) for e, _ in result.emulations]
    bound = FILTERS[design.filter].lower(design).error_bound_rad
    time_s = result.held_out.time_s - result.held_out.time_s[0]
    return (
        Plot(
            title="Residual of each device",
            caption="Device minus float model, first axis, on the held-out recording.",
            svg=figures.device_residuals(time_s, residuals, bound),
        ),
    )


def _steps_table(steps: tuple[Step, ...]) -> Table:
    return Table(
        title="Steps",
        header=("step", "outcome", "detail"),
        rows=tuple((s.name, "ok" if s.ok else "failed", s.detail) for s in steps),
        is_text=True,
    )
