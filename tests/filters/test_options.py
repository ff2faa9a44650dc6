"""The parameters beside eta, in the float and in the integer model."""

import math
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from designs import all_parameters, design, more_parameters
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from vectors import against_the_limit, near_1_g, on_the_bounds

from hostkit.attitude import up_from_tilt, wrap_rad
from hostkit.errors import FormatError
from hostkit.filters.complementary import (
    BIAS_LIMIT_RAD_S,
    force_gate,
    lower,
    measured_tilt_rad,
    measured_tilt_raw,
    run_float,
    run_integer,
    step_integer,
)
from hostkit.fixedpoint import shift_round, wrap32
from hostkit.records import FilterDesign
from hostkit.sensors import SENSORS
from hostkit.sensors.counts import Counts, to_counts, to_rate_and_force_g
from hostkit.units import RAD_PER_HALF_TURN_LSB, STANDARD_GRAVITY_M_S2

PART = SENSORS["mpu6050"]
N = 600


def on_counts(d: FilterDesign, counts: Counts) -> np.ndarray:
    return run_float(d, *to_rate_and_force_g(PART, d.sensor, counts))


def motion(d: FilterDesign, seed: int, samples: int = N) -> Counts:
    """A smooth motion of both axes as a sensor with the errors of the design reports it."""
    rng = np.random.default_rng(seed)
    t = np.arange(samples) * d.period_s
    errors = {p.name: p.value for p in d.parameters}
    angle, rate = np.zeros((samples, 2)), np.zeros((samples, 3))
    for i, axis in enumerate(("roll", "pitch")):
        size, speed, phase = rng.uniform(0.1, 0.8), rng.uniform(0.1, 2.0), rng.uniform(0, 6)
        angle[:, i] = size * np.sin(speed * t + phase) + errors.get(f"tilt_offset_{axis}_rad", 0.0)
        rate[:, i] = size * speed * np.cos(speed * t + phase)
        rate[:, i] += errors.get(f"gyro_bias_{axis}_rad_s", 0.0)
        rate[:, i] /= 1.0 + errors.get(f"gyro_scale_{axis}", 0.0)
    force = up_from_tilt(angle[:, 0], angle[:, 1]) + rng.normal(0, 0.02, (samples, 3))
    return to_counts(
        PART, d.sensor, rate + rng.normal(0, 0.02, rate.shape), force * STANDARD_GRAVITY_M_S2
    )


def closed_samples(d: FilterDesign, counts: Counts) -> int:
    gate = lower(d).gate
    square = (counts.accel**2).sum(axis=1)[1:]
    return 0 if gate is None else int(((square < gate.lowest) | (square > gate.highest)).sum())


pairs = st.tuples(st.floats(-1.0, 1.0), st.floats(-1.0, 1.0))


def scaled(pair: tuple[float, float], size: float) -> tuple[float, float]:
    return size * pair[0], size * pair[1]


@settings(max_examples=40, deadline=None)
@given(
    bias=pairs,
    scale=pairs,
    offset=pairs,
    gate=st.none() | st.floats(0.02, 1.0),
    gain=st.none() | st.floats(-6.0, 1.0),
    eta=st.floats(0.3, 0.9999),
    rate_hz=st.sampled_from([20.0, 100.0, 500.0]),
    tilt=st.sampled_from(["atan2", "arcsin"]),
    seed=st.integers(0, 99),
)
def test_integer_stays_within_the_stated_bound_of_float(
    bias, scale, offset, gate, gain, eta, rate_hz, tilt, seed
) -> None:
    more = more_parameters(
        bias_deg_s=scaled(bias, 15.0),
        scale=scaled(scale, 0.25),
        offset_deg=scaled(offset, 30.0),
        gate_g=gate,
        integral_gain=None if gain is None else 10.0**gain,
    )
    d = design(eta=eta, rate_hz=rate_hz, tilt=tilt, more=more)
    spec, counts = lower(d), motion(d, seed)
    exact = on_counts(d, counts)
    state = run_integer(spec, counts.accel, counts.gyro) * np.array(spec.state_per_unit)
    closed = closed_samples(d, counts)
    bound = spec.error_bound_rad + (closed and closed * spec.error_per_closed_sample_rad)
    assume(spec.integral is None or np.abs(state[:, 2:]).max() < 0.99 * BIAS_LIMIT_RAD_S)
    assert np.abs(wrap_rad(state[:, :2] - exact[:, :2])).max() <= bound


