from pathlib import Path

import numpy as np
import pytest
from designs import all_parameters, design
from hdl_cases import (
    Core,
    answer,
    build_broken_core,
    count_vectors,
    design_name,
    option_designs,
    option_vectors,
    varied_designs,
)

from hostkit.design_file import digest
from hostkit.emulation import ghdl
from hostkit.errors import EmulationError
from hostkit.filters.arctan import arctan_table, atan2_count
from hostkit.filters.complementary import lower, run_integer
from hostkit.records import FilterDesign
from hostkit.synthesis.convert import convert

ACCEL, GYRO = count_vectors()
CORE = "hk_complementary_iterative.vhd"
SILENT = "nothing has come out for 1000 clocks"
GREEDY = "takes a sample while a result waits"
LATENCY_CYCLES = {
    ("atan2", "roll"): 30,
    ("atan2", "pitch"): 54,
    ("atan2", "both"): 54,
    ("arcsin", "roll"): 57,
    ("arcsin", "pitch"): 58,
    ("arcsin", "both"): 82,
}


def latency_cycles(design: FilterDesign) -> int:
    """An integral costs a clock."""
    base = LATENCY_CYCLES[design.tilt, design.axes]
    return base if lower(design).integral is None else base + 1


each_design = pytest.mark.parametrize("core", varied_designs(), ids=design_name, indirect=True)
each_option = pytest.mark.parametrize("core", option_designs(), ids=design_name, indirect=True)
both_methods = pytest.mark.parametrize(
    "core",
    [design(), design(tilt="arcsin"), all_parameters()],
    ids=design_name,
    indirect=True,
)


def test_the_designs_cover_every_axis_choice_and_method() -> None:
    covered = {(design.tilt, design.axes) for design in varied_designs()}
    assert covered == set(LATENCY_CYCLES)


@each_design
def test_the_core_equals_the_integer_model(core: Core) -> None:
    run = ghdl.simulate(core.folder, ACCEL, GYRO)
    np.testing.assert_array_equal(answer(run), core.expected(ACCEL, GYRO))
    assert run.restarted.tolist() == [True] + [False] * (len(ACCEL) - 1)
    counts = np.hstack([ACCEL, GYRO])
    np.testing.assert_array_equal(run.saturated, (np.abs(counts) >= 32767).any(axis=1))
    assert set(np.diff(run.taken_cycle)) == {run.latency_cycles[0] + 1}
    assert set(run.latency_cycles) == {LATENCY_CYCLES[core.design.tilt, core.design.axes]}
    assert run.design_digest == digest(core.design)


@each_design
def test_the_core_equals_the_integer_model_with_random_stalls(core: Core) -> None:
    run = ghdl.simulate(core.folder, ACCEL, GYRO, random_stalls=True)
    np.testing.assert_array_equal(answer(run), core.expected(ACCEL, GYRO))
    assert set(run.latency_cycles) == {LATENCY_CYCLES[core.design.tilt, core.design.axes]}


@each_option
@pytest.mark.parametrize("random_stalls", [False, True])
def test_every_parameter_equals_the_integer_model(core: Core, random_stalls: bool) -> None:
    accel, gyro = option_vectors(core.design)
    run = ghdl.simulate(core.folder, accel, gyro, random_stalls=random_stalls)
    np.testing.assert_array_equal(answer(run), core.expected(accel, gyro))
    assert set(run.latency_cycles) == {latency_cycles(core.design)}


def test_the_option_designs_reach_the_limit_of_the_bias_and_both_sides_of_the_gate() -> None:
    for option in option_designs():
        spec, accel = lower(option), option_vectors(option)[0]
        if spec.gate is not None:
            squares = (accel**2).sum(axis=1)
            assert (squares == spec.gate.lowest).any() or (squares == spec.gate.highest).any()
            assert ((squares < spec.gate.lowest) | (squares > spec.gate.highest)).any()
    hits = [option for option in option_designs() if _meets_the_limit(option)]
    assert {option.tilt for option in hits} == {"atan2", "arcsin"}


def _meets_the_limit(option: FilterDesign) -> bool:
    spec = lower(option)
    if spec.integral is None:
        return False
    state = run_integer(spec, *option_vectors(option))
    return bool((np.abs(state[:, len(spec.axes) :]) == spec.integral.limit_raw).any())


@both_methods
def test_a_reset_in_any_state_starts_over(core: Core) -> None:
    accel, gyro = ACCEL[200:203], GYRO[200:203]
    expected = core.expected(accel, gyro)
    for clocks in range(1, latency_cycles(core.design) + 4):
        run = ghdl.simulate(core.folder, accel, gyro, abandon_clocks=clocks)
        np.testing.assert_array_equal(answer(run), expected, err_msg=f"{clocks} clocks")
        assert run.restarted.tolist() == [True, False, False]


@both_methods
def test_the_core_converts_for_synthesis(core: Core) -> None:
    converted = convert(core.folder, "hk_complementary_fixed")
    assert converted.products == 1
    # What GHDL 2.0 writes wrongly: a case loses its default, a signed shift its sign, and a
    # constant of more than 32 bits becomes a text.
    for wrong in ('"', "case", ">>"):
        assert wrong not in converted.text


