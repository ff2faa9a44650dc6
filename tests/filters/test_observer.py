"""The observer: float model, integer model against it, words that never overflow."""

import math
from dataclasses import fields, is_dataclass, replace

import numpy as np
import pytest
from observing import all_counts, full_design, hostile, motion, observer_design, weights

from hostkit.errors import DesignError, FormatError
from hostkit.filters import FILTERS
from hostkit.filters.observer import (
    integer_geometry,
    integer_model,
    lower,
    parameter,
    response,
    run_float,
    run_integer,
    settings,
    step_integer,
)
from hostkit.filters.observer.parameters import BIAS_LIMIT_RAD_S
from hostkit.records import FilterDesign
from hostkit.units import STANDARD_GRAVITY_M_S2

G = STANDARD_GRAVITY_M_S2
BOUND_DEG = 0.01
DESIGNS = {
    "default": observer_design(),
    "bare": observer_design(bare=True),
    "full": full_design(mounting="+z+x+y"),
    "fast": observer_design(
        parameter("kt", 9.0), parameter("kv", 28.0), parameter("kb", 0.05), accel_full_scale_g=16
    ),
    "500 Hz": full_design(rate_hz=500.0, gyro_full_scale_deg_s=250, accel_full_scale_g=2),
    "67 Hz": observer_design(rate_hz=1000.0 / 15.0, gyro_full_scale_deg_s=2000),
}


def float_states(design: FilterDesign, counts: np.ndarray) -> np.ndarray:
    rad_s, m_s2 = weights(design)
    return run_float(design, counts[:, 3:] * rad_s, counts[:, :3] * m_s2 / G)


def up_of(angles: np.ndarray) -> np.ndarray:
    roll, pitch = angles[:, 0], angles[:, 1]
    cosine = np.cos(pitch)
    return np.stack([-np.sin(pitch), np.sin(roll) * cosine, np.cos(roll) * cosine], axis=1)


