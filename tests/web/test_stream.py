import asyncio
from collections.abc import Callable
from dataclasses import fields, replace
from functools import wraps

import numpy as np
import pytest
from fake_session import batch, info, report, snapshot
from sse import of_text, times

from hostkit.monitor.snapshot import Snapshot
from hostkit.records import ValidationReport
from hostkit.web import stream
from hostkit.web.history import History, broken, joined, portions
from hostkit.web.stream import MOST_CLIENTS, PENDING_SAMPLES, QUEUE_EVENTS, Hub
from hostkit.web.wire import encode, encode_samples, plain


def on_a_loop(test: Callable) -> Callable:
    @wraps(test)
    def run(*args, **kwargs):
        return asyncio.run(test(*args, **kwargs))

    return run


def hub() -> Hub:
    return Hub(info(), snapshot())


def test_samples_in_degrees() -> None:
    sent = of_text(b"event: samples\ndata: " + encode_samples(batch(0, 3), info().axes))[0].data
    assert sent["t"] == [0.0, 0.01, 0.02]
    assert sent["begins"] == [1, 0, 0]
    assert sent["mismatch"] == [0, 0, 0]
    assert sent["epoch"] == 0
    assert sent["received_ms"] == 1.7e12
    expected = np.degrees(batch(0, 3).device_rad)
    np.testing.assert_allclose(sent["roll"]["device"], expected[:, 0], atol=5e-5)
    np.testing.assert_allclose(sent["pitch"]["device"], expected[:, 1], atol=5e-5)
    residual = np.degrees(batch(0, 3).residual_rad)
    np.testing.assert_allclose(sent["pitch"]["residual"], residual[:, 1], atol=5e-7)
    assert set(sent) == {"epoch", "t", "roll", "pitch", "mismatch", "begins", "received_ms"}


def test_only_axes_of_the_design_are_sent() -> None:
    one = replace(
        batch(0, 2),
        device_rad=np.ones((2, 1)),
        model_rad=np.ones((2, 1)),
        residual_rad=np.zeros((2, 1)),
    )
    sent = of_text(b"event: samples\ndata: " + encode_samples(one, ("pitch",)))[0].data
    assert sent["pitch"]["model"] == [57.2958, 57.2958]
    assert "roll" not in sent


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_what_is_no_number_is_null(bad: float) -> None:
    values = np.array([[0.0, bad], [bad, 0.0]])
    odd = replace(
        batch(0, 2), model_rad=values, residual_rad=values, device_rad=values, received_s=bad
    )
    sent = of_text(b"event: samples\ndata: " + encode_samples(odd, info().axes))[0].data
    assert sent["roll"]["model"] == [0.0, None]
    assert sent["pitch"]["residual"] == [None, 0.0]
    assert sent["received_ms"] is None


def test_record_keeps_radians_and_adds_degrees() -> None:
    sent = plain(replace(report(10), rms_rad=np.pi, max_rad=None))
    assert isinstance(sent, dict)
    assert sent["rms_rad"] == np.pi
    assert sent["rms_deg"] == 180.0
    assert sent["max_deg"] is None
    assert sent["residual"][1]["drift_deg_s"] == pytest.approx(np.degrees(1e-7))
    assert {field.name for field in fields(ValidationReport)} <= set(sent)


def test_text_of_a_device_is_ascii_on_the_wire() -> None:
    assert encode({"text": "\ud800<\u2028"}) == b'{"text":"\\ud800<\\u2028"}'
    with pytest.raises(TypeError, match="object"):
        encode(object())


@on_a_loop
async def test_batches_between_two_flushes_are_one_event_for_all() -> None:
    h = hub()
    clients = [h.join(), h.join()]
    for client in clients:
        await client.next()
    for start in range(0, 30, 10):
        h.take_batch(batch(start, 10, received_s=float(start)))
    h.flush()
    texts = [await client.next() for client in clients]
    assert texts[0] == texts[1]
    (event,) = of_text(texts[0])
    assert len(event.data["t"]) == 30
    assert event.data["received_ms"] == 20_000.0


@on_a_loop
async def test_samples_are_encoded_once(monkeypatch: pytest.MonkeyPatch) -> None:
    calls = []
    monkeypatch.setattr(
        stream, "encode_samples", lambda *args: calls.append(args) or encode_samples(*args)
    )
    h = hub()
    h.take_batch(batch(0, 5))
    h.flush()
    assert calls == []
    for _ in range(MOST_CLIENTS):
        h.join()
    h.take_batch(batch(5, 5))
    h.flush()
    assert len(calls) == 1


@on_a_loop
async def test_a_slow_client_loses_its_oldest_and_is_told() -> None:
    h = hub()
    slow, quick = h.join(), h.join()
    seen = []
    for number in range(QUEUE_EVENTS + 10):
        h.take_batch(batch(number, 1))
        h.flush()
        seen += of_text(await quick.next())
    h.take_snapshot(snapshot(missed_batches=2))
    h.flush()
    seen += of_text(await quick.next())
    late = of_text(await slow.next())
    assert len(times(seen)) == QUEUE_EVENTS + 10
    assert seen[-1].data["missed_batches"] == 2
    assert times(late) == times(seen)[10:]
    assert late[-1].data["missed_batches"] == 12
    begins = [event.data["begins"][0] for event in late if event.kind == "samples"]
    assert begins == [1] + [0] * (QUEUE_EVENTS - 1)
    assert not seen[10].data["begins"][0]


