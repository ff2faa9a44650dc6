"""hk_complementary_fixed, pipelined, against the integer model while its results are left waiting.

Channels come in any order, the same one several times in a row as well; the consumer rests for so
long that the queue of results fills and the core stops taking samples.
"""

import random

import cocotb
import numpy as np
from cocotb.clock import Clock
from cocotb.triggers import ReadOnly, RisingEdge
from designs import all_parameters

from hostkit.filters.complementary import lower, run_integer

CHANNELS, SAMPLES = 16, 700
QUEUE = 128
COUNTS = ("accel_x", "accel_y", "accel_z", "gyro_x", "gyro_y", "gyro_z")
WORDS = ("angle_roll", "angle_pitch", "bias_roll", "bias_pitch")


def stimulus() -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(8)
    channels = np.repeat(rng.integers(0, CHANNELS, SAMPLES), rng.integers(1, 4, SAMPLES))[:SAMPLES]
    force = rng.normal(size=(SAMPLES, 3))
    force *= rng.uniform(14700, 18000, (SAMPLES, 1)) / np.linalg.norm(force, axis=1, keepdims=True)
    rate = rng.integers(-32768, 32768, (SAMPLES, 3)) >> rng.integers(0, 12, (SAMPLES, 3))
    return channels, np.hstack([np.rint(force), rate]).astype(np.int64)


def expected(channels: np.ndarray, counts: np.ndarray) -> np.ndarray:
    spec = lower(all_parameters())
    states = np.zeros((len(counts), 4), dtype=np.int64)
    for channel in range(CHANNELS):
        of = channels == channel
        states[of] = run_integer(spec, counts[of, :3], counts[of, 3:])
    return states


async def start(dut) -> None:
    Clock(dut.clk, 10, "ns").start()
    dut.in_valid.value = 0
    dut.out_ready.value = 0
    dut.rst.value = 1
    await RisingEdge(dut.clk)
    await RisingEdge(dut.clk)
    dut.rst.value = 0


@cocotb.test()
async def a_resting_consumer_stops_the_core_and_loses_nothing(dut) -> None:
    channels, counts = stimulus()
    states = expected(channels, counts) % 2**32
    rng = random.Random(4)
    await start(dut)
    fed, clock, most, seen = 0, 0, 0, []
    while len(seen) < SAMPLES:
        offered = fed < SAMPLES
        dut.in_valid.value = int(offered)
        if offered:
            dut.in_channel.value = int(channels[fed])
            for name, count in zip(COUNTS, counts[fed].tolist(), strict=True):
                getattr(dut, name).value = count % 2**16
        ready = clock // 700 % 2 == 1 and rng.random() < 0.8
        dut.out_ready.value = int(ready)
        await ReadOnly()
        takes = offered and dut.in_ready.value == 1
        assert dut.busy.value == 1 or fed == len(seen)
        if ready and dut.out_valid.value == 1:
            words = [int(getattr(dut, name).value.to_unsigned()) for name in WORDS]
            seen.append((int(dut.out_channel.value.to_unsigned()), *words))
        await RisingEdge(dut.clk)
        fed += takes
        most = max(most, fed - len(seen))
        clock += 1
        assert clock < 40 * SAMPLES
    dut.in_valid.value = 0
    await RisingEdge(dut.clk)
    await ReadOnly()
    assert dut.busy.value == 0
    assert [row[0] for row in seen] == channels.tolist()
    np.testing.assert_array_equal([row[1:] for row in seen], states)
    # The last place is left free where the interlock lets no two samples in a row in.
    assert QUEUE - 3 <= most <= QUEUE - 2
