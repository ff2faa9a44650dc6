"""The observer in C: equal to the integer model bit for bit; in floats, near the float model."""

from pathlib import Path

import numpy as np
import pytest
from boards import TARGET_TOOLS, changed, hear, require_or_skip
from observing import all_counts, full_design, motion, observer_design, weights

from hostkit.emulation.board import Stimulus
from hostkit.emulation.run import board_of
from hostkit.filters.observer import (
    RUN_TIME,
    device_limits,
    lower,
    parameter,
    run_float,
    run_integer,
    told_by_device,
    with_told,
)
from hostkit.filters.observer.run_time import words
from hostkit.records import FilterDesign
from hostkit.render import FirmwareOptions, generate, render_target, write
from hostkit.sensors.mpu6050 import settle_samples
from hostkit.targets import TARGETS

SOURCES = ("hk_filter.c", "hk_filter_settings.c", "hk_arctan.c", "hk_units.c", "hk_fixed.c")
DESIGNS = {
    "default": observer_design(),
    "bare": observer_design(bare=True, mounting="-y+x+z"),
    "full": full_design(mounting="+z+x+y"),
    "narrow": full_design(rate_hz=500.0, gyro_full_scale_deg_s=250, accel_full_scale_g=2),
    "wide": observer_design(
        parameter("kt", 9.0),
        parameter("kv", 28.0),
        parameter("kb", 0.3),
        gyro_full_scale_deg_s=2000,
        accel_full_scale_g=16,
    ),
}
PROCESSORS = {
    "large": (),
    "no long product": ("-DHK_LONG_PRODUCT=0",),
    "no division": ("-DHK_LONG_PRODUCT=0", "-DHK_DIVIDES=0"),
}


def built(host_cc, design: FilterDesign, folder: Path, *flags: str, real: bool = False) -> Path:
    options = FirmwareOptions(arithmetic="float") if real else None
    if not (folder / "hk_filter.c").exists():
        write(render_target(design, TARGETS["host"], options), folder)
    harness = Path(__file__).with_name("observer_main.c")
    sources = [folder / name for name in SOURCES if (folder / name).exists()]
    return host_cc.build(folder / "observer", *flags, f"-I{folder}", harness, *sources, "-lm")


def response(host_cc, program: Path, counts: np.ndarray) -> np.ndarray:
    rows = [("u", *row) for row in counts.tolist()]
    return np.array(host_cc.run(program, rows), dtype=np.int64)


def expected(design: FilterDesign, counts: np.ndarray) -> np.ndarray:
    states = run_integer(lower(design), counts[:, :3], counts[:, 3:])
    loaded = np.zeros((len(counts), 1), dtype=np.int64)
    loaded[0] = 1
    return np.hstack([states[:, :2], loaded, states[:, 2:]])


CASES = [
    *((name, "large") for name in DESIGNS),
    *(("full", other) for other in ("no long product", "no division")),
]


@pytest.mark.parametrize(("name", "processor"), CASES)
def test_the_c_equals_the_integer_model(host_cc, tmp_path: Path, name: str, processor: str) -> None:
    design = DESIGNS[name]
    counts = all_counts(design)
    program = built(host_cc, design, tmp_path, *PROCESSORS[processor])
    np.testing.assert_array_equal(response(host_cc, program, counts), expected(design, counts))


@pytest.mark.parametrize(
    ("file", "old", "new"),
    [
        ("hk_filter.c", "(rows->x[i], by_x) - hk", "(rows->x[i], by_x) + hk"),
        (
            "hk_filter.c",
            "filter->still < HK_REST_SAMPLES) {",
            "filter->still <= HK_REST_SAMPLES) {",
        ),
        ("hk_filter.c", "if (gain <= HK_START_END)", "if (gain < HK_START_END / 2)"),
        ("hk_filter.c", "filter->start_gain = HK_CLIP_GAIN", "filter->start_gain = 0"),
        ("hk_filter.c", "up[2] += HK_LEFT(", "up[2] -= HK_LEFT("),
        ("hk_filter.c", "less = HK_LEFT(less, 3)", "less = HK_LEFT(less, 2)"),
        ("hk_filter.c", "along, HK_ACCELERATION_LIMIT)", "along, HK_ACCELERATION_LIMIT / 3)"),
    ],
)
def test_a_fault_is_found(host_cc, tmp_path: Path, file: str, old: str, new: str) -> None:
    design = full_design()
    write(render_target(design, TARGETS["host"]), tmp_path)
    changed(tmp_path / file, old, new)
    counts = all_counts(design)
    got = response(host_cc, built(host_cc, design, tmp_path), counts)
    assert (got != expected(design, counts)).any()


