from pathlib import Path

import pytest
from cocotb_run import run_bench
from designs import design

from hostkit.render import render_target, write
from hostkit.targets import TARGETS

CLOCKS_HZ = (1_000_000, 1_843_200, 8_000_000, 12_000_000, 33_333_000, 33_333_333)


@pytest.fixture(scope="module")
def generated(tmp_path_factory: pytest.TempPathFactory, ghdl_installed: None) -> Path:
    folder = tmp_path_factory.mktemp("stopwatch")
    write(render_target(design(), TARGETS["spartan3adsp"]), folder)
    return folder


@pytest.mark.parametrize("clock_hz", CLOCKS_HZ)
def test_microseconds_are_exact(generated: Path, tmp_path: Path, clock_hz: int) -> None:
    run_bench(
        generated,
        "hk_stopwatch",
        "stopwatch_bench",
        build=tmp_path,
        parameters={"CLOCK_HZ": clock_hz},
        environment={"CLOCK_HZ": str(clock_hz)},
    )
