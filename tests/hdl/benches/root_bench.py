"""hk_root against the integer square root of Python."""

import math
import random

import cocotb
from cocotb.clock import Clock
from cocotb.triggers import RisingEdge

INTEGER_BITS, FRACTION_BITS = 15, 8


@cocotb.test()
async def the_root_is_floored(dut) -> None:
    rng = random.Random(3)
    radicands = [0, 1, 2, 3, 4, 2**30 - 1, 2**28, *(rng.randrange(2**30) for _ in range(60))]
    Clock(dut.clk, 10, "ns").start()
    dut.rst.value = 1
    dut.in_valid.value = 0
    dut.out_ready.value = 0
    await RisingEdge(dut.clk)
    await RisingEdge(dut.clk)
    dut.rst.value = 0
    for radicand in radicands:
        dut.radicand.value = radicand
        dut.in_valid.value = 1
        await RisingEdge(dut.clk)
        while not dut.in_ready.value:
            await RisingEdge(dut.clk)
        dut.in_valid.value = 0
        while not dut.out_valid.value:
            await RisingEdge(dut.clk)
        assert dut.root.value.to_unsigned() == math.isqrt(radicand << 2 * FRACTION_BITS)
        dut.out_ready.value = rng.random() < 0.5
        while not (dut.out_valid.value and dut.out_ready.value):
            await RisingEdge(dut.clk)
            dut.out_ready.value = 1
        dut.out_ready.value = 1
        await RisingEdge(dut.clk)
        dut.out_ready.value = 0