@pytest.mark.usefixtures("ghdl_installed")
@pytest.mark.parametrize(
    ("source", "good", "bad"),
    [
        ("hk_complementary_design_pkg.vhd", "to_signed(117441, 18)", "to_signed(117440, 18)"),
        ("hk_design_pkg.vhd", "to_signed(41719, 18)", "to_signed(41718, 18)"),
        ("hk_common_pkg.vhd", "(b & carry)", "(b & '0')"),
        ("hk_arctan.vhd", "if nothing_r = '1' then", "if false then"),
    ],
    ids=["blend", "slope", "rounding", "zero vector"],
)
def test_one_wrong_bit_is_found(tmp_path: Path, source: str, good: str, bad: str) -> None:
    core = build_broken_core(tmp_path, source=source, good=good, bad=bad)
    run = ghdl.simulate(core.folder, ACCEL, GYRO)
    assert np.any(answer(run) != core.expected(ACCEL, GYRO))


@pytest.mark.usefixtures("ghdl_installed")
@pytest.mark.parametrize(
    ("source", "good", "bad"),
    [
        ("hk_design_pkg.vhd", " 10679838,", " 10679839,"),
        ("hk_design_pkg.vhd", " 531488619", " 531488618"),
        ("hk_design_pkg.vhd", " 32,", " 33,"),
        ("hk_design_pkg.vhd", " 105699", " 105698"),
        ("hk_arctan.vhd", "elsif count_r(8)", "elsif count_r(7)"),
        (
            "hk_arctan.vhd",
            "steep_r <= trial(32);",
            "steep_r <= trial(32); if trial = 0 then steep_r <= '1'; end if;",
        ),
        ("hk_arctan.vhd", "steep_r and below_r", "steep_r and behind_r"),
    ],
)
def test_a_fault_in_the_arc_tangent_is_found(
    tmp_path: Path, source: str, good: str, bad: str
) -> None:
    """With eta near zero a core says what it measured, to the last bit."""
    built = design(eta=0.001)
    core = build_broken_core(tmp_path, source=source, good=good, bad=bad, built=built)
    run = ghdl.simulate(core.folder, ACCEL, GYRO)
    assert np.any(answer(run) != core.expected(ACCEL, GYRO))


def test_the_vectors_reach_every_turn_of_the_arc_tangent() -> None:
    table = arctan_table()
    stretches = atan2_count(table, ACCEL[:, 1], ACCEL[:, 2])[2]
    assert set(stretches.tolist()) == set(table.stretches_raw)


@pytest.mark.usefixtures("ghdl_installed")
@pytest.mark.parametrize(
    ("source", "good", "bad"),
    [
        (
            "hk_complementary_design_pkg.vhd",
            "gate_lowest_c  : unsigned(31 downto 0) := to_unsigned(2174",
            "1",
        ),
        (CORE, "square_r <= settings.gate_highest", "square_r < settings.gate_highest"),
        (CORE, "and stored_started = '0' then", "and false then"),
        ("hk_complementary_pkg.vhd", "return bias_limit_c", "return bias"),
        ("hk_complementary_pkg.vhd", "return -bias_limit_c", "return bias"),
        ("hk_arctan.vhd", "quarters_v - zero", "quarters_v + zero"),
        (CORE, "bias_next_r <= settings.gyro_bias_pitch", "bias_next_r <= settings.gyro_bias_roll"),
        (CORE, "(step_r(first_force_c + 2) or", "("),
    ],
)
def test_a_fault_in_the_options_is_found(tmp_path: Path, source: str, good: str, bad: str) -> None:
    bad = good.replace("2174", "2175") if bad == "1" else bad
    built = all_parameters()
    core = build_broken_core(tmp_path, source=source, good=good, bad=bad, built=built)
    accel, gyro = option_vectors(built)
    run = ghdl.simulate(core.folder, accel, gyro)
    assert np.any(answer(run) != core.expected(accel, gyro))


@pytest.mark.usefixtures("ghdl_installed")
@pytest.mark.parametrize(
    ("good", "bad", "complaint"),
    [
        ("if arctan_done = '1' then", "if false then", SILENT),
        ("in_ready    <= '1' when state_r = idle else '0'", "in_ready <= '1'", GREEDY),
        ("if out_ready = '1' then", "if true then", "takes back a result"),
        ("busy        <= '0' when state_r = idle else '1'", "busy <= '0'", "is not busy"),
        ("busy        <= '0' when state_r = idle else '1'", "busy <= '1'", "and is busy"),
    ],
    ids=["silent", "greedy", "impatient", "never busy", "always busy"],
)
def test_a_broken_handshake_is_found(tmp_path: Path, good: str, bad: str, complaint: str) -> None:
    core = build_broken_core(tmp_path, source=CORE, good=good, bad=bad)
    with pytest.raises(EmulationError, match=complaint):
        ghdl.simulate(core.folder, ACCEL, GYRO, random_stalls=True)
