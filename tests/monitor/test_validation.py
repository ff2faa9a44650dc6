import math

import numpy as np
import pytest
from designs import all_parameters, design
from device import Device
from hypothesis import given, settings
from hypothesis import strategies as st
from judging import feed, judge

from hostkit.errors import HostkitError
from hostkit.filters import FILTERS
from hostkit.link.frames.decoder import Decoder
from hostkit.trace import AngleTrace
from hostkit.validation import Thresholds, Validator, device_parameters

SAMPLES = 400


@pytest.mark.parametrize("axes", ["roll", "pitch", "both"])
@pytest.mark.parametrize("batch", [1, 37, 1000])
def test_right_device_passes(axes: str, batch: int) -> None:
    d = design(axes=axes)
    report = judge(Device(d).frames(SAMPLES), d, batch=batch).report(Thresholds())
    assert (report.verdict, report.reasons) == ("pass", ())
    assert (report.samples, report.checked, report.mismatches, report.lost) == (
        SAMPLES,
        SAMPLES,
        0,
        0,
    )
    assert 0.0 < report.rms_rad < report.max_rad < math.radians(0.005)


def test_one_wrong_bit_in_one_angle_is_two_mismatches_and_fails() -> None:
    """The step into the wrong angle is wrong, and so is the step out of it."""
    device = Device(design())
    states = device.states(SAMPLES)
    states[200, 1] ^= 1
    report = judge(device.frames(SAMPLES, states=states)).report(Thresholds())
    assert (report.verdict, report.mismatches) == ("fail", 2)
    assert "2 of 400 steps" in report.reasons[0]


@pytest.mark.parametrize("axes", ["roll", "pitch", "both"])
@pytest.mark.parametrize("batch", [1, 37])
def test_right_device_with_every_parameter_passes(axes: str, batch: int) -> None:
    d = all_parameters(axes)
    states = Device(d).states(SAMPLES)
    assert len(np.unique(states[:, 2])) > SAMPLES // 4
    report = judge(Device(d).frames(SAMPLES), d, batch=batch).report(Thresholds())
    assert (report.verdict, report.checked, report.mismatches) == ("pass", SAMPLES, 0)
    assert 0.0 < report.max_rad < math.radians(0.005)


@pytest.mark.parametrize("word", [2, 3])
def test_one_wrong_bit_in_the_hidden_state_is_two_mismatches_and_fails(word: int) -> None:
    """Bit 20 changes the angle of the next step too, the last bit only the word itself."""
    device = Device(all_parameters())
    for bit in (0, 20):
        states = device.states(SAMPLES)
        states[200, word] ^= 1 << bit
        frames = device.frames(SAMPLES, states=states)
        report = judge(frames, device.design).report(Thresholds())
        assert (report.verdict, report.mismatches) == ("fail", 2)


def test_a_device_that_hides_its_state_fails() -> None:
    device = Device(all_parameters())
    states = device.states(SAMPLES)
    states[:, 2:] = 0
    report = judge(device.frames(SAMPLES, states=states), device.design).report(Thresholds())
    assert (report.verdict, report.mismatches) == ("fail", SAMPLES)


def test_the_float_model_takes_up_the_hidden_state_after_a_loss() -> None:
    d = all_parameters()
    frames = Device(d).frames(SAMPLES)
    report = judge(frames[:150] + frames[151:], d).report(Thresholds())
    assert (report.verdict, report.lost, report.mismatches) == ("pass", 1, 0)
    assert report.max_rad < math.radians(0.001)


@pytest.mark.parametrize("lost", [[7], [100, 101, 102, 250]])
def test_losses_are_counted_and_cost_one_check_each_gap(lost: list[int]) -> None:
    frames = [f for i, f in enumerate(Device(design()).frames(SAMPLES)) if i - 1 not in lost]
    report = judge(frames).report(Thresholds(max_lost_share=0.5))
    gaps = sum(k - 1 not in lost for k in lost)
    assert report.lost == len(lost)
    assert report.checked == SAMPLES - len(lost) - gaps
    assert (report.mismatches, report.verdict) == (0, "pass")
    assert report.max_rad < math.radians(0.005)


def test_too_many_losses_fail() -> None:
    frames = Device(design()).frames(SAMPLES)
    report = judge(frames[:100] + frames[150:]).report(Thresholds())
    assert report.verdict == "fail"
    assert "50 of 400 samples were lost" in report.reasons[0]


