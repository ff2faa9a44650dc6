"""Parameters changed while the filter runs: what the device keeps is what `lower` makes."""

from pathlib import Path

import numpy as np
import pytest
from boards import changed
from c_filter import filter_sources
from designs import all_parameters, design, more_parameters
from hdl_cases import design_name, option_designs, option_vectors

from hostkit.errors import DesignError
from hostkit.filters.complementary import (
    RUN_TIME,
    limits,
    lower,
    run_integer,
    told_by_device,
    with_told,
)
from hostkit.records import AXES, FilterDesign
from hostkit.render import render_target, write
from hostkit.targets import TARGETS
from hostkit.units import RAD_PER_HALF_TURN_LSB

DESIGNS = (
    *option_designs(),
    design(),
    design(rate_hz=4.0),
    design(rate_hz=500.0, eta=1 - 1.001e-6),
)
COLUMN = {"roll": 0, "pitch": 1}


def bits(value: float) -> int:
    return int(np.float32(value).view(np.uint32))


def value_of(word: str) -> float:
    return float(np.uint32(int(word)).view(np.float32))


def built(host_cc, code: FilterDesign, folder: Path, *fault: str) -> Path:
    write(render_target(code, TARGETS["host"]), folder)
    if fault:
        changed(folder / fault[0], *fault[1:])
    harness = Path(__file__).with_name("settings_main.c")
    return host_cc.build(folder / "settings", f"-I{folder}", harness, *filter_sources(folder))


def values_of(code: FilterDesign, rng: np.random.Generator) -> list[float]:
    """Return one value for each parameter, of any size within the limits."""
    found = []
    for item in RUN_TIME:
        lowest, highest = limits(item, code.period_s)
        if item.kind == "tau":
            value = np.exp(rng.uniform(np.log(lowest), np.log(highest)))
        else:
            value = rng.choice([-1.0, 1.0]) * highest * 10.0 ** rng.uniform(-6.0, 0.0)
        found.append(float(np.clip(np.float32(value), lowest, highest)))
    return found


def edges_of(code: FilterDesign) -> list[list[float]]:
    pairs = [limits(item, code.period_s) for item in RUN_TIME]
    zero = [max(lowest, 0.0) for lowest, _ in pairs]
    return [[low for low, _ in pairs], [high for _, high in pairs], zero]


def words_of(code: FilterDesign) -> list[int]:
    """Return the words of the settings that the integers of a design make."""
    spec = lower(code)
    bias, offset = [0, 0], [0, 0]
    for i, axis in enumerate(spec.axes):
        bias[COLUMN[axis]] = spec.gyro_bias_raw[i]
        offset[COLUMN[axis]] = spec.tilt_offset_raw[i]
    return [spec.blend.raw, spec.blend.format.fraction_bits, *bias, *offset]


def set_and_told(host_cc, program: Path, trials: list[list[float]]) -> list[tuple]:
    """Set all parameters; give the words, what is told, and the words after setting that again."""
    numbers = range(len(RUN_TIME))
    setting = [[("s", i, bits(v)) for i, v in enumerate(trial)] for trial in trials]
    rows = [row for lines in setting for row in (*lines, ("w",), *(("g", i) for i in numbers))]
    answers = host_cc.run(program, rows)
    size = 2 * len(RUN_TIME) + 1
    pieces = [answers[i : i + size] for i in range(0, len(answers), size)]
    told = [[value_of(line[0]) for line in piece[-len(RUN_TIME) :]] for piece in pieces]
    words = [[int(w) for w in piece[len(RUN_TIME)]] for piece in pieces]
    return list(zip(words, told, strict=True))


def own(code: FilterDesign, values: list[float]) -> list[float]:
    return [v if item.of(code) else 0.0 for item, v in zip(RUN_TIME, values, strict=True)]


@pytest.mark.parametrize("code", DESIGNS, ids=design_name)
def test_what_is_told_lowers_to_the_words_in_use(
    host_cc, code: FilterDesign, tmp_path: Path
) -> None:
    program = built(host_cc, code, tmp_path)
    rng = np.random.default_rng(5)
    trials = [*edges_of(code), *(values_of(code, rng) for _ in range(300))]
    found = set_and_told(host_cc, program, trials)
    again = set_and_told(host_cc, program, [told for _, told in found])
    assert len(found) == len(trials)
    for values, (words, told) in zip(trials, found, strict=True):
        assert words_of(with_told(code, tuple(told))) == words
        np.testing.assert_allclose(told, own(code, values), rtol=1e-4, atol=4e-6)
    assert again == found


@pytest.mark.parametrize("code", DESIGNS, ids=design_name)
def test_a_design_that_nothing_was_set_on_tells_itself(
    host_cc, code: FilterDesign, tmp_path: Path
) -> None:
    program = built(host_cc, code, tmp_path)
    numbers = range(len(RUN_TIME) + 1)
    words, *told = host_cc.run(program, [("w",), *(("g", i) for i in numbers)])
    assert [int(word) for word in words] == words_of(code)
    values = tuple(value_of(line[0]) for line in told[:-1])
    assert value_of(told[-1][0]) == 0.0
    np.testing.assert_allclose(values[0], told_by_device(code)[0], rtol=3e-7)
    assert values[1:] == told_by_device(code)[1:]
    assert with_told(code, (told_by_device(code)[0], *values[1:])) == code


