"""Properties that hold for every input, proved on the converted VHDL."""

import shutil
from pathlib import Path

import pytest
from designs import all_parameters, design
from formal.bounds import CASES, COMMAND_CLOCKS
from formal.prove import FOLDER, Verdict, prove, read_verdict
from gate_cases import generate
from mutation_checks import proof, verdict_of

from hostkit.emulation.tools import require
from hostkit.errors import ToolMissingError
from hostkit.synthesis import convert

ROOT = {"INTEGER_BITS": 15, "FRACTION_BITS": 8}
ROOT_CLOCKS = 24
SMALL_ROOT = {"INTEGER_BITS": 3, "FRACTION_BITS": 2}
NARROW = {"DIFFERENCE_BITS": 12, "BLEND_BITS": 8}


@pytest.fixture(autouse=True)
def _tools() -> None:
    try:
        require("ghdl", "yosys")
    except ToolMissingError as error:
        pytest.skip(str(error))


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    made = generate(all_parameters(), tmp_path_factory.mktemp("core"))
    shutil.copy(FOLDER / "functions.vhd", made)
    return made


@pytest.fixture(scope="module")
def plain(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return generate(design(), tmp_path_factory.mktemp("plain"))


def latency(folder: Path, clocks: int, work: Path) -> Verdict:
    core = convert(folder, "hk_complementary").text
    return prove(core, "complementary", work, {"LATENCY": clocks})


def test_the_root_keeps_the_handshake(folder: Path, tmp_path: Path) -> None:
    core = convert(folder, "hk_root", ROOT).text
    assert prove(core, "root", tmp_path / "a", {"LATENCY": ROOT_CLOCKS}).proved
    too_tight = prove(core, "root", tmp_path / "b", {"LATENCY": ROOT_CLOCKS - 1})
    assert too_tight == Verdict(proved=False, frame=ROOT_CLOCKS + 1)


def test_a_small_root_is_the_floor(folder: Path, tmp_path: Path) -> None:
    core = convert(folder, "hk_root", SMALL_ROOT).text
    assert prove(core, "root_value", tmp_path / "a", free_products=False).proved
    worse = core.replace(">=", ">", 1)
    assert worse != core
    assert not prove(worse, "root_value", tmp_path / "b", free_products=False).proved


def test_the_arithmetic_stays_within_its_bounds(folder: Path, tmp_path: Path) -> None:
    core = convert(folder, "functions", NARROW).text
    assert prove(core, "functions", tmp_path, NARROW, free_products=False).proved


@pytest.mark.parametrize(
    ("good", "bad"),
    [
        ("result_v := result_v + 1;", "null;"),
        ("product(bits - 1) = '1'", "product(bits) = '1'"),
        ("count > limit then", "count >= 0 then"),
        ("size_v := -count;", "size_v := not count;"),
    ],
)
def test_wrong_arithmetic_is_refuted(folder: Path, tmp_path: Path, good: str, bad: str) -> None:
    wrong = shutil.copytree(folder, tmp_path / "wrong")
    source = wrong / "hk_common_pkg.vhd"
    text = source.read_text(encoding="ascii")
    assert text.count(good) == 1
    source.write_text(text.replace(good, bad), encoding="ascii")
    core = convert(wrong, "functions", NARROW).text
    assert not prove(core, "functions", tmp_path / "work", NARROW, free_products=False).proved


def test_one_channel_keeps_the_handshake(folder: Path, tmp_path: Path) -> None:
    """Every parameter in the design; the bound is the latency itself."""
    assert latency(folder, 55, tmp_path / "a").proved
    assert not latency(folder, 54, tmp_path / "b").proved


def test_several_channels_keep_the_handshake(plain: Path, tmp_path: Path) -> None:
    core = convert(plain, "hk_complementary", {"CHANNELS": 4}).text
    assert prove(core, "complementary", tmp_path, {"LATENCY": 54, "CHANNEL": 2, "IDLE": 5}).proved


@pytest.mark.parametrize("block", sorted(CASES))
def test_a_block_around_the_filter_keeps_its_promises(
    plain: Path, tmp_path: Path, block: str
) -> None:
    proof(plain, tmp_path, block)


@pytest.mark.parametrize(
    ("block", "tight", "frame"),
    [
        ("transmitter", {"BUSY": 39}, 45),
        ("bus master", {"BOUND": COMMAND_CLOCKS - 1}, 2),
        ("axi4lite", {"READ": 4}, 8),
        ("axi4lite", {"WRITE": 5}, 8),
        ("wishbone", {"BOUND": 2}, 6),
        ("queue", {"MOST": 5}, None),
    ],
)
def test_a_bound_that_is_too_tight_is_refuted(
    plain: Path, tmp_path: Path, block: str, tight: dict[str, int], frame: int | None
) -> None:
    verdict = verdict_of(plain, tmp_path, block, tight)
    assert not verdict.proved
    assert verdict.frame == frame or frame is None


def test_the_verdict_is_read_from_the_text() -> None:
    assert read_verdict("Property proved.  Time = 2.5 sec").proved
    assert read_verdict("Output 3 of miter was asserted in frame 7.").frame == 7
    held = "No output asserted in 3 frames. "
    assert read_verdict(held + "Networks are equivalent.").proved
    assert read_verdict(held + "Networks are UNDECIDED.") == Verdict(proved=False)
    for said in ("Property UNDECIDED.", "Networks are equivalent.", held):
        with pytest.raises(AssertionError):
            read_verdict(said)