def test_the_bound_is_of_use() -> None:
    """It is some tens of microradians for usual designs, and not far from what is met."""
    d = all_parameters()
    spec, counts = lower(d), motion(d, 1)
    assert closed_samples(d, counts) == 0
    state = run_integer(spec, counts.accel, counts.gyro) * np.array(spec.state_per_unit)
    error = np.abs(wrap_rad(state[:, :2] - on_counts(d, counts)[:, :2])).max()
    assert spec.error_bound_rad / 500 < error <= spec.error_bound_rad < math.radians(0.1)


def test_the_float_model_is_its_equations() -> None:
    """The equations of the parameters' module, one sample at a time and without vectors."""
    d = all_parameters()
    value = {p.name: p.value for p in d.parameters}
    counts = Counts(accel=near_1_g(d)[:, :3], gyro=near_1_g(d)[:, 3:])
    rate, force = to_rate_and_force_g(PART, d.sensor, counts)
    got = on_counts(d, counts)
    dt, ki = d.period_s, value["integral_gain_per_s2"]
    for i, axis in enumerate(("roll", "pitch")):
        o, s = value[f"tilt_offset_{axis}_rad"], value[f"gyro_scale_{axis}"]
        m = measured_tilt_rad(axis, "atan2", force)
        theta, b = wrap_rad(m[0] - o), value[f"gyro_bias_{axis}_rad_s"]
        for k in range(len(counts)):
            if k:
                t = theta + ((1.0 + s) * rate[k, i] - b) * dt
                is_open = abs(math.sqrt(force[k] @ force[k]) - 1.0) < value["gate_g"]
                r = wrap_rad(m[k] - o - t) if is_open else 0.0
                theta = wrap_rad(t + (1.0 - value["eta"]) * r)
                b = min(max(b - ki * r * dt, -BIAS_LIMIT_RAD_S), BIAS_LIMIT_RAD_S)
            assert wrap_rad(got[k, i] - theta) == pytest.approx(0.0, abs=1e-9)
            assert got[k, 2 + i] == pytest.approx(b, abs=1e-9)


@pytest.mark.parametrize("tilt", ["atan2", "arcsin"])
def test_the_integer_model_is_its_equations(tilt: str) -> None:
    """The same in Python's own integers, from the constants of the spec."""
    d = all_parameters(tilt=tilt)
    spec, samples = lower(d), np.vstack([near_1_g(d), against_the_limit(d, (40, 20))])
    tilts = measured_tilt_raw(spec, samples[:, :3]).tolist()
    got = run_integer(spec, samples[:, :3], samples[:, 3:]).tolist()
    blend, gain = spec.blend, spec.integral.gain
    for i in range(2):
        bias, angle = spec.gyro_bias_raw[i], wrap32(tilts[0][i] - spec.tilt_offset_raw[i])
        for k, row in enumerate(samples.tolist()):
            if k:
                rate = spec.rate_gains[i]
                turn = shift_round(row[3 + i] * rate.raw, rate.format.fraction_bits)
                turn -= shift_round(bias, spec.integral.fraction_bits)
                square = sum(count * count for count in row[:3])
                innovation = wrap32(tilts[k][i] - spec.tilt_offset_raw[i] - angle - turn)
                innovation *= spec.gate.lowest <= square <= spec.gate.highest
                change = shift_round(innovation * gain.raw, gain.format.fraction_bits)
                limit = spec.integral.limit_raw
                bias = min(max(bias - change, -limit), limit)
                correction = shift_round(innovation * blend.raw, blend.format.fraction_bits)
                angle = wrap32(angle + turn + correction)
            assert (got[k][i], got[k][2 + i]) == (angle, bias)


@pytest.mark.parametrize(
    "more",
    [
        more_parameters(bias_deg_s=(20.0, -20.0), scale=(0.25, -0.25), offset_deg=(30.0, -30.0)),
        more_parameters(gate_g=0.1),
        more_parameters(integral_gain=10.0),
        all_parameters().parameters[1:],
    ],
)
def test_single_steps_make_up_the_run(more) -> None:
    d = design(more=more)
    samples = np.vstack([near_1_g(d), against_the_limit(d, (60, 90))])
    accel, gyro = samples[:, :3], samples[:, 3:]
    run = run_integer(lower(d), accel, gyro)
    assert run.shape == (len(samples), 2 + len(lower(d).hidden))
    np.testing.assert_array_equal(step_integer(lower(d), run[:-1], accel[1:], gyro[1:]), run[1:])


def test_a_run_may_be_taken_up_from_any_of_its_states() -> None:
    d = all_parameters()
    counts = motion(d, 3)
    rate, force = to_rate_and_force_g(PART, d.sensor, counts)
    whole = run_float(d, rate, force)
    rest = run_float(d, rate[200:], force[200:], whole[199])
    np.testing.assert_allclose(rest, whole[200:], rtol=0, atol=1e-12)


