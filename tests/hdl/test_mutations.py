"""Every deliberate fault of the RTL is caught."""

import shutil
from collections import Counter
from collections.abc import Callable
from functools import cache
from pathlib import Path

import pytest
from cocotb_run import run_bench
from designs import all_parameters, design
from formal.prove import FOLDER, prove
from gate_cases import TOP, Configuration, assert_equal, generate, vectors
from mutations import MUTATIONS, Mutation

from hostkit.design_file import digest
from hostkit.emulation.tools import require
from hostkit.errors import EmulationError, ToolMissingError
from hostkit.records import FilterDesign
from hostkit.synthesis import convert
from hostkit.synthesis.convert import needed_sources
from hostkit.synthesis.netlist import play

SAMPLES = 250
BENCHES = Path(__file__).parent / "benches"
NARROW = {"DIFFERENCE_BITS": 8, "BLEND_BITS": 6}
UART = {"CLOCK_HZ": 40_000_000, "BAUD": 10_000_000}

DESIGNS: dict[str, FilterDesign] = {
    "measured": design(eta=0.001),
    "options": all_parameters(),
    "functions": all_parameters(),
    "arcsin": design(tilt="arcsin"),
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
    channels = 5 if check == "channels" else 1
    case = Configuration(name=check, design=built, channels=channels, budget=(0, 0, 0, 0))
    played = vectors(case, SAMPLES)
    text = convert(folder, TOP, case.generics).text
    run = play(text, played, channels=channels, stalls=True, mapped=False)
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
        _run(folder, "uart_pair", "uart_bench", work, UART, text)
    elif check == "mavlink":
        environment = {"HIDDEN_AXES": "", "DIGEST": digest(built)}
        _run(folder, "hk_mavlink_tx", "mavlink_bench", work, {}, environment)
    else:
        clock = {"CLOCK_HZ": 1_843_200}
        _run(folder, "hk_stopwatch", "stopwatch_bench", work, clock, {"CLOCK_HZ": "1843200"})


def _run(
    folder: Path,
    entity: str,
    bench: str,
    work: Path,
    generics: dict[str, int],
    environment: dict[str, str],
) -> None:
    """Run a bench on what an entity needs, and nothing else of the folder."""
    few = work / "sources"
    few.mkdir(parents=True)
    for name in needed_sources(folder, entity):
        shutil.copy(folder / name, few)
    try:
        run_bench(few, entity, bench, build=work, parameters=generics, environment=environment)
    except SystemExit as error:
        raise AssertionError(f"{bench} fails") from error


def _check(folder: Path, work: Path, check: str) -> None:
    built = DESIGNS.get(check, design())
    if check == "handshake":
        _handshake(folder, work)
    elif check == "functions":
        _functions(folder, work)
    elif check in {"uart", "mavlink", "stopwatch"}:
        _bench(folder, work, check, built)
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


@pytest.mark.parametrize("check", sorted({m.check for m in MUTATIONS} - {"handshake"}))
def test_without_a_fault_nothing_is_found(
    check: str, rendered: Callable[[FilterDesign], Path], tmp_path: Path
) -> None:
    built = DESIGNS.get(check, design())
    folder = shutil.copytree(rendered(built), tmp_path / "core")
    _check(folder, tmp_path / "work", check)


def test_there_are_enough_faults() -> None:
    names = Counter((m.check, m.name) for m in MUTATIONS)
    assert max(names.values()) == 1
    assert len(MUTATIONS) >= 30
