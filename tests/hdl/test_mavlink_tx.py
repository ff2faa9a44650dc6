from pathlib import Path

import pytest
from cocotb_run import run_bench
from designs import all_parameters, design

from hostkit.design_file import digest
from hostkit.render import render_target, write
from hostkit.render.fpga_options import FpgaOptions
from hostkit.targets import TARGETS

GCS, COMPONENT = "1 1 0 0", "42 200 40 8"
"""System id, component id, type and autopilot."""
DESIGNS = {
    "plain": (design(), "", FpgaOptions(), GCS),
    "integral": (all_parameters(), "roll pitch", FpgaOptions(), GCS),
    "integral-pitch": (
        all_parameters("pitch"),
        "pitch",
        FpgaOptions(profile="component", system_id=42),
        COMPONENT,
    ),
}


@pytest.mark.usefixtures("ghdl_installed")
@pytest.mark.parametrize("name", DESIGNS)
def test_frames_are_those_of_pymavlink(tmp_path: Path, name: str) -> None:
    built, hidden, options, identity = DESIGNS[name]
    write(render_target(built, TARGETS["spartan3adsp"], options), tmp_path / "core")
    tests = run_bench(
        tmp_path / "core",
        "hk_mavlink_tx",
        "mavlink_bench",
        build=tmp_path / "build",
        environment={"HIDDEN_AXES": hidden, "DIGEST": digest(built), "IDENTITY": identity},
    )
    assert tests == 5


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
            "IDENTITY": GCS,
            "RATIO": str(clock_hz / baud),
            "MOST_CLOCKS": str(FRAME_BYTES * 10 * clock_hz / baud + GAP_CLOCKS),
        },
    )
