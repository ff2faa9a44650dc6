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


LOADS = {
    "4": (40_000_000, 10_000_000),
    "8.68": (25_000_000, 2_880_000),
    "434.03": (50_000_000, 115_200),
}
FRAME_BYTES = 55
GAP_CLOCKS = 440
"""In which the payload is measured."""


@pytest.mark.usefixtures("ghdl_installed")
@pytest.mark.parametrize("ratio", LOADS)
def test_frames_arrive_at_the_rate_of_the_line(tmp_path: Path, ratio: str) -> None:
    clock_hz, baud = LOADS[ratio]
    write(render_target(design(), TARGETS["spartan3adsp"]), tmp_path / "core")
    run_bench(
        tmp_path / "core",
        "link_loop",
        "link_bench",
        build=tmp_path / "build",
        parameters={"CLOCK_HZ": clock_hz, "BAUD": baud},
        more_sources=[Path(__file__).parent / "benches" / "link_loop.vhd"],
        environment={
            "DIGEST": digest(design()),
            "RATIO": str(clock_hz / baud),
            "MOST_CLOCKS": str(FRAME_BYTES * 10 * clock_hz / baud + GAP_CLOCKS),
        },
    )
