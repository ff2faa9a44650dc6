from collections.abc import Iterator

import pytest
from cocotb_run import QUICK
from hdl_cases import Core, build_core

from hostkit.emulation import ghdl
from hostkit.emulation.tools import require
from hostkit.errors import ToolMissingError
from hostkit.records import FilterDesign


@pytest.fixture(scope="package", autouse=True)
def compiled_quickly() -> Iterator[None]:
    """Compile cores as benches are: they run for a second."""
    usual, ghdl.OPTIMISE = ghdl.OPTIMISE, QUICK
    yield
    ghdl.OPTIMISE = usual


@pytest.fixture(scope="session")
def ghdl_installed() -> None:
    """Skip the test where GHDL is missing."""
    try:
        require("ghdl")
    except ToolMissingError as error:
        pytest.skip(str(error))


@pytest.fixture(scope="module")
def core(
    request: pytest.FixtureRequest,
    tmp_path_factory: pytest.TempPathFactory,
    ghdl_installed: None,
) -> Core:
    """Return the analysed core of the design that the test is parametrised with."""
    design: FilterDesign = request.param
    return build_core(design, tmp_path_factory.mktemp("core"))
