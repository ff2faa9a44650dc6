"""The acceptance figures: the paper's value, ours, and the band in which ours must lie."""

import math

import numpy as np
from numpy.typing import NDArray

from hostkit.filters.complementary import eta_from_tau
from hostkit.optimisers.qpso import CONTRACTION
from hostkit.optimisers.swarm import falling
from hostkit.reproduction.results import AcceptanceRow, TableRow, Unit
from hostkit.reproduction.study import (
    PAPER_PERIOD_S,
    PSO_TAU_S,
    QPSO_TAU_S,
    ClassStudy,
    PaperRun,
    Study,
)
from hostkit.reproduction.trials import HIT_RAD, ITERATIONS, Trial

Vector = NDArray[np.float64]

QPSO_TABLE = (0.001, 0.02, 0.01, 0.412)
PSO_TABLE = (0.005, 0.04, 0.02, 0.444)
"""Table 1 of the paper: best, worst, mean and eta; it prints no unit."""

NOT_GIVEN = "not given"

RARELY = 0.95
"""Quantile that stands for the slowest runs."""


def table_one(study: ClassStudy) -> tuple[TableRow, ...]:
    """Return Table 1 beside ours: QPSO, and both forms of PSO that the paper may have meant."""
    return (
        _table_row("QPSO", QPSO_TABLE, study.qpso),
        _table_row("PSO, falling weight", PSO_TABLE, study.ldwpso),
        _table_row("PSO, constriction", PSO_TABLE, study.pso),
    )


def acceptance(study: Study) -> tuple[AcceptanceRow, ...]:
    """Return every acceptance figure."""
    return (
        *_arithmetic(),
        *_table_rows(study),
        *_miss_rows(study),
        *_iteration_rows(study.slow),
        *_other_rows(study),
    )


def iterations_median(trial: Trial) -> float:
    """Return the median iteration of a hit; a miss counts as never."""
    return _quantile(trial.iterations_to_hit(), 0.5)


def iterations_rarely(trial: Trial) -> float:
    """Return the 95 % quantile of the iteration of a hit; a miss counts as never."""
    return _quantile(trial.iterations_to_hit(), RARELY)


def hit_share(excess_rad: Vector) -> float:
    """Return the share of searches that came to the optimum."""
    return float(np.mean(excess_rad <= HIT_RAD))


def _quantile(iterations: Vector, share: float) -> float:
    """Return a quantile without interpolation, which infinities do not survive."""
    return float(np.quantile(iterations, share, method="higher"))


def _table_row(algorithm: str, paper: tuple[float, float, float, float], run: PaperRun) -> TableRow:
    best, worst, mean = run.trial.row_rad()
    return TableRow(
        algorithm=algorithm,
        paper=paper,
        best_rad=best,
        worst_rad=worst,
        mean_rad=mean,
        eta_pooled=float(np.median(run.pooled_eta)),
        eta_median=run.trial.eta_median,
    )


def _row(
    figure: str,
    paper: str,
    ours: float,
    band: tuple[float, float] | None = None,
    unit: Unit = "",
) -> AcceptanceRow:
    low, high = band or (None, None)
    return AcceptanceRow(figure=figure, paper=paper, ours=ours, unit=unit, low=low, high=high)


def _arithmetic() -> tuple[AcceptanceRow, ...]:
    """Return what needs no data: eta of the paper's time constants, and its schedule."""
    weights = ((QPSO_TAU_S, "0.412", 0.4118), (PSO_TAU_S, "0.444", 0.4444))
    ends = ((0, "start", 0.9), (ITERATIONS, "end", 0.5))
    return (
        *(
            _row(
                f"eta of tau {tau_s:g} s at {PAPER_PERIOD_S:g} s",
                paper,
                eta_from_tau(tau_s, PAPER_PERIOD_S),
                (exact - 1e-4, exact + 1e-4),
            )
            for tau_s, paper, exact in weights
        ),
        *(
            _row(
                f"alpha at the {when}, equation 7 mended",
                NOT_GIVEN,
                falling(*CONTRACTION, iteration, ITERATIONS),
                (exact, exact),
            )
            for iteration, when, exact in ends
        ),
    )


