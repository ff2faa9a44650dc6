from pathlib import Path

import pytest
from cocotb_run import run_bench
from designs import all_parameters, design

from hostkit.records import FilterDesign
from hostkit.render import render_target, write
from hostkit.targets import TARGETS

BENCHES = Path(__file__).parent / "benches"
SOURCES = (
    "hk_common_pkg",
    "hk_design_pkg",
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
