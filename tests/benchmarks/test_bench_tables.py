import math
import subprocess
import sys
from pathlib import Path

import pytest

from benchmarks.install import main as install
from benchmarks.install import peers
from benchmarks.large import BYTES_PER_SAMPLE, measured, missing_bytes, wanted_samples
from benchmarks.run import BENCHES, main
from benchmarks.standing import Search, Standing, first_hit, median
from benchmarks.table import Table, figure
from benchmarks.timing import least_seconds
from benchmarks.tuning import verdicts
from hostkit.errors import HostkitError

FOLDER = Path(__file__).resolve().parents[2] / "benchmarks"
PEERS = ("cma", "mealpy", "niapy", "pygmo", "pymoo", "pyswarms", "sko", "star_pso")
WITHOUT_PEERS = f"""
import importlib, sys
sys.modules.update(dict.fromkeys({PEERS!r}))
for name in {BENCHES!r}:
    assert callable(importlib.import_module(f"benchmarks.{{name}}").tables), name
from benchmarks.peers import PEERS
from benchmarks.tuning import Contest, _peer
contest = Contest.of("rmse", log=True)
gone = [p for p in PEERS if not _peer(contest, p).searches]
assert {{p.package for p in gone}} == {{p.package for p in PEERS}} - {{"scipy"}}, gone
"""


def standing(method, *found, scalar=False):
    searches = tuple(Search(evaluations=e, hit_after=h, seconds=s) for e, h, s in found)
    beside = (
        Search(evaluations=9, hit_after=9.0, seconds=4.0),
        Search(evaluations=9, hit_after=9.0, seconds=2.0),
    )
    return Standing(method=method, version="1", searches=searches, beside=beside, scalar=scalar)


def test_everything_imports_and_runs_without_the_peers():
    run = subprocess.run(
        [sys.executable, "-c", WITHOUT_PEERS], capture_output=True, text=True, check=False
    )
    assert run.returncode == 0, run.stderr


def test_every_benchmark_is_listed():
    found = {p.stem for p in FOLDER.glob("*.py") if "\ndef tables()" in p.read_text("utf-8")}
    assert found == set(BENCHES)


def test_unknown_benchmark_is_refused(capsys):
    assert main(["kernel", "nothing"]) == 2
    assert "no benchmark nothing; there are: kernel" in capsys.readouterr().err


def test_what_a_benchmark_lacks_is_said(monkeypatch, capsys):
    monkeypatch.setenv("HOSTKIT_BENCH_SAMPLES", "1")
    assert main(["large"]) == HostkitError.exit_code
    assert "large: HOSTKIT_BENCH_SAMPLES = 1: below 2e6" in capsys.readouterr().err


def test_table_is_aligned_markdown():
    table = Table(
        title="Title", columns=("a", "long"), rows=(("x", "1"), ("yyy", "22")), remarks=("End.",)
    )
    assert table.text().splitlines() == [
        "Title",
        "",
        "| a   | long |",
        "| --- | ---- |",
        "| x   |    1 |",
        "| yyy |   22 |",
        "",
        "End.",
    ]


def test_table_refuses_a_short_row():
    with pytest.raises(HostkitError, match=r"a row of 1 cells.*2 columns"):
        Table(title="Title", columns=("a", "b"), rows=(("x",),))


@pytest.mark.parametrize(
    ("value", "text"),
    [(0.0, "0"), (0.08764, "0.0876"), (1234.5, "1234"), (3.2e7, "3.20e+07"), (4e-5, "4.00e-05")],
)
def test_figure(value, text):
    assert figure(value) == text


def test_contenders_take_turns():
    order = []
    least_seconds(
        [lambda: order.append("a"), lambda: order.append("b")], budget_s=0.0, least=3, turn_s=0.0
    )
    assert "".join(order) == "abababab"


def test_shortest_time_is_kept(monkeypatch):
    ticks = iter([0.0, 0.0, 0.0, 5.0, 9.0, 9.0, 9.0, 9.0, 12.0, 19.0, 19.0])
    monkeypatch.setattr("benchmarks.timing.time.perf_counter", lambda: next(ticks))
    assert least_seconds([lambda: None], budget_s=10.0, least=1, turn_s=0.0) == (3.0,)


def test_misses_count_as_never():
    assert median((3.0, math.inf, 5.0)) == 5.0
    assert median((3.0, math.inf, math.inf)) == math.inf
    row = standing("m", (20, math.inf, 2.0), (20, math.inf, 4.0), (20, 7.0, 4.0)).row()
    assert row == ("m", "1", "3", "0.33", "never", "20", "1")


def test_missing_peer_has_a_row():
    assert standing("m").row() == ("m", "missing", "0", "-", "-", "-", "-")


def test_first_hit_is_known_to_the_step():
    assert first_hit([3.0, 2.0, 1.0], 60, 20, 2.0) == 40
    assert first_hit([3.0, 2.0, 1.0], 34, 1, 3.0) == 32
    assert first_hit([3.0, 2.0], 40, 20, 1.0) == math.inf


def test_verdict_takes_the_fastest_that_always_hit():
    found = verdicts(
        (
            standing("sure", (9, 5.0, 8.0), (9, 5.0, 6.0)),
            standing("slow", (9, 5.0, 80.0)),
            standing("lucky", (9, 5.0, 1.0), (9, math.inf, 1.0)),
            standing("scalar", (9, 5.0, 1.0), scalar=True),
            standing("gone"),
        ),
        default=0.25,
    )
    assert [one.split(": ")[1] for one in found] == [
        "sure, 3 times the time of hostkit's swarm, 12 times that of its default.",
        "scalar, 0.5 times the time of hostkit's swarm, 2 times that of its default.",
    ]


def test_samples_of_the_large_file():
    assert wanted_samples("") == 100_000_000
    assert wanted_samples("3e6") == 3_000_000
    with pytest.raises(HostkitError, match="below 2e6"):
        wanted_samples("1999999")
    with pytest.raises(HostkitError, match="'many' is no number"):
        wanted_samples("many")
    assert missing_bytes(10, 0) - missing_bytes(10, 7) == 7
    assert missing_bytes(11, 0) - missing_bytes(10, 0) > BYTES_PER_SAMPLE


def test_peak_is_that_of_the_child_alone():
    own = b"x" * (300 << 20)
    code = "import sys; x = b'x' * (100 << 20); sys.exit(len(x) % 7 + 1)"
    big = measured((sys.executable, "-c", code))
    small = measured((sys.executable, "-c", "pass"))
    assert (big.exit_code, small.exit_code) == ((100 << 20) % 7 + 1, 0)
    assert small.peak_bytes < 60 << 20 < 100 << 20 <= big.peak_bytes < len(own)


def test_peer_that_cannot_be_installed_is_said(monkeypatch, capsys):
    asked = []
    monkeypatch.setattr("benchmarks.install.requires", lambda _: ['a>=1; extra == "bench"'])
    monkeypatch.setattr(
        "benchmarks.install.subprocess.run",
        lambda command, **_: asked.append(command) or subprocess.CompletedProcess(command, 1),
    )
    assert install() == 0
    assert [command[-1] for command in asked] == ["a>=1"]
    assert "a>=1 cannot be installed here" in capsys.readouterr().err


def test_peers_are_read_from_the_extra():
    wanted = [
        "numpy>=1.24",
        'mealpy>=3; extra == "bench"',
        "starpso>=0.2; (python_version >= '3.11') and extra == 'bench'",
        'pytest>=8; extra == "dev"',
    ]
    assert peers(wanted) == ("mealpy>=3", "starpso>=0.2")
