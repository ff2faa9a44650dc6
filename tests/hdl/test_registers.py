import shutil
from pathlib import Path

import pytest
from cocotb_run import run_bench
from cocotb_tools.check_results import get_results
from cocotb_tools.runner import get_runner
from designs import all_parameters, design

from hostkit.records import FilterDesign
from hostkit.render import render_target, write
from hostkit.synthesis.convert import convert
from hostkit.targets import TARGETS

BENCHES = Path(__file__).parent / "benches"
SOURCES = (
    "hk_common_pkg",
    "hk_design_pkg",
    "hk_complementary_design_pkg",
    "hk_complementary_pkg",
    "hk_regs_pkg",
    "hk_regs",
    "hk_axi4lite",
    "hk_wishbone",
)


def _core(design: FilterDesign, folder: Path) -> Path:
    """Write what the registers are made of, and nothing else of the system."""
    files = render_target(design, TARGETS["spartan3adsp"])
    wanted = tuple(file for file in files if file.path.removesuffix(".vhd") in SOURCES)
    write(wanted, folder)
    return folder


@pytest.mark.parametrize(
    ("bench", "name", "source"),
    [
        ("axi4lite_bench", "all", all_parameters()),
        ("wishbone_bench", "plain", design()),
        ("wishbone_bench", "pitch", design(axes="pitch", tilt="arcsin")),
    ],
    ids=lambda value: value if isinstance(value, str) else "",
)
@pytest.mark.usefixtures("ghdl_installed")
def test_the_bus_sees_the_described_registers(
    tmp_path: Path, bench: str, name: str, source: FilterDesign
) -> None:
    run_bench(
        _core(source, tmp_path / "core"),
        "hk_regs_bench",
        bench,
        build=tmp_path / "build",
        parameters={"WISHBONE": str(bench == "wishbone_bench").lower()},
        more_sources=[BENCHES / "hk_regs_bench.vhd"],
        environment={"DESIGN": name},
    )


@pytest.mark.usefixtures("ghdl_installed")
def test_the_converted_verilog_behaves_alike(tmp_path: Path) -> None:
    """The writer of GHDL has its limits, and what it gets wrong it does not tell."""
    if shutil.which("iverilog") is None:
        pytest.skip("iverilog is not installed")
    folder = _core(design(), tmp_path / "core")
    shutil.copy(BENCHES / "hk_regs_bench.vhd", folder)
    converted = convert(folder, "hk_regs_bench", {"WISHBONE": True})
    source = tmp_path / "hk_regs_bench.v"
    source.write_text(converted.text, encoding="ascii")
    runner = get_runner("icarus")
    build = tmp_path / "build"
    timescale = ("1ns", "1ps")
    runner.build(
        sources=[source], hdl_toplevel="hk_regs_bench", build_dir=build, timescale=timescale
    )
    results = runner.test(
        hdl_toplevel="hk_regs_bench",
        test_module="wishbone_bench",
        build_dir=build,
        test_dir=build,
        timescale=timescale,
        extra_env={"DESIGN": "plain"},
    )
    tests, failed = get_results(results)
    assert tests > 20
    assert failed == 0
