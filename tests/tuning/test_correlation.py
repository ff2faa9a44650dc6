import numpy as np
import pytest
from recorded import problem, recorded

from hostkit.tuning import TuningOptions
from hostkit.tuning.complementary.correlation import _pays, lags_of, tabulate, tabulated
from hostkit.tuning.search import search

ENOUGH = 10**9


@pytest.fixture(scope="module")
def long():
    return problem(recorded("random", duration_s=1000.0), recorded("steps", duration_s=40.0))


def test_tables_give_the_rmse_of_the_kernel(long):
    import hostkit.tuning.complementary.correlation as correlation

    tables = correlation.TabulatedProblem(
        problem=long,
        tables=tuple((tabulate(s[0], lags_of(0.9999)),) for s in long.streams),
    )
    x = np.linspace(long.space.lower, long.space.upper, 30)
    np.testing.assert_allclose(tables.cost(x), long.cost(x), rtol=1e-10)


def test_tables_hold_for_the_plain_rmse_of_all_samples_only(long, monkeypatch):
    monkeypatch.setattr("hostkit.tuning.complementary.correlation.KERNEL_NS", 1e9)
    assert tabulated(long, ENOUGH) is not None
    recording = recorded()
    assert tabulated(problem(recording, objective="mae"), ENOUGH) is None
    assert tabulated(problem(recording, free=("tau", "gate")), ENOUGH) is None
    valid = np.array(recording.valid)
    valid[5] = False
    from dataclasses import replace

    assert tabulated(problem(replace(recording, valid=valid)), ENOUGH) is None


def test_they_are_made_where_they_pay(long):
    short = problem(recorded(duration_s=5.0))
    assert not _pays(short, ENOUGH)
    assert not _pays(long, 100)


def test_search_with_tables_finds_the_same(monkeypatch):
    p = problem(recorded(duration_s=20.0))
    options = TuningOptions(axes="roll", optimiser="qpso", restarts=2)
    kernel = search(p, options, "qpso")
    monkeypatch.setattr("hostkit.tuning.complementary.correlation.KERNEL_NS", 1e9)
    tables = search(p, options, "qpso")
    assert tables.cost == pytest.approx(kernel.cost, rel=1e-9)
    assert tables.x == pytest.approx(kernel.x, abs=1e-3)
