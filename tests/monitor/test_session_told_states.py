"""A session with a device that tells its state in messages of their own."""

import math

import pytest
from fake_ports import FakeClock, FakeTransport
from slow_filter import STATE_ID, SlowDevice, is_state, register, slow_design

from hostkit.dialect import python_module
from hostkit.monitor import Session, SessionOptions, SessionResult
from hostkit.validation import Thresholds

SAMPLES = 400
CHUNK = 10


@pytest.fixture(autouse=True)
def slow_filter(monkeypatch: pytest.MonkeyPatch) -> None:
    register(monkeypatch)


class Replayed(FakeTransport):
    """Frames in pieces of any size; the stream ends with them."""

    live = False


class AskedPort(FakeTransport):
    """A live device that tells its state only when it is asked for it."""

    def __init__(self, frames: list[bytes], clock: FakeClock) -> None:
        self._frames, self._clock, self.asked_s = list(frames), clock, []
        self._heard = python_module().MAVLink(None)
        self._wanted = 0
        super().__init__()

    def read(self, timeout_s: float) -> bytes | None:
        self._clock.sleep(0.1)
        data = b""
        for _ in range(CHUNK):
            while self._frames and is_state(self._frames[0]):
                state = self._frames.pop(0)
                data += state if self._wanted > 0 else b""
                self._wanted -= self._wanted > 0
            data += self._frames.pop(0) if self._frames else b""
        return data

    def write(self, data: bytes) -> None:
        for message in self._heard.parse_buffer(data) or []:
            if message.get_type() == "COMMAND_LONG" and message.param1 == STATE_ID:
                assert (message.command, message.target_system) == (512, 1)
                self.asked_s.append(self._clock.monotonic())
                self._wanted += 1


def pieces(frames: list[bytes], size: int) -> list[bytes]:
    stream = b"".join(frames)
    return [stream[i : i + size] for i in range(0, len(stream), size)]


def session(frames: list[bytes], size: int = 700) -> SessionResult:
    return Session(
        design=slow_design(),
        transport=Replayed(*pieces(frames, size), then=None),
        thresholds=Thresholds(),
        clock=FakeClock(),
    ).run()


@pytest.mark.parametrize("size", [50, 97, 700, 10**6])
def test_states_reach_the_models_however_the_bytes_come(size: int) -> None:
    frames = SlowDevice(slow_design()).run(SAMPLES, changes={150: {"SLOW_BIAS": 9.0}})
    frames.insert(0, SlowDevice(slow_design()).told("SLOW_GAIN", 2.0))
    report = session(frames, size).report
    assert (report.verdict, report.reasons) == ("pass", ())
    assert (report.checked, report.unjudged) == (SAMPLES, 0)


@pytest.mark.parametrize("size", [50, 97, 700, 10**6])
def test_a_wrong_state_fails_a_session(size: int) -> None:
    report = session(SlowDevice(slow_design()).run(SAMPLES, upset={130: (3, 4)}), size).report
    assert (report.verdict, report.mismatches) == ("fail", 1)


def test_states_of_other_senders_are_passed_over() -> None:
    frames = SlowDevice(slow_design()).run(SAMPLES)
    other = SlowDevice(slow_design())
    other.mav.srcSystem = 7
    wrong = [other.state_frame(k, [0] * 8) for k in (50, 50, 100, 2**31)]
    report = session([wrong[0], *frames[:70], *wrong[1:], *frames[70:]]).report
    assert (report.verdict, report.mismatches) == ("pass", 0)


def test_a_session_shows_the_facts_and_the_wait() -> None:
    result = session(SlowDevice(slow_design()).run(SAMPLES)[20:])
    assert result.info is not None
    assert result.info.filter == "slow filter"
    assert [fact.text() for fact in result.info.facts] == ["gain 2"]
    assert result.report.waiting == 31
    assert result.report.rms_rad < math.radians(0.005)


@pytest.mark.parametrize("passive", [False, True])
def test_a_state_that_is_needed_is_asked_for(passive: bool) -> None:
    """Met in mid-flight, and then a sample is lost: each time once is enough."""
    clock = FakeClock()
    frames = SlowDevice(slow_design(), every=1).run(1000)[21:]
    assert not is_state(frames.pop(1000))
    port = AskedPort(frames, clock)
    report = (
        Session(
            design=slow_design(),
            transport=port,
            thresholds=Thresholds(),
            clock=clock,
            duration_s=9.0,
            options=SessionOptions(passive=passive),
        )
        .run()
        .report
    )
    assert (report.verdict, report.mismatches) == (("pass", "fail")[passive], 0)
    assert len(port.asked_s) == (0 if passive else 2)
    if not passive:
        assert report.waiting < 60
