"""Tuning a filter for a comparison: the same search and the same scores for ours and for peers."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hostkit.tuning import HeldOut, TuningOptions
from hostkit.tuning.archive import archived
from hostkit.tuning.retuning import LEAST_UNITS, cross_validate
from hostkit.tuning.search import choose_optimiser, search
from hostkit.tuning.start import search_from
from hostkit.tuning.task import Task

Vector = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Tuned:
    """The best point of a search, and how it does.

    Attributes
    ----------
    x
        Coordinates in the space of the task, shape ``(D,)``.
    each_rad
        RMSE of every recording, in their order.
    held_out
        The errors while recordings were left out; None if that was not asked for.
    evaluations
        How many points were tried.
    """

    x: Vector
    each_rad: tuple[float, ...]
    held_out: HeldOut | None
    evaluations: int


def tuned(task: Task, start: Vector | None, options: TuningOptions) -> Tuned:
    """Search a task.

    Parameters
    ----------
    start
        The filter's own settings as a point, shape ``(D,)``: where points are dear, and so few are
        tried, it is one of them. None where they are not.

    Raises
    ------
    HostkitError
        If the cost is finite nowhere.
    """
    optimiser = choose_optimiser(options.optimiser, len(task.space.dimensions))
    recordings = len(task.lengths)
    problem = task if start is None else archived(task, LEAST_UNITS)
    if start is None:
        found = search(problem, options, optimiser)
    else:
        found = search_from(problem, options, optimiser, start)
    return Tuned(
        x=found.x,
        each_rad=tuple(problem.rms_rad(found.x, i) for i in range(recordings)),
        held_out=cross_validate(problem, options) if options.held_out else None,
        evaluations=found.evaluations,
    )
