"""hk_polar against its bit-true model: full speed, random stalls, a reset in the middle."""

import os
import random

import cocotb
import numpy as np
from cocotb.clock import Clock
from cocotb.triggers import ReadOnly, RisingEdge

from hostkit.filters.arctan import arctan_table
from hostkit.filters.polar import polar_arcsin, polar_atan2

TABLE = arctan_table()
CORNERS = (-65536, -32769, -32768, -32767, -16384, -1, 0, 1, 255, 32767, 32768, 65535)


def stimulus(samples: int) -> np.ndarray:
    """Rows of arc sine or not, y and x: corners first, then vectors of any length."""
    rng = np.random.default_rng(5)
    corners = [(op, y, x) for op in (0, 1) for y in CORNERS for x in CORNERS]
    sizes = 2.0 ** rng.uniform(1.0, 15.0, (samples, 1))
    parts = np.rint(rng.uniform(-1.0, 1.0, (samples, 2)) * sizes)
    rest = np.hstack([rng.integers(0, 2, (samples, 1)), parts])
    rows = np.vstack([rng.permutation(np.array(corners)), rest]).astype(np.int64)
    return rows[: int(os.environ.get("SAMPLES", len(rows)))]


def expected(rows: np.ndarray) -> list[tuple[int, int]]:
    op, y, x = rows.T
    turned, sine = polar_atan2(TABLE, y, x), polar_arcsin(TABLE, y, x)
    both = [np.where(op == 1, b, a) for a, b in zip(turned, sine, strict=True)]
    return list(zip(*(part.tolist() for part in both), strict=True))


async def start(dut) -> None:
    Clock(dut.clk, 10, "ns").start()
    dut.in_valid.value = 0
    dut.out_ready.value = 0
    await reset(dut)


async def reset(dut) -> None:
    dut.rst.value = 1
    await RisingEdge(dut.clk)
    await RisingEdge(dut.clk)
    dut.rst.value = 0


async def play(dut, rows: np.ndarray, stalls: bool, watchdog: int = 2000):
    """Feed rows, take results; return them and the clocks on which each was taken and given."""
    rng = random.Random(11)
    ids = 2 ** len(dut.in_id)
    fed, results, taken_at, given_at = 0, [], [], []
    clock, last, held, offered = 0, 0, None, False
    while len(results) < len(rows):
        if not offered and fed < len(rows):
            offered = not stalls or rng.random() < 0.6
            if offered:
                op, y, x = (int(v) for v in rows[fed])
                dut.arcsine.value, dut.y.value, dut.x.value = op, y % 2**17, x % 2**17
                dut.in_id.value = fed % ids
        dut.in_valid.value = int(offered)
        # Long rests fill the queue to its end.
        ready = 0 if stalls and (clock // 300 % 3 == 1 or rng.random() < 0.3) else 1
        dut.out_ready.value = ready
        await ReadOnly()
        takes = offered and bool(dut.in_ready.value)
        if dut.out_valid.value == 1:
            seen = tuple(
                int(part.to_unsigned())
                for part in (dut.angle.value, dut.magnitude.value, dut.out_id.value)
            )
            assert held is None or held == seen, "a waiting result changes"
            held = None if ready else seen
            if ready:
                results.append(seen)
                given_at.append(clock)
                last = clock
        else:
            assert held is None, "a result is taken back"
        await RisingEdge(dut.clk)
        if takes:
            taken_at.append(clock)
            fed, offered, last = fed + 1, False, clock
        clock += 1
        assert clock - last < watchdog, "nothing happens"
    dut.in_valid.value = 0
    dut.out_ready.value = 0
    await RisingEdge(dut.clk)
    assert dut.out_valid.value == 0
    return results, taken_at, given_at


def check(dut, rows: np.ndarray, results: list) -> None:
    ids = 2 ** len(dut.in_id)
    for i, ((angle, magnitude), got) in enumerate(zip(expected(rows), results, strict=True)):
        assert got == (angle % 2**32, magnitude, i % ids), (rows[i].tolist(), got)


@cocotb.test()
async def full_speed(dut) -> None:
    rows = stimulus(int(os.environ["RANDOM_SAMPLES"]))
    await start(dut)
    results, taken, given = await play(dut, rows, stalls=False)
    check(dut, rows, results)
    latencies = {b - a for a, b in zip(taken, given, strict=True)}
    dut._log.info(f"latencies {sorted(latencies)}, {given[-1] - taken[0] + 1} clocks")
    assert latencies == {int(word) for word in os.environ["LATENCIES"].split()}
    if os.environ["PIPELINED"] == "true":
        assert given[-1] - taken[0] == len(rows) - 1 + max(latencies)


@cocotb.test()
async def random_stalls(dut) -> None:
    rows = stimulus(int(os.environ["RANDOM_SAMPLES"]))
    await start(dut)
    results, _, _ = await play(dut, rows, stalls=True)
    check(dut, rows, results)


@cocotb.test()
async def a_reset_drops_what_is_in_work(dut) -> None:
    rows = stimulus(40)[-40:]
    await start(dut)
    for clocks in (1, 2, 5, 30, 62, 75):
        dut.in_valid.value = 1
        for _ in range(clocks):
            await RisingEdge(dut.clk)
        dut.in_valid.value = 0
        await reset(dut)
        results, _, _ = await play(dut, rows[:12], stalls=False)
        check(dut, rows[:12], results)
