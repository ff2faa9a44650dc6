"""The parameter protocol from the host's side: losses, lies and floods."""

import contextlib
import math

import numpy as np
import pytest
from answering import AnsweringDevice, M, ManualClock, Sender
from designs import design
from hypothesis import given, settings
from hypothesis import strategies as st

from hostkit.errors import HostkitError
from hostkit.link.device.parameter_facts import parameter_facts
from hostkit.link.device.parameters import ParameterClient
from hostkit.link.frames.decoder import Decoder
from hostkit.link.frames.encoder import Encoder


class Bench:
    """A client and a device, joined by a link on which time passes only when it is pumped."""

    def __init__(self, **options: object) -> None:
        self.clock = ManualClock()
        self.device = AnsweringDevice(self.clock)
        encoder, self.decoder = Encoder(), Decoder()
        self.sent: list = []

        def send(message) -> None:
            self.sent.append(message)
            self.device.write(encoder.pack(message))

        self.client = ParameterClient(send, self.clock, **options)

    def pump(self, duration_s: float = 1.0) -> None:
        end_s = self.clock.now_s + duration_s
        while self.clock.now_s < end_s:
            for frame in self.decoder.feed(self.device.read(0.0) or b""):
                self.client.take(frame)
            self.client.poll()

    def values(self) -> dict[str, float]:
        return {name: entry.value for name, entry in self.client.entries.items()}


def listed(**options: object) -> Bench:
    bench = Bench(**options)
    bench.client.request_all()
    bench.pump()
    assert bench.client.complete
    return bench


def test_the_whole_list_comes_with_one_request() -> None:
    bench = listed()
    assert bench.values() == bench.device.values
    assert [entry.index for entry in bench.client.entries.values()] == [0, 1, 2, 3]
    assert bench.device.asked == ["PARAM_REQUEST_LIST"]


def test_nothing_is_sent_before_the_device_is_known() -> None:
    bench = Bench()
    bench.device.silent = True
    bench.client.request_all()
    bench.client.set("FILT_TAU", 1.0)
    bench.pump()
    assert not bench.sent
    bench.device.silent = False
    bench.pump()
    assert bench.client.complete
    assert bench.device.values["FILT_TAU"] == 1.0


def test_what_got_lost_of_the_list_is_asked_for_by_number() -> None:
    bench = Bench()
    lost = {"CAL_START", "TILT_OFS_ROLL"}

    def loses_once(message) -> bool:
        name = getattr(message, "param_id", "")
        found = name in lost
        lost.discard(name)
        return found

    bench.device.loses = loses_once
    bench.client.request_all()
    bench.pump(2.0)
    assert bench.client.complete
    assert bench.values() == bench.device.values
    assert bench.device.asked == ["PARAM_REQUEST_LIST", *["PARAM_REQUEST_READ"] * 2]
    assert [m.param_index for m in bench.sent[1:]] == [1, 3]


def test_a_request_that_got_lost_is_repeated_five_times_in_all() -> None:
    bench = Bench()
    bench.device.hears = lambda message: False
    bench.client.request_all()
    bench.pump(20.0)
    assert bench.device.asked == ["PARAM_REQUEST_LIST"] * 5
    assert not bench.client.complete
    assert not bench.client.listing
    assert "did not answer 5 requests" in bench.client.listing_error


def test_a_number_that_never_comes_is_given_up() -> None:
    bench = Bench()
    bench.device.loses = lambda message: getattr(message, "param_id", "") == "CAL_START"
    bench.client.request_all()
    bench.pump(20.0)
    assert "1 of 4 parameters were not told" in bench.client.listing_error
    assert set(bench.values()) == {"SYS_ID", "FILT_TAU", "TILT_OFS_ROLL"}


def test_the_value_told_back_is_the_truth() -> None:
    bench = listed()
    bench.device.rounded = lambda value: value * (1 + 3e-6)
    bench.client.set("FILT_TAU", 1.5)
    assert bench.client.entries["FILT_TAU"].wanted == 1.5
    bench.pump()
    entry = bench.client.entries["FILT_TAU"]
    assert entry.value == pytest.approx(1.5, rel=1e-5)
    assert entry.value != 1.5
    assert entry.wanted is None
    assert entry.error == ""


