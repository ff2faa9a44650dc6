from pathlib import Path

import pytest
from cocotb_run import run_bench
from designs import design

from hostkit.render import render_target, write
from hostkit.targets import TARGETS

PIPELINED_LATENCY = 60
ITERATIVE_LATENCIES = (31, 61)


@pytest.mark.usefixtures("ghdl_installed")
@pytest.mark.parametrize("pipelined", [True, False], ids=["pipelined", "iterative"])
def test_the_polar_core_equals_its_model(tmp_path: Path, pipelined: bool) -> None:
    write(render_target(design(), TARGETS["spartan3adsp"]), tmp_path / "core")
    latencies = (PIPELINED_LATENCY,) if pipelined else ITERATIVE_LATENCIES
    tests = run_bench(
        tmp_path / "core",
        "hk_polar",
        "polar_bench",
        build=tmp_path / "build",
        parameters={"PIPELINED": str(pipelined).lower(), "ID_BITS": 6},
        environment={
            "PIPELINED": str(pipelined).lower(),
            "RANDOM_SAMPLES": "1000" if pipelined else "100",
            "LATENCIES": " ".join(map(str, latencies)),
        },
    )
    assert tests == 3
