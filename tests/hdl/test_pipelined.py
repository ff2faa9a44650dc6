"""The pipelined core of the filter against the integer model, channel by channel."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from cocotb_run import run_bench
from designs import all_parameters, design
from hdl_cases import (
    Core,
    IntArray,
    answer,
    build_broken_core,
    count_vectors,
    design_name,
    option_designs,
    option_vectors,
    varied_designs,
)

from hostkit.emulation import ghdl
from hostkit.emulation.ghdl import HdlRun
from hostkit.emulation.hdl_vectors import hdl_settings
from hostkit.errors import EmulationError
from hostkit.filters.complementary import lower, step_integer
from hostkit.filters.complementary.core import clocks
from hostkit.filters.core import Latency
from hostkit.records import FilterDesign
from hostkit.render import render_target, write
from hostkit.targets import TARGETS

ACCEL, GYRO = count_vectors()
ENOUGH = 12
"""Channels with which no sample meets the one before it."""


def latency(varied: FilterDesign) -> Latency:
    return clocks(lower(varied), pipelined=True)


def expected(core: Core, channel: IntArray, accel: IntArray, gyro: IntArray) -> IntArray:
    states = np.zeros((len(accel), 4), dtype=np.int64)
    for each in set(channel.tolist()):
        states[channel == each] = core.expected(accel[channel == each], gyro[channel == each])
    return states


def run_and_compare(
    core: Core, channel: IntArray, channels: int, *, random_stalls: bool = False
) -> HdlRun:
    accel, gyro = vectors(core.design, len(channel))
    run = ghdl.simulate(
        core.folder,
        accel,
        gyro,
        channel=channel,
        channels=channels,
        pipelined=True,
        random_stalls=random_stalls,
    )
    np.testing.assert_array_equal(answer(run), expected(core, channel, accel, gyro))
    np.testing.assert_array_equal(run.channel, channel)
    counts = np.hstack([accel, gyro])
    np.testing.assert_array_equal(run.saturated, (np.abs(counts) >= 32767).any(axis=1))
    first = np.zeros(len(channel), dtype=bool)
    first[np.unique(channel, return_index=True)[1]] = True
    np.testing.assert_array_equal(run.restarted, first)
    return run


def vectors(varied: FilterDesign, samples: int) -> tuple[IntArray, IntArray]:
    accel, gyro = option_vectors(varied) if len(varied.parameters) > 1 else (ACCEL, GYRO)
    return accel[:samples], gyro[:samples]


def round_robin(varied: FilterDesign, channels: int) -> IntArray:
    return np.arange(len(vectors(varied, 2**20)[0])) % channels


# Both methods with every choice of axes, and parameters of every kind.
CHOSEN = (*varied_designs()[18:24], option_designs()[2], option_designs()[3])
each_design = pytest.mark.parametrize("core", CHOSEN, ids=design_name, indirect=True)
three_designs = pytest.mark.parametrize(
    "core",
    [design(), design(tilt="arcsin"), all_parameters()],
    ids=design_name,
    indirect=True,
)


def test_the_chosen_designs_cover_every_axis_choice_and_method() -> None:
    assert {(varied.tilt, varied.axes) for varied in CHOSEN} == {
        (tilt, axes) for tilt in ("atan2", "arcsin") for axes in ("roll", "pitch", "both")
    }


@each_design
def test_with_many_channels_there_is_a_result_a_clock(core: Core) -> None:
    channel = round_robin(core.design, ENOUGH)
    run = run_and_compare(core, channel, ENOUGH)
    assert set(np.diff(run.taken_cycle)) == {1}
    assert set(run.latency_cycles) == {latency(core.design).latency}


@three_designs
def test_samples_of_one_channel_wait_for_each_other(core: Core) -> None:
    channel = np.zeros(250, dtype=np.int64)
    run = run_and_compare(core, channel, 1)
    # The first two go into the two places of the entry at once.
    assert set(np.diff(run.taken_cycle)[2:]) == {latency(core.design).channel_interval}


@three_designs
def test_any_order_of_channels_is_safe(core: Core) -> None:
    channel = np.random.default_rng(6).integers(0, 5, 600)
    run_and_compare(core, channel, 5)
    run_and_compare(core, channel[:120], 5, random_stalls=True)


@pytest.mark.parametrize("core", [all_parameters()], ids=design_name, indirect=True)
def test_the_last_of_1024_channels_is_a_filter_of_its_own(core: Core) -> None:
    channel = np.random.default_rng(6).choice([0, 1, 511, 512, 1022, 1023], 300)
    run_and_compare(core, channel, 1024)


@three_designs
def test_a_reset_in_the_middle_starts_over(core: Core) -> None:
    accel, gyro = ACCEL[200:203], GYRO[200:203]
    for after in (1, 3, 20, 62, 68, 71, 75, 90):
        run = ghdl.simulate(core.folder, accel, gyro, pipelined=True, abandon_clocks=after)
        np.testing.assert_array_equal(answer(run), core.expected(accel, gyro))
        assert run.restarted.tolist() == [True, False, False]


@pytest.mark.parametrize("core", [all_parameters()], ids=design_name, indirect=True)
def test_settings_may_change_between_samples(core: Core) -> None:
    own = lower(core.design)
    changed = replace(
        own,
        blend=replace(own.blend, raw=own.blend.raw // 3),
        tilt_offset_raw=(12345, -54321),
        rate_gains=tuple(replace(gain, raw=gain.raw - 999) for gain in own.rate_gains),
        integral=replace(own.integral, gain=replace(own.integral.gain, raw=4321)),
        gate=replace(own.gate, lowest=own.gate.lowest + 5, highest=own.gate.highest // 2 * 3),
    )
    accel, gyro = vectors(core.design, 2**20)
    accel, gyro = accel[-200:], gyro[-200:]
    run = ghdl.simulate(
        core.folder, accel, gyro, pipelined=True, settings={80: hdl_settings(core.design, changed)}
    )
    state = core.expected(accel[:80], gyro[:80])
    for i in range(80, len(accel)):
        state = np.vstack([state, step_integer(changed, state[-1:], accel[[i]], gyro[[i]])])
    np.testing.assert_array_equal(answer(run), state)


@pytest.mark.usefixtures("ghdl_installed")
def test_a_resting_consumer_loses_nothing(tmp_path: Path) -> None:
    write(render_target(all_parameters(), TARGETS["spartan3adsp"]), tmp_path / "core")
    run_bench(
        tmp_path / "core",
        "hk_complementary_fixed",
        "pipelined_bench",
        build=tmp_path / "build",
        parameters={"CHANNELS": 16, "PIPELINED": "true"},
        ieee_asserts="disable",
    )


@pytest.mark.usefixtures("ghdl_installed")
@pytest.mark.parametrize(
    ("source", "good", "bad", "channels"),
    [
        ("hk_pipelined_pkg.vhd", "return loop_clocks + 1", "return loop_clocks", 1),
        ("hk_complementary_entry.vhd", "second_v := '1'", "null", 1),
        ("hk_complementary_loop.vhd", "<= not clear", "<= '1'", ENOUGH),
        ("hk_arctan_pipelined.vhd", "if rest_r(summed_c)(32) = '1'", "if false", ENOUGH),
        ("hk_root_pipelined.vhd", '& "11"', '& "01"', ENOUGH),
    ],
)
def test_a_fault_is_found(tmp_path: Path, source: str, good: str, bad: str, channels: int) -> None:
    built = design(tilt="arcsin")
    core = build_broken_core(tmp_path, source=source, good=good, bad=bad, built=built)
    with pytest.raises((AssertionError, EmulationError)):
        run_and_compare(core, round_robin(built, channels)[:300], channels)
