import subprocess
from pathlib import Path

import numpy as np
import pytest
from designs import design
from hdl_cases import (
    Core,
    build_broken_core,
    count_vectors,
    design_name,
    varied_designs,
)

from hostkit.design_file import digest
from hostkit.emulation import ghdl
from hostkit.errors import EmulationError

ACCEL, GYRO = count_vectors()
LATENCY_CYCLES = {
    ("atan2", "roll"): 26,
    ("atan2", "pitch"): 48,
    ("atan2", "both"): 48,
    ("arcsin", "roll"): 53,
    ("arcsin", "pitch"): 54,
    ("arcsin", "both"): 78,
}
each_design = pytest.mark.parametrize("core", varied_designs(), ids=design_name, indirect=True)
both_methods = pytest.mark.parametrize(
    "core", [design(), design(tilt="arcsin")], ids=design_name, indirect=True
)


def test_the_designs_cover_every_axis_choice_and_method() -> None:
    covered = {(design.tilt, design.axes) for design in varied_designs()}
    assert covered == set(LATENCY_CYCLES)


@each_design
def test_the_core_equals_the_integer_model(core: Core) -> None:
    run = ghdl.simulate(core.folder, ACCEL, GYRO)
    np.testing.assert_array_equal(run.angle_raw, core.expected(ACCEL, GYRO))
    assert run.restarted.tolist() == [True] + [False] * (len(ACCEL) - 1)
    assert set(run.latency_cycles) == {LATENCY_CYCLES[core.design.tilt, core.design.axes]}
    assert run.design_digest == digest(core.design)


@each_design
def test_the_core_equals_the_integer_model_with_random_stalls(core: Core) -> None:
    run = ghdl.simulate(core.folder, ACCEL, GYRO, random_stalls=True)
    np.testing.assert_array_equal(run.angle_raw, core.expected(ACCEL, GYRO))
    assert set(run.latency_cycles) == {LATENCY_CYCLES[core.design.tilt, core.design.axes]}


@both_methods
def test_a_reset_in_any_state_starts_over(core: Core) -> None:
    accel, gyro = ACCEL[200:203], GYRO[200:203]
    expected = core.expected(accel, gyro)
    for clocks in range(1, LATENCY_CYCLES[core.design.tilt, "both"] + 4):
        run = ghdl.simulate(core.folder, accel, gyro, abandon_clocks=clocks)
        np.testing.assert_array_equal(run.angle_raw, expected, err_msg=f"{clocks} clocks")
        assert run.restarted.tolist() == [True, False, False]


@both_methods
def test_the_core_converts_for_synthesis(core: Core) -> None:
    names = ("hk_common_pkg", "hk_design_pkg", "hk_multiplier", "hk_root", "hk_cordic")
    sources = [f"{name}.vhd" for name in (*names, "hk_complementary")]
    build = core.folder / "synthesis"
    build.mkdir()
    command = ["ghdl", "--synth", "--std=93", f"--workdir={build}", "--out=verilog", *sources]
    done = subprocess.run(
        [*command, "-e", "hk_complementary"],
        cwd=core.folder,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert "latch" not in done.stderr
    # What GHDL 2.0 writes wrongly: a case loses its default, a signed shift its sign.
    assert "case" not in done.stdout
    assert ">>" not in done.stdout
    assert done.stdout.count("// smul") <= 1


@pytest.mark.usefixtures("ghdl_installed")
@pytest.mark.parametrize(
    ("source", "good", "bad"),
    [
        ("hk_design_pkg.vhd", "to_signed(117441, 18)", "to_signed(117440, 18)"),
        ("hk_design_pkg.vhd", "to_signed(10430, 32)", "to_signed(10431, 32)"),
        ("hk_common_pkg.vhd", "result_v + 1", "result_v + 0"),
        ("hk_cordic.vhd", "if nothing_v then", "if false then"),
    ],
    ids=["blend", "angle table", "rounding", "zero vector"],
)
def test_one_wrong_bit_is_found(tmp_path: Path, source: str, good: str, bad: str) -> None:
    core = build_broken_core(tmp_path, source=source, good=good, bad=bad)
    run = ghdl.simulate(core.folder, ACCEL, GYRO)
    assert np.any(run.angle_raw != core.expected(ACCEL, GYRO))


@pytest.mark.usefixtures("ghdl_installed")
@pytest.mark.parametrize(
    ("good", "bad", "complaint"),
    [
        ("'1' when state_r = finished else '0'", "'0'", "nothing has come out for 1000 clocks"),
        ("'1' when state_r = idle else '0'", "'1'", "takes a sample while a result waits"),
        ("if out_ready = '1' then", "if true then", "takes back a result"),
    ],
    ids=["silent", "greedy", "impatient"],
)
def test_a_broken_handshake_is_found(tmp_path: Path, good: str, bad: str, complaint: str) -> None:
    source = "hk_complementary.vhd"
    core = build_broken_core(tmp_path, source=source, good=good, bad=bad)
    with pytest.raises(EmulationError, match=complaint):
        ghdl.simulate(core.folder, ACCEL, GYRO, random_stalls=True)
