"""One device behind a transport: found, asked, and gone."""

from collections.abc import Callable

import pytest
from answering import AnsweringDevice, ManualClock, Sender

from hostkit.errors import DeviceError, HostkitError
from hostkit.link.device.device_link import DeviceLink
from hostkit.link.frames.signing import SigningKey, sign_with


class Stream:
    """A transport that says what a function of the time says."""

    live, state, epoch, overrun_bytes = True, "connected", 0, 0

    def __init__(self, clock: ManualClock, say: Callable[[], bytes | None]) -> None:
        self._clock, self._say = clock, say

    def read(self, timeout_s: float) -> bytes | None:
        self._clock.now_s += timeout_s
        return self._say()

    def write(self, data: bytes) -> None:
        pass

    def close(self) -> None:
        pass


def joined(**options: object) -> tuple[DeviceLink, AnsweringDevice]:
    clock = ManualClock()
    device = AnsweringDevice(clock)
    return DeviceLink(device, clock=clock, **options), device


def listening(say: Callable[[], bytes | None], **options: object) -> DeviceLink:
    clock = ManualClock()
    return DeviceLink(Stream(clock, say), clock=clock, **options)


def test_a_device_is_found_listed_set_and_commanded() -> None:
    link, device = joined()
    with link:
        assert link.find() == (1, 1)
        assert [e.name for e in link.fetch()] == list(device.values)
        (outcome,) = link.set({"FILT_TAU": 1.5})
        assert (outcome.name, outcome.in_use, outcome.error) == ("FILT_TAU", 1.5, "")
        assert link.run("store").state == "accepted"
        assert link.rate_hz is None
        link.wait(lambda: False, 0.5)
        assert link.rate_hz == pytest.approx(100.0)
        assert link.digest == "000000000000"
    assert device.closed


def test_each_value_has_its_own_outcome() -> None:
    link, _ = joined()
    link.find()
    link.fetch()
    good, bad = link.set({"FILT_TAU": 1.5, "TILT_OFS_ROLL": 0.75})
    assert good.error == ""
    assert "the device keeps 0 rad" in bad.error
    with pytest.raises(HostkitError, match="no parameter 'NOPE'"):
        link.set({"FILT_TAU": 1.0, "NOPE": 1.0})


def test_a_deaf_device_is_told_of() -> None:
    link, device = joined()
    device.hears = lambda message: False
    link.find()
    with pytest.raises(DeviceError, match="did not answer 5 requests for its parameters"):
        link.fetch()
    (outcome,) = link.set({"FILT_TAU": 1.5})
    assert (outcome.in_use, outcome.error) == (None, "the device did not answer 4 requests")
    with pytest.raises(DeviceError, match="did not answer store"):
        link.run("store")


def test_a_refused_command_is_told_of() -> None:
    link, device = joined()
    device.results = [4]
    link.find()
    with pytest.raises(HostkitError, match="refused calibrate: failed"):
        link.run("calibrate")


def test_a_device_that_sends_no_samples_is_known_by_its_heartbeat() -> None:
    sender = Sender(7, 200)
    assert listening(sender.heartbeat).find() == (7, 200)


def test_ground_stations_are_no_devices() -> None:
    link = listening(lambda: Sender(255, 190).heartbeat(6))
    with pytest.raises(DeviceError, match="but no device"):
        link.find()


def test_of_several_systems_the_one_with_samples_is_meant() -> None:
    vehicle, board = Sender(3, 1), Sender(3, 200)
    turn = iter(range(1000))
    link = listening(lambda: board.sample() if next(turn) == 9 else vehicle.heartbeat())
    assert link.find() == (3, 200)


def test_several_systems_without_samples_must_be_chosen_from() -> None:
    both = (Sender(3, 1), Sender(4, 1))
    turn = iter(range(1000))

    def say() -> bytes:
        return both[next(turn) % 2].heartbeat()

    with pytest.raises(DeviceError, match=r"3/1, 4/1.*--system"):
        listening(say).find()
    assert listening(say, system=4).find() == (4, 1)
    with pytest.raises(DeviceError, match="system 9 was not heard"):
        listening(say, system=9).find()


@pytest.mark.parametrize(
    ("said", "says"),
    [
        (b"", "nothing was received"),
        (b"\x12\x34hello", "not MAVLink 2"),
        (None, "the device went away"),
    ],
)
def test_silence_noise_and_an_end_are_told_apart(said: bytes | None, says: str) -> None:
    with pytest.raises(DeviceError, match=says):
        listening(lambda: said).find()


def test_without_the_key_s_signature_nobody_is_believed() -> None:
    key = SigningKey(secret=b"k" * 32)
    with pytest.raises(DeviceError, match="messages were refused: they are not signed with this"):
        listening(Sender().sample, signing=key).find()


def test_a_device_that_signs_and_does_not_answer_asks_for_the_key() -> None:
    link, device = joined()
    sign_with(device.sender._mav, SigningKey(secret=b"k" * 32))
    device.hears = lambda message: False
    link.find()
    with pytest.raises(DeviceError, match="give --signing-key"):
        link.fetch()


def test_another_opening_of_the_port_ends_a_setting() -> None:
    link, device = joined()
    link.find()
    link.fetch()

    def hears(message) -> bool:
        if message.get_type() == "PARAM_SET":
            device.epoch += 1
            return False
        return True

    device.hears = hears
    (outcome,) = link.set({"FILT_TAU": 1.5})
    assert "the link was lost" in outcome.error


def test_a_flood_of_systems_fills_no_memory() -> None:
    clock = ManualClock()
    senders = [Sender(1 + i % 200, 1 + i // 200) for i in range(300)]
    flood = b"".join(sender.heartbeat() for sender in senders)
    link = DeviceLink(Stream(clock, lambda: flood), clock=clock)
    with pytest.raises(DeviceError, match=r"several systems .* \.\.\.\)"):
        link.find()
    assert len(link._presence.heard) <= 64