def test_floats_follow_the_float_model(host_cc, tmp_path: Path) -> None:
    design = full_design(mounting="+z+x+y")
    counts, (rad_s, m_s2) = motion(design), weights(design)
    counts[1500:1505, 3] = 32767  # clipped
    program = built(host_cc, design, tmp_path, real=True)
    got = response(host_cc, program, counts)[:, [0, 1, *range(3, 21)]]
    wanted = run_float(design, counts[:, 3:] * rad_s, counts[:, :3] * m_s2 / 9.80665)
    apart = np.abs(got * np.array(lower(design).state_per_unit) - wanted)
    apart[:, :2] = np.abs((apart[:, :2] + np.pi) % (2.0 * np.pi) - np.pi)
    assert 0.0 < apart[:, 2:6].max() < 1e-4
    assert apart[:, 8:11].max() < 1e-5
    steep = np.abs(np.abs(wanted[:, 1]) - np.pi / 2) < 0.1
    assert apart[~steep, :2].max() < 1e-3


def bits(value: float) -> int:
    return int(np.float32(value).view(np.uint32))


def value_of(word: str) -> float:
    return float(np.uint32(int(word)).view(np.float32))


def trials(design: FilterDesign) -> list[list[float]]:
    """Values for each parameter: the ends, and any between them."""
    rng = np.random.default_rng(8)
    ends = [device_limits(item, design) for item in RUN_TIME]
    found = [[low for low, _ in ends], [high for _, high in ends]]
    for _ in range(60):
        row = [low + (high - low) * 10.0 ** rng.uniform(-6, 0) for low, high in ends]
        pairs = zip(row, ends, strict=True)
        found.append([float(np.clip(np.float32(v), low, high)) for v, (low, high) in pairs])
    return found


@pytest.mark.parametrize("name", ["default", "full", "narrow"])
def test_what_is_set_is_what_lower_makes_of_it(host_cc, tmp_path: Path, name: str) -> None:
    design = DESIGNS[name]
    program = built(host_cc, design, tmp_path)
    names = [item.link_name for item in RUN_TIME]
    for row in trials(design):
        lines = [("s", i, bits(value)) for i, value in enumerate(row)]
        gets = [("g", i) for i in range(6)]
        answers = host_cc.run(program, [*lines, ("w",), *gets])
        told = [value_of(line[0]) for line in answers[7:]]
        changed_design = with_told(design, dict(zip(names, row, strict=True)))
        assert [int(word) for word in answers[6]] == list(words(lower(changed_design)))
        np.testing.assert_allclose(told, told_by_device(changed_design), rtol=0.0)


def test_a_device_that_nothing_was_set_on_runs_the_design(host_cc, tmp_path: Path) -> None:
    design = DESIGNS["full"]
    program = built(host_cc, design, tmp_path)
    answers = host_cc.run(program, [*(("g", i) for i in range(6)), ("w",)])
    assert [value_of(line[0]) for line in answers[:6]] == list(told_by_device(design))
    assert [int(word) for word in answers[6]] == list(words(lower(design)))
    names = [item.link_name for item in RUN_TIME]
    assert with_told(design, dict(zip(names, told_by_device(design), strict=True))) == design


def test_what_is_no_value_is_refused(host_cc, tmp_path: Path) -> None:
    program = built(host_cc, DESIGNS["default"], tmp_path)
    for value in (float("nan"), float("inf"), -1.0, 1e9):
        assert host_cc.run(program, [("s", 0, bits(value))]) == [["0"]]
    assert host_cc.run(program, [("s", 6, bits(0.1)), ("g", 6)]) == [["0"], ["0"]]


@pytest.mark.parametrize("target", ["atmega328p", "rp2040", "stm32f103"])
def test_a_board_tells_what_the_integer_model_says(tmp_path: Path, target: str) -> None:
    require_or_skip(*TARGET_TOOLS[target])
    design = full_design(mounting="+z+x+y")
    rad_s, m_s2 = weights(design)
    counts = np.concatenate([motion(design, 130), all_counts(design)[1000:1300]])
    write(generate(design, TARGETS[target]), tmp_path)
    board = board_of(TARGETS[target])
    board.build(tmp_path)
    feels = Stimulus(
        angular_rate_rad_s=counts[:, 3:] * rad_s,
        specific_force_m_s2=counts[:, :3] * m_s2,
        temperature_deg_c=25.0 + np.arange(len(counts)) % 2 / 340.0,
        settle_samples=settle_samples(design.sensor, design.rate_hz),
    )
    run = board.run(tmp_path, feels)
    heard, wanted = hear(run), run_integer(lower(design), counts[:, :3], counts[:, 3:])
    assert [s.sequence for s in heard.samples] == list(range(len(counts)))
    np.testing.assert_array_equal([[*s.accel, *s.gyro] for s in heard.samples], counts)
    np.testing.assert_array_equal([[s.roll, s.pitch] for s in heard.samples], wanted[:, :2])
    told = heard.of("TILT_STATE")
    assert len(told) >= 4
    for message in told:
        assert list(message.words)[:18] == wanted[message.sequence, 2:].tolist()
    if target == "atmega328p":
        assert run.cycles_max is not None
        assert run.cycles_max < 25000
