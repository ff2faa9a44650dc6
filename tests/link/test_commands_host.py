"""Commands from the host's side: answers, repetitions, and what is no answer."""

import pytest
from answering import AnsweringDevice, M, ManualClock, Sender

from hostkit.errors import HostkitError
from hostkit.link.device.commands import COMMANDS, CommandClient
from hostkit.link.frames.decoder import Decoder
from hostkit.link.frames.encoder import Encoder

ACCEPTED, IN_PROGRESS = 0, 5
CALIBRATE = 241


class Bench:
    def __init__(self) -> None:
        self.clock = ManualClock()
        self.device = AnsweringDevice(self.clock)
        self.decoder, encoder = Decoder(), Encoder()
        self.client = CommandClient(lambda m: self.device.write(encoder.pack(m)), self.clock)
        self.client.attend((1, 1))

    def pump(self, duration_s: float = 0.1) -> None:
        end_s = self.clock.now_s + duration_s
        while self.clock.now_s < end_s:
            for frame in self.decoder.feed(self.device.read(0.0) or b""):
                self.client.take(frame)
            self.client.poll()

    def stage(self) -> str:
        assert self.client.state is not None
        return self.client.state.state

    def answer(self, result: int, *, command: int = CALIBRATE, to: tuple[int, int] = (0, 0)):
        message = M.MAVLink_command_ack_message(command, result, 0, 0, *to)
        self.client.take(self.device.sender.frame(message))


@pytest.mark.parametrize(
    ("name", "number", "first"),
    [
        ("calibrate", 241, 1),
        ("self-test", 31010, 0),
        ("store", 245, 1),
        ("defaults", 245, 2),
        ("reboot", 246, 1),
    ],
)
def test_each_command_is_the_documented_one(name: str, number: int, first: int) -> None:
    bench = Bench()
    bench.client.send(name)
    assert bench.stage() == "waiting"
    bench.pump()
    assert bench.device.commands == [(number, first, 0)]
    assert bench.stage() == "accepted"
    assert name in COMMANDS


def test_progress_is_waited_for_without_asking_again() -> None:
    bench = Bench()
    bench.device.results = [IN_PROGRESS]
    bench.client.send("calibrate")
    bench.pump(30.0)
    assert bench.stage() == "in progress"
    assert len(bench.device.commands) == 1
    bench.answer(ACCEPTED)
    assert bench.stage() == "accepted"


def test_progress_without_end_is_given_up() -> None:
    bench = Bench()
    bench.device.results = [IN_PROGRESS]
    bench.client.send("calibrate")
    bench.pump(61.0)
    assert bench.stage() == "no answer"
    assert "60 s" in bench.client.state.detail


def test_without_an_answer_it_is_repeated_with_the_next_confirmation() -> None:
    bench = Bench()
    bench.device.results = []
    bench.client.send("store")
    bench.pump(10.0)
    assert [confirmation for _, _, confirmation in bench.device.commands] == [0, 1, 2, 3]
    assert bench.stage() == "no answer"
    assert "4 times" in bench.client.state.detail


def test_an_answer_to_a_repetition_counts() -> None:
    bench = Bench()
    bench.device.hears = lambda message: message.confirmation == 2
    bench.client.send("store")
    bench.pump(10.0)
    assert bench.stage() == "accepted"
    assert len(bench.device.commands) == 1


@pytest.mark.parametrize(
    ("result", "says"),
    [(1, "not now"), (2, "denied"), (3, "not supported"), (4, "failed"), (77, "result 77")],
)
def test_a_refusal_is_told_in_words(result: int, says: str) -> None:
    bench = Bench()
    bench.device.results = [result]
    bench.client.send("calibrate")
    bench.pump()
    assert bench.stage() == "refused"
    assert says in bench.client.state.detail


def test_what_is_no_answer_to_us_changes_nothing() -> None:
    bench = Bench()
    bench.device.results = []
    bench.client.send("calibrate")
    bench.answer(ACCEPTED, command=245)
    bench.answer(ACCEPTED, to=(255, 230))
    bench.answer(ACCEPTED, to=(9, 0))
    stranger = Sender(2, 1).frame(M.MAVLink_command_ack_message(CALIBRATE, ACCEPTED))
    bench.client.take(stranger)
    assert bench.stage() == "waiting"
    bench.answer(ACCEPTED, to=(255, 190))
    assert bench.stage() == "accepted"
    bench.answer(4)
    assert bench.stage() == "accepted", "what comes later is another's"


def test_one_command_at_a_time() -> None:
    bench = Bench()
    bench.device.results = [IN_PROGRESS]
    bench.client.send("calibrate")
    bench.pump()
    with pytest.raises(HostkitError, match="calibrate is still in progress"):
        bench.client.send("store")


def test_unknown_commands_and_no_device_are_said() -> None:
    bench = Bench()
    with pytest.raises(HostkitError, match="no command 'explode'; there are: calibrate"):
        bench.client.send("explode")
    bench.client.target = None
    with pytest.raises(HostkitError, match="no device has been heard"):
        bench.client.send("store")


def test_another_opening_ends_the_waiting() -> None:
    bench = Bench()
    bench.device.results = []
    bench.client.send("store")
    bench.client.begin_epoch()
    assert bench.stage() == "no answer"
    bench.client.send("store")
    assert bench.stage() == "waiting"
