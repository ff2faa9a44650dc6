"""The observer's VHDL core against its integer model, bit for bit."""

from pathlib import Path

import numpy as np
import pytest
from observer_cases import (
    REST,
    START,
    build,
    count_vectors,
    design,
    design_name,
    lead,
    varied_designs,
)

from hostkit.design_file import digest
from hostkit.emulation import ghdl
from hostkit.emulation.fpga_system import SHORTEST_US
from hostkit.emulation.system_bench import DRAIN_US, SystemTiming
from hostkit.emulation.tools import require
from hostkit.errors import RenderError, ToolMissingError
from hostkit.filters.observer import lower, parameter, run_integer
from hostkit.filters.observer.core import clocks
from hostkit.records import FilterDesign
from hostkit.render import FpgaOptions, render_target
from hostkit.synthesis import convert, map_netlist
from hostkit.synthesis.netlist import play
from hostkit.targets import TARGETS

pytestmark = pytest.mark.usefixtures("ghdl_installed")

PROGRAM = "hk_observer_program_pkg.vhd"
FULL = design(*REST, *START, *lead(0.004), rate_hz=25.0)
BUDGET = {"lut": 1500, "dsp": 2, "block_ram": 4}


@pytest.mark.parametrize("varied", varied_designs(), ids=design_name)
def test_the_core_equals_the_integer_model(tmp_path: Path, varied: FilterDesign) -> None:
    spec = lower(varied)
    accel, gyro = count_vectors(spec.rest is not None)
    folder = build(varied, tmp_path)
    ghdl.analyse(folder)
    run = ghdl.simulate(folder, accel, gyro, random_stalls=True)
    expected = run_integer(spec, accel, gyro)
    np.testing.assert_array_equal(run.state_raw(spec), expected)
    assert run.design_digest == digest(varied)
    assert set(run.latency_cycles[1:]) == {clocks(spec).latency}
    assert run.latency_cycles[0] < clocks(spec).latency
    assert run.restarted.tolist() == [True] + [False] * (len(accel) - 1)
    ends = np.isin(np.hstack([accel, gyro]), (-32768, -32767, 32767)).any(axis=1)
    np.testing.assert_array_equal(run.saturated, ends)
    absent = [column for axis, column in ghdl.COLUMN.items() if axis not in spec.axes]
    assert not run.angle_raw[:, absent].any()
    if spec.rest is not None:
        still, rested = expected[:, -2], expected[:, -1]
        assert still.max() == spec.rest_samples
        assert rested.max() == 1
        assert still.min() == 0


@pytest.fixture(scope="module")
def core(tmp_path_factory: pytest.TempPathFactory, ghdl_installed: None) -> Path:
    folder = build(FULL, tmp_path_factory.mktemp("observer"))
    ghdl.analyse(folder)
    return folder


@pytest.mark.parametrize("abandon_clocks", [1, 3, 200, 380, 405, 412])
def test_a_reset_forgets_the_sample_in_work(core: Path, abandon_clocks: int) -> None:
    accel, gyro = (counts[-4:] for counts in count_vectors())
    run = ghdl.simulate(core, accel, gyro, abandon_clocks=abandon_clocks)
    np.testing.assert_array_equal(run.state_raw(lower(FULL)), run_integer(lower(FULL), accel, gyro))


def test_settings_are_taken_over_between_samples(core: Path) -> None:
    accel, gyro = (counts[-12:] for counts in count_vectors())
    changed = design(
        *(*REST, *START, *lead(0.004), parameter("kt", 0.5), parameter("kv", 3.0)),
        *(parameter("kb", 0.05), parameter("gyro_bias", 0.1, "y")),
        rate_hz=25.0,
    )
    spec, other = lower(FULL), lower(changed)
    run = ghdl.simulate(core, accel, gyro, settings={5: ghdl.hdl_settings(changed, other)})
    before = run_integer(spec, accel[:5], gyro[:5])
    after = run_integer(other, accel[5:], gyro[5:], before[-1])
    np.testing.assert_array_equal(run.state_raw(spec), np.vstack([before, after]))


@pytest.mark.parametrize(
    ("source", "good", "bad"),
    [
        (PROGRAM, "plus(q_0, sine_y),", "less(q_0, sine_y),"),
        (PROGRAM, "less(rested, mode => test)", "plus(rested, mode => test)"),
        (
            "hk_sequence_pkg.vhd",
            "result_clocks_c : positive := 6",
            "result_clocks_c : positive := 5",
        ),
        ("hk_sequencer.vhd", "& steps_r(accumulate_c).minus);", "& '0');"),
        (
            "hk_observer_design_pkg.vhd",
            "half_per_g_c : integer := 175",
            "half_per_g_c : integer := 174",
        ),
    ],
    ids=["a sign", "the first rest", "a result too early", "a carry", "a constant"],
)
def test_a_fault_is_found(tmp_path: Path, source: str, good: str, bad: str) -> None:
    folder = build(FULL, tmp_path)
    text = (folder / source).read_text(encoding="ascii")
    assert good in text
    (folder / source).write_text(text.replace(good, bad), encoding="ascii")
    ghdl.analyse(folder)
    accel, gyro = (counts[:60] for counts in count_vectors())
    run = ghdl.simulate(folder, accel, gyro)
    assert np.any(run.state_raw(lower(FULL)) != run_integer(lower(FULL), accel, gyro))


def test_it_fits_and_its_gates_equal_the_integer_model(tmp_path: Path) -> None:
    try:
        require("yosys", "iverilog")
    except ToolMissingError as error:
        pytest.skip(str(error))
    mapped = map_netlist(
        convert(build(FULL, tmp_path), "hk_observer_fixed"), "xc3sda", dsp=BUDGET["dsp"]
    )
    assert mapped.resources.lut <= BUDGET["lut"]
    assert mapped.resources.block_ram <= BUDGET["block_ram"]
    accel, gyro = (counts[60:64] for counts in count_vectors())
    played = np.hstack([np.zeros((len(accel), 1), dtype=np.int64), accel, gyro])
    run = play(mapped.netlist, played, lower(FULL))
    np.testing.assert_array_equal(run.state_raw, run_integer(lower(FULL), accel, gyro))


@pytest.mark.parametrize("options", [FpgaOptions(pipelined=True), FpgaOptions(channels=2)])
def test_it_serves_one_sensor_one_sample_at_a_time(options: FpgaOptions) -> None:
    with pytest.raises(RenderError, match=r"pipelined|channels"):
        render_target(FULL, TARGETS["spartan3adsp"], options)


def test_the_bench_of_the_system_waits_for_the_last_sample() -> None:
    timing = SystemTiming()
    slowest = max(clocks(lower(varied)).latency for varied in varied_designs())
    frames_bytes = 2 * (12 + 4 + 4 * 24)  # a state, a sample and a heartbeat are less
    taken_us = SHORTEST_US + 1e6 * slowest / timing.clock_hz + 1e7 * frames_bytes / timing.baud
    assert taken_us < DRAIN_US
