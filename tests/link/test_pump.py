"""The thread between a port and a session: bounded, in order, and never silently dead."""

import threading
import time

import pytest
from fake_ports import FakeOpener, FakeTransport, read_until, wait_until

from hostkit.errors import DeviceError
from hostkit.link.ports.pump import Pump
from hostkit.link.ports.reconnect import Reconnecting


def pump_of(*ports: FakeTransport | DeviceError, keep: bool = True, **options: object) -> Pump:
    return Pump(Reconnecting(FakeOpener(*ports), keep=keep), **options)


def numbered(count: int, size: int = 1000) -> list[bytes]:
    return [k.to_bytes(4, "big") * (size // 4) for k in range(count)]


def test_everything_comes_in_order_however_slow_the_reader() -> None:
    chunks = numbered(300, 4000)
    pump = pump_of(FakeTransport(*chunks))
    wait_until(lambda: pump._queued_bytes == 300 * 4000)
    assert pump.read(1.0) == b"".join(chunks)
    assert pump.overrun_bytes == 0
    pump.close()


@pytest.mark.parametrize("size", [1, 999, 4000])
def test_full_queue_drops_the_newest_and_counts_them_exactly(size: int) -> None:
    chunks = [bytes([k % 251]) * size for k in range(60)]
    sent = b"".join(chunks)
    limit = len(sent) // 3
    pump = pump_of(FakeTransport(*chunks), queue_bytes=limit, rest_s=0.0)
    wait_until(lambda: pump.overrun_bytes == len(sent) - limit)
    assert pump.read(1.0) == sent[:limit]
    pump.close()


def test_queue_that_was_emptied_takes_more_and_counts_on() -> None:
    port = FakeTransport(b"a" * 150)
    pump = pump_of(port, queue_bytes=100)
    wait_until(lambda: pump.overrun_bytes == 50)
    assert pump.read(1.0) == b"a" * 100
    port.chunks.append(b"b" * 130)
    assert pump.read(5.0) == b"b" * 100
    assert pump.overrun_bytes == 80
    pump.close()


def test_queue_of_a_flood_that_nobody_reads_holds_8_mib() -> None:
    flood = FakeTransport(then=bytes(65536))
    pump = pump_of(flood)
    wait_until(lambda: pump.overrun_bytes > 1 << 20)
    assert pump._queued_bytes == 8 << 20
    assert len(pump._queue) == 1
    pump.close()
    assert flood.closed


def test_many_small_pieces_cost_no_more_than_their_bytes() -> None:
    pump = pump_of(FakeTransport(*[b"x"] * 2000), rest_s=0.0)
    wait_until(lambda: pump._queued_bytes == 2000)
    assert len(pump._queue) == 1
    pump.close()


def test_batch_never_holds_bytes_of_two_epochs() -> None:
    pump = pump_of(FakeTransport(b"before", None), FakeTransport(b"after"))
    wait_until(lambda: pump._queued_bytes == len(b"beforeafter"))
    assert (pump.read(1.0), pump.epoch) == (b"before", 0)
    assert (pump.read(1.0), pump.epoch) == (b"after", 1)
    pump.close()


def test_epoch_is_told_when_nothing_has_come_since() -> None:
    pump = pump_of(FakeTransport(None), FakeTransport())
    wait_until(lambda: pump.state == "connected" and pump._port.epoch == 1)
    assert (pump.read(0.0), pump.epoch) == (b"", 1)
    pump.close()


def test_loss_without_reconnection_ends_after_the_last_byte() -> None:
    pump = pump_of(FakeTransport(b"last", None), keep=False)
    wait_until(lambda: not pump._thread.is_alive())
    assert [pump.read(0.1) for _ in range(3)] == [b"last", None, None]


def test_failure_of_the_thread_reaches_the_reader() -> None:
    class Broken(FakeTransport):
        def read(self, timeout_s: float) -> bytes | None:
            if self.chunks:
                return super().read(timeout_s)
            raise RuntimeError("a bug")

    port = Broken(b"last")
    pump = pump_of(port)
    assert pump.read(5.0) == b"last"
    with pytest.raises(DeviceError, match="a bug"):
        read_until(pump, lambda got: False)
    assert port.closed
    with pytest.raises(DeviceError, match="not being read"):
        pump.release()
    pump.close()


def test_release_closes_before_it_returns_and_take_opens() -> None:
    first, second = FakeTransport(), FakeTransport(b"two")
    pump = pump_of(first, second)
    pump.release()
    assert (first.closed, pump.state) == (True, "released")
    assert pump.read(0.0) == b""
    pump.take()
    assert pump.state == "connected"
    assert pump.read(5.0) == b"two"
    pump.close()
    assert second.closed


def test_orders_of_several_threads_are_all_carried_out() -> None:
    pump = pump_of(FakeTransport())
    failures, released = [], []
    release = pump._port.release
    pump._port.release = lambda: released.append(release())

    def order() -> None:
        try:
            for _ in range(5):
                pump.release()
                pump.take()
        except DeviceError as error:
            failures.append(error)

    pump._port._opener = FakeTransport
    threads = [threading.Thread(target=order) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(20)
    assert not failures
    assert len(released) == 20
    wait_until(lambda: pump.state == "connected")
    pump.close()


def test_write_goes_through_from_any_thread() -> None:
    port = FakeTransport()
    pump = pump_of(port)
    threads = [threading.Thread(target=pump.write, args=(bytes([k]),)) for k in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(5)
    assert sorted(port.written) == [bytes([k]) for k in range(8)]
    pump.close()


def test_close_ends_the_thread_quickly_and_calls_what_was_asked() -> None:
    called = []
    pump = pump_of(FakeTransport(None), DeviceError("gone"))
    pump.close_too(lambda: called.append(pump._thread.is_alive()))
    wait_until(lambda: pump.state == "lost")
    before_s = time.monotonic()
    pump.close()
    assert time.monotonic() - before_s < 1.0
    assert (called, pump._thread.is_alive(), pump.state) == ([True], False, "ended")
    assert pump.read(1.0) is None
    pump.close()


def test_each_piece_has_its_time() -> None:
    port = FakeTransport(b"one", b"three")
    before_ns = time.monotonic_ns()
    pump = pump_of(port)
    wait_until(lambda: pump._queued_bytes == 8)
    assert pump.read(1.0) == b"onethree"
    first, second = pump.arrivals
    assert (first.end, second.end) == (3, 8)
    assert before_ns < first.received_ns <= second.received_ns - 1_000_000
    assert second.received_ns < time.monotonic_ns()
    assert pump.read(0.0) == b""
    assert pump.arrivals == ()
    pump.close()


def test_large_pieces_wait_for_nothing() -> None:
    port = FakeTransport(*numbered(20, 4000))
    pump = pump_of(port, rest_s=1000.0)
    got = 0
    while got < 20 * 4000:
        got += len(pump.read(5.0) or b"")
    pump.close()


def test_what_comes_soon_after_waits_for_its_turn_unless_nobody_wants_to_wait() -> None:
    port = FakeTransport(b"a")
    pump = pump_of(port, rest_s=0.0, handover_s=0.3)
    assert pump.read(5.0) == b"a"
    begun = time.monotonic()
    port.chunks.append(b"b")
    wait_until(lambda: pump._queued_bytes == 1)
    assert pump.read(5.0) == b"b"
    assert time.monotonic() - begun > 0.25
    port.chunks.append(b"c")
    wait_until(lambda: pump._queued_bytes == 1)
    assert pump.read(0.0) == b"c"
    pump.close()