@given(st.floats(0.001, 1.0), st.sampled_from([2048, 4096, 8192, 16384]))
def test_the_bounds_of_the_gate_are_exact(gate_g: float, gravity: int) -> None:
    """| |f| - 1 | < gate, squared so that no root is needed, in fractions."""
    gate, exact = force_gate(gate_g, gravity), Fraction(gate_g)

    def passes(square: int) -> bool:
        share = Fraction(square, gravity * gravity)
        return (1 - exact) ** 2 < share < (1 + exact) ** 2

    assert passes(gate.lowest)
    assert passes(gate.highest)
    assert not passes(gate.lowest - 1)
    assert not passes(gate.highest + 1)
    assert gate.highest < 2**31


@pytest.mark.parametrize("gate_g", [0.001, 0.1, 0.5, 1.0])
@pytest.mark.parametrize("full_scale_g", [2, 4, 8, 16])
def test_both_models_decide_alike_on_the_bounds(gate_g: float, full_scale_g: int) -> None:
    d = design(eta=0.5, accel_full_scale_g=full_scale_g, more=more_parameters(gate_g=gate_g))
    edges = on_the_bounds(lower(d).gate)
    assert len(edges) >= 1
    accel = np.repeat(np.vstack([[[0, 0, 0]], edges]), 2, axis=0)
    counts = Counts(accel=accel, gyro=np.full_like(accel, 900))
    state = run_integer(lower(d), counts.accel, counts.gyro)
    held = np.diff(state[:, 0], axis=0) == np.diff(state[:, 0])[0]
    assert held[0]
    exact = on_counts(d, counts)
    np.testing.assert_array_equal(
        held, np.abs(np.diff(exact[:, 0]) - np.diff(exact[:, 0])[0]) < 1e-9
    )
    assert not held.all()


def test_a_force_far_from_1_g_neither_corrects_nor_teaches() -> None:
    d = design(more=more_parameters(bias_deg_s=(2.0, -1.0), gate_g=0.1, integral_gain=1.0))
    accel = np.tile([[3000, 5000, 12000]], (50, 1))
    counts = Counts(accel=accel, gyro=np.zeros_like(accel))
    exact = on_counts(d, counts)
    np.testing.assert_allclose(np.degrees(exact[:, 2:]), np.tile([[2.0, -1.0]], (50, 1)))
    np.testing.assert_allclose(np.degrees(np.diff(exact[:, 0])), -2.0 * d.period_s)
    raw = run_integer(lower(d), counts.accel, counts.gyro)
    assert len(np.unique(raw[:, 2:], axis=0)) == 1
    np.testing.assert_allclose(raw[:, 2:] * lower(d).hidden[0].per_unit, exact[:, 2:], atol=1e-9)


def test_samples_that_do_not_correct_add_to_the_bound_and_no_more_than_is_said() -> None:
    d = design(axes="roll", eta=0.3, more=more_parameters("roll", gate_g=0.1))
    spec, closed = lower(d), 5000
    accel = np.tile([[0, 0, 8192]], (closed + 1, 1))
    counts = Counts(accel=accel, gyro=np.full_like(accel, 32001))
    raw = run_integer(spec, counts.accel, counts.gyro) * RAD_PER_HALF_TURN_LSB
    error = np.abs(wrap_rad(raw - on_counts(d, counts))).max()
    added = closed * spec.error_per_closed_sample_rad
    assert spec.error_bound_rad + added / 10 < error <= spec.error_bound_rad + added
    assert lower(design()).error_per_closed_sample_rad == 0.0
    assert lower(all_parameters()).error_per_closed_sample_rad == math.inf


def test_the_integral_finds_the_bias_and_the_angle_is_right_then() -> None:
    d = design(axes="roll", more=more_parameters("roll", integral_gain=0.1))
    rate = np.zeros((6000, 3))
    rate[:, 0] = math.radians(3.0)
    force = np.tile([[0.0, 0.0, STANDARD_GRAVITY_M_S2]], (6000, 1))
    counts = to_counts(PART, d.sensor, rate, force)
    for state in (
        on_counts(d, counts),
        run_integer(lower(d), counts.accel, counts.gyro) * np.array(lower(d).state_per_unit),
    ):
        angle, bias = np.degrees(state[-1])
        assert bias == pytest.approx(3.0, abs=0.01)
        assert angle == pytest.approx(0.0, abs=0.001)
        assert np.degrees(state[:, 0]).max() > 2.0


