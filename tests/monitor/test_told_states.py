import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from judging import judge
from slow_filter import SlowDevice, is_state, register, slow_design

from hostkit.link.frames.decoder import Decoder, trace_of
from hostkit.trace import ToldState
from hostkit.validation import Thresholds, Validator
from hostkit.validation.told_states import ToldStates

SAMPLES = 400
BATCHES = pytest.mark.parametrize("batch", [1, 7, 37, 1000])
UNSEEN = (3, 4)
"""A word and a bit that no angle shows."""


@pytest.fixture(autouse=True)
def slow_filter(monkeypatch: pytest.MonkeyPatch) -> None:
    register(monkeypatch)


def verdict(frames: list[bytes], *, batch: int = 37, lost_share: float = 0.5, **options):
    d = slow_design()
    return judge(frames, d, batch=batch, **options).report(Thresholds(max_lost_share=lost_share))


def without_sample(frames: list[bytes], *sequences: int) -> list[bytes]:
    kept = [frame for frame in frames if number(frame) not in sequences]
    assert len(kept) == len(frames) - len(sequences)
    return kept


def number(frame: bytes) -> int | None:
    message = Decoder().feed(frame)[0].message
    return message.sequence if message.get_type() == "TILT_SAMPLE" else None


@BATCHES
@pytest.mark.parametrize("axes", ["roll", "pitch", "both"])
def test_a_right_device_passes(batch: int, axes: str) -> None:
    d = slow_design(axes=axes)
    report = judge(SlowDevice(d).run(SAMPLES), d, batch=batch).report(Thresholds())
    assert (report.verdict, report.reasons) == ("pass", ())
    assert (report.checked, report.mismatches, report.unjudged) == (SAMPLES, 0, 0)
    assert report.rms_rad is not None
    assert report.max_rad < 1e-8


@BATCHES
def test_one_bit_of_a_told_state_that_no_angle_shows_is_a_mismatch(batch: int) -> None:
    """The device goes on with it, and is right again by itself."""
    report = verdict(SlowDevice(slow_design()).run(SAMPLES, upset={130: UNSEEN}), batch=batch)
    assert (report.verdict, report.mismatches) == ("fail", 1)
    assert report.rms_rad < 1e-8


@BATCHES
def test_after_a_lost_sample_the_models_take_up_at_the_next_told_state(batch: int) -> None:
    frames = without_sample(SlowDevice(slow_design()).run(SAMPLES), 130)
    report = verdict(frames, batch=batch)
    assert (report.verdict, report.lost, report.mismatches) == ("pass", 1, 0)
    assert report.unjudged == report.waiting
    # A state that came behind its batch is taken up with the next one.
    assert report.waiting == 20
    assert report.checked == SAMPLES - 1 - report.waiting
    assert report.longest_wait_s == pytest.approx(0.01 * report.waiting)


@BATCHES
def test_what_is_wrong_behind_a_gap_is_found_at_the_state_after_next(batch: int) -> None:
    frames = without_sample(SlowDevice(slow_design()).run(SAMPLES, upset={170: UNSEEN}), 130)
    report = verdict(frames, batch=batch)
    assert (report.verdict, report.mismatches) == ("fail", 1)