@pytest.mark.parametrize(
    ("name", "value", "says"),
    [
        ("TILT_OFS_ROLL", 0.75, "the device keeps 0 rad; it takes -0.5235987 to 0.5235987 rad"),
        ("FILT_TAU", 5000.0, "the device keeps 2.75 s"),
        ("CAL_START", 2.0, "the device keeps 0; it takes whole numbers from 0 to 1"),
    ],
)
def test_a_value_out_of_range_is_told_with_what_the_device_takes(
    name: str, value: float, says: str
) -> None:
    bench = listed()
    bench.client.set(name, value)
    bench.pump()
    entry = bench.client.entries[name]
    assert says in entry.error
    assert entry.value == bench.device.values[name]
    assert entry.wanted is None
    assert bench.device.asked.count("PARAM_SET") == 2, "asked once more before it is believed"


def test_the_limits_of_the_time_constant_are_those_of_the_design() -> None:
    bench = listed(facts=parameter_facts(design()))
    bench.client.set("FILT_TAU", 5000.0)
    bench.pump()
    assert "it takes 9.536743e-09 to 9999.997 s" in bench.client.entries["FILT_TAU"].error


def test_an_error_goes_with_the_next_value_that_takes() -> None:
    bench = listed()
    bench.client.set("TILT_OFS_ROLL", 0.75)
    bench.pump()
    bench.client.set("TILT_OFS_ROLL", 0.25)
    bench.pump()
    assert bench.client.entries["TILT_OFS_ROLL"].error == ""
    assert bench.values()["TILT_OFS_ROLL"] == 0.25


def test_the_old_value_of_a_list_on_its_way_is_not_taken_for_the_answer() -> None:
    bench = listed()
    bench.client.set("FILT_TAU", 1.5)
    bench.client.poll()
    bench.client.take(bench.device.sender.value("FILT_TAU", 2.75, 2, 4))
    bench.pump()
    entry = bench.client.entries["FILT_TAU"]
    assert (entry.value, entry.error) == (1.5, "")


def test_a_setting_is_repeated_and_then_given_up() -> None:
    bench = listed()
    bench.device.hears = lambda message: message.get_type() != "PARAM_SET"
    bench.client.set("FILT_TAU", 1.5)
    bench.pump(5.0)
    assert bench.device.asked.count("PARAM_SET") == 4
    entry = bench.client.entries["FILT_TAU"]
    assert (entry.value, entry.wanted) == (2.75, None)
    assert "did not answer 4 requests" in entry.error
    assert not bench.client.setting


def test_of_many_values_in_a_row_the_newest_is_set_last_and_few_are_sent() -> None:
    bench = listed()
    for value in np.linspace(1.0, 2.0, 100):
        bench.client.set("FILT_TAU", float(value))
    bench.pump()
    assert bench.values()["FILT_TAU"] == 2.0
    assert bench.device.asked.count("PARAM_SET") == 1


def test_values_are_set_one_after_the_other() -> None:
    bench = listed()
    bench.device.hears = lambda message: False
    for name in ("FILT_TAU", "TILT_OFS_ROLL"):
        bench.client.set(name, 0.25)
    bench.pump(0.2)
    assert bench.device.asked[1:] == ["PARAM_SET"]
    bench.device.hears = lambda message: True
    bench.pump(2.0)
    assert bench.values()["FILT_TAU"] == bench.values()["TILT_OFS_ROLL"] == 0.25


def test_a_name_that_the_device_lacks_is_refused_once_the_list_is_known() -> None:
    bench = listed()
    with pytest.raises(HostkitError, match="no parameter 'NO_SUCH'; it has: SYS_ID"):
        bench.client.set("NO_SUCH", 1.0)


def test_a_name_that_never_is_told_fails_by_name() -> None:
    bench = Bench()
    bench.client.set("NO_SUCH", 1.0)
    bench.pump(5.0)
    assert "did not answer" in bench.client.failures["NO_SUCH"]
    assert "NO_SUCH" not in bench.client.entries


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf, 1e39])
def test_what_is_no_finite_number_is_not_sent(value: float) -> None:
    bench = listed()
    with pytest.raises(HostkitError, match="no finite number of 32 bits"):
        bench.client.set("FILT_TAU", value)


@pytest.mark.parametrize("name", ["", "X" * 17, "A B", "A\n", "Ä", "A\x1b[2J"])
def test_what_is_no_name_is_not_sent(name: str) -> None:
    with pytest.raises(HostkitError, match="no name of a parameter"):
        Bench().client.set(name, 1.0)


