from pathlib import Path

import pytest
from cocotb_run import run_bench
from designs import all_parameters, design

from hostkit.design_file import digest
from hostkit.records import FilterDesign
from hostkit.render import render_target, write
from hostkit.targets import TARGETS

DESIGNS = {
    "plain": (design(), ""),
    "integral": (all_parameters(), "roll pitch"),
    "integral-pitch": (all_parameters("pitch"), "pitch"),
}


@pytest.mark.usefixtures("ghdl_installed")
@pytest.mark.parametrize("name", DESIGNS)
def test_frames_are_those_of_pymavlink(tmp_path: Path, name: str) -> None:
    built, hidden = DESIGNS[name]
    tests = _run(built, hidden, tmp_path)
    assert tests == 5


def _run(built: FilterDesign, hidden: str, folder: Path) -> int:
    write(render_target(built, TARGETS["spartan3adsp"]), folder / "core")
    return run_bench(
        folder / "core",
        "hk_mavlink_tx",
        "mavlink_bench",
        build=folder / "build",
        environment={"HIDDEN_AXES": hidden, "DIGEST": digest(built)},
    )
