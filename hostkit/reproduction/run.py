"""The whole reproduction: experiments, acceptance figures, figures, findings."""

import numpy as np

from hostkit.errors import HostkitError
from hostkit.reproduction.acceptance import acceptance, table_one
from hostkit.reproduction.findings import REMARKS, findings
from hostkit.reproduction.paper_figures import paper_figures
from hostkit.reproduction.results import Reproduction
from hostkit.reproduction.study import run_study

LOGS, REPEATS, WEIGHT_LOGS = 100, 2, 200
STREAMS = 4


def reproduce(
    seed: int, *, logs: int = LOGS, repeats: int = REPEATS, weight_logs: int = WEIGHT_LOGS
) -> Reproduction:
    """Run the tilt paper's experiments again on simulated data.

    Parameters
    ----------
    seed
        Start of all random numbers; the same one gives the same figures.
    logs
        Simulated logs of each class, ten groups each.
    repeats
        Runs of each optimiser in paper mode on every group; in other modes each runs once.
    weight_logs
        Logs on which the paper's two weights are compared.

    Raises
    ------
    HostkitError
        If a count is below one or the seed is negative.
    """
    if min(logs, repeats, weight_logs) < 1 or seed < 0:
        raise HostkitError(
            f"{logs} logs, {repeats} repeats, {weight_logs} logs for the weights and seed {seed}: "
            "the counts must be at least 1 and the seed at least 0"
        )
    children = np.random.SeedSequence(seed).spawn(STREAMS)
    study = run_study(
        logs=logs,
        repeats=repeats,
        weight_logs=weight_logs,
        streams=[np.random.default_rng(child) for child in children],
    )
    return Reproduction(
        seed=seed,
        logs=logs,
        repeats=repeats,
        table1=table_one(study.slow),
        acceptance=acceptance(study),
        figures=paper_figures(study),
        findings=findings(study),
        remarks=REMARKS,
    )