def test_late_listener_has_lost_nothing() -> None:
    report = judge(Device(design()).frames(SAMPLES)[101:]).report(Thresholds())
    assert (report.verdict, report.lost, report.checked) == ("pass", 0, SAMPLES - 101)


def test_restart_of_the_device_is_followed() -> None:
    frames = Device(design()).frames(100) + Device(design(), seed=2).frames(100)
    report = judge(frames).report(Thresholds())
    assert (report.verdict, report.samples, report.lost, report.mismatches) == ("pass", 200, 0, 0)


@pytest.mark.parametrize("d", [design(), all_parameters()], ids=["eta", "all"])
def test_a_filter_that_starts_anew_is_no_restart_of_the_device(d) -> None:
    """After a fault of the sensor the counter goes on, and the sample says RESTARTED."""
    device, at = Device(d), 150
    accel, gyro = device.counts(SAMPLES)
    states = device.states(SAMPLES)
    run_integer = FILTERS[d.filter].run_integer
    again = run_integer(FILTERS[d.filter].lower(d), accel[at:], gyro[at:])
    states[at:, : again.shape[1]] = again
    frames = device.frames(SAMPLES, states=states)
    flagged = Decoder().feed(frames[at + 1])[0].message
    frames[at + 1] = device._pack(
        device._sample(at, states[at], np.array(flagged.accel), np.array(flagged.gyro), 1)
    )
    report = judge(frames, d, batch=1000).report(Thresholds())
    assert (report.checked, report.mismatches, report.lost) == (SAMPLES, 0, 0)
    assert report.max_rad < math.radians(0.001)


def test_other_eta_is_found_by_the_float_model_too() -> None:
    """A device whose integers agree with nothing fails on both models."""
    device = Device(design(eta=0.98))
    report = judge(device.frames(SAMPLES), design()).report(Thresholds())
    assert report.mismatches > SAMPLES // 2
    assert any("residual" in reason for reason in report.reasons)


def test_nothing_at_all_fails() -> None:
    report = Validator(design()).report(Thresholds())
    assert report.verdict == "fail"
    assert report.rms_rad is None


def test_hostile_numbers_do_not_break_it() -> None:
    rng = np.random.default_rng(0)
    device = Device(design())
    m = device.module
    frames = []
    for _ in range(300):
        message = m.MAVLink_tilt_sample_message(
            int(rng.integers(0, 2**63)),
            int(rng.choice([0, 1, 2**32 - 1, rng.integers(2**32)])),
            int(rng.choice([-(2**31), 2**31 - 1])),
            int(rng.integers(-(2**31), 2**31)),
            rng.choice([-32768, 0, 32767], 3).tolist(),
            rng.choice([-32768, 0, 32767], 3).tolist(),
            0,
            0,
            [0] * 6,
            int(rng.integers(256)),
        )
        frames.append(device._pack(message))
    report = judge(frames).report(Thresholds())
    assert report.samples == 300
    assert report.verdict == "fail"


@pytest.mark.parametrize("value", [math.nan, math.inf, -1.0])
def test_thresholds_are_numbers_that_can_be_exceeded(value: float) -> None:
    with pytest.raises(HostkitError, match="max_rms_deg"):
        Thresholds(max_rms_deg=value)
    with pytest.raises(HostkitError, match="max_lost_share"):
        Thresholds(max_lost_share=value)


def tau_and_offset(k: int) -> dict[int, dict[str, float]]:
    return {k: {"FILT_TAU": 0.5, "TILT_OFS_ROLL": 0.02}}


@pytest.mark.parametrize("batch", [1, 37])
@pytest.mark.parametrize("with_everything", [False, True])
def test_a_change_is_followed_to_the_bit_from_the_sample_behind_it(
    batch: int, with_everything: bool
) -> None:
    d = all_parameters() if with_everything else design()
    changes = {
        100: {"FILT_TAU": 0.5},
        200: {"GYRO_BIAS_ROLL": 0.01, "TILT_OFS_PITCH": -0.1},
        300: {"FILT_TAU": 12.0},
    }
    report = judge(Device(d).retuned_frames(SAMPLES, changes), d, batch=batch).report(Thresholds())
    assert (report.verdict, report.reasons) == ("pass", ())
    assert (report.checked, report.mismatches, report.unjudged) == (SAMPLES, 0, 0)
    assert report.max_rad < math.radians(0.005)
    assert [p.name for p in report.retuned] == ["FILT_TAU", "GYRO_BIAS_ROLL", "TILT_OFS_PITCH"]
    assert report.retuned[0].device_value == 12.0


