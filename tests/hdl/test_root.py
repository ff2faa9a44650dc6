from pathlib import Path

import pytest
from cocotb_run import run_bench
from designs import design

from hostkit.render import render_target, write
from hostkit.targets import TARGETS


@pytest.mark.usefixtures("ghdl_installed")
def test_the_root_is_floored(tmp_path: Path) -> None:
    write(render_target(design(), TARGETS["spartan3adsp"]), tmp_path / "core")
    run_bench(
        tmp_path / "core",
        "hk_root",
        "root_bench",
        build=tmp_path / "build",
        parameters={"INTEGER_BITS": 15, "FRACTION_BITS": 8},
    )
