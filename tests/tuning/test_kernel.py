import ctypes
import os
import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from recorded import EVERY, problem, recorded

from hostkit.optimisers import OPTIMISERS
from hostkit.records import Objective
from hostkit.tuning import SearchRange, TuningOptions
from hostkit.tuning.complementary.problem import Problem
from hostkit.tuning.complementary.space import search_space
from hostkit.tuning.kernel import (
    NativeKernel,
    PortableKernel,
    arrays,
    kernel,
    runs_of,
    within,
)
from hostkit.tuning.search import search

OBJECTIVES: list[Objective] = ["rmse", "mae"]


@pytest.fixture(scope="module")
def native() -> NativeKernel:
    found = kernel()
    assert isinstance(found, NativeKernel), "the kernel was not compiled"
    return found


@pytest.fixture(scope="module")
def masked():
    """A recording with lost reference and samples that do not count, in several stretches."""
    recording = recorded(duration_s=8.0)
    valid = np.array(recording.valid)
    valid[:50] = valid[170:172] = valid[350:500] = False
    lost = np.array(recording.up_reference)
    lost[600:660] = np.nan
    return replace(recording, valid=valid, up_reference=lost)


def points(p: Problem, count: int, seed: int = 0) -> np.ndarray:
    share = np.random.default_rng(seed).random((count, len(p.space.dimensions)))
    return p.space.lower + (p.space.upper - p.space.lower) * share


@pytest.mark.parametrize("objective", OBJECTIVES)
@pytest.mark.parametrize("free", [("tau",), EVERY], ids=["plain", "full"])
@pytest.mark.parametrize("count", [1, 8, 20, 33, 70])
def test_compiled_and_portable_give_the_same_numbers(native, masked, objective, free, count):
    compiled = problem(masked, objective=objective, free=free, by=native)
    portable = replace(compiled, kernel=PortableKernel())
    x = points(compiled, count)
    np.testing.assert_allclose(compiled.cost(x), portable.cost(x), rtol=1e-12)


@pytest.mark.parametrize("by", [PortableKernel(), None], ids=["numpy", "c"])
@pytest.mark.parametrize("free", [("tau",), EVERY], ids=["plain", "full"])
def test_state_is_carried_from_block_to_block(masked, by, free):
    p = problem(masked, axes="both", free=free, by=by)
    x = points(p, 5)
    whole = p.block_sums(x, 1)[:, :, 0]
    np.testing.assert_allclose(p.block_sums(x, 7).sum(axis=2), whole, rtol=1e-12)
    assert p.block_counts(7).sum(axis=2) == pytest.approx(p.block_counts(1)[:, :, 0])


def test_full_recursion_with_neutral_parameters_is_the_plain_one(masked):
    plain = problem(masked, full=True)
    full = replace(plain, space=replace(plain.space, fixed=()))
    x = points(plain, 9)
    candidates = plain.space.candidates("roll", x)
    assert candidates.plain
    longer = replace(candidates, plain=False)
    sums = [plain._stream_sums(full.streams[0][0], c, 1) for c in (candidates, longer)]
    np.testing.assert_allclose(sums[0], sums[1], rtol=1e-10)


@pytest.mark.parametrize("by", [PortableKernel(), None], ids=["numpy", "c"])
@pytest.mark.parametrize(
    ("arithmetic", "digits"), [(np.float64, 1e-5), (np.float32, 1e-4)], ids=["mixed", "float32"]
)
def test_narrow_streams_and_arithmetic_agree_to_their_digits(masked, by, arithmetic, digits):
    double = problem(masked)
    single = problem(masked, by=by, dtype=np.float32, arithmetic=arithmetic)
    x = points(double, 40)
    np.testing.assert_allclose(single.cost(x), double.cost(x), rtol=digits)


@pytest.mark.parametrize("arithmetic", [np.float64, np.float32])
def test_narrow_full_recursion_agrees(masked, arithmetic):
    """A sample whose force is as far from 1 g as the gate may fall on either side of it."""
    double = problem(masked, free=EVERY)
    single = problem(masked, free=EVERY, dtype=np.float32, arithmetic=arithmetic)
    x = points(double, 40)
    np.testing.assert_allclose(single.cost(x), double.cost(x), rtol=2e-3)


def test_trace_is_what_the_sums_add_up(native, masked):
    for free in (("tau",), EVERY):
        for by in (native, PortableKernel()):
            p = problem(masked, axes="roll", free=free, by=by)
            x = points(p, 3)
            errors = p.error(x)[0, 0]
            assert [p.rms_rad(one, 0) for one in x] == pytest.approx(errors, rel=1e-12)


def test_not_a_number_stays_one(native):
    recording = recorded()
    force = np.array(recording.specific_force_m_s2)
    force[500, 1] = np.nan
    p = problem(replace(recording, specific_force_m_s2=force), by=native)
    assert np.isnan(p.cost(points(p, 3))).all()


@pytest.mark.parametrize("objective", OBJECTIVES)
def test_swarm_in_c_is_the_swarm_in_python(native, objective):
    p = problem(recorded(), recorded("sine-sweep"), axes="both", objective=objective, by=native)
    options = TuningOptions(optimiser="qpso", seed=5)
    compiled = search(p, options, "qpso")
    python = OPTIMISERS["qpso"].minimise(
        p.cost, p.space.lower, p.space.upper, rng=np.random.default_rng(5)
    )
    assert compiled.evaluations == python.evaluations == 2020
    np.testing.assert_allclose(compiled.history[:20], python.history[:20], rtol=1e-9)
    assert compiled.cost == pytest.approx(python.cost, rel=1e-9)
    assert compiled.x == pytest.approx(python.x, abs=1e-4)


