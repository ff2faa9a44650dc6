"""The experiments: every optimiser on simulated logs of both classes, and what goes with them."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hostkit.optimisers import adaptive_pso, pso, qpso, rdpso
from hostkit.records import read_only
from hostkit.reproduction.errors import errors_rad, eta_of, first_samples
from hostkit.reproduction.frequency import SensorErrorSweep, sweep_cycles, sweep_time
from hostkit.reproduction.optimum import Optima, find_optima, pooled_cost
from hostkit.reproduction.signals import FAST, GROUPS, LOG_SAMPLES, SLOW, DataClass, simulate_logs
from hostkit.reproduction.trials import (
    Material,
    Setting,
    Trial,
    grid_brent_excess_rad,
    prepare,
    run_trial,
    search,
)

Vector = NDArray[np.float64]

RULES = (
    (qpso.NAME, qpso.rule()),
    (pso.LDW_NAME, pso.ldw_rule()),
    (pso.NAME, pso.rule()),
    (rdpso.NAME, rdpso.rule()),
    (rdpso.ARTICLE_NAME, rdpso.article_rule()),
    (adaptive_pso.NAME, adaptive_pso.rule()),
    (adaptive_pso.AWP_NAME, adaptive_pso.awp_rule()),
)
PAPER_RULES = RULES[:3]
"""QPSO, and the two common forms of PSO; the paper does not say which one it used."""

QPSO_TAU_S, PSO_TAU_S, PAPER_PERIOD_S = 0.7, 0.8, 1.0
"""Time constants behind the paper's eta 0.412 (printed) and 0.444 (inferred), at 1 s."""

CYCLES, SWEEP_S = 2.0, 30.0
"""How long figure 4 observes a frequency: so many cycles, or so many seconds."""


@dataclass(frozen=True, slots=True, kw_only=True)
class PaperRun:
    """One optimiser in paper mode: tau searched linearly, particles put onto the bounds.

    Attributes
    ----------
    trial
        On single groups.
    pooled_eta
        On all ten groups of a log together, shape ``(L,)``.
    """

    trial: Trial
    pooled_eta: Vector

    def __post_init__(self) -> None:
        """Make the array read-only."""
        read_only(self.pooled_eta)


@dataclass(frozen=True, slots=True, kw_only=True)
class ClassStudy:
    """All trials on one class of data.

    Attributes
    ----------
    material, pooled
        Groups with their optima, and the optima of whole logs.
    qpso, ldwpso, pso
        In paper mode.
    log_tau
        Every rule of hostkit with log tau, particles put onto the bounds.
    bounced
        Both forms of PSO with tau, particles mirrored at the bounds.
    grid_excess_rad, grid_evaluations
        Grid and Brent's search, shape ``(G,)``.
    """

    material: Material
    pooled: Optima
    qpso: PaperRun
    ldwpso: PaperRun
    pso: PaperRun
    log_tau: tuple[Trial, ...]
    bounced: tuple[Trial, ...]
    grid_excess_rad: Vector
    grid_evaluations: Vector

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        read_only(self.grid_excess_rad)
        read_only(self.grid_evaluations)


@dataclass(frozen=True, slots=True, kw_only=True)
class Study:
    """Everything that is measured.

    Attributes
    ----------
    slow, fast
        Both classes of data.
    weight_ratio
        RMSE of a whole log with the paper's QPSO weight over that with its PSO weight, on logs of
        the slow class that nothing was tuned on, shape ``(W,)``.
    by_cycles, by_time
        Figure 4 in its two forms.
    """

    slow: ClassStudy
    fast: ClassStudy
    weight_ratio: Vector
    by_cycles: SensorErrorSweep
    by_time: SensorErrorSweep

    def __post_init__(self) -> None:
        """Make the array read-only."""
        read_only(self.weight_ratio)


def run_study(
    *, logs: int, repeats: int, weight_logs: int, streams: list[np.random.Generator]
) -> Study:
    """Run all experiments.

    Parameters
    ----------
    logs, repeats
        Logs of each class, and runs of each optimiser in paper mode on every group; in other modes
        each runs once.
    weight_logs
        Logs on which the paper's two weights are compared.
    streams
        Four independent generators: slow class, fast class, weights, figure 4.
    """
    return Study(
        slow=study_class(SLOW, logs, repeats, streams[0]),
        fast=study_class(FAST, logs, repeats, streams[1]),
        weight_ratio=compare_weights(weight_logs, streams[2]),
        by_cycles=sweep_cycles(CYCLES, streams[3]),
        by_time=sweep_time(SWEEP_S, streams[3]),
    )


def study_class(kind: DataClass, logs: int, repeats: int, rng: np.random.Generator) -> ClassStudy:
    """Run every optimiser on one class of data, `repeats` times in paper mode."""
    material = prepare(kind, logs, rng)
    paper = [
        _paper_run(material, Setting(name=n, rule=r, log_tau=False, bounce=False), repeats, rng)
        for n, r in PAPER_RULES
    ]
    with_log = [Setting(name=n, rule=r, log_tau=True, bounce=False) for n, r in RULES]
    bounced = [Setting(name=n, rule=r, log_tau=False, bounce=True) for n, r in PAPER_RULES[1:]]
    excess, evaluations = grid_brent_excess_rad(material, rng)
    return ClassStudy(
        material=material,
        pooled=find_optima(pooled_cost(material.groups, GROUPS), logs),
        qpso=paper[0],
        ldwpso=paper[1],
        pso=paper[2],
        log_tau=tuple(run_trial(material, s, repeats=1, rng=rng) for s in with_log),
        bounced=tuple(run_trial(material, s, repeats=1, rng=rng) for s in bounced),
        grid_excess_rad=excess,
        grid_evaluations=evaluations,
    )


def compare_weights(logs: int, rng: np.random.Generator) -> Vector:
    """Return the ratio of errors, eta 0.412 over 0.444, the filter run through whole logs."""
    whole = first_samples(simulate_logs(SLOW, logs, rng), LOG_SAMPLES)
    rms = []
    for tau_s in (QPSO_TAU_S, PSO_TAU_S):
        error = errors_rad(whole, eta_of(np.full(logs, tau_s), PAPER_PERIOD_S))
        rms.append(np.sqrt(np.mean(error**2, axis=1)))
    return np.asarray(rms[0] / rms[1])


def _paper_run(
    material: Material, setting: Setting, repeats: int, rng: np.random.Generator
) -> PaperRun:
    trial = run_trial(material, setting, repeats=repeats, rng=rng)
    groups = material.groups
    pooled = search(pooled_cost(groups, GROUPS), setting, runs=len(groups) // GROUPS, rng=rng)
    return PaperRun(trial=trial, pooled_eta=eta_of(pooled.x[:, 0], groups.period_s))