def test_a_change_that_takes_effect_one_sample_late_is_one_mismatch() -> None:
    changes = {50: {"TILT_OFS_ROLL": 0.02}, 100: {"FILT_TAU": 0.5}}
    frames = Device(design()).retuned_frames(SAMPLES, changes)
    frames[100:102] = frames[101], frames[100]
    report = judge(frames).report(Thresholds())
    assert (report.verdict, report.mismatches) == ("fail", 1)


def test_going_back_to_the_design_is_followed() -> None:
    own = {p.name: p.design_value for p in device_parameters(design())}
    changes = {**tau_and_offset(100), 200: own}
    report = judge(Device(design()).retuned_frames(SAMPLES, changes)).report(Thresholds())
    assert (report.verdict, report.mismatches, report.checked) == ("pass", 0, SAMPLES)
    assert report.retuned == ()


def test_a_retuned_device_is_judged_once_it_has_told_everything() -> None:
    device = Device(design())
    frames = device.retuned_frames(SAMPLES, tau_and_offset(0))[2:]
    told = {p.name: p.design_value for p in device_parameters(design())}
    told.update(FILT_TAU=0.5, TILT_OFS_ROLL=float(np.float32(0.02)))
    values = [device.told(name, value) for name, value in told.items()]
    validator = judge(frames[:60] + values[:-1] + frames[60:80])
    assert validator.untold == ("TILT_OFS_PITCH",)
    assert "not told TILT_OFS_PITCH" in validator.report(Thresholds()).reasons[1]
    validator = judge(frames[:60] + values[:-1] + frames[60:80] + values[-1:] + frames[80:])
    report = validator.report(Thresholds())
    assert (report.verdict, report.unjudged, report.untold) == ("pass", 80, ())
    assert (report.checked, report.mismatches) == (SAMPLES - 80, 0)


def test_most_samples_without_their_parameters_fail() -> None:
    device = Device(design())
    frames = device.retuned_frames(SAMPLES, tau_and_offset(0))[2:]
    told = {p.name: p.design_value for p in device_parameters(design())}
    told.update(FILT_TAU=0.5, TILT_OFS_ROLL=float(np.float32(0.02)))
    values = [device.told(name, value) for name, value in told.items()]
    report = judge(frames[:300] + values + frames[300:]).report(Thresholds())
    assert (report.verdict, report.unjudged) == ("fail", 300)
    assert "before their parameters were known" in report.reasons[0]


def test_as_designed_refuses_other_parameters() -> None:
    frames = Device(design()).retuned_frames(SAMPLES, tau_and_offset(200))
    report = judge(frames, as_designed=True).report(Thresholds())
    assert (report.verdict, report.digest_ok, report.checked) == ("refused", True, 200)
    assert "other parameters" in report.reasons[0]


@pytest.mark.parametrize("value", [math.nan, math.inf, -1.0, 1e30, 0.0])
def test_a_value_that_no_device_has_is_not_used(value: float) -> None:
    device = Device(design())
    frames = device.retuned_frames(SAMPLES, tau_and_offset(100))
    frames.insert(200, device.told("FILT_TAU", value))
    validator = judge(frames)
    assert validator.untold == ("FILT_TAU",)
    assert validator.report(Thresholds()).mismatches == 0


def test_strange_names_are_passed_over() -> None:
    device = Device(design())
    frames = device.retuned_frames(SAMPLES, tau_and_offset(100))
    frames[150:150] = [device.told(name, 1.0) for name in ("", "X" * 16, "SYS_ID", "eta", "HK_Z")]
    report = judge(frames).report(Thresholds())
    assert (report.verdict, report.checked) == ("pass", SAMPLES)


