"""An emulated run is judged by the states that the device told, too."""

import numpy as np
import pytest
from slow_filter import SlowDevice, is_state, lower, register, run_float, run_integer, slow_design

from hostkit.emulation.board import BoardRun
from hostkit.emulation.comparison import Answer, compare, compare_with_faults
from hostkit.emulation.run import answer_of, heard_of
from hostkit.sensors.counts import Counts
from hostkit.targets import TARGETS
from hostkit.trace import ToldState

HOST, SAMPLES = TARGETS["host"], 200


@pytest.fixture(autouse=True)
def slow_filter(monkeypatch: pytest.MonkeyPatch) -> None:
    register(monkeypatch)


def counts_of(device: SlowDevice) -> Counts:
    accel, gyro = device.counts(SAMPLES)
    return Counts(accel=accel, gyro=gyro)


def result_of(device: SlowDevice, frames: list[bytes]):
    answer = answer_of(BoardRun(stream=b"".join(frames)), HOST, device.design)
    return compare(HOST, device.design, counts_of(device), answer)


def test_right_states_pass_and_are_counted() -> None:
    device = SlowDevice(slow_design())
    result = result_of(device, device.run(SAMPLES))
    assert (result.samples, result.mismatches, result.states_told) == (SAMPLES, 0, 3)
    assert result.passed
    assert run_float(device.design, *np.zeros((2, 1, 3))).shape == (1, 10)


def test_a_word_that_no_angle_shows_is_a_mismatch() -> None:
    device = SlowDevice(slow_design())
    result = result_of(device, device.run(SAMPLES, upset={100: (3, 4)}))
    assert (result.mismatches, result.passed) == (2, False)


def test_a_state_counts_by_itself_where_its_sample_is_missing_or_none() -> None:
    device = SlowDevice(slow_design())
    frames = device.run(SAMPLES)
    place = next(i for i, frame in enumerate(frames) if is_state(frame))
    del frames[place - 1]
    assert result_of(device, frames).mismatches == 0
    words = [9] * 8
    strange = [device.state_frame(50, words), device.state_frame(2**32 - 1, words)]
    assert result_of(device, [*frames, *strange]).mismatches == 2


def test_words_of_a_filter_in_float_are_not_compared() -> None:
    device = SlowDevice(slow_design())
    counts = counts_of(device)
    states = run_integer(lower(device.design), counts.accel, counts.gyro)
    answer = Answer(
        row=np.arange(SAMPLES),
        counts=counts,
        state_raw=states[:, :2],
        cycles_mean=None,
        cycles_max=None,
        tolerance_rad=1e-7,
        told=(ToldState(sequence=7, words_raw=(0,) * 8),),
    )
    assert compare(HOST, device.design, counts, answer).mismatches == 0


@pytest.mark.parametrize(("upset", "mismatches"), [({}, 0), ({100: (3, 4)}, 2)])
def test_states_of_a_run_with_faults_are_those_since_its_restart(upset, mismatches) -> None:
    device = SlowDevice(slow_design())
    frames = device.run(SAMPLES, restarts=(70,), upset=upset)
    heard = heard_of(BoardRun(stream=b"".join(frames)), HOST, device.design)
    result = compare_with_faults(
        HOST, device.design, counts_of(device), BoardRun(stream=b""), heard, (), None
    )
    assert (result.mismatches, result.states_told) == (mismatches, 3)
