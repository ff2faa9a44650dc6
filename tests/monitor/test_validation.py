import math

import numpy as np
import pytest
from designs import all_parameters, design
from device import Device

from hostkit.errors import HostkitError
from hostkit.link.decoder import Decoder, trace_of
from hostkit.records import AXES
from hostkit.validation import Thresholds, Validator

SAMPLES = 400


def judge(frames: list[bytes], d=None, *, batch: int = 37) -> Validator:
    d = d or design()
    validator, decoder = Validator(d), Decoder()
    for i in range(0, len(frames), batch):
        got = decoder.feed(b"".join(frames[i : i + batch]))
        hidden_words = len(validator.spec.hidden)
        validator.add(trace_of(got, AXES[d.axes], hidden_words=hidden_words))
    return validator


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
