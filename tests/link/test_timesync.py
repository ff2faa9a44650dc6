"""A simulated device whose clock and delays are known."""

import random
from dataclasses import dataclass, field

import numpy as np
import pytest

from hostkit.dialect import python_module
from hostkit.link.frames.decoder import Decoder, Frame
from hostkit.link.frames.timesync import SAMPLES, TimeSync

M = python_module()
MS, S = 1_000_000, 1_000_000_000


@dataclass
class Bench:
    """A host whose clock is turned by hand, and a device behind delays."""

    ppm: float = 0.0
    offset_ns: int = 123 * S
    delay_ns: int = 3 * MS
    jitter_ns: int = 0
    back_jitter_ns: int = 0
    """Only answers wait, as they do where bytes are collected before they are read."""
    batch: int = 1
    rate_hz: int = 100
    wrap_us: int = 2**64
    now_ns: int = 5 * S
    rng: random.Random = field(default_factory=lambda: random.Random(1))

    def __post_init__(self) -> None:
        self.sync = TimeSync(lambda: self.now_ns)
        self.mav = M.MAVLink(None, 1, 1)
        self.samples: list[int] = []

    def device_ns(self) -> int:
        return round(self.now_ns * (1 + self.ppm * 1e-6)) + self.offset_ns

    def delay(self) -> int:
        return self.delay_ns + self.rng.randrange(self.jitter_ns + 1)

    def frame(self, message: object, source: tuple[int, int] = (1, 1)) -> Frame:
        (frame,) = Decoder().feed(bytes(message.pack(M.MAVLink(None, *source))))
        return frame

    def run(self, seconds: float) -> None:
        for _ in range(round(seconds * self.rate_hz)):
            self.exchange()
            time_us = self.device_ns() // 1000 % self.wrap_us
            self.samples.append(time_us)
            if len(self.samples) == self.batch:
                received_ns = self.now_ns + self.delay()
                self.arrived(self.samples, received_ns)
                self.samples.clear()
            self.now_ns += S // self.rate_hz

    def arrived(self, time_us: list[int], received_ns: int) -> None:
        """Samples that came together."""
        times = np.array(time_us, dtype=np.int64)
        self.sync.arrived(times, np.full(len(times), received_ns))

    def exchange(self) -> None:
        request = self.sync.poll()
        if request is None:
            return
        begun_ns = self.now_ns
        self.now_ns += self.delay()
        device_ns = self.device_ns() // 1000 % self.wrap_us * 1000
        self.now_ns += self.delay() + self.rng.randrange(self.back_jitter_ns + 1)
        self.sync.take(self.frame(M.MAVLink_timesync_message(device_ns, request.ts1)), self.now_ns)
        self.now_ns = begun_ns


def test_nothing_is_known_before_anything_came() -> None:
    figures = TimeSync(lambda: 0).statistics()
    assert figures.round_trip_ms is figures.clock_ppm is figures.latency is figures.jitter is None


def test_a_constant_delay_is_found() -> None:
    bench = Bench()
    bench.run(20)
    figures = bench.sync.statistics()
    assert figures.round_trip_ms == pytest.approx(6.0)
    assert figures.latency is not None
    assert figures.jitter is not None
    assert figures.latency.median_ms == pytest.approx(3.0, abs=0.002)
    assert figures.latency.max_ms == pytest.approx(3.0, abs=0.01)
    assert figures.jitter.max_ms == pytest.approx(0.0, abs=0.002)
    assert figures.clock_ppm == pytest.approx(0.0, abs=0.5)


def test_jitter_is_found_and_does_not_spoil_the_offset() -> None:
    bench = Bench(jitter_ns=10 * MS)
    bench.run(60)
    figures = bench.sync.statistics()
    assert figures.latency is not None
    assert figures.jitter is not None
    assert figures.latency.median_ms == pytest.approx(8.0, abs=2.0)
    assert figures.latency.p95_ms == pytest.approx(12.5, abs=2.0)
    assert figures.latency.max_ms == pytest.approx(13.0, abs=2.0)
    assert figures.jitter.median_ms == pytest.approx(10 * (1 - 0.5**0.5), abs=0.4)


def test_of_many_answers_the_fastest_tells_the_offset() -> None:
    bench = Bench(back_jitter_ns=20 * MS)
    bench.run(60)
    figures = bench.sync.statistics()
    assert figures.latency is not None
    assert figures.latency.median_ms == pytest.approx(3.0, abs=1.0)


def test_the_rate_is_still_known_when_a_32_bit_clock_has_just_wrapped() -> None:
    bench = Bench(ppm=40.0, wrap_us=2**32, offset_ns=(2**32 * 1000) - 43 * S)
    bench.run(40)
    assert bench.sync.statistics().clock_ppm == pytest.approx(40.0, abs=0.5)


@pytest.mark.parametrize("ppm", [40.0, -25.0, 0.0])
@pytest.mark.parametrize("jitter_ms", [0, 4])
def test_the_rate_of_the_device_clock_is_found(ppm: float, jitter_ms: int) -> None:
    bench = Bench(ppm=ppm, jitter_ns=jitter_ms * MS, rate_hz=5)
    bench.run(300)
    figures = bench.sync.statistics()
    assert figures.clock_ppm == pytest.approx(ppm, abs=0.1 if jitter_ms == 0 else 8.0)
    assert figures.latency is not None
    assert figures.latency.median_ms == pytest.approx(3 + jitter_ms / 2, abs=0.6)


