"""Every deliberate fault of the RTL is caught."""

import shutil
from collections import Counter
from collections.abc import Callable
from functools import cache
from pathlib import Path

import pytest
from designs import all_parameters, design
from formal.bounds import CASES
from formal.prove import FOLDER, prove
from gate_cases import TOP, Configuration, assert_equal, generate, vectors
from mutation import Mutation
from mutation_checks import BENCHES, CHECKS, bench, proof
from mutation_checks import DESIGNS as OF_BLOCKS
from mutations import MUTATIONS
from test_mavlink_tx import GCS

from hostkit.design_file import digest
from hostkit.emulation.tools import require
from hostkit.errors import EmulationError, ToolMissingError
from hostkit.filters.complementary import lower
from hostkit.records import FilterDesign
from hostkit.synthesis import convert
from hostkit.synthesis.netlist import play

SAMPLES = 250
NARROW = {"DIFFERENCE_BITS": 8, "BLEND_BITS": 6}
UART = {"CLOCK_HZ": 40_000_000, "BAUD": 10_000_000}

DESIGNS: dict[str, FilterDesign] = {
    "measured": design(eta=0.001),
    "options": all_parameters(),
    "functions": all_parameters(),
    "arcsin": design(tilt="arcsin"),
    "pipelined": design(tilt="arcsin"),
    **OF_BLOCKS,
}


@pytest.fixture(scope="module")
def rendered(tmp_path_factory: pytest.TempPathFactory) -> Callable[[FilterDesign], Path]:
    try:
        require("ghdl", "yosys", "iverilog")
    except ToolMissingError as error:
        pytest.skip(str(error))
    return cache(lambda built: generate(built, tmp_path_factory.mktemp("core")))


def _vectors(folder: Path, check: str, built: FilterDesign) -> None:
    """Play vectors with stalls on the converted core, the samples of every channel in turn."""
    channels = {"channels": 5, "pipelined": 3}.get(check, 1)
    case = Configuration(
        name=check,
        design=built,
        channels=channels,
        pipelined=check == "pipelined",
        budget=(0, 0, 0, 0),
    )
    played = vectors(case, SAMPLES)
    text = convert(folder, TOP, case.generics).text
    run = play(text, played, lower(built), channels=channels, stalls=True, mapped=False)
    assert run.design_digest == digest(built)
    assert_equal(run, case, played)


def _handshake(folder: Path, work: Path) -> None:
    core = convert(folder, "hk_complementary").text
    assert prove(core, "complementary", work, {"LATENCY": 54}).proved


def _functions(folder: Path, work: Path) -> None:
    shutil.copy(FOLDER / "functions.vhd", folder)
    core = convert(folder, "functions", NARROW).text
    assert prove(core, "functions", work, NARROW, free_products=False).proved


def _bench(folder: Path, work: Path, check: str, built: FilterDesign) -> None:
    """Run the cocotb bench of a block."""
    text = {name: str(value) for name, value in UART.items()}
    if check == "uart":
        shutil.copy(BENCHES / "uart_pair.vhd", folder)
        bench(folder, "uart_pair", "uart_bench", work, UART, text)
    elif check == "mavlink":
        environment = {"HIDDEN_AXES": "", "DIGEST": digest(built), "IDENTITY": GCS}
        bench(folder, "hk_mavlink_tx", "mavlink_bench", work, {}, environment)
    else:
        clock = {"CLOCK_HZ": 1_843_200}
        bench(folder, "hk_stopwatch", "stopwatch_bench", work, clock, {"CLOCK_HZ": "1843200"})


def _check(folder: Path, work: Path, check: str) -> None:
    built = DESIGNS.get(check, design())
    if check == "handshake":
        _handshake(folder, work)
    elif check == "functions":
        _functions(folder, work)
    elif check in {"uart", "mavlink", "stopwatch"}:
        _bench(folder, work, check, built)
    elif check in CASES:
        proof(folder, work, check)
    elif check in CHECKS:
        CHECKS[check](folder, work)
    else:
        _vectors(folder, check, built)


def _mutated(folder: Path, mutation: Mutation) -> None:
    source = folder / mutation.source
    text = source.read_text(encoding="ascii")
    assert text.count(mutation.good) == 1, f"{mutation.name}: not there once"
    source.write_text(text.replace(mutation.good, mutation.bad), encoding="ascii")


@pytest.mark.parametrize("mutation", MUTATIONS, ids=lambda m: f"{m.check}-{m.name}")
def test_a_fault_is_caught(
    mutation: Mutation, rendered: Callable[[FilterDesign], Path], tmp_path: Path
) -> None:
    built = DESIGNS.get(mutation.check, design())
    folder = shutil.copytree(rendered(built), tmp_path / "core")
    _mutated(folder, mutation)
    with pytest.raises((AssertionError, EmulationError)):
        _check(folder, tmp_path / "work", mutation.check)


@pytest.mark.parametrize("check", sorted({m.check for m in MUTATIONS} - {"handshake", *CASES}))
def test_without_a_fault_nothing_is_found(
    check: str, rendered: Callable[[FilterDesign], Path], tmp_path: Path
) -> None:
    built = DESIGNS.get(check, design())
    folder = shutil.copytree(rendered(built), tmp_path / "core")
    _check(folder, tmp_path / "work", check)


def test_there_are_enough_faults() -> None:
    names = Counter((m.check, m.name) for m in MUTATIONS)
    assert max(names.values()) == 1
    assert len(MUTATIONS) >= 88