def test_a_change_whose_value_was_lost_is_withheld_until_it_is_told_again() -> None:
    """The device is right; without the value its steps look wrong, and must not fail it."""
    device = Device(design())
    changes = {**tau_and_offset(50), 200: {"FILT_TAU": 2.0}}
    frames = device.retuned_frames(SAMPLES, changes)
    value = next(i for i in range(100, len(frames)) if len(frames[i]) != len(frames[100]))
    told = {p.name: p.design_value for p in device_parameters(design())}
    told.update(FILT_TAU=2.0, TILT_OFS_ROLL=float(np.float32(0.02)))
    validator, decoder, d = Validator(design()), Decoder(), design()
    feed(validator, decoder, frames[:value], d)
    validator.doubt_parameters()
    feed(validator, decoder, frames[value + 1 : value + 41], d)
    assert len(validator.untold) == 5
    feed(validator, decoder, [device.told(*item) for item in told.items()], d)
    feed(validator, decoder, frames[value + 41 :], d)
    report = validator.report(Thresholds())
    assert (report.verdict, report.mismatches) == ("pass", 0)
    assert 35 <= report.unjudged <= 40
    assert report.checked + report.unjudged == SAMPLES


def test_wrong_steps_after_a_loss_count_if_nothing_had_changed() -> None:
    device = Device(design())
    frames = device.retuned_frames(SAMPLES, tau_and_offset(50))
    spoilt = Decoder().feed(frames[210])[0].message
    states = np.array([spoilt.roll ^ 256, spoilt.pitch, 0, 0])
    frames[210] = device._pack(
        device._sample(spoilt.sequence, states, np.array(spoilt.accel), np.array(spoilt.gyro), 4)
    )
    told = {p.name: p.design_value for p in device_parameters(design())}
    told.update(FILT_TAU=0.5, TILT_OFS_ROLL=float(np.float32(0.02)))
    validator, decoder, d = Validator(design()), Decoder(), design()
    feed(validator, decoder, frames[:200], d)
    validator.doubt_parameters()
    feed(validator, decoder, frames[200:230], d)
    assert validator.report(Thresholds()).mismatches == 0
    feed(validator, decoder, [device.told(*item) for item in told.items()], d)
    feed(validator, decoder, frames[230:], d)
    assert validator.report(Thresholds()).mismatches == 2


def test_a_device_that_says_retuned_and_tells_the_design_is_not_judged() -> None:
    device = Device(design())
    frames = device.frames(SAMPLES, flags=device.module.HOSTKIT_SAMPLE_RETUNED)
    values = [device.told(p.name, p.design_value) for p in device_parameters(design())]
    report = judge(values + frames).report(Thresholds())
    assert (report.verdict, report.checked, report.unjudged) == ("fail", 0, SAMPLES)


def test_a_restart_makes_what_was_told_void() -> None:
    device = Device(design())
    frames = device.retuned_frames(SAMPLES, tau_and_offset(0))
    again = Device(design(), seed=2).retuned_frames(50, tau_and_offset(0))[2:]
    own = [device.told(p.name, p.design_value) for p in device_parameters(design())]
    validator = judge(own + frames + again)
    report = validator.report(Thresholds())
    assert (report.unjudged, report.lost, len(validator.untold)) == (50, 0, 5)


@pytest.mark.parametrize("every", [2, 10, 7])
def test_a_thinned_out_stream_has_lost_nothing_and_cannot_be_judged(every: int) -> None:
    frames = [f for i, f in enumerate(Device(design()).frames(SAMPLES)[1:]) if i % every == 0]
    report = judge(frames).report(Thresholds())
    assert (report.verdict, report.lost, report.stride) == ("fail", 0, every)
    assert report.checked <= 1
    assert report.unjudged >= len(frames) - 1
    assert any("sample is sent" in reason for reason in report.reasons)


def test_losses_of_a_thinned_out_stream_are_counted() -> None:
    frames = Device(design()).frames(SAMPLES)[1::5]
    report = judge(frames[:20] + frames[23:40] + frames[41:]).report(Thresholds())
    assert (report.lost, report.stride) == (4, 5)


def test_a_stream_that_is_thinned_out_later_has_lost_nothing() -> None:
    frames = Device(design()).frames(SAMPLES)[1:]
    kept = frames[:50] + frames[70:200] + frames[209:300:10] + frames[300:]
    report = judge(kept).report(Thresholds())
    assert (report.stride, report.lost) == (10, 20)
    assert report.verdict == "fail"


def test_every_second_sample_lost_a_few_times_is_a_loss() -> None:
    frames = Device(design()).frames(SAMPLES)[1:]
    report = judge(frames[:100] + frames[101:112:2] + frames[112:]).report(Thresholds())
    assert (report.stride, report.lost) == (1, 6)