def test_samples_that_come_together_wait_for_each_other() -> None:
    bench = Bench(rate_hz=1000, batch=20)
    bench.run(10)
    figures = bench.sync.statistics()
    assert figures.latency is not None
    assert figures.jitter is not None
    assert figures.latency.median_ms == pytest.approx(3 + 9.5, abs=0.6)
    assert figures.latency.max_ms == pytest.approx(3 + 19, abs=0.01)
    assert figures.jitter.max_ms == pytest.approx(0.0, abs=0.002)


def test_a_32_bit_clock_may_wrap() -> None:
    bench = Bench(wrap_us=2**32, offset_ns=(2**32 * 1000) - 15 * S)
    bench.run(40)
    figures = bench.sync.statistics()
    assert figures.latency is not None
    assert figures.jitter is not None
    assert figures.latency.max_ms == pytest.approx(3.0, abs=0.01)
    assert figures.jitter.max_ms == pytest.approx(0.0, abs=0.002)
    assert figures.clock_ppm == pytest.approx(0.0, abs=0.5)


def test_a_device_that_began_anew_has_a_new_offset() -> None:
    bench = Bench()
    bench.run(20)
    bench.offset_ns -= 100 * S
    bench.sync.begin_epoch()
    bench.run(20)
    figures = bench.sync.statistics()
    assert figures.latency is not None
    assert figures.jitter is not None
    assert figures.latency.max_ms == pytest.approx(3.0, abs=0.01)
    assert figures.jitter.max_ms == pytest.approx(0.0, abs=0.002)
    assert figures.clock_ppm == pytest.approx(0.0, abs=0.5)


def test_a_start_that_nobody_told_of_is_noticed() -> None:
    bench = Bench()
    bench.run(20)
    bench.offset_ns -= 100 * S
    bench.run(60)
    figures = bench.sync.statistics()
    assert figures.latency is not None
    assert figures.latency.median_ms == pytest.approx(3.0, abs=0.01)


def test_requests_come_fast_at_first_and_then_once_a_second() -> None:
    now_ns, sent_s = 0, []
    sync = TimeSync(lambda: now_ns)
    for now_ns in range(0, 6 * S, 10 * MS):
        if sync.poll() is not None:
            sent_s.append(now_ns / S)
    assert np.diff(sent_s[:11]).tolist() == pytest.approx([0.1] * 10)
    assert np.diff(sent_s[10:]).tolist() == pytest.approx([1.0] * 4)


@pytest.mark.parametrize(
    ("tc1", "ts1_shift", "source"),
    [(0, 0, (1, 1)), (-5, 0, (1, 1)), (7 * S, 1, (1, 1)), (7 * S, 0, (1, 2)), (7 * S, 0, (9, 1))],
    ids=["request", "negative", "of another's request", "component", "system"],
)
def test_what_is_no_answer_of_the_device_is_passed_over(
    tc1: int, ts1_shift: int, source: tuple[int, int]
) -> None:
    bench = Bench()
    bench.sync.source = (1, 1)
    request = bench.sync.poll()
    bench.now_ns += 4 * MS
    message = M.MAVLink_timesync_message(tc1, request.ts1 + ts1_shift)
    bench.sync.take(bench.frame(message, source))
    assert bench.sync.statistics().round_trip_ms is None
    bench.sync.take(bench.frame(M.MAVLink_timesync_message(7 * S, request.ts1)))
    assert bench.sync.statistics().round_trip_ms == pytest.approx(4.0)


def test_an_answer_counts_once_and_the_first_to_answer_is_kept() -> None:
    bench = Bench()
    request = bench.sync.poll()
    answer = bench.frame(M.MAVLink_timesync_message(7 * S, request.ts1))
    bench.now_ns += 4 * MS
    bench.sync.take(answer)
    bench.now_ns -= 3 * MS
    bench.sync.take(answer)
    assert bench.sync.statistics().round_trip_ms == pytest.approx(4.0)
    assert bench.sync.source == (1, 1)


@pytest.mark.parametrize("tc1", [1, 2**63 - 1, 2**62])
@pytest.mark.parametrize("time_us", [0, 1, 2**31, 2**32, 2**63 - 1, -(2**63), -1])
def test_times_beyond_reason_break_nothing(tc1: int, time_us: int) -> None:
    bench = Bench()
    for _ in range(20):
        request = bench.sync.poll()
        if request is not None:
            bench.sync.take(bench.frame(M.MAVLink_timesync_message(tc1, request.ts1)))
        bench.arrived(np.array([time_us, 0, time_us], dtype=np.int64), bench.now_ns)
        bench.now_ns += 20 * S
    figures = bench.sync.statistics()
    assert figures.latency is not None
    assert np.isfinite(figures.latency.max_ms)
    assert figures.clock_ppm is None


def test_memory_is_bounded() -> None:
    bench = Bench()
    for _ in range(2000):
        bench.sync.poll()
        bench.now_ns += S
        bench.arrived(np.arange(3 * SAMPLES, dtype=np.int64), bench.now_ns)
    assert len(bench.sync._open) <= 16
    assert bench.sync._jitter._values.size == SAMPLES


def test_no_sample_is_no_arrival() -> None:
    bench = Bench()
    bench.arrived([], 0)
    assert bench.sync.statistics().jitter is None


def test_samples_with_arrivals_of_their_own_are_told_apart() -> None:
    """Three samples 10 ms apart, of which the last came 4 ms late, and one that came with it."""
    bench = Bench()
    time_us = np.array([0, 10_000, 20_000, 21_000], dtype=np.int64)
    bench.sync.arrived(time_us, np.array([0, 10, 24, 24]) * MS + S)
    jitter = bench.sync.statistics().jitter
    assert jitter.max_ms == pytest.approx(3.0)
    assert jitter.median_ms == pytest.approx(1.5)
