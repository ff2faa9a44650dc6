"""The FPGA system around a filter whose state does not fit into TILT_SAMPLE."""

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import long_state
import numpy as np
import pytest
from cocotb_run import run_bench
from hdl_cases import count_vectors
from recorded import swept

from hostkit.design_file import digest
from hostkit.emulation import ghdl
from hostkit.emulation.fpga_system import emulate_system, table_of, timing_of
from hostkit.emulation.system_bench import build_system, run_system
from hostkit.emulation.tools import require
from hostkit.errors import EmulationError, RenderError, ToolMissingError
from hostkit.link.frames.decoder import Decoder
from hostkit.records import FilterDesign
from hostkit.render import FpgaOptions, render_target, write
from hostkit.render.context import render_context
from hostkit.synthesis.convert import convert
from hostkit.synthesis.netlist import play
from hostkit.targets import TARGETS

TARGET = TARGETS["spartan3adsp"]
ACCEL, GYRO = (counts[:120] for counts in count_vectors())
DESIGN = long_state.design()
SPEC = long_state.lower(DESIGN)


@pytest.fixture(scope="module", autouse=True)
def _stand_in(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    with pytest.MonkeyPatch.context() as monkeypatch:
        long_state.register(monkeypatch, tmp_path_factory.mktemp("templates"))
        yield


def built(source: FilterDesign, folder: Path) -> Path:
    write(render_target(source, TARGET), folder)
    return folder


@pytest.fixture(scope="module")
def core(tmp_path_factory: pytest.TempPathFactory, ghdl_installed: None, _stand_in: None) -> Path:
    folder = built(DESIGN, tmp_path_factory.mktemp("core"))
    ghdl.analyse(folder)
    return folder


@pytest.mark.parametrize("random_stalls", [False, True])
def test_every_word_of_the_state_is_read(core: Path, random_stalls: bool) -> None:
    run = ghdl.simulate(core, ACCEL, GYRO, random_stalls=random_stalls)
    wanted = long_state.run_integer(SPEC, ACCEL, GYRO)
    np.testing.assert_array_equal(run.state_raw(SPEC), wanted)
    assert run.design_digest == digest(DESIGN)
    assert set(run.latency_cycles) == {18}


def test_settings_are_taken_over_between_samples(core: Path) -> None:
    other = replace(SPEC, gain=5, limit=65535)
    run = ghdl.simulate(core, ACCEL, GYRO, settings={50: ghdl.hdl_settings(DESIGN, other)})
    wanted = long_state.run_integer(SPEC, ACCEL[:50], GYRO[:50])
    more = long_state.run_integer(other, ACCEL[50:], GYRO[50:], wanted[-1])
    np.testing.assert_array_equal(run.state_raw(SPEC), np.vstack([wanted, more]))


def test_a_core_that_is_late_with_a_word_is_found(tmp_path: Path, ghdl_installed: None) -> None:
    folder = built(DESIGN, tmp_path)
    source = folder / "hk_stand_in.vhd"
    text = source.read_text(encoding="ascii")
    late = text.replace("    <= word_r;", "    <= word_r after 11 ns;")
    assert late != text
    source.write_text(late, encoding="ascii")
    ghdl.analyse(folder)
    with pytest.raises(EmulationError, match="the core gives an unknown value"):
        ghdl.simulate(folder, ACCEL, GYRO)


@pytest.mark.parametrize("stalls", [False, True])
def test_converted_verilog_shows_every_word(core: Path, stalls: bool) -> None:
    try:
        require("iverilog")
    except ToolMissingError as error:
        pytest.skip(str(error))
    played = np.hstack([np.zeros((len(ACCEL), 1), dtype=np.int64), ACCEL, GYRO])
    verilog = convert(core, "hk_stand_in_fixed").text
    run = play(verilog, played, SPEC, stalls=stalls, mapped=False)
    np.testing.assert_array_equal(run.state_raw, long_state.run_integer(SPEC, ACCEL, GYRO))
    assert set(run.latency_cycles) == {18}


@pytest.mark.parametrize("words", long_state.RATES_HZ)
def test_state_frames_are_those_of_pymavlink(
    tmp_path: Path, ghdl_installed: None, words: int
) -> None:
    source = long_state.design(words)
    tests = run_bench(
        built(source, tmp_path / "core"),
        "hk_mavlink_tx",
        "state_bench",
        build=tmp_path / "build",
        environment={
            "DIGEST": digest(source),
            "IDENTITY": "1 1 0 0",
            "WORDS": str(words),
            "HIDDEN_AXES": "",
        },
    )
    assert tests == 5


def test_the_system_tells_the_state_once_a_second(tmp_path: Path, ghdl_installed: None) -> None:
    folder = built(DESIGN, tmp_path)
    build_system(folder)
    recording = swept(DESIGN)
    result = emulate_system(folder, TARGET, DESIGN, recording, samples=45)
    assert (result.samples, result.missing, result.mismatches) == (45, 0, 0)
    assert result.states_told == 2

    _, table = table_of(DESIGN, recording, 45)
    frames = Decoder().feed(run_system(folder, table, timing_of(DESIGN)).stream)
    told = [i for i, frame in enumerate(frames) if frame.name == "TILT_STATE"]
    assert [frames[i - 1].name for i in told] == ["TILT_SAMPLE"] * 2
    sequences = [frames[i].message.sequence for i in told]
    assert sequences == [frames[i - 1].message.sequence for i in told]
    assert np.diff(sequences) == [25]


@pytest.mark.parametrize("bus", ["axi4lite", "wishbone"])
def test_the_system_with_registers_is_valid(tmp_path: Path, ghdl_installed: None, bus: str) -> None:
    write(render_target(DESIGN, TARGET, FpgaOptions(bus=bus)), tmp_path)
    assert "hk_regs" in ghdl.analyse(tmp_path, top="hk_system")
    text = (tmp_path / "hk_regs.h").read_text(encoding="ascii")
    assert "#define HK_REGS_LIMIT_OFFSET 0x48U" in text
    assert "BIAS" not in text


@pytest.mark.parametrize(
    ("options", "says"),
    [
        (FpgaOptions(pipelined=True), "the core of the stand-in takes one sample at a time"),
        (FpgaOptions(channels=2), "channels = 2: the core of the stand-in serves 1 at most"),
    ],
)
def test_options_of_another_core_are_refused(options: FpgaOptions, says: str) -> None:
    with pytest.raises(RenderError, match=says):
        render_target(DESIGN, TARGET, options)


def test_a_filter_without_a_core_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    bare = replace(long_state.STAND_IN, core=None)
    monkeypatch.setitem(long_state.FILTERS._parts, long_state.NAME, bare)
    with pytest.raises(RenderError, match=r"the stand-in has no VHDL core; .*: complementary"):
        render_target(DESIGN, TARGET)


@pytest.mark.parametrize(
    ("rate_hz", "baud"),
    [(25.0, 115_200), (1000.0 / 6, 230_400), (500.0, 460_800), (1000.0, 2_000_000)],
)
def test_no_sample_is_lost_while_a_state_is_sent(
    monkeypatch: pytest.MonkeyPatch, rate_hz: float, baud: int
) -> None:
    """Twice the time between samples is longer than both frames and a reading of the sensor."""
    monkeypatch.setitem(long_state.RATES_HZ, 17, rate_hz)
    fpga = render_context(long_state.design(), TARGET).fpga
    assert fpga.baud == baud
    assert 10 * (55 + 84) / baud + 0.75e-3 < 2 / rate_hz


def test_the_line_has_room_for_the_state() -> None:
    files = {file.path: file.content for file in render_target(DESIGN, TARGET)}
    assert "| frame of the state, once a second | 84 bytes |" in files["README.md"]
    assert "roll and pitch from nothing but sums" in files["README.md"]
