"""hk_uart_tx and hk_uart_rx against a line that is timed in picoseconds, not in clocks."""

import os
import random

import cocotb
from cocotb.clock import Clock
from cocotb.triggers import FallingEdge, ReadOnly, RisingEdge, Timer

CLOCK_PS = 10_000
RATIO = int(os.environ["CLOCK_HZ"]) / int(os.environ["BAUD"])
BIT_PS = RATIO * CLOCK_PS
BYTES = 40 if RATIO < 100 else 8 if RATIO < 1000 else 3


class Line:
    """What came out of the receiver, and a sender to it."""

    def __init__(self, dut, seed: int) -> None:
        self.dut = dut
        self.rng = random.Random(seed)
        self.received: list[int] = []
        self.framing_errors = 0
        self.overruns = 0

    async def start(self) -> None:
        dut = self.dut
        Clock(dut.clk, CLOCK_PS, "ps").start()
        dut.in_valid.value = 0
        dut.in_data.value = 0
        dut.rx.value = 1
        dut.out_ready.value = 1
        dut.rst.value = 1
        for _ in range(3):
            await RisingEdge(dut.clk)
        dut.rst.value = 0
        cocotb.start_soon(self._bytes())
        cocotb.start_soon(self._pulses("framing_error", "framing_errors"))
        cocotb.start_soon(self._pulses("overrun", "overruns"))
        await Timer(round(3 * CLOCK_PS + self.rng.random() * CLOCK_PS), "ps")

    async def _bytes(self) -> None:
        """A byte is taken on a falling edge's look at both signals, half a clock before."""
        while True:
            if not self.dut.out_valid.value:
                await self.dut.out_valid.value_change
            await FallingEdge(self.dut.clk)
            if self.dut.out_valid.value and self.dut.out_ready.value:
                self.received.append(self.dut.out_data.value.to_unsigned())
                await RisingEdge(self.dut.clk)
                await ReadOnly()

    async def _pulses(self, signal: str, counter: str) -> None:
        while True:
            await RisingEdge(getattr(self.dut, signal))
            await RisingEdge(self.dut.clk)
            await ReadOnly()
            assert not getattr(self.dut, signal).value, "a pulse is one clock"
            setattr(self, counter, getattr(self, counter) + 1)

    async def levels(self, changes: list[tuple[float, int]]) -> None:
        """Put levels on the line, each for so many bits; the sum is rounded, not each."""
        now, at = 0, 0.0
        for bits, level in changes:
            self.dut.rx.value = level
            at += bits * BIT_PS
            await Timer(round(at) - now, "ps")
            now = round(at)

    async def send(self, data: list[int], error: float = 0.0, stop: int = 1) -> None:
        bit = 1.0 / (1.0 + error)
        changes = []
        for byte in data:
            levels = [0, *(byte >> i & 1 for i in range(8)), stop]
            changes += [(bit, level) for level in levels]
        await self.levels(changes)
        self.dut.rx.value = 1

    async def rest(self, bits: float = 2.0) -> None:
        await Timer(round(bits * BIT_PS + 4 * CLOCK_PS), "ps")

    def data(self, count: int) -> list[int]:
        return [0x00, 0xFF, 0x55, *(self.rng.randrange(256) for _ in range(count - 3))]


@cocotb.test()
async def bytes_follow_each_other_at_the_exact_rate(dut) -> None:
    line = Line(dut, 1)
    await line.start()
    data = line.data(BYTES)
    cocotb.start_soon(_offer(dut, data))
    await FallingEdge(dut.tx)
    begin = cocotb.utils.get_sim_time("ps")
    for place, byte in enumerate(data):
        for number, level in enumerate([0, *(byte >> i & 1 for i in range(8)), 1]):
            # Every tick, the first one included, is less than a clock early and never late.
            for part in (1.01 * CLOCK_PS, BIT_PS - 1.01 * CLOCK_PS):
                at = round(begin + (10 * place + number) * BIT_PS + part)
                await Timer(at - int(cocotb.utils.get_sim_time("ps")), "ps")
                assert dut.tx.value == level, (place, number, part)
    await Timer(round(3 * BIT_PS), "ps")
    assert dut.tx.value == 1
    assert dut.in_ready.value == 1