@BATCHES
@pytest.mark.parametrize("first", [1, 77, 151])
def test_a_device_that_is_met_in_mid_flight_is_judged_from_its_next_state_on(
    batch: int, first: int
) -> None:
    frames = SlowDevice(slow_design()).run(SAMPLES)
    begin = next(i for i, frame in enumerate(frames) if number(frame) == first)
    report = verdict(frames[begin:], batch=batch)
    assert (report.verdict, report.lost, report.mismatches) == ("pass", 0, 0)
    assert report.waiting == -(-first // 50) * 50 - first + 1
    assert report.checked == SAMPLES - first - report.waiting


@pytest.mark.parametrize("first", [0, 1])
def test_a_device_that_never_tells_its_state_is_judged_from_its_start_or_not_at_all(first) -> None:
    frames = [f for f in SlowDevice(slow_design()).run(SAMPLES) if not is_state(f)]
    report = verdict(frames[first:])
    assert (report.verdict, report.checked) == (("pass", 400), ("fail", 0))[first]
    if first:
        assert report.reasons[0].startswith("no step could be checked: the device has not told")


def test_a_wait_without_end_fails_though_something_was_checked() -> None:
    frames = [f for f in SlowDevice(slow_design()).run(1200) if not is_state(f)]
    report = verdict(without_sample(frames, 100))
    assert (report.verdict, report.mismatches) == ("fail", 0)
    assert report.reasons == (
        "the state of the filter was not known for 11.0 s; "
        "have the device send TILT_STATE more often",
    )


@BATCHES
def test_one_lost_sample_of_a_short_run_does_not_fail(batch: int) -> None:
    frames = without_sample(SlowDevice(slow_design()).run(45), 5)
    report = verdict(frames, batch=batch)
    assert (report.verdict, report.checked, report.waiting) == ("pass", 5, 39)


def test_a_lost_state_costs_nothing() -> None:
    frames = SlowDevice(slow_design()).run(SAMPLES)
    first = next(i for i, frame in enumerate(frames) if is_state(frame))
    report = verdict(frames[:first] + frames[first + 1 :])
    assert (report.verdict, report.checked, report.lost) == ("pass", SAMPLES, 0)


@BATCHES
def test_a_filter_that_begins_anew_is_followed(batch: int) -> None:
    report = verdict(SlowDevice(slow_design()).run(SAMPLES, restarts=(130, 150)), batch=batch)
    assert (report.verdict, report.checked, report.mismatches) == ("pass", SAMPLES, 0)


@BATCHES
@pytest.mark.parametrize("samples", [20, 51, 190])
def test_a_device_that_begins_anew_is_followed(batch: int, samples: int) -> None:
    frames = SlowDevice(slow_design()).run(samples) + SlowDevice(slow_design(), seed=2).run(200)
    report = verdict(frames, batch=batch)
    assert (report.verdict, report.checked, report.mismatches) == ("pass", samples + 200, 0)


@BATCHES
def test_a_restart_whose_first_sample_was_lost_is_no_mismatch(batch: int) -> None:
    """The first state of the new run may come before any of its samples did."""
    again = SlowDevice(slow_design(), seed=2)
    new = [f for f in again.run(200) if is_state(f) or number(f) > 50]
    report = verdict(SlowDevice(slow_design()).run(3000) + new, batch=batch)
    assert (report.verdict, report.mismatches) == ("pass", 0)


@BATCHES
def test_a_state_without_its_sample_before_a_restart_is_no_mismatch(batch: int) -> None:
    old = SlowDevice(slow_design()).run(2951)
    assert is_state(old[-1])
    frames = [*old[:-2], old[-1], *SlowDevice(slow_design(), seed=2).run(200)]
    report = verdict(frames, batch=batch)
    assert (report.verdict, report.mismatches) == ("pass", 0)


@BATCHES
def test_a_late_state_from_before_a_gap_is_passed_over(batch: int) -> None:
    """Nothing can be computed across the sample that is missing."""
    frames = without_sample(SlowDevice(slow_design()).run(SAMPLES), 130, 152)
    place = next(i for i, frame in enumerate(frames) if number(frame) == 150) + 1
    assert is_state(frames[place])
    moved = [*frames[:place], *frames[place + 1 : place + 4], frames[place], *frames[place + 4 :]]
    report = verdict(moved, batch=batch)
    assert (report.verdict, report.mismatches) == ("pass", 0)


@BATCHES
def test_states_of_no_sample_are_mismatches(batch: int) -> None:
    device = SlowDevice(slow_design())
    wrong = [device.state_frame(k, [1, 2, 3, 4, 5, 6, 7, 8]) for k in (2**31, 70_000, 2**32 - 5000)]
    frames = SlowDevice(slow_design()).run(SAMPLES)
    report = verdict([*frames[:100], *wrong, *frames[100:]], batch=batch)
    assert (report.verdict, report.mismatches) == ("fail", 3)
    assert report.checked == SAMPLES + 3


def test_a_state_may_come_before_its_sample_or_far_behind_it() -> None:
    frames = SlowDevice(slow_design()).run(SAMPLES)
    at = [i for i, frame in enumerate(frames) if is_state(frame)]
    early, late = frames[at[1]], frames[at[2]]
    rest = [frame for frame in frames if frame not in (early, late)]
    for batch in (1, 10, 1000):
        moved = [*rest[:99], early, *rest[99:190], late, *rest[190:]]
        assert verdict(moved, batch=batch).verdict == "pass"
        # A state that comes behind its sample by more than is kept is passed over.
        assert verdict([*rest[:300], late, *rest[300:]], batch=batch).verdict == "pass"


@BATCHES
def test_a_late_state_that_is_news_is_caught_up_with(batch: int) -> None:
    frames = without_sample(SlowDevice(slow_design()).run(SAMPLES), 130)
    at = next(i for i, frame in enumerate(frames) if is_state(frame) and i > 130)
    moved = [*frames[:at], *frames[at + 1 : at + 11], frames[at], *frames[at + 11 :]]
    report = verdict(moved, batch=batch)
    assert (report.verdict, report.mismatches) == ("pass", 0)
    assert report.checked >= SAMPLES - 1 - 20 - 11


@BATCHES
def test_a_retuned_device_is_followed_with_the_parameters_that_it_told(batch: int) -> None:
    changes = {120: {"SLOW_GAIN": 5.0}, 180: {"SLOW_BIAS": 9.0}, 260: {"SLOW_GAIN": 2.0}}
    report = verdict(
        SlowDevice(slow_design()).run(SAMPLES, changes={0: {"SLOW_BIAS": 7.0}, **changes}),
        batch=batch,
    )
    # The gain was told at 120 and the bias at the start; the samples between are known.
    assert (report.verdict, report.reasons) == ("pass", ())
    assert (report.mismatches, report.checked) == (0, SAMPLES)
    assert {p.name for p in report.retuned} == {"SLOW_BIAS"}


def test_a_gain_that_was_not_told_is_found_by_the_words_alone() -> None:
    """No angle shows the gain."""
    device = SlowDevice(slow_design())
    frames = device.run(SAMPLES, changes={0: {"SLOW_BIAS": 9.0}, 120: {"SLOW_GAIN": 5.0}})
    lied = [device.told("SLOW_GAIN", 6.0) if f[7:10] == b"\x16\0\0" else f for f in frames]
    told = Decoder().feed(lied[0])[0].message
    assert told.get_type() == "PARAM_VALUE"
    lied[0] = device.told("SLOW_BIAS", 9.0)
    report = verdict(lied)
    assert (report.verdict, report.mismatches > 0) == ("fail", True)


@BATCHES
def test_a_change_that_was_lost_is_withheld_and_not_counted(batch: int) -> None:
    d = slow_design()
    device = SlowDevice(d)
    frames = device.run(SAMPLES, changes={0: {"SLOW_BIAS": 9.0}, 120: {"SLOW_GAIN": 5.0}})
    lost = next(i for i, f in enumerate(frames) if i and f[7:10] == b"\x16\0\0")
    validator, decoder = Validator(d), Decoder()
    again = [device.told("SLOW_GAIN", 5.0), device.told("SLOW_BIAS", 9.0)]
    for begin in range(0, SAMPLES, batch):
        part = [f for i, f in enumerate(frames) if begin <= i < begin + batch and i != lost]
        samples = []
        for frame in decoder.feed(b"".join(part)):
            if frame.name == "PARAM_VALUE":
                validator.told(frame.message.param_id, frame.message.param_value)
            else:
                samples.append(frame)
        if begin == 0:
            validator.told("SLOW_GAIN", 2.0)
        if begin <= lost < begin + batch:
            validator.doubt_parameters()
        validator.add(trace_of(samples, ("roll", "pitch"), hidden_words=8))
        if validator.untold:
            for told in Decoder().feed(b"".join(again)):
                validator.told(told.message.param_id, told.message.param_value)
    report = validator.report(Thresholds())
    assert (report.mismatches, report.untold) == (0, ())
    assert report.checked > 0


def test_begin_epoch_takes_up_at_the_next_state() -> None:
    d = slow_design()
    frames = SlowDevice(d).run(SAMPLES)
    validator, decoder = Validator(d), Decoder()
    for part in (frames[:120], frames[180:]):
        validator.begin_epoch()
        found = decoder.feed(b"".join(part))
        validator.add(trace_of(found, ("roll", "pitch"), hidden_words=8))
    report = validator.report(Thresholds())
    assert (report.verdict, report.lost, report.mismatches) == ("pass", 0, 0)
    assert report.waiting == 24


@pytest.mark.parametrize("first", [0, 77])
def test_a_filter_in_float_is_held_against_the_float_model_only(first: int) -> None:
    frames = SlowDevice(slow_design()).run(SAMPLES, upset={130: UNSEEN})
    begin = next(i for i, frame in enumerate(frames) if number(frame) == first)
    for batch in (1, 37):
        report = verdict(frames[begin:], batch=batch, tolerance_rad=1e-7)
        assert (report.verdict, report.mismatches) == ("pass", 0)
        assert report.checked == (400 if not first else 299)


def test_any_number_of_late_states_costs_no_more_than_a_few() -> None:
    told = tuple(ToldState(sequence=k % 40, words_raw=(k,)) for k in range(1000))
    found = ToldStates().sort(told, [60, 61], range(40), anew=False)
    assert [state.words_raw[0] for state in found.late] == [996, 997, 998, 999]
    assert found.wrong == 0


@settings(max_examples=40, deadline=None)
@given(
    st.lists(
        st.tuples(
            st.integers(0, 2**32 - 1) | st.integers(0, 60), st.binary(min_size=96, max_size=96)
        ),
        max_size=20,
    ),
    st.integers(1, 30),
)
def test_hostile_states_break_nothing(states, batch: int) -> None:
    device = SlowDevice(slow_design())
    frames = device.run(60)
    for at, (sequence, content) in enumerate(states):
        words = np.frombuffer(content.ljust(96, b"\xff"), dtype="<i4").tolist()
        frames.insert((at * 7) % len(frames), device.state_frame(sequence, words))
    report = judge(frames, slow_design(), batch=batch).report(Thresholds())
    assert 0 <= report.mismatches <= report.checked