def test_reordered_and_repeated_samples_are_left_out_and_not_lost() -> None:
    frames = Device(design()).frames(SAMPLES)[1:]
    frames[100], frames[101] = frames[101], frames[100]
    frames.insert(200, frames[190])
    frames.insert(300, frames[299])
    late = frames.pop(320)
    frames.insert(340, late)
    report = judge(frames).report(Thresholds())
    assert (report.late, report.repeated, report.lost) == (2, 2, 0)
    assert (report.samples, report.mismatches) == (SAMPLES, 0)
    assert report.checked == SAMPLES - 4, "a late one and the one behind its gap are not checked"
    assert report.verdict == "pass"


@pytest.mark.parametrize("seed", range(20))
def test_injected_losses_swaps_and_copies_are_counted_exactly(seed: int) -> None:
    rng = np.random.default_rng(seed)
    frames = Device(design()).frames(SAMPLES)[1:]
    lost = set(rng.choice(np.arange(5, SAMPLES - 5), 12, replace=False).tolist())
    kept = [k for k in range(SAMPLES) if k not in lost]
    swapped = set(rng.choice(np.arange(5, len(kept) - 5, 3), 6, replace=False).tolist())
    for i in swapped:
        kept[i], kept[i + 1] = kept[i + 1], kept[i]
    copied = rng.choice(kept, 5, replace=False).tolist()
    for k in copied:
        kept.insert(kept.index(k) + int(rng.integers(1, 5)), k)
    report = judge([frames[k] for k in kept], batch=int(rng.integers(1, 60))).report(Thresholds())
    assert (report.lost, report.late, report.repeated) == (len(lost), len(swapped), len(copied))
    assert (report.samples, report.mismatches) == (SAMPLES - len(lost), 0)


def test_a_new_epoch_is_no_loss() -> None:
    frames = Device(design()).frames(SAMPLES)[1:]
    validator, decoder, d = Validator(design()), Decoder(), design()
    feed(validator, decoder, frames[:100], d)
    validator.begin_epoch()
    judged = feed(validator, decoder, frames[250:], d)
    report = validator.report(Thresholds())
    assert (report.lost, report.verdict) == (0, "pass")
    assert judged[0].begins[0]
    assert not judged[0].begins[1:].any()
    assert np.isnan(judged[0].residual_rad[0]).all()
    validator.begin_epoch()
    feed(validator, decoder, frames[:50], d)
    assert validator.report(Thresholds()).lost == 0


def test_the_counter_wraps_without_a_loss() -> None:
    m = Device(design()).module
    device, frames = Device(design()), []
    for k, frame in enumerate(Device(design()).frames(40)[1:]):
        message = Decoder().feed(frame)[0].message
        values = [getattr(message, name) for name in message.fieldnames]
        fields = dict(zip(message.fieldnames, values, strict=True))
        fields["sequence"] = (2**32 - 20 + k) % 2**32
        frames.append(device._pack(m.MAVLink_tilt_sample_message(**fields)))
    report = judge(frames).report(Thresholds())
    assert (report.lost, report.checked, report.mismatches) == (0, 40, 0)


def test_restarted_verdict_forgets_figures_and_goes_on() -> None:
    frames = Device(design()).frames(SAMPLES)[1:]
    validator, decoder, d = Validator(design()), Decoder(), design()
    feed(validator, decoder, frames[:100] + frames[110:200], d)
    validator.restart()
    report = validator.report(Thresholds())
    assert (report.samples, report.lost, report.rms_rad) == (0, 0, None)
    feed(validator, decoder, frames[200:], d)
    report = validator.report(Thresholds())
    assert (report.samples, report.checked, report.verdict) == (200, 200, "pass")


def test_judged_samples_carry_both_models() -> None:
    device = Device(design())
    states = device.states(SAMPLES)
    states[200, 1] ^= 1
    validator, decoder = Validator(design()), Decoder()
    frames = device.frames(SAMPLES, states=states)
    judged = feed(validator, decoder, frames[:100] + frames[102:], design(), batch=1000)[0]
    assert len(judged) == SAMPLES - 2
    assert np.flatnonzero(judged.mismatch).tolist() == [198, 199]
    assert np.flatnonzero(judged.begins).tolist() == [0, 99]
    assert np.flatnonzero(np.isnan(judged.model_rad[:, 0])).tolist() == [99]
    away = judged.device_rad - judged.model_rad
    np.testing.assert_allclose(away, judged.residual_rad, atol=1e-14)
    assert judged.time_us[1] - judged.time_us[0] == 10_000


