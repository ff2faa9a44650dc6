"""Whatever comes over the link: the host firmware, built with checks, goes on sampling."""

import random
from pathlib import Path

import pytest
from boards import hear, stimulus
from ground import REAL32, Ground, M, acks, values
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

SAMPLES = 150
NO_DEADLINE = settings(
    max_examples=25, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)


def assert_sampling_goes_on(heard) -> None:
    assert [s.sequence for s in heard.samples] == list(range(SAMPLES))
    assert heard.decoder.bad == heard.decoder.unknown == heard.decoder.lost_frames == 0


@given(data=st.binary(min_size=0, max_size=2000), after_s=st.floats(0.0, 1.5))
@NO_DEADLINE
def test_any_bytes(host_folder: Path, data: bytes, after_s: float) -> None:
    ground = Ground()
    ground.raw(after_s, data)
    assert_sampling_goes_on(ground.run(host_folder, stimulus(SAMPLES)))


FLOATS = st.floats(width=32, allow_nan=True, allow_infinity=True)
BYTES = st.integers(0, 255)
TO_US = st.sampled_from([0, 1, 1, 1, 2, 255])
MESSAGES = st.one_of(
    st.builds(
        lambda to, number, confirmation, v: M.MAVLink_command_long_message(
            to, to, number, confirmation, *v
        ),
        TO_US,
        st.sampled_from([511, 512, 241, 245, 31010, 0, 65535]),
        BYTES,
        st.lists(
            st.one_of(FLOATS, st.sampled_from([0.0, 1.0, 2.0, 26.0, 27.0, 30.0, 105.0, 148.0])),
            min_size=7,
            max_size=7,
        ),
    ),
    st.builds(
        lambda name, v: M.MAVLink_param_set_message(1, 1, name, v, REAL32),
        st.one_of(
            st.binary(max_size=16),
            st.sampled_from([b"SYS_ID", b"FILT_TAU", b"CAL_START", b"GYRO_BIAS_ROLL"]),
        ),
        FLOATS,
    ),
    st.builds(
        lambda name, i: M.MAVLink_param_request_read_message(1, 1, name, i),
        st.binary(max_size=16),
        st.integers(-(2**15), 2**15 - 1),
    ),
    st.builds(lambda a, b: M.MAVLink_param_request_list_message(a, b), TO_US, TO_US),
    st.builds(lambda s: M.MAVLink_timesync_message(0, s), st.integers(-(2**63), 2**63 - 1)),
    st.builds(
        lambda t, s, a, b: M.MAVLink_ping_message(t, s, a, b),
        st.integers(0, 2**64 - 1),
        st.integers(0, 2**32 - 1),
        TO_US,
        TO_US,
    ),
)


@given(messages=st.lists(st.tuples(st.floats(0.0, 1.5), MESSAGES), max_size=40))
@NO_DEADLINE
def test_any_messages(host_folder: Path, messages: list) -> None:
    """All of them are well formed; no value of them breaks anything, and no sample is lost."""
    ground = Ground()
    for time_s, message in sorted(messages, key=lambda pair: pair[0]):
        ground.send(time_s, message)
    # a message that somebody has switched off, or made rarer, is not missed
    heard = ground.run(host_folder, stimulus(SAMPLES))
    counted = [s.sequence for s in heard.samples]
    assert counted == sorted(set(counted))
    assert heard.decoder.bad == heard.decoder.unknown == heard.decoder.lost_frames == 0
    assert heard.of("SYS_STATUS")


@pytest.mark.parametrize("seed", range(3))
def test_frames_that_break_off_and_noise_between_them(host_folder: Path, seed: int) -> None:
    rng = random.Random(seed)
    ground = Ground()
    whole = 0
    for i in range(100):
        frame = ground.frame(M.MAVLink_ping_message(i, i, 0, 0))
        if rng.random() < 0.5:
            frame = frame[: rng.randrange(len(frame))] + bytes(40)
        else:
            whole += 1
        ground.raw(0.5 + 0.008 * i, frame)
    heard = ground.run(host_folder, stimulus(SAMPLES))
    assert_sampling_goes_on(heard)
    answers = [m.seq for m in heard.of("PING")]
    assert len(answers) == whole
    assert answers == sorted(answers)


def test_a_link_that_is_never_silent_does_not_starve_the_sampling(host_folder: Path) -> None:
    """50 kB in one go, of which the receiver takes some at a time."""
    ground = Ground()
    frames = b"".join(ground.frame(M.MAVLink_ping_message(i, i, 0, 0)) for i in range(1000))
    ground.raw(0.6, frames + bytes(25_000))
    ground.command(1.3, 512, 148)
    heard = ground.run(host_folder, stimulus(SAMPLES))
    assert_sampling_goes_on(heard)
    assert [m.seq for m in heard.of("PING")] == list(range(1000))
    assert acks(heard) == [(512, 0)]


def test_settings_for_others_change_nothing(host_folder: Path) -> None:
    ground = Ground()
    ground.set(0.5, "FILT_TAU", 1.0, to=(7, 1))
    ground.command(0.6, 246, 1, to=(1, 7))
    ground.read(0.8, "FILT_TAU")
    run = ground.board_run(host_folder, stimulus(SAMPLES))
    assert "resets" not in dict(run.faults)
    assert [name for name, _ in values(hear(run))] == ["FILT_TAU"]
    assert not any(s.flags & 4 for s in hear(run).samples)
