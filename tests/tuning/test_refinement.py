from dataclasses import replace
from pathlib import Path

import numpy as np
from recorded import SENSOR, recorded

from hostkit.tuning import TuningOptions
from hostkit.tuning.archive import archived
from hostkit.tuning.observer import observer_problem
from hostkit.tuning.refinement import NEAR, refined
from hostkit.tuning.retuning import cross_validate, retune
from hostkit.tuning.search import search
from hostkit.tuning.weighting import weighted_cost

OPTIONS = TuningOptions(
    filter="observer", free=("kt", "kv", "kb"), sensor=SENSOR, particles=16, iterations=20
)
RECORDINGS = tuple(recorded("random", seed=s, duration_s=5.0) for s in (1, 2, 3))
WITHOUT_ONE = (1.0 - np.eye(3))[:, :, np.newaxis]


def searched(recordings=RECORDINGS, options=OPTIONS):
    p = archived(observer_problem(recordings, options, Path()), 16)
    search(p, options, "qpso")
    return p


def test_a_fold_does_not_see_what_it_leaves_out() -> None:
    start = retune(searched(), WITHOUT_ONE, OPTIONS)
    found = refined(searched(), WITHOUT_ONE, start, OPTIONS)
    other = (recorded("steps", seed=9, duration_s=5.0), *RECORDINGS[1:])
    again = refined(searched(other), WITHOUT_ONE, start, OPTIONS)
    np.testing.assert_array_equal(found[0], again[0])
    assert (found[1:] != again[1:]).any()


def test_a_fold_searches_on_nearby_and_hardly_loses() -> None:
    p = searched()
    start = retune(p, WITHOUT_ONE, OPTIONS)
    found = refined(p, WITHOUT_ONE, start, OPTIONS)
    assert (found != start).all()
    assert (np.abs(found - start) <= NEAR * (p.space.upper - p.space.lower) + 1e-12).all()
    for one, before, after in zip(WITHOUT_ONE, start, found, strict=True):
        points = np.array([before, after])
        cost = weighted_cost(p, p.block_sums(points, 1), p.block_counts(1), one)
        assert cost[1] < 1.01 * cost[0]


def test_threads_do_not_change_the_held_out_error() -> None:
    each = [
        cross_validate(searched(options=options), options).each_rad
        for options in (OPTIONS, replace(OPTIONS, jobs=2))
    ]
    assert each[0] == each[1]


def test_too_few_moves_leave_the_archive_as_it_is() -> None:
    p, short = searched(), replace(OPTIONS, particles=4, iterations=10)
    start = retune(p, WITHOUT_ONE, OPTIONS)
    np.testing.assert_array_equal(refined(p, WITHOUT_ONE, start, short), start)
    assert refined(p.task, WITHOUT_ONE, start, OPTIONS) is start
