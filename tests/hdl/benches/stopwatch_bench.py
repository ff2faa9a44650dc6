"""hk_stopwatch against the clocks that have gone by."""

import os

import cocotb
from cocotb.clock import Clock
from cocotb.triggers import FallingEdge, Timer

CLOCK_HZ = int(os.environ["CLOCK_HZ"])
CLOCK_PS = 10_000


@cocotb.test()
async def microseconds_are_exact_in_the_long_run(dut) -> None:
    Clock(dut.clk, CLOCK_PS, "ps").start()
    dut.rst.value = 1
    for _ in range(3):
        await FallingEdge(dut.clk)
    assert dut.time_us.value.to_unsigned() == 0
    dut.rst.value = 0
    clocks = 0
    for distance in (*[1] * 200, *[997] * 20, 33_331, 60_000):
        await Timer(distance * CLOCK_PS, "ps")
        clocks += distance
        time_us = dut.time_us.value.to_unsigned()
        # A microsecond begins on its clock or less than one before.
        assert time_us == ((clocks + 1) * 10**6 - 1) // CLOCK_HZ, clocks
    dut.rst.value = 1
    for _ in range(2):
        await FallingEdge(dut.clk)
    assert dut.time_us.value.to_unsigned() == 0
