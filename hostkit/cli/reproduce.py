"""The subcommand ``reproduce``: the tilt paper's table and figures beside ours."""

import json
import math
from pathlib import Path

import click
import numpy as np
from numpy.typing import NDArray

from hostkit.cli.inputs import JSON, say
from hostkit.cli.output import emit_json
from hostkit.errors import HostkitError, VerdictError
from hostkit.files import write_aside
from hostkit.reproduction import AcceptanceRow, FigureResult, Reproduction, TableRow
from hostkit.reproduction import reproduce as run_reproduction

DIGITS = 6
"""Significant digits of a figure's points in the JSON document."""


@click.command("reproduce")
@click.option(
    "--out",
    "out",
    type=click.Path(file_okay=False, path_type=Path),
    metavar="DIR",
    help="Write DIR/reproduction.html and DIR/reproduction.json.",
)
@click.option("--seed", type=click.IntRange(0, 2**63 - 1), default=1, show_default=True)
@JSON
def reproduce(out: Path | None, seed: int, as_json: bool) -> None:
    """Run the tilt paper's experiments again, on simulated data, and show both side by side.

    Ends with exit code 3 if a figure is outside the band that is asked of it.

    \b
    Example:
      hostkit reproduce --out reproduction
    """
    say("simulating and tuning, some ten seconds")
    result = run_reproduction(seed)
    document = reproduction_document(result)
    if as_json:
        emit_json(document)
    else:
        _show(result)
    if out is not None:
        _write(result, document, out)
    if result.failures:
        raise VerdictError(
            f"{len(result.failures)} of {len(result.acceptance)} figures are outside their band: "
            + "; ".join(f"{row.figure} = {row.text}, not {row.band}" for row in result.failures)
        )


def reproduction_document(result: Reproduction) -> dict[str, object]:
    """Return a reproduction as the document ``hostkit.reproduce/1``."""
    return {
        "schema": "hostkit.reproduce/1",
        "seed": result.seed,
        "logs": result.logs,
        "repeats": result.repeats,
        "holds": not result.failures,
        "remarks": list(result.remarks),
        "table1": [_table_row(row) for row in result.table1],
        "acceptance": [_acceptance_row(row) for row in result.acceptance],
        "figures": [_figure(figure) for figure in result.figures],
        "findings": [
            {"claim": f.claim, "verdict": f.verdict, "text": f.text} for f in result.findings
        ],
    }


def _table_row(row: TableRow) -> dict[str, object]:
    columns = ("best", "worst", "mean", "eta")
    ours = (row.best_rad, row.worst_rad, row.mean_rad, row.eta_pooled)
    return {
        "algorithm": row.algorithm,
        "paper": None if row.paper is None else dict(zip(columns, row.paper, strict=True)),
        "ours": {**dict(zip(columns, ours, strict=True)), "eta_of_single_groups": row.eta_median},
    }


def _acceptance_row(row: AcceptanceRow) -> dict[str, object]:
    return {
        "figure": row.figure,
        "paper": row.paper,
        "ours": _finite(row.ours),
        "unit": row.unit,
        "low": _finite(row.low),
        "high": _finite(row.high),
        "holds": row.holds,
        "shown": row.is_only_shown,
    }


def _figure(figure: FigureResult) -> dict[str, object]:
    return {
        "figure": figure.name,
        "title": figure.title,
        "claim": figure.claim,
        "found": figure.found,
        "x": figure.x_label,
        "y": figure.y_label,
        "series": [
            {"label": s.label, "x": _rounded(s.x), "y": _rounded(s.y)} for s in figure.series
        ],
    }


def _finite(value: float | None) -> float | None:
    """Return None for what JSON cannot say: an open end of a band, or an event that never was."""
    return None if value is None or not math.isfinite(value) else value


def _rounded(values: NDArray[np.float64]) -> list[float]:
    return [float(f"{value:.{DIGITS}g}") for value in values]


def _write(result: Reproduction, document: dict[str, object], out: Path) -> None:
    from hostkit.report.reproduction import write_reproduction_report

    try:
        out.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise HostkitError(f"{out} cannot be made a folder: {error.strerror}") from error
    write_reproduction_report(result, out / "reproduction.html")
    text = json.dumps(document, indent=2, allow_nan=False) + "\n"
    write_aside(out / "reproduction.json", text)
    say(f"{out / 'reproduction.html'}, {out / 'reproduction.json'}")


def _show(result: Reproduction) -> None:
    click.echo("Table 1, RMSE in rad          best    worst     mean      eta")
    for row in result.table1:
        if row.paper is not None:
            printed = "".join(f"{value:>9g}" for value in row.paper)
            click.echo(f"{row.algorithm + ', paper':<25}{printed}")
        ours = "".join(f"{x:9.4f}" for x in (row.best_rad, row.worst_rad, row.mean_rad))
        click.echo(f"{row.algorithm + ', here':<25}{ours}{row.eta_pooled:9.3f}")
    width = max(len(row.figure) for row in result.acceptance) + 2
    click.echo(f"\n{'figure':<{width}}{'paper':<22}{'here':<14}{'asked':<20}holds")
    words = {True: "yes", False: "NO", None: "-"}
    for row_ in result.acceptance:
        start = f"{row_.figure:<{width}}{row_.paper:<22}"
        click.echo(f"{start}{row_.text:<14}{row_.band:<20}{words[row_.holds]}")
    for finding in result.findings:
        click.echo(f"\n{finding.claim}\n  {finding.verdict}: {finding.text}")
    click.echo("")
    for remark in result.remarks:
        click.echo(f"- {remark}")