def test_a_filter_in_float_is_held_against_the_float_model() -> None:
    """Noise below the tolerance passes, and one sample far off does not."""
    device = Device(design())
    states = device.states(SAMPLES)
    states[:, :2] += np.random.default_rng(0).integers(-50, 50, (SAMPLES, 2))
    assert judge(device.frames(SAMPLES, states=states)).report(Thresholds()).verdict == "fail"
    report = judge(device.frames(SAMPLES, states=states), tolerance_rad=1e-5).report(Thresholds())
    assert (report.verdict, report.mismatches, report.checked) == ("pass", 0, SAMPLES)
    states[200, 0] += 100_000
    report = judge(device.frames(SAMPLES, states=states), tolerance_rad=1e-5).report(Thresholds())
    assert (report.verdict, report.mismatches) == ("fail", 1)
    assert (
        report.reasons[0] == "1 of 400 steps differ from the float model by more than 0.000573 deg"
    )
    with pytest.raises(HostkitError, match="tolerance_rad"):
        Validator(design(), tolerance_rad=0.0)


def test_a_huge_gap_is_counted_and_costs_nothing() -> None:
    device = Device(design())
    frames = device.frames(20)
    message = Decoder().feed(frames[-1])[0].message
    fields = {name: getattr(message, name) for name in message.fieldnames}
    for jump in (2**31 - 2, 2**31 + 10, 5, 2**32 - 1):
        fields["sequence"] = (fields["sequence"] + jump) % 2**32
        fields["time_usec"] = 2**64 - 1 - jump
        frames.append(device._pack(device.module.MAVLink_tilt_sample_message(**fields)))
    report = judge(frames).report(Thresholds())
    assert report.lost > 2**30
    assert report.verdict == "fail"


NUMBERS = st.sampled_from([0, 1, 2, 63, 1025, 2**31 - 1, 2**31, 2**32 - 1]) | st.integers(0, 2**32)
WORDS = st.sampled_from([-(2**31), -1, 0, 2**31 - 1]) | st.integers(-(2**31), 2**31 - 1)
COUNTS = st.sampled_from([-32768, -1, 0, 32767])
TIMES = st.sampled_from([0, 2**63 - 1, -(2**63), -1]) | st.integers(0, 10**9)
SAMPLE = st.tuples(NUMBERS, TIMES, COUNTS, COUNTS, WORDS, WORDS, st.booleans(), st.booleans())
VALUE = st.tuples(
    st.sampled_from([p.name for p in device_parameters(design())]) | st.text(max_size=16),
    st.floats(width=32) | st.sampled_from([0.5, 0.01, -0.01]),
)


@pytest.mark.parametrize("options", [{}, {"tolerance_rad": 1e-5}, {"as_designed": True}])
@pytest.mark.parametrize("d", [design(), all_parameters()], ids=["eta", "all"])
def test_nothing_that_a_device_says_breaks_it(d, options: dict[str, object]) -> None:
    @settings(max_examples=60, deadline=None)
    @given(st.lists(st.lists(SAMPLE, max_size=12) | VALUE | st.just("doubt"), max_size=8))
    def hold(said: list) -> None:
        validator, came = Validator(d, **options), 0
        for piece in said:
            if piece == "doubt":
                validator.doubt_parameters()
            elif isinstance(piece, tuple):
                validator.told(*piece)
            else:
                came += len(piece)
                judged = validator.add(trace_from(piece, len(validator.spec.state_per_unit)))
                assert not np.isinf(judged.residual_rad).any()
        report = validator.report(Thresholds(max_lag_ms=1.0))
        assert report.samples + report.repeated == came
        assert 0 <= report.mismatches <= report.checked <= report.samples
        assert 0 <= report.lost < 2**32 * (came + 1)
        assert report.verdict != "pass" or report.checked

    hold()


def trace_from(rows: list, words: int) -> AngleTrace:
    columns = [np.array([row[i] for row in rows], dtype=np.int64) for i in range(8)]
    number, time, accel, gyro, first, second, restarted, retuned = columns
    return AngleTrace(
        sequence=number % 2**32,
        time_us=time,
        accel_count=np.stack([accel, gyro, accel], axis=1).reshape(-1, 3),
        gyro_count=np.stack([gyro, gyro, accel], axis=1).reshape(-1, 3),
        state_raw=np.stack([first, second, second, first], axis=1).reshape(-1, 4)[:, :words],
        restarted=restarted != 0,
        retuned=retuned != 0,
    )