@pytest.mark.parametrize("objective", OBJECTIVES)
@pytest.mark.parametrize("seed", range(6))
def test_grid_and_brent_in_c_are_those_in_python(native, objective, seed):
    p = problem(recorded("random", seed=seed, duration_s=3.0), objective=objective, by=native)
    compiled = search(p, TuningOptions(optimiser="grid-brent"), "grid-brent")
    python = OPTIMISERS["grid-brent"].minimise(
        p.cost, p.space.lower, p.space.upper, rng=np.random.default_rng(1)
    )
    assert compiled.evaluations == python.evaluations
    assert compiled.stopped_at == python.stopped_at
    np.testing.assert_allclose(compiled.history, python.history, rtol=1e-9)
    assert compiled.x == pytest.approx(python.x, abs=1e-6)


def test_swarm_over_tau_itself_is_no_swarm_over_its_logarithm(native):
    """The loop in C searches log tau; a linear range must not be given to it."""
    p = problem(recorded(), by=native)
    linear = SearchRange(name="tau", lowest=0.02, highest=100.0, is_log=False)
    space = search_space("roll", 0.01, ("tau",), ranges=(linear,))
    found = search(replace(p, space=space), TuningOptions(optimiser="qpso"), "qpso")
    wanted = search(p, TuningOptions(optimiser="grid-brent"), "grid-brent")
    assert found.x[0] == pytest.approx(np.exp(wanted.x[0]), rel=1e-2)


def test_threads_change_nothing():
    recordings = [recorded(seed=seed) for seed in range(4)]
    p = problem(*recordings, free=EVERY)
    x = points(p, 6)
    np.testing.assert_array_equal(replace(p, jobs=3).cost(x), p.cost(x))


def test_runs_are_the_stretches_that_count():
    scored = np.array([1, 1, 0, 1, 0, 0, 1], dtype=bool)
    runs = runs_of(scored)
    assert runs.tolist() == [[0, 2], [3, 4], [6, 7]]
    assert within(runs, 1, 6).tolist() == [[1, 2], [3, 4]]
    assert runs_of(np.zeros(3, dtype=bool)).shape == (0, 2)


def chosen(**environment: str) -> str:
    code = "from hostkit.tuning.kernel import kernel; print(kernel().name)"
    return subprocess.run(
        [sys.executable, "-c", code],
        env={**os.environ, **environment},
        check=True,
        capture_output=True,
        text=True,
    ).stdout.strip()


def test_without_a_compiler_the_portable_kernel_is_chosen(tmp_path: Path):
    assert chosen(PATH=str(tmp_path)) == "numpy"
    assert chosen(HOSTKIT_KERNEL="numpy") == "numpy"


def built(tmp_path: Path, cache: Path) -> str:
    """Build a source that takes no time in a process of its own; return what it answers."""
    source = tmp_path / "small.c"
    source.write_text("int small(void);\nint small(void) { return 7; }\n", encoding="ascii")
    code = (
        "import pathlib, sys; from hostkit.tuning.kernel.library import library; "
        "print(library((pathlib.Path(sys.argv[1]),)).small())"
    )
    return subprocess.run(
        [sys.executable, "-c", code, str(source)],
        env={**os.environ, "XDG_CACHE_HOME": str(cache)},
        check=True,
        capture_output=True,
        text=True,
    ).stdout.strip()


def test_kernel_is_built_once_and_kept(tmp_path: Path):
    assert built(tmp_path, tmp_path) == "7"
    (kept,) = (tmp_path / "hostkit").iterdir()
    assert kept.suffix == ".so"
    before = kept.stat().st_mtime_ns
    assert built(tmp_path, tmp_path) == "7"
    assert kept.stat().st_mtime_ns == before


def test_a_damaged_kept_kernel_is_built_again(tmp_path: Path):
    assert built(tmp_path, tmp_path) == "7"
    (kept,) = (tmp_path / "hostkit").iterdir()
    whole = kept.read_bytes()
    kept.write_bytes(b"no library")
    assert built(tmp_path, tmp_path) == "7"
    assert len(kept.read_bytes()) == len(whole)


def test_a_broken_compiler_leaves_the_portable_kernel(tmp_path: Path):
    compiler = tmp_path / "cc"
    compiler.write_text("#!/bin/sh\nexit 1\n", encoding="ascii")
    compiler.chmod(0o755)
    assert chosen(PATH=str(tmp_path), XDG_CACHE_HOME=str(tmp_path / "cache")) == "numpy"


def test_where_nothing_can_be_kept_it_is_built_for_the_process(tmp_path: Path):
    blocked = tmp_path / "file"
    blocked.write_text("", encoding="ascii")
    assert built(tmp_path, blocked) == "7"


@pytest.mark.skipif(shutil.which("gcc") is None, reason="needs gcc")
def test_kernel_has_no_undefined_behaviour(tmp_path: Path, masked):
    """The sanitisers see a run of every kind; they end the process on a finding."""
    source = Path(arrays.__file__).with_name("kernel.c")
    built = tmp_path / "kernel.so"
    flags = ["-O0", "-fsanitize=undefined", "-fno-sanitize-recover=all", "-shared", "-fPIC"]
    subprocess.run(["gcc", *flags, "-o", str(built), str(source), "-lm"], check=True)
    by = NativeKernel(ctypes.CDLL(str(built)))
    for free in (("tau",), EVERY):
        p = problem(masked, free=free, by=by)
        x = points(p, 37)
        np.testing.assert_allclose(p.cost(x), replace(p, kernel=kernel()).cost(x), rtol=1e-9)
