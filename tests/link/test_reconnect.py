"""Losing a port and having it again, on a clock that is turned by hand."""

from itertools import pairwise

import pytest
from fake_ports import FakeClock, FakeOpener, FakeTransport

from hostkit.errors import DeviceError
from hostkit.link.ports.reconnect import Reconnecting

GONE = DeviceError("not there")


def test_first_opening_is_not_repeated() -> None:
    opener = FakeOpener(GONE)
    with pytest.raises(DeviceError, match="not there"):
        Reconnecting(opener, clock=FakeClock())
    assert opener.calls == 1


def test_loss_closes_the_port_and_nothing_is_raised() -> None:
    first, second = FakeTransport(b"one", None), FakeTransport(b"two")
    clock = FakeClock()
    port = Reconnecting(FakeOpener(first, GONE, second), clock=clock)
    assert (port.read(0.1), port.state, port.epoch) == (b"one", "connected", 0)
    assert (port.read(0.1), port.state, port.epoch, first.closed) == (b"", "lost", 0, True)
    assert port.read(0.1) == b""
    assert (port.state, port.problem) == ("lost", "not there")
    while port.state == "lost":
        assert port.read(0.05) == b""
    assert (port.read(0.1), port.state, port.epoch, port.problem) == (b"two", "connected", 1, "")


def test_waits_double_up_to_two_seconds_and_begin_anew() -> None:
    clock, times = FakeClock(), []

    def opener() -> FakeTransport:
        times.append(clock.now_s)
        if len(times) in (1, 9):
            return FakeTransport(None)
        raise GONE

    port = Reconnecting(opener, clock=clock)
    while len(times) < 12:
        port.read(0.03)
    waits = [round(b - a, 6) for a, b in pairwise(times)]
    assert waits == [0.1, 0.2, 0.4, 0.8, 1.6, 2.0, 2.0, 2.0, 0.1, 0.2, 0.4]


@pytest.mark.parametrize("timeout_s", [0.0, 0.01, 0.5])
def test_read_of_a_lost_port_takes_no_longer_than_asked(timeout_s: float) -> None:
    clock = FakeClock()
    port = Reconnecting(FakeOpener(FakeTransport(None), GONE), clock=clock)
    port.read(0.0)
    for _ in range(50):
        before_s = clock.now_s
        port.read(timeout_s)
        assert clock.now_s - before_s <= timeout_s + 1e-9


def test_without_reconnection_a_loss_is_the_end() -> None:
    opener = FakeOpener(FakeTransport(b"one", None))
    port = Reconnecting(opener, keep=False, clock=FakeClock())
    assert [port.read(0.1) for _ in range(3)] == [b"one", None, None]
    assert (port.state, opener.calls) == ("lost", 1)


def test_release_closes_and_take_opens_at_once() -> None:
    first, second = FakeTransport(), FakeTransport(b"two")
    port = Reconnecting(FakeOpener(first, second), clock=FakeClock())
    port.release()
    assert (port.state, first.closed, port.read(0.1)) == ("released", True, b"")
    port.write(b"dropped")
    port.take()
    assert (port.state, port.epoch, port.read(0.1)) == ("connected", 1, b"two")
    port.write(b"kept")
    assert (first.written, second.written) == ([], [b"kept"])
    port.take()
    assert port.epoch == 1


@pytest.mark.parametrize("keep", [True, False])
def test_take_of_a_port_that_is_not_free_yet_goes_on_trying(keep: bool) -> None:
    opener = FakeOpener(FakeTransport(), GONE, GONE, FakeTransport(b"two"))
    port = Reconnecting(opener, keep=keep, clock=FakeClock())
    port.release()
    port.take()
    assert port.state == "lost"
    for _ in range(20):
        if port.read(0.1) == b"two":
            break
    assert (port.state, port.epoch) == ("connected", 1)


def test_released_port_is_not_opened_by_itself() -> None:
    opener = FakeOpener(FakeTransport(), FakeTransport(b"two"))
    port = Reconnecting(opener, clock=FakeClock())
    port.release()
    for _ in range(100):
        assert port.read(0.5) == b""
    assert (opener.calls, port.state) == (1, "released")


def test_closed_port_stays_closed() -> None:
    inner = FakeTransport()
    port = Reconnecting(FakeOpener(inner), clock=FakeClock())
    port.close()
    assert (port.state, inner.closed) == ("ended", True)
    port.write(b"x")
    port.close()
