"""What hostkit says when GHDL is missing, refuses a source, or writes something odd."""

from pathlib import Path

import numpy as np
import pytest
from designs import design

from hostkit.emulation import ghdl
from hostkit.errors import BuildError, EmulationError, ToolMissingError
from hostkit.render import render_target, write
from hostkit.targets import TARGETS

ACCEL = np.array([[0, 0, 16384], [100, -200, 16000]], dtype=np.int64)
GYRO = np.zeros_like(ACCEL)
RESULTS = (
    "0123456789ab\n"
    "0000 00000000 ffffffff 00000007 fffffff9 1 0 9 48\n"
    "0003 7fffffff 80000000 00000000 00000000 0 1 58 48\n"
)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    write(render_target(design(), TARGETS["spartan3adsp"]), tmp_path / "core")
    return tmp_path / "core"


@pytest.fixture
def fake_ghdl(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return a script that stands in for GHDL; with ``-r`` it runs what the test adds to it."""
    tool = tmp_path / "bin" / "ghdl"
    tool.parent.mkdir()
    tool.write_text('#!/bin/sh\n[ "$1" = -r ] || exit 0\nresults=${5#-gRESULT_FILE=}\n')
    tool.chmod(0o755)
    monkeypatch.setenv("PATH", f"{tool.parent}:/usr/bin:/bin")
    return tool


def add(tool: Path, text: str) -> None:
    tool.write_text(tool.read_text() + text)


def answer(tool: Path, results: str) -> None:
    add(tool, f"cat > $results <<'END'\n{results}END\n")


def test_missing_ghdl_comes_with_a_hint(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", "")
    with pytest.raises(ToolMissingError, match="apt-get install ghdl"):
        ghdl.analyse(folder)


def test_a_folder_without_sources_is_refused(tmp_path: Path, fake_ghdl: Path) -> None:
    with pytest.raises(BuildError, match="no VHDL source"):
        ghdl.analyse(tmp_path)


def test_a_folder_that_was_not_analysed_is_refused(folder: Path, fake_ghdl: Path) -> None:
    with pytest.raises(BuildError, match="has not been analysed"):
        ghdl.simulate(folder, ACCEL, GYRO)


@pytest.mark.usefixtures("ghdl_installed")
def test_the_first_error_of_ghdl_is_the_message(folder: Path) -> None:
    source = folder / "hk_arctan.vhd"
    source.write_text(source.read_text().replace("turn_r  <=", "trun_r  <="))
    with pytest.raises(BuildError, match=r'hk_arctan\.vhd:\d+:\d+: no declaration for "trun_r"'):
        ghdl.analyse(folder)


@pytest.mark.usefixtures("ghdl_installed")
def test_analyse_names_the_units_and_may_be_repeated(folder: Path) -> None:
    units = ghdl.analyse(folder)
    assert units == ghdl.analyse(folder)
    assert set(units) == {path.stem for path in folder.glob("*.vhd")}


@pytest.mark.usefixtures("ghdl_installed")
def test_no_sample_is_a_run_too(folder: Path) -> None:
    ghdl.analyse(folder)
    run = ghdl.simulate(folder, ACCEL[:0], GYRO[:0])
    assert run.angle_raw.shape == (0, 2)


def test_results_are_read(folder: Path, fake_ghdl: Path) -> None:
    (folder / "build").mkdir()
    answer(fake_ghdl, RESULTS)
    add(fake_ghdl, "sleep 0.3\n")
    seen: list[int] = []
    run = ghdl.simulate(folder, ACCEL, GYRO, progress=seen.append)
    assert run.design_digest == "0123456789ab"
    assert run.angle_raw.tolist() == [[0, -1], [2**31 - 1, -(2**31)]]
    assert run.hidden_raw.tolist() == [[7, -7], [0, 0]]
    assert run.restarted.tolist() == [True, False]
    assert run.channel.tolist() == [0, 3]
    assert run.saturated.tolist() == [False, True]
    assert run.taken_cycle.tolist() == [9, 58]
    assert run.latency_cycles.tolist() == [48, 48]
    assert seen
    assert seen[-1] == 2


@pytest.mark.parametrize(
    ("results", "complaint"),
    [
        ("", "no results"),
        ("0123456789AB\n", "not a digest"),
        (RESULTS.rsplit("\n", 2)[0] + "\n", "1 results for 2 samples"),
        (RESULTS + RESULTS.splitlines()[1] + "\n", "3 results for 2 samples"),
        (RESULTS.replace("ffffffff", "XXXXXXXX"), "is not a result"),
        (RESULTS.replace("00000007 ", ""), "differ in their numbers of words"),
        (RESULTS.replace("fffffff9 1", "fffffff9 2"), "is not a result"),
        (RESULTS.replace("0003 ", ""), "is not a result"),
    ],
)
def test_odd_results_are_refused(
    folder: Path, fake_ghdl: Path, results: str, complaint: str
) -> None:
    (folder / "build").mkdir()
    answer(fake_ghdl, results)
    with pytest.raises(EmulationError, match=complaint):
        ghdl.simulate(folder, ACCEL, GYRO)


def test_a_run_that_writes_nothing_is_refused(folder: Path, fake_ghdl: Path) -> None:
    (folder / "build").mkdir()
    with pytest.raises(EmulationError, match="no results"):
        ghdl.simulate(folder, ACCEL, GYRO)


def test_a_failed_run_says_why(folder: Path, fake_ghdl: Path) -> None:
    (folder / "build").mkdir()
    add(fake_ghdl, "echo 'bench.vhd:1:1:@5ns:(assertion failure): broken'\nexit 1\n")
    with pytest.raises(EmulationError, match="broken"):
        ghdl.simulate(folder, ACCEL, GYRO)


def test_a_run_that_hangs_is_ended(
    folder: Path, fake_ghdl: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (folder / "build").mkdir()
    add(fake_ghdl, "exec sleep 60\n")
    monkeypatch.setattr(ghdl, "RUN_TIMEOUT_S", 0.2)
    with pytest.raises(EmulationError, match="did not end within"):
        ghdl.simulate(folder, ACCEL, GYRO)


@pytest.mark.parametrize("count", [32768, -32769])
def test_a_count_beyond_16_bits_is_refused(folder: Path, fake_ghdl: Path, count: int) -> None:
    (folder / "build").mkdir()
    with pytest.raises(EmulationError, match=f"count {count} does not fit 16 bits"):
        ghdl.simulate(folder, np.full((1, 3), count), GYRO[:1])