def _table_rows(study: Study) -> tuple[AcceptanceRow, ...]:
    qpso, ldwpso = study.slow.qpso, study.slow.ldwpso
    bands = ((-math.inf, 0.003), (0.015, 0.03), (0.006, 0.012))
    columns = ("best", "worst", "mean")
    ours = zip(columns, QPSO_TABLE, qpso.trial.row_rad(), bands, strict=False)
    theirs = zip(columns, PSO_TABLE, ldwpso.trial.row_rad(), strict=False)
    return (
        *(_row(f"QPSO, {c} RMSE", f"{paper:g}", x, band, "rad") for c, paper, x, band in ours),
        _row(
            "QPSO, eta of all groups together",
            "0.412",
            float(np.median(qpso.pooled_eta)),
            (0.32, 0.56),
        ),
        *(
            _row(f"PSO, falling weight, {c} RMSE", f"{paper:g}", x, None, "rad")
            for c, paper, x in theirs
        ),
        _ratio_row("1 s", study.slow, (1.02, 1.10)),
        _ratio_row("0.05 s", study.fast, (1.15, 1.35)),
    )


def _ratio_row(where: str, part: ClassStudy, band: tuple[float, float]) -> AcceptanceRow:
    ratio = float(np.mean(part.ldwpso.trial.ratio_to(part.qpso.trial)))
    return _row(f"mean RMSE, PSO with falling weight over QPSO, {where}", "2", ratio, band)


def _miss_rows(study: Study) -> tuple[AcceptanceRow, ...]:
    slow = study.slow
    classes = (("1 s", slow), ("0.05 s", study.fast))
    return (
        *_pso_miss_rows("falling weight", slow.ldwpso.trial),
        *_pso_miss_rows("constriction", slow.pso.trial),
        _row("QPSO: misses", "none claimed", slow.qpso.trial.miss_share, (0.0, 0.02), "share"),
        *(
            _row(
                f"log tau, most misses of {len(part.log_tau)} rules, {where}",
                NOT_GIVEN,
                max(trial.miss_share for trial in part.log_tau),
                (0.0, 0.01),
                "share",
            )
            for where, part in classes
        ),
    )


def _pso_miss_rows(name: str, trial: Trial) -> tuple[AcceptanceRow, ...]:
    return (
        _row(f"PSO, {name}: misses", "trapped", trial.miss_share, (0.25, 0.50), "share"),
        _row(
            f"PSO, {name}: misses that sit at tau 0.02 s",
            NOT_GIVEN,
            trial.stuck_share,
            (0.95, 1.0),
            "share",
        ),
    )


def _iteration_rows(slow: ClassStudy) -> tuple[AcceptanceRow, ...]:
    what, flat = "iterations to 1e-6 rad", "flat at 15 and at 41"
    qpso = slow.qpso.trial
    return (
        _row(f"QPSO, {what}, median", "11, one run", iterations_median(qpso), (5.0, 11.0)),
        _row(f"QPSO, {what}, 95 %", NOT_GIVEN, iterations_rarely(qpso), (-math.inf, 19.0)),
        _row(f"PSO, constriction, {what}, median", flat, iterations_median(slow.pso.trial)),
        _row(f"PSO, falling weight, {what}, median", flat, iterations_median(slow.ldwpso.trial)),
    )


def _other_rows(study: Study) -> tuple[AcceptanceRow, ...]:
    crossings = (
        ("2 cycles", study.by_cycles.crossing_rad_s, (1.0, 2.0)),
        ("30 s", study.by_time.crossing_rad_s, (2.0, 5.0)),
    )
    grids = (("1 s", study.slow, 0.99), ("0.05 s", study.fast, 0.97))
    ratio = float(np.mean(study.weight_ratio))
    return (
        *(
            _row(f"figure 4, crossing, {span}", "a crossing", crossing, band, "rad/s")
            for span, crossing, band in crossings
        ),
        _row("RMSE of whole logs, eta 0.412 over 0.444", "below 1", ratio, (1.00, 1.05)),
        *(
            _row(
                f"grid and Brent within 1e-6 rad, {where}",
                NOT_GIVEN,
                hit_share(part.grid_excess_rad),
                (least, 1.0),
                "share",
            )
            for where, part, least in grids
        ),
    )