def test_the_bias_stops_at_its_limit_and_leaves_it_at_once() -> None:
    d = design(axes="roll", more=more_parameters("roll", integral_gain=1.0))
    spec, samples = lower(d), against_the_limit(d, (400, 400))
    counts = Counts(accel=samples[:, :3], gyro=samples[:, 3:])
    angle, bias = run_integer(spec, counts.accel, counts.gyro).T
    turned = 400 + int(np.argmax(angle[400:] < 0))
    assert (bias[399:turned] == spec.integral.limit_raw).all()
    assert bias.max() == spec.integral.limit_raw
    assert (np.diff(bias[turned - 1 : turned + 20]) < 0).all()
    exact = on_counts(d, counts)[:, 1]
    assert exact.max() == exact[399] == BIAS_LIMIT_RAD_S


def test_the_offset_wraps_in_the_first_sample_and_after() -> None:
    d = design(axes="roll", more=more_parameters("roll", offset_deg=(-30.0, 0.0)))
    turned = up_from_tilt(np.full(5, math.radians(170.0)), np.zeros(5)) * STANDARD_GRAVITY_M_S2
    counts = to_counts(PART, d.sensor, np.zeros((5, 3)), turned)
    raw = run_integer(lower(d), counts.accel, counts.gyro) * RAD_PER_HALF_TURN_LSB
    for angle in (raw, on_counts(d, counts)):
        np.testing.assert_allclose(np.degrees(angle[:, 0]), -160.0, atol=0.01)


def test_scale_and_bias_undo_what_the_sensor_does() -> None:
    """Without gravity to correct it, the angle follows the true rate for ten turns."""
    errors = {"bias_deg_s": (1.5, 0.0), "scale": (-0.2, 0.0)}
    d = design(axes="roll", more=more_parameters("roll", **errors, gate_g=0.1))
    rate = np.zeros((4000, 3))
    rate[:, 0] = (math.radians(90.0) + math.radians(1.5)) / 0.8
    counts = to_counts(PART, d.sensor, rate, np.zeros((4000, 3)))
    raw = run_integer(lower(d), counts.accel, counts.gyro) * RAD_PER_HALF_TURN_LSB
    for angle in (raw, on_counts(d, counts)):
        turned = np.degrees(np.unwrap(angle[:, 0]))
        assert turned[-1] == pytest.approx(3999 * 0.9, abs=0.5)


def test_neutral_values_are_no_parameters_at_all() -> None:
    zeros = more_parameters(bias_deg_s=(0.0, 0.0), scale=(0.0, 0.0), offset_deg=(0.0, 0.0))
    assert lower(design(more=zeros)) == lower(design())


@given(
    st.floats(-6.0, 1.0).map(lambda exponent: 10.0**exponent),
    st.sampled_from([4.0, 20.0, 100.0, 500.0, 1000.0, 8000.0]),
)
def test_the_bias_never_leaves_its_word(gain: float, rate_hz: float) -> None:
    """At the limit, after the largest innovation, with the half that rounds it."""
    d = design(rate_hz=rate_hz, gyro_full_scale_deg_s=250, more=more_parameters(integral_gain=gain))
    try:
        integral = lower(d).integral
    except FormatError:
        assert gain / rate_hz**2 > 0.4
        return
    change = shift_round(2**31 * integral.gain.raw, integral.gain.format.fraction_bits)
    assert integral.limit_raw + change + 2 ** (integral.fraction_bits - 1) < 2**31
    assert 17 <= integral.gain.format.fraction_bits <= 49
    assert integral.fraction_bits >= 1
    # One bit more would not fit.
    assert 2 * (integral.limit_raw + change + 2**integral.fraction_bits) > 0.999 * 2**31


def test_an_integral_gain_that_is_too_large_is_refused_with_the_largest_that_fits() -> None:
    slow = design(rate_hz=4.0, gyro_full_scale_deg_s=250)
    with pytest.raises(FormatError, match=r"integral_gain = 10 .* rate_hz = 4 .*up to") as refusal:
        lower(replace(slow, parameters=(*slow.parameters, *more_parameters(integral_gain=10.0))))
    fits = float(str(refusal.value).split("up to ")[2].split()[0])
    for gain, ok in ((fits, True), (1.001 * fits, False)):
        d = replace(slow, parameters=(*slow.parameters, *more_parameters(integral_gain=gain)))
        if ok:
            assert lower(d).integral.fraction_bits == 1
        else:
            with pytest.raises(FormatError):
                lower(d)


def test_a_scale_that_turns_half_a_turn_is_refused_with_the_numbers() -> None:
    d = design(rate_hz=12.5, gyro_full_scale_deg_s=2000, more=more_parameters(scale=(0.2, 0.0)))
    with pytest.raises(FormatError, match="192 deg per sample; the limit is 180"):
        lower(d)