async def _offer(dut, data: list[int]) -> None:
    for byte in data:
        dut.in_data.value = byte
        dut.in_valid.value = 1
        await RisingEdge(dut.clk)
        while not dut.in_ready.value:
            await RisingEdge(dut.in_ready)
            await RisingEdge(dut.clk)
        dut.in_valid.value = 0
        dut.in_data.value = byte ^ 0xFF
        await Timer(round(CLOCK_PS * (RATIO - 3)), "ps")  # late, but within the stop bit


@cocotb.test()
async def senders_may_be_2_percent_off(dut) -> None:
    line = Line(dut, 2)
    await line.start()
    for error in (-0.02, -0.01, 0.0, 0.01, 0.02):
        line.received.clear()
        data = line.data(BYTES)
        await line.send(data, error)
        await line.rest()
        assert line.received == data, error
    assert (line.framing_errors, line.overruns) == (0, 0)


@cocotb.test()
async def glitches_are_no_start_bits(dut) -> None:
    line = Line(dut, 3)
    await line.start()
    longest = 0.24 if RATIO < 8 else 0.36
    for _ in range(10):
        await line.levels([(longest * line.rng.random(), 0), (1.3 + line.rng.random(), 1)])
    data = line.data(4)
    await line.send(data)
    await line.rest()
    assert line.received == data
    assert line.framing_errors == 0


@cocotb.test()
async def one_bad_sample_of_a_bit_is_outvoted(dut) -> None:
    line = Line(dut, 4)
    await line.start()
    # Shorter than the distance of two samples.
    width = 0.9 / RATIO if RATIO < 16 else 0.11
    for byte in line.data(6 if RATIO < 1000 else 3):
        changes = []
        for level in [0, *(byte >> i & 1 for i in range(8)), 1]:
            first = 0.1 + line.rng.random() * (0.8 - width)
            if changes == []:
                first = 0.5  # an earlier one in the start bit would start it anew
            changes += [(first, level), (width, 1 - level), (1.0 - first - width, level)]
        await line.levels(changes)
        line.dut.rx.value = 1
        await line.rest(1.0 + line.rng.random())
        assert line.received[-1] == byte, line.received
    assert line.framing_errors == 0


@cocotb.test()
async def a_break_is_one_framing_error(dut) -> None:
    line = Line(dut, 5)
    await line.start()
    await line.send([0x5A], stop=0)
    await line.rest()
    assert (line.received, line.framing_errors) == ([], 1)
    await line.levels([(25.0, 0), (2.0, 1)])
    assert (line.received, line.framing_errors) == ([], 2)
    await line.send([0xA5])
    await line.rest()
    assert (line.received, line.framing_errors) == ([0xA5], 2)


@cocotb.test()
async def a_byte_too_many_is_dropped_and_told(dut) -> None:
    line = Line(dut, 6)
    await line.start()
    dut.out_ready.value = 0
    await line.send([0x12, 0x34, 0x56])
    await line.rest()
    assert (line.received, line.overruns) == ([], 2)
    await RisingEdge(dut.clk)
    dut.out_ready.value = 1
    await line.rest()
    await line.send([0x78])
    await line.rest()
    assert (line.received, line.overruns) == ([0x12, 0x78], 2)


@cocotb.test()
async def the_receiver_hears_the_transmitter(dut) -> None:
    line = Line(dut, 7)
    await line.start()
    cocotb.start_soon(_wire(dut))
    data = line.data(BYTES)
    await _offer(dut, data)
    await line.rest(12.0)
    assert line.received == data
    assert (line.framing_errors, line.overruns) == (0, 0)


async def _wire(dut) -> None:
    while True:
        await dut.tx.value_change
        dut.rx.value = dut.tx.value
