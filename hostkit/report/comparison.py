"""The report of a comparison: a chart of the errors, and the tables."""

import math
from pathlib import Path

import numpy as np

from hostkit.comparison import Comparison, Cost, Row
from hostkit.design_file import digest
from hostkit.report.canvas import BLUE, GREY, INK, ORANGE, new_figure, svg_text
from hostkit.report.page import Fact, Page, Plot, Table, write_page

ROW_INCHES = 0.3
CUT_SHARE = 4.0
"""Bars longer than so many times the median are cut, so that the others can be told apart."""


def write_comparison_report(comparison: Comparison, costs: tuple[Cost, ...], path: Path) -> None:
    """Write a comparison as one HTML file.

    Raises
    ------
    ToolMissingError
        If matplotlib is not installed.
    HostkitError
        If the file cannot be written.
    """
    count = len(comparison.recordings)
    page = Page(
        title="Comparison of filters",
        subtitle=f"RMSE of {comparison.quantity} over {count} recording(s)",
        facts=_facts(comparison),
        sections=(
            Plot(
                title="Errors",
                caption=(
                    "Mean over recordings; tuned settings on what was left out. The mark is the "
                    "worst recording."
                ),
                svg=bars(comparison.rows),
            ),
            _errors(comparison),
            *([_costs(costs)] if costs else []),
            _parameters(comparison),
            *_missing(comparison),
        ),
        provenance=_provenance(comparison),
    )
    write_page(page, path)


def bars(rows: tuple[Row, ...]) -> str:
    """Draw the errors of filters, one bar each, hostkit's in another colour."""
    figure, axes, mpl = new_figure(height=0.9 + ROW_INCHES * len(rows))
    means = np.degrees([row.honest_mean_rad for row in rows])
    worst = np.degrees([row.honest_worst_rad for row in rows])
    limit = CUT_SHARE * float(np.nanmedian(means))
    place = np.arange(len(rows))[::-1]
    colours = [BLUE if row.origin == "hostkit" else GREY for row in rows]
    axes.barh(place, np.minimum(means, limit), color=colours, height=0.7)
    axes.plot(np.where(worst <= limit, worst, np.nan), place, "|", color=ORANGE, markersize=11)
    for y, mean in zip(place, means, strict=True):
        axes.annotate(f" {mean:.3g}", (min(mean, limit), y), va="center", color=INK)
    axes.set_yticks(place, [f"{row.title}, {row.settings}" for row in rows])
    axes.set(xlabel="RMSE, deg", xlim=(0.0, 1.08 * limit))
    return svg_text(figure, mpl)


def _facts(comparison: Comparison) -> tuple[Fact, ...]:
    facts = []
    for origin, label in (("hostkit", "best of hostkit"), ("peer", "best peer")):
        online = [row for row in comparison.rows if row.origin == origin and not row.is_offline]
        if online:
            best = min(online, key=lambda row: row.honest_mean_rad)
            facts.append(
                Fact(
                    label=label,
                    value=f"{math.degrees(best.honest_mean_rad):.3f} deg",
                    note=f"{best.title}, {best.settings}",
                )
            )
    return tuple(facts)


def _errors(comparison: Comparison) -> Table:
    rows = []
    for row in comparison.rows:
        left: tuple[str, ...] = ("", "")
        if row.held_out is not None:
            left = (_text(row.held_out.rms_rad), _text(row.honest_worst_rad))
        rows.append(
            (
                f"{row.title}, {row.settings}{' with scale' if row.is_scaled else ''}",
                _text(row.mean_rad),
                _text(row.worst_rad),
                *left,
                str(row.evaluations or ""),
                f"{row.lead_s * 1e3:g}",
            )
        )
    return Table(
        title="Errors",
        header=("filter", "mean, deg", "worst", "left out", "worst", "tried", "lead, ms"),
        rows=tuple(rows),
        note="Left out: scored by settings that were tuned without the recording. "
        "With scale: the scale of the gyroscope was tuned too.",
    )


def _costs(costs: tuple[Cost, ...]) -> Table:
    return Table(
        title="Cost of a sample on this machine",
        header=("filter", "what was timed", "ns"),
        rows=tuple(
            (
                cost.title,
                cost.timed,
                cost.reason if cost.ns_per_sample is None else f"{cost.ns_per_sample:.3g}",
            )
            for cost in costs
        ),
        note="One process, in turns, shortest time; read ratios.",
        is_text=True,
    )


def _parameters(comparison: Comparison) -> Table:
    return Table(
        title="Settings",
        header=("filter", "settings"),
        rows=tuple(
            (
                f"{row.title}, {row.settings}",
                ", ".join(f"{p.name} {p.value:.4g}" for p in row.parameters),
            )
            for row in comparison.rows
        ),
        is_text=True,
    )


def _missing(comparison: Comparison) -> tuple[Table, ...]:
    if not comparison.missing:
        return ()
    rows = tuple((one.name, one.reason) for one in comparison.missing)
    return (Table(title="Missing peers", header=("peer", "reason"), rows=rows, is_text=True),)


def _provenance(comparison: Comparison) -> tuple[tuple[str, str], ...]:
    design = comparison.design
    return (
        ("design", "none" if design is None else digest(design)),
        ("recordings", ", ".join(comparison.recordings)),
        ("samples", str(comparison.samples)),
        ("lead", f"{comparison.lead_s * 1e3:g} ms"),
        ("peers calibrated", "yes" if comparison.calibrated_peers else "no"),
    )


def _text(value_rad: float) -> str:
    return f"{math.degrees(value_rad):.3f}"
