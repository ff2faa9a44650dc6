"""A filter whose state does not fit TILT_SAMPLE: what the firmware around it makes of that."""

from itertools import pairwise
from pathlib import Path

import pytest
from boards import RESTARTED, TARGET_TOOLS, Heard, hear, require_or_skip, stimulus
from ground import ACCEPTED, DENIED, TEMPORARILY_REJECTED, Ground, acks, resting, values
from long_filter import PARAMETERS, states, with_long_filter, with_slow_link, words_after

from hostkit.emulation import avr_board, host_board
from hostkit.emulation.make import make
from hostkit.render import FirmwareOptions

ATTITUDE, TILT_SAMPLE, TILT_STATE = 30, 52050, 52051
INTERVAL, REQUEST, CALIBRATE, STORE = 511, 512, 241, 245
RETUNED = 4


@pytest.fixture(scope="session", params=[False, True], ids=["plain", "signing"])
def folder(tmp_path_factory: pytest.TempPathFactory, request: pytest.FixtureRequest) -> Path:
    """Code of the host with the long filter, built with sanitizers."""
    require_or_skip("gcc", "make")
    options = FirmwareOptions(signing=request.param)
    code = with_long_filter("host", tmp_path_factory.mktemp("long"), options)
    host_board.build(code, sanitize=True)
    return code


def assert_behind_their_samples(heard: Heard) -> None:
    """Each state comes right behind the sample it belongs to, and no sample comes twice."""
    behind = [
        (before.name, before.message.sequence, after.message.sequence)
        for before, after in pairwise(f for f in heard.frames)
        if after.name == "TILT_STATE"
    ]
    assert behind == [("TILT_SAMPLE", sequence, sequence) for sequence, _ in states(heard)]
    told = [s.sequence for s in heard.samples]
    assert told == sorted(set(told))


def assert_told_after_each_second(heard: Heard, samples: int) -> None:
    assert [s.sequence for s in heard.samples] == list(range(samples))
    assert_behind_their_samples(heard)
    assert [sequence for sequence, _ in states(heard)] == list(range(0, samples, 100))
    for sequence, words in states(heard):
        assert words[:13] == words_after(heard, 0, sequence)
        assert words[16] == words[0]


def test_the_state_is_told_once_a_second_behind_its_sample(folder: Path) -> None:
    heard = hear(host_board.run(folder, stimulus(350)))
    assert_told_after_each_second(heard, 350)
    assert {tuple(s.hidden) for s in heard.samples} == {(0, 0)}


def test_an_avr_tells_the_same(tmp_path: Path) -> None:
    require_or_skip(*TARGET_TOOLS["atmega328p"])
    code = with_long_filter("atmega328p", tmp_path / "code")
    make(code, "WERROR=1")
    avr_board.build(code)
    assert_told_after_each_second(hear(avr_board.run(code, stimulus(250))), 250)


def test_it_compiles_without_a_warning(tmp_path: Path) -> None:
    require_or_skip("make", "arm-none-eabi-gcc")
    make(with_long_filter("stm32f103", tmp_path / "code"), "WERROR=1")


def test_a_state_is_told_on_request_and_brings_no_sample_twice(folder: Path) -> None:
    ground = Ground()
    ground.command(0.0, REQUEST, TILT_STATE)
    for time_s in (1.333, 1.337, 1.342):
        ground.command(time_s, REQUEST, TILT_STATE)
    heard = ground.run(folder, stimulus(250))
    assert acks(heard) == [(REQUEST, TEMPORARILY_REJECTED)] + 3 * [(REQUEST, ACCEPTED)]
    told = states(heard)
    assert 4 <= len(told) <= 6
    by_request = [sequence for sequence, _ in told if sequence % 100]
    assert by_request
    for sequence, words in told:
        assert words[:13] == words_after(heard, 0, sequence)
    sequences = [s.sequence for s in heard.samples]
    assert sequences == list(range(250))


def test_a_state_brings_its_sample_where_samples_are_off_or_few(folder: Path) -> None:
    ground = Ground()
    ground.command(1.0, INTERVAL, TILT_SAMPLE, -1)
    ground.command(1.0, INTERVAL, TILT_STATE, 130_000)
    ground.command(2.5, INTERVAL, TILT_SAMPLE, 70_000)
    heard = ground.run(folder, stimulus(400))
    assert acks(heard) == [(INTERVAL, ACCEPTED)] * 3
    assert_behind_their_samples(heard)
    sequences = [sequence for sequence, _ in states(heard)][2:]
    assert {b - a for a, b in pairwise(sequences)} == {13}
    assert len(sequences) > 10


def test_the_interval_of_states_is_set_and_bound_by_the_link(folder: Path) -> None:
    ground = Ground()
    ground.command(1.0, INTERVAL, TILT_STATE, -1)
    ground.command(2.5, INTERVAL, TILT_STATE, 0)
    heard = ground.run(folder, stimulus(400))
    assert acks(heard) == [(INTERVAL, ACCEPTED)] * 2
    first, second = (sequence for sequence, _ in states(heard) if sequence)
    assert second - first == 100