def apart_deg(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    cross = np.cross(up_of(one), up_of(other))
    return np.degrees(np.linalg.norm(cross, axis=1))


@pytest.mark.parametrize("name", DESIGNS)
def test_the_integer_model_is_near_the_float_model(name: str) -> None:
    design = DESIGNS[name]
    counts, spec = motion(design), lower(design)
    words = run_integer(spec, counts[:, :3], counts[:, 3:])
    wanted = float_states(design, counts)
    got = words * np.array(spec.state_per_unit)
    assert apart_deg(got, wanted).max() < 0.5 * BOUND_DEG
    assert np.abs(got - wanted)[:, 2:6].max() < 2e-4
    assert np.abs(got - wanted)[:, 8:11].max() < 1e-5
    np.testing.assert_allclose(got[:, -2:], wanted[:, -2:], atol=1e-9)


class Word(int):
    """An integer whose sums and shifts must stay within 32 bits."""

    def __add__(self, other: int) -> "Word":
        return kept(int(self) + int(other))

    __radd__ = __add__

    def __sub__(self, other: int) -> "Word":
        return kept(int(self) - int(other))

    def __rsub__(self, other: int) -> "Word":
        return kept(int(other) - int(self))

    def __neg__(self) -> "Word":
        return kept(-int(self))

    def __abs__(self) -> "Word":
        return kept(abs(int(self)))

    def __lshift__(self, bits: int) -> "Word":
        return kept(int(self) << int(bits))

    def __rshift__(self, bits: int) -> "Word":
        return kept(int(self) >> int(bits))

    def __mul__(self, other: int) -> "Product":
        return Product(int(self) * int(other))

    __rmul__ = __mul__


class Product(int):
    """A product of two words, which only a shift makes a word again."""

    def __rshift__(self, bits: int) -> Word:
        return kept(int(self) >> int(bits))


def kept(value: int) -> Word:
    if not -(2**31) <= value < 2**31:
        raise OverflowError(value)
    return Word(value)


def as_words(value: object) -> object:
    """Return integers, tuples and lists of them, and records of them, as words."""
    if isinstance(value, bool) or value is None:
        return value
    if isinstance(value, int):
        return kept(value)
    if isinstance(value, list):
        return [as_words(part) for part in value]
    if isinstance(value, tuple) and all(isinstance(part, int) for part in value):
        return tuple(kept(part) for part in value)
    if is_dataclass(value) and type(value).__name__ in {"ObserverGains", "ObserverRest", "_State"}:
        return replace(value, **{f.name: as_words(getattr(value, f.name)) for f in fields(value)})
    return value


def largest(rate_hz: float, gyro: int, accel: int) -> FilterDesign:
    """The largest gains and the largest errors of a sensor that a design may have."""
    bare = observer_design(
        rate_hz=rate_hz, gyro_full_scale_deg_s=gyro, accel_full_scale_g=accel, bare=True
    )
    own = {p.name: p.highest for p in FILTERS["observer"].run_time.parameters(bare)}
    return observer_design(
        parameter("kt", own["FILT_KT"]),
        parameter("kv", own["FILT_KV"]),
        parameter("kb", own["FILT_KB"]),
        parameter("rest_rate", 0.5),
        parameter("rest_force", 20.0),
        parameter("rest_gain", min(5.0, 0.015 * rate_hz)),
        parameter("clip_rate", 3.0),
        parameter("lead", -min(0.05, 31.0 / rate_hz)),
        *(parameter("gyro_scale", 0.05, axis) for axis in "xyz"),
        *(parameter("gyro_bias", math.radians(19.0), axis) for axis in "xyz"),
        *(parameter("accel_scale", 0.1, axis) for axis in "xyz"),
        *(parameter("accel_offset", -2.0, axis) for axis in "xyz"),
        rate_hz=rate_hz,
        gyro_full_scale_deg_s=gyro,
        accel_full_scale_g=accel,
    )


@pytest.mark.parametrize(
    ("rate_hz", "gyro", "accel"),
    [(100.0, 2000, 16), (100.0, 250, 2), (1000.0, 2000, 16), (12.5, 250, 8), (66.7, 2000, 4)],
)
def test_no_word_overflows_whatever_the_counts(
    rate_hz: float, gyro: int, accel: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    for module in (integer_geometry, integer_model):
        for name in ("SIXTH", "FIFTH", "TWENTY_FOURTH", "HALF_PER_G", "CLIP_GAIN", "START_LIMIT"):
            if hasattr(module, name):
                monkeypatch.setattr(module, name, Word(getattr(module, name)))
    plain = lower(largest(rate_hz, gyro, accel))
    keep = {"arctan", "mounting", "formats", "hidden", "axes", "filter"}
    names = [f.name for f in fields(plain) if f.name not in keep]
    spec = replace(plain, **{name: as_words(getattr(plain, name)) for name in names})
    for _, counts in hostile(60):
        state = None
        for row in counts.tolist():
            accel_count, gyro_count = as_words(row[:3]), as_words(row[3:])
            if state is None:
                state = integer_model.load(spec, accel_count, gyro_count)
            else:
                integer_model.step(spec, state, accel_count, gyro_count)
            square = sum(float(part) ** 2 for part in state.quaternion) / 2.0**60
            assert 0.9 < square < 1.1


def test_steps_from_told_states_are_those_of_the_run() -> None:
    design = full_design()
    counts, spec = all_counts(design), lower(design)
    run = run_integer(spec, counts[:, :3], counts[:, 3:])
    stepped = step_integer(spec, run[:-1], counts[1:, :3], counts[1:, 3:])
    np.testing.assert_array_equal(stepped, run[1:])
    again = run_integer(spec, counts[901:, :3], counts[901:, 3:], start=run[900])
    np.testing.assert_array_equal(again, run[901:])


def test_the_float_model_goes_on_from_a_state() -> None:
    design = full_design()
    counts = motion(design, 800)
    rad_s, m_s2 = weights(design)
    rate, force = counts[:, 3:] * rad_s, counts[:, :3] * m_s2 / G
    run = run_float(design, rate, force)
    again = run_float(design, rate[401:], force[401:], start=run[400])
    np.testing.assert_allclose(again, run[401:], atol=1e-12)


@pytest.mark.parametrize("word", [-(2**31), -1, 0, 2**29, 2**31 - 1, None])
def test_a_told_state_that_no_device_can_have_does_no_harm(word: int | None) -> None:
    design = full_design()
    counts, spec = motion(design, 60), lower(design)
    rad_s, m_s2 = weights(design)
    words = np.random.default_rng(2).integers(-(2**31), 2**31, 2 + len(spec.hidden))
    start = words if word is None else np.full(2 + len(spec.hidden), word)
    found = run_integer(spec, counts[:, :3], counts[:, 3:], start)
    assert np.abs(found).max() <= 2**31
    rate, force = counts[:, 3:] * rad_s, counts[:, :3] * m_s2 / G
    found = run_float(design, rate, force, start * np.array(spec.state_per_unit))
    np.testing.assert_allclose(np.linalg.norm(found[9:, 2:6], axis=1), 1.0, atol=0.02)


def still(design: FilterDesign, seconds: float, bias: tuple[float, float, float]) -> np.ndarray:
    rad_s, m_s2 = weights(design)
    row = [0.2 * G / m_s2, 0.0, math.sqrt(0.96) * G / m_s2, *(b / rad_s for b in bias)]
    return np.tile(np.rint(row).astype(np.int64), (round(seconds * design.rate_hz), 1))


def test_the_first_rest_finds_a_large_bias() -> None:
    design = observer_design()
    states = float_states(design, still(design, 4.0, (0.08, -0.1, 0.05)))
    np.testing.assert_allclose(states[-1, 8:11], [0.08, -0.1, 0.05], atol=2e-3)
    assert math.degrees(states[-1, 1]) == pytest.approx(-math.degrees(math.asin(0.2)), abs=0.05)


def test_a_turn_that_is_too_fast_for_a_bias_is_no_rest() -> None:
    design = observer_design()
    states = float_states(design, still(design, 4.0, (0.0, 0.0, 0.3)))
    assert not states[:, -1].any()


def test_without_rest_detection_the_correction_finds_the_bias() -> None:
    design = observer_design(parameter("kb", 0.1), bare=True)
    states = float_states(design, still(design, 120.0, (0.01, 0.0, 0.0)))
    assert states[-1, 8] == pytest.approx(0.01, abs=1e-3)


def test_no_bias_is_larger_than_a_sensor_may_have() -> None:
    design = observer_design(parameter("kt", 0.2), parameter("kb", 0.3), bare=True)
    spec, counts = lower(design), still(design, 15.0, (math.radians(40.0), 0.0, 0.0))
    exact = float_states(design, counts)[:, 8]
    assert exact.max() == exact[-1] == BIAS_LIMIT_RAD_S
    assert run_integer(spec, counts[:, :3], counts[:, 3:])[-1, 8] == spec.bias_limit


def test_an_acceleration_that_comes_and_goes_hardly_tilts_it() -> None:
    design = observer_design()
    counts = still(design, 20.0, (0.0, 0.0, 0.0))
    level = float_states(design, counts)[-1, :2]
    _, m_s2 = weights(design)
    time_s = np.arange(len(counts)) / design.rate_hz
    counts[500:, 1] += np.rint(3.0 / m_s2 * np.sin(2.0 * np.pi * time_s[500:])).astype(np.int64)
    states = float_states(design, counts)
    assert np.degrees(np.abs(states[:, :2] - level)[500:].max()) < 1.0
    assert np.degrees(math.atan(3.0 / G)) > 15.0


def test_a_clipped_rate_lets_the_force_correct() -> None:
    counts = still(observer_design(), 12.0, (0.0, 0.0, 0.0))
    counts[500:540, 3] = 32767
    level = float_states(observer_design(), counts)[499, :2]
    left = []
    for more in ((), (parameter("clip_rate", 8.0),)):
        states = float_states(observer_design(*more), counts)
        left.append(np.degrees(np.abs(states[-1, :2] - level)).max())
    assert left[1] < 0.5 * left[0]


def test_the_lead_tells_the_angle_that_is_to_come() -> None:
    counts = still(observer_design(), 3.0, (0.0, 0.0, 0.0))
    counts[200:, 4] = 8000
    now = float_states(observer_design(bare=True), counts)
    ahead = float_states(observer_design(parameter("lead", 0.01), bare=True), counts)
    np.testing.assert_allclose(ahead[250:-1, 1], now[251:, 1], atol=2e-3)


def test_the_response_is_that_of_the_float_model() -> None:
    design = observer_design(parameter("kt", 0.1), parameter("kv", 0.9), bare=True)
    frequency = np.array([0.2])
    force, rate = response(design, frequency)
    np.testing.assert_allclose(force + rate, 1.0, atol=1e-12)
    time_s = np.arange(6000) / design.rate_hz
    tilt = 0.02 * np.sin(2.0 * np.pi * frequency * time_s)
    counts = (
        np.zeros((len(time_s), 3)),
        np.stack([np.zeros(len(time_s)), np.sin(tilt), np.cos(tilt)], axis=1),
    )
    roll = run_float(design, *counts)[3000:, 0]
    wave = np.exp(-2j * np.pi * frequency * time_s[3000:])
    gain = (roll * wave).sum() / (tilt[3000:] * wave).sum()
    assert gain == pytest.approx(force[0], abs=5e-3)


@pytest.mark.parametrize(
    ("more", "options", "message"),
    [
        ([parameter("kv", 60.0)], {}, "below 0.5"),
        ([parameter("kt", 19.0)], {}, "kt_rad_m = 19"),
        ([], {"rate_hz": 40.0, "gyro_full_scale_deg_s": 2000}, "44 Hz or faster|45 Hz or faster"),
        ([parameter("lead", 0.05)], {"rate_hz": 1000.0}, "lead_s = 0.05"),
        ([parameter("kt", float("nan"))], {}, "outside"),
        ([parameter("gyro_bias", 0.4, "x")], {}, "gyro_bias_x_rad_s"),
    ],
)
def test_what_does_not_fit_is_refused(more: list, options: dict, message: str) -> None:
    with pytest.raises((FormatError, DesignError), match=message):
        lower(observer_design(*more, **options))


def test_rest_detection_is_there_as_a_whole_or_not() -> None:
    bare = observer_design(parameter("rest_rate", 0.02), bare=True)
    with pytest.raises(DesignError, match="rest_gain_per_s"):
        settings(bare)


def test_another_filters_parameter_and_the_arc_sine_are_refused() -> None:
    design = observer_design()
    with pytest.raises(DesignError, match="arcsin"):
        settings(replace(design, tilt="arcsin"))
    eta = replace(design.parameters[0], name="eta")
    with pytest.raises(DesignError, match="no parameter 'eta'"):
        settings(replace(design, parameters=(*design.parameters, eta)))