@pytest.mark.parametrize("code", [design(), all_parameters(), design(axes="pitch")])
def test_the_filter_runs_with_what_was_set(host_cc, code: FilterDesign, tmp_path: Path) -> None:
    program = built(host_cc, code, tmp_path)
    rng = np.random.default_rng(6)
    accel, gyro = option_vectors(code)
    rows = np.hstack([accel, gyro])
    for _ in range(3):
        values = values_of(code, rng)
        lines = [("s", i, bits(v)) for i, v in enumerate(values)]
        lines += [("i",), *(("g", i) for i in range(len(RUN_TIME)))]
        answers = host_cc.run(program, [*lines, *(("u", *row) for row in rows.tolist())])
        told = tuple(value_of(line[0]) for line in answers[len(RUN_TIME) : 2 * len(RUN_TIME)])
        got = np.array([[int(w) for w in line[:2]] for line in answers[2 * len(RUN_TIME) :]])
        wanted = run_integer(lower(with_told(code, told)), accel, gyro)
        for i, axis in enumerate(AXES[code.axes]):
            np.testing.assert_array_equal(got[:, COLUMN[axis]], wanted[:, i])
        assert (run_integer(lower(code), accel, gyro) != wanted).any()


@pytest.mark.parametrize("axes", ["both", "roll", "pitch"])
def test_what_does_not_fit_changes_nothing(host_cc, tmp_path: Path, axes) -> None:
    code = all_parameters(axes)
    program = built(host_cc, code, tmp_path)
    refused = [(i, v) for i in range(len(RUN_TIME)) for v in (np.nan, np.inf, -np.inf, 3e38)]
    for i, item in enumerate(RUN_TIME):
        lowest, highest = (np.float32(v) for v in limits(item, code.period_s))
        refused += [(i, np.nextafter(lowest, np.float32(-9))), (i, -np.float32(1.0))]
        refused += [(i, np.nextafter(highest, np.float32(np.inf)))]
    refused += [(i, 0.01) for i, item in enumerate(RUN_TIME) if not item.of(code)]
    refused += [(5, 0.01), (200, 0.01), (255, 0.0)]
    answers = host_cc.run(program, [*(("s", i, bits(v)) for i, v in refused), ("w",)])
    assert {line[0] for line in answers[:-1]} == {"0"}
    assert [int(word) for word in answers[-1]] == words_of(code)


def test_the_rate_is_that_of_the_filter_in_body_axes(host_cc, tmp_path: Path) -> None:
    more = more_parameters(scale=(0.01, -0.02))
    code = design(mounting="-y+x+z", more=more)
    program = built(host_cc, code, tmp_path)
    counts = (1000.0, -250.0, 77.0)
    answers = host_cc.run(program, [("r", axis, *counts) for axis in (0, 1, 2)])
    gains = [g.quantised * RAD_PER_HALF_TURN_LSB * code.rate_hz for g in lower(code).rate_gains]
    wanted = [250.0 * gains[0], 1000.0 * gains[1], 0.0]
    np.testing.assert_allclose([value_of(a[0]) for a in answers], wanted, rtol=3e-7)


def test_an_angle_is_told_in_rad(host_cc, tmp_path: Path) -> None:
    program = built(host_cc, design(), tmp_path)
    ((roll, pitch, told),) = host_cc.run(program, [("u", -16384, 100, 200, 0, 0, 0)])
    assert int(pitch) > 2**29
    assert int(roll) != 0
    np.testing.assert_allclose(value_of(told), int(pitch) * RAD_PER_HALF_TURN_LSB, rtol=2e-7)


def test_a_value_outside_the_limits_of_a_design_is_refused() -> None:
    told = list(told_by_device(design()))
    told[1] = 1.0
    with pytest.raises(DesignError, match="gyro_bias_roll_rad_s"):
        with_told(design(), tuple(told))


@pytest.mark.parametrize(
    "fault",
    [
        ("hk_units.c", "(size.low + 1U) >> 1", "size.low >> 1"),
        ("hk_units.c", "+ ((size.high >> 7) & 1U)", "+ 0U"),
        ("hk_units.c", "sum.low < low ? 1U : 0U", "0U"),
        (
            "hk_filter_settings.c",
            "* (float)HK_COEFFICIENT_END + 0.5f",
            "* (float)HK_COEFFICIENT_END",
        ),
        ("hk_filter_settings.c", "HK_LEAST_FRAC      17U", "HK_LEAST_FRAC      18U"),
        ("hk_filter_settings.c", "value == hk_told(of_design, is_bias)", "value == 99.0f"),
        ("hk_filter_settings.c", "hk_within(tau, HK_TAU_HIGHEST)", "tau"),
    ],
)
def test_a_fault_is_found(host_cc, tmp_path: Path, fault: tuple[str, str, str]) -> None:
    code = all_parameters(rate_hz=4.0)
    program = built(host_cc, code, tmp_path, *fault)
    rng = np.random.default_rng(7)
    trials = [*edges_of(code), *(values_of(code, rng) for _ in range(300))]
    trials.append(list(told_by_device(code)))
    found = set_and_told(host_cc, program, trials)
    again = set_and_told(host_cc, program, [told for _, told in found])
    assert again != found or any(wrong(code, *pair) for pair in found)


def wrong(code: FilterDesign, words: list[int], told: list[float]) -> bool:
    try:
        return words_of(with_told(code, tuple(told))) != words
    except DesignError:
        return True