def test_another_opening_ends_what_was_on_its_way_and_lists_anew() -> None:
    bench = listed()
    bench.device.hears = lambda message: False
    bench.client.set("FILT_TAU", 1.5)
    bench.pump(0.2)
    bench.client.begin_epoch()
    assert "the link was lost" in bench.client.entries["FILT_TAU"].error
    bench.device.hears = lambda message: True
    bench.device.values["SYS_ID"] = 7.0
    bench.pump()
    assert bench.client.complete
    assert bench.values()["SYS_ID"] == 7.0
    assert bench.device.values["FILT_TAU"] == 2.75


def test_other_systems_are_not_listened_to() -> None:
    bench = listed()
    other = Sender(2, 1)
    bench.client.take(other.value("FILT_TAU", 9.0, 2, 4))
    bench.client.take(other.value("EVIL", 9.0, 0, 1))
    assert bench.values() == bench.device.values
    assert bench.client.complete


def test_a_flood_of_names_ends_at_the_bound() -> None:
    bench = listed()
    for i in range(2000):
        bench.client.take(bench.device.sender.value(f"P{i}", 1.0, i % 4, 4))
    assert len(bench.client.entries) == 256
    assert bench.client.refused == 2000 - 252
    bench.client.take(bench.device.sender.value("FILT_TAU", 3.0, 2, 4))
    assert bench.values()["FILT_TAU"] == 3.0


@pytest.mark.parametrize("count", [0, 257, 65535])
def test_a_count_that_cannot_be_is_not_believed(count: int) -> None:
    bench = Bench()
    bench.device.silent = True
    bench.client.attend((1, 1))
    bench.client.request_all()
    bench.client.poll()
    bench.client.take(bench.device.sender.value("A", 1.0, 0, count))
    assert not bench.client.complete
    assert f"says that it has {count} parameters" in bench.client.listing_error


@pytest.mark.parametrize("value", [math.nan, math.inf])
def test_no_value_is_told_as_an_error_and_changes_nothing(value: float) -> None:
    bench = listed()
    bench.client.take(bench.device.sender.value("FILT_TAU", value, 2, 4))
    entry = bench.client.entries["FILT_TAU"]
    assert entry.value == 2.75
    assert "which is no value" in entry.error


@pytest.mark.parametrize("name", [b"", b"\xff\xfe", b"A B", b"A\x1b[2J", b"A\n"])
def test_names_that_are_none_are_refused(name: bytes) -> None:
    bench = listed()
    message = M.MAVLink_param_value_message(name, 1.0, 9, 4, 0)
    bench.client.take(bench.device.sender.frame(message))
    assert len(bench.client.entries) == 4
    assert bench.client.refused == 1


def test_an_answer_without_a_number_keeps_the_number() -> None:
    bench = listed()
    bench.client.take(bench.device.sender.value("FILT_TAU", 3.0, 65535, 4))
    assert bench.client.entries["FILT_TAU"].index == 2
    assert bench.client.entries["FILT_TAU"].value == 3.0


NAMES = st.sampled_from(["SYS_ID", "FILT_TAU", "X", "", "A B", "Y" * 16])
TOLD = st.tuples(NAMES, st.floats(width=32), st.integers(0, 65535), st.integers(0, 65535))


@given(st.lists(st.one_of(TOLD, st.sampled_from(["set", "list", "wait", "epoch"])), max_size=40))
@settings(max_examples=40, deadline=None)
def test_whatever_a_device_tells_entries_are_numbers_and_requests_few(steps: list) -> None:
    clock, sender, sent = ManualClock(), Sender(), []
    client = ParameterClient(sent.append, clock, target=(1, 1))
    for step in steps:
        if step == "set":
            with contextlib.suppress(HostkitError):
                client.set("FILT_TAU", 1.0)
        elif step == "list":
            client.request_all()
        elif step == "wait":
            clock.now_s += 1.0
        elif step == "epoch":
            client.begin_epoch()
        else:
            client.take(sender.value(*step))
        client.poll()
    assert len(sent) <= 8 * len(steps)
    assert all(math.isfinite(entry.value) for entry in client.entries.values())
    assert set(client.entries) <= {"SYS_ID", "FILT_TAU", "X", "Y" * 16}
    for _ in range(100):
        clock.now_s += 1.0
        client.poll()
    quiet = len(sent)
    clock.now_s += 1.0
    client.poll()
    assert len(sent) == quiet
    assert not client.setting
    assert not client.listing
