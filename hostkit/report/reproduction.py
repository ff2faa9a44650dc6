"""The report of the reproduction: the paper's figures and claims beside ours."""

from pathlib import Path

from hostkit.report.page import Fact, Page, Plot, Table, write_page
from hostkit.report.reproduction_figures import draw
from hostkit.reproduction import AcceptanceRow, Reproduction, TableRow


def write_reproduction_report(result: Reproduction, path: Path) -> None:
    """Write the reproduction as one HTML file.

    Raises
    ------
    ToolMissingError
        If matplotlib is not installed.
    HostkitError
        If the file cannot be written.
    """
    page = Page(
        title="The tilt paper, reproduced",
        subtitle=(
            "Shi, He, Luo, He (2017): a complementary filter tuned with QPSO. "
            + " ".join(result.remarks)
        ),
        verdict="fail" if result.failures else "pass",
        facts=_facts(result),
        sections=(
            _table_one(result.table1),
            _acceptance(result.acceptance),
            *_plots(result),
            _findings(result),
        ),
        provenance=(
            ("seed", str(result.seed)),
            ("simulated logs", f"{result.logs} of each class, ten groups of 30 samples each"),
            (
                "runs",
                f"{result.repeats} of each optimiser in paper mode on every group, one in others",
            ),
        ),
    )
    write_page(page, path)


def _facts(result: Reproduction) -> tuple[Fact, ...]:
    judged = [row for row in result.acceptance if not row.is_only_shown]
    refuted = [f for f in result.findings if f.verdict == "does not hold"]
    return (
        Fact(
            label="figures within their band",
            value=f"{len(judged) - len(result.failures)} of {len(judged)}",
            note=f"{len(result.acceptance) - len(judged)} more are only shown",
        ),
        Fact(
            label="claims that do not hold",
            value=f"{len(refuted)} of {len(result.findings)}",
            note="see the findings at the end",
        ),
    )


def _table_one(rows: tuple[TableRow, ...]) -> Table:
    lines = []
    for row in rows:
        if row.paper is not None:
            lines.append((f"{row.algorithm}: paper", *(f"{x:g}" for x in row.paper), "-"))
        ours = (row.best_rad, row.worst_rad, row.mean_rad)
        etas = (f"{row.eta_pooled:.3f}", f"{row.eta_median:.3f}")
        lines.append((f"{row.algorithm}: here", *(f"{x:.4f}" for x in ours), *etas))
    return Table(
        title="Table 1",
        header=("optimiser", "best, rad", "worst, rad", "mean, rad", "eta", "eta of single groups"),
        rows=tuple(lines),
        note=(
            "RMSE of the test samples over ten groups, median over logs and runs; eta is the "
            "optimum of all ten groups together. The paper has one PSO and does not say which."
        ),
    )


def _acceptance(rows: tuple[AcceptanceRow, ...]) -> Table:
    words = {True: "holds", False: "does not hold", None: "only shown"}
    return Table(
        title="Acceptance",
        header=("figure", "paper", "here", "band", ""),
        rows=tuple((r.figure, r.paper, r.text, r.band, words[r.holds]) for r in rows),
        is_text=True,
    )


def _plots(result: Reproduction) -> tuple[Plot, ...]:
    return tuple(
        Plot(
            title=f"Figure {figure.name}: {figure.title}",
            caption=f"The paper: {figure.claim} Here: {figure.found}",
            svg=draw(figure),
        )
        for figure in result.figures
    )


def _findings(result: Reproduction) -> Table:
    return Table(
        title="Findings",
        header=("the paper", "verdict", "here"),
        rows=tuple((f.claim, f.verdict, f.text) for f in result.findings),
        is_text=True,
    )