def test_a_link_that_is_full_refuses_more_states(tmp_path: Path) -> None:
    require_or_skip("gcc", "make")
    code = with_long_filter("host", tmp_path / "code", FirmwareOptions(baud=115_200))
    host_board.build(code, sanitize=True)
    ground = Ground()
    ground.command(0.5, INTERVAL, TILT_STATE, 10_000)
    assert acks(ground.run(code, stimulus(100))) == [(INTERVAL, DENIED)]


def test_its_parameters_are_listed_set_and_kept(folder: Path) -> None:
    ground = Ground()
    ground.list(0.3)
    ground.set(1.0, "FILT_KV", 0.5)
    ground.set(1.2, "FILT_KB", 3.0)
    ground.command(1.5, STORE, 1)
    run = ground.board_run(folder, stimulus(250))
    told = values(hear(run))
    assert [name for name, _ in told[:8]] == list(PARAMETERS)
    assert told[8:] == [("FILT_KV", 0.5), ("FILT_KB", 0.25)]
    later = Ground()
    later.read(0.3, "FILT_KV")
    assert values(later.run(folder, stimulus(100), store=run.store)) == [("FILT_KV", 0.5)]


def test_a_bias_starts_the_filter_anew_and_a_gain_does_not(folder: Path) -> None:
    ground = Ground()
    ground.set(0.7, "FILT_KT", 0.5)
    ground.set(1.31, "GYRO_BIAS_Z", -0.125)
    heard = ground.run(folder, stimulus(350))
    (first, again) = (s.sequence for s in heard.samples if s.flags & RESTARTED)
    assert first == 0
    retuned = [s.sequence for s in heard.samples if s.flags & RETUNED]
    assert retuned == list(range(retuned[0], 350))
    assert retuned[0] < again
    before, after = states(heard)[1], states(heard)[2]
    assert before[1][:13] == words_after(heard, 0, 100)
    assert after[1][:13] == words_after(heard, again, 200)
    assert after[1][13:16] == [0, 0, -125_000]


def test_three_biases_are_calibrated(folder: Path) -> None:
    bias_rad_s = (0.02, -0.03, 0.04)
    ground = Ground()
    ground.command(1.0, CALIBRATE, 1)
    heard = ground.run(folder, resting(400, bias_rad_s))
    found = dict(values(heard))
    for name, wanted in zip(PARAMETERS[5:], bias_rad_s, strict=True):
        assert found[name] == pytest.approx(wanted, abs=3e-4)
    _, words = states(heard)[-1]
    for word, name in zip(words[13:16], PARAMETERS[5:], strict=True):
        assert word == pytest.approx(1e6 * found[name], abs=0.51)


def test_all_values_are_told_and_used_even_if_they_do_not_fit_at_once(folder: Path) -> None:
    """With signatures six frames are longer than the queue of a board."""
    ground = Ground()
    for i, name in enumerate(PARAMETERS[2:]):
        ground.set(0.5 + 0.01 * i, name, 0.5)
    ground.command(1.5, STORE, 2)
    heard = ground.run(folder, stimulus(350))
    told = values(heard)
    assert told[:6] == [(name, 0.5) for name in PARAMETERS[2:]]
    assert sorted(told[6:]) == sorted(
        [(name, 0.25) for name in PARAMETERS[2:5]]
        + [(name, 0.0) for name in PARAMETERS[5:]]
        + [("SYS_ID", 1.0), ("CAL_START", 0.0)]
    )
    by_sequence = dict(states(heard))
    assert by_sequence[100][13:16] == [500_000] * 3
    assert by_sequence[200][13:16] == [0] * 3
    flags = {s.sequence: s.flags & RETUNED for s in heard.samples}
    assert (flags[100], flags[300]) == (RETUNED, 0)


def assert_made_with_what_was_told(heard: Heard) -> None:
    """The biases of each state are those of the last PARAM_VALUEs before it."""
    used = dict.fromkeys(PARAMETERS[5:], 0.0)
    checked = set()
    for frame in heard.frames:
        if frame.name == "PARAM_VALUE" and frame.message.param_id in used:
            used[frame.message.param_id] = frame.message.param_value
        if frame.name == "TILT_STATE":
            assert frame.message.words[13:16] == [round(1e6 * value) for value in used.values()]
            checked.add(tuple(used.values()))
    assert (0.5, 0.0, 0.0) in checked
    assert (0.0, 0.0, 0.5) in checked, "a sample between two parts of what is told"


def test_a_slow_link_parts_neither_states_from_samples_nor_values_from_their_use(
    tmp_path: Path,
) -> None:
    require_or_skip("gcc", "make")
    code = with_long_filter("host", tmp_path / "code", FirmwareOptions(signing=True))
    host_board.build(with_slow_link(code, 10_000), sanitize=True)
    ground = Ground()
    for message in (TILT_SAMPLE, TILT_STATE):
        ground.command(0.4, INTERVAL, message, 20_000)
    ground.command(0.4, INTERVAL, ATTITUDE, -1)
    for second in range(1, 5):
        for i, name in enumerate(PARAMETERS[2:]):
            ground.set(second + 0.043 * i, name, 0.5)
        ground.command(second + 0.5 + 0.0037 * second, STORE, 2)
    heard = ground.run(code, stimulus(500))
    assert_behind_their_samples(heard)
    assert_made_with_what_was_told(heard)