@on_a_loop
async def test_a_flood_between_two_flushes_is_bounded_and_counted() -> None:
    h = hub()
    client = h.join()
    await client.next()
    for start in range(0, 3 * PENDING_SAMPLES, 1024):
        h.take_batch(batch(start, 1024))
    h.take_snapshot(snapshot())
    h.flush()
    samples, state = of_text(await client.next())
    assert len(samples.data["t"]) == PENDING_SAMPLES
    assert samples.data["begins"][0] == 1
    assert state.data["missed_batches"] == 2 * PENDING_SAMPLES // 1024


@on_a_loop
async def test_only_the_latest_snapshot_is_sent() -> None:
    h = hub()
    client = h.join()
    await client.next()
    for elapsed_s in (1.0, 2.0, 3.0):
        h.take_snapshot(snapshot(elapsed_s=elapsed_s))
        h.flush()
    (event,) = of_text(await client.next())
    assert (event.kind, event.data["elapsed_s"]) == ("snapshot", 3.0)
    assert set(event.data) == {field.name for field in fields(Snapshot)}
    assert event.data["report"]["residual"][0]["rms_deg"] == pytest.approx(np.degrees(7.1e-5))
    assert event.data["timing"]["latency"]["p95_ms"] == 2.0


@on_a_loop
async def test_a_new_client_gets_the_state_and_what_was() -> None:
    h = hub()
    h.take_snapshot(snapshot(elapsed_s=5.0, missed_batches=3))
    h.take_batch(batch(10, 10))
    client = h.join()
    kept = h.history.batches()
    (state,) = of_text(await client.next())
    assert (state.data["elapsed_s"], state.data["missed_batches"]) == (5.0, 3)
    assert [len(b) for b in kept] == [10]
    h.take_batch(batch(20, 10))
    h.flush()
    assert times(of_text(await client.next())) == batch(20, 10).time_s.tolist()


@on_a_loop
async def test_epochs_are_told_apart() -> None:
    h = hub()
    client = h.join()
    await client.next()
    h.take_batch(batch(50, 2))
    h.take_batch(batch(0, 3, epoch=1))
    h.flush()
    first, second = of_text(await client.next())
    assert (first.data["epoch"], len(first.data["t"])) == (0, 2)
    assert (second.data["epoch"], len(second.data["t"])) == (1, 3)
    assert len(h.history) == 3


@on_a_loop
async def test_samples_belong_at_least_to_the_epoch_of_the_snapshot() -> None:
    h = hub()
    client = h.join()
    await client.next()
    h.take_batch(batch(50, 2))
    h.take_snapshot(snapshot(epoch=4))
    h.take_batch(batch(0, 3))
    h.flush()
    first, second, _ = of_text(await client.next())
    assert (first.data["epoch"], second.data["epoch"]) == (0, 4)


@on_a_loop
async def test_nothing_is_sent_for_no_samples() -> None:
    h = hub()
    h.take_batch(batch(0, 0))
    h.flush()
    assert len(h.history) == 0


@on_a_loop
async def test_number_of_clients_is_bounded() -> None:
    h = hub()
    clients = [h.join() for _ in range(MOST_CLIENTS)]
    assert all(clients)
    assert h.join() is None
    h.leave(clients[3])
    assert h.join() is not None


@on_a_loop
async def test_the_last_snapshot_ends_the_stream() -> None:
    h = hub()
    client = h.join()
    await client.next()
    h.take_batch(batch(0, 4))
    h.take_snapshot(snapshot(ended=True))
    h.flush()
    samples, state = of_text(await client.next())
    assert (len(samples.data["t"]), state.data["ended"]) == (4, True)
    assert await client.next() is None
    later = h.join()
    assert of_text(await later.next())[0].data["ended"]
    assert await later.next() is None


@on_a_loop
async def test_silence_is_filled_with_comments(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(stream, "ALIVE_S", 0.001)
    client = hub().join()
    await client.next()
    assert await client.next() == b": alive\n\n"


def test_history_is_bounded_in_time() -> None:
    history = History(length_s=1.0)
    for start in range(0, 1000, 10):
        history.add(batch(start, 10))
    kept = joined(history.batches())
    assert kept.time_s[-1] == 9.99
    assert 1.0 <= kept.time_s[-1] - kept.time_s[0] <= 1.1
    assert kept.begins[0]
    assert kept.begins.sum() == 1
    assert len(kept) == len(history)


def test_history_is_bounded_in_samples() -> None:
    history = History(most_samples=100)
    for start in range(0, 1000, 30):
        history.add(batch(start, 30, rate_hz=8000.0))
    assert len(history) == 90


@pytest.mark.parametrize("jump_s", [1e9, -1e9, np.nan, np.inf])
def test_history_survives_a_hostile_clock(jump_s: float) -> None:
    history = History(most_samples=1000)
    for number in range(300):
        odd = batch(number * 10, 10)
        history.add(replace(odd, time_s=odd.time_s + (jump_s if number % 2 else 0.0)))
    assert 10 <= len(history) <= 1000


def test_history_keeps_one_epoch() -> None:
    history = History()
    history.add(batch(0, 10))
    history.add(batch(0, 5, epoch=1))
    assert [b.epoch for b in history.batches()] == [1]
    assert History().batches() == ()


def test_portions_keep_every_sample() -> None:
    parts = [batch(start, 10) for start in range(0, 100, 10)]
    assert [len(p) for p in portions(parts, 40)] == [40, 40, 20]
    np.testing.assert_array_equal(joined(portions(parts, 40)).time_s, batch(0, 100).time_s)
    assert portions([], 40) == []


def test_a_broken_batch_leaves_the_other_alone() -> None:
    whole = batch(5, 3)
    assert broken(whole).begins.tolist() == [True, False, False]
    assert not whole.begins.any()
