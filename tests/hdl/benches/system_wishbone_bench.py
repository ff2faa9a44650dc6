"""The whole system with a Wishbone bus and no sensor: its identity, and a byte that it hears."""

import cocotb
from cocotb.clock import Clock
from cocotb.triggers import ClockCycles, RisingEdge
from uart_line import send

CLOCK_HZ, BAUD = 4_000_000, 1_000_000
UART_RX = 0x34


async def read(dut, address: int) -> int:
    dut.wb_adr.value = address
    dut.wb_we.value = 0
    dut.wb_cyc.value = dut.wb_stb.value = 1
    await RisingEdge(dut.clk)
    while not (dut.wb_ack.value or dut.wb_err.value):
        await RisingEdge(dut.clk)
    assert not dut.wb_err.value
    value = dut.wb_dat_r.value.to_unsigned()
    dut.wb_cyc.value = dut.wb_stb.value = 0
    await RisingEdge(dut.clk)
    return value


@cocotb.test()
async def a_master_reads(dut) -> None:
    Clock(dut.clk, round(1e12 / CLOCK_HZ), "ps").start()
    for name in ("wb_cyc", "wb_stb", "wb_we", "wb_adr", "wb_sel", "wb_dat_w", "int_pin"):
        getattr(dut, name).value = 0
    dut.scl_in.value = dut.sda_in.value = dut.uart_rx.value = dut.rst.value = 1
    await ClockCycles(dut.clk, 4)
    dut.rst.value = 0
    await RisingEdge(dut.clk)
    assert await read(dut, 0) == 0x484B4954
    await send(dut.uart_rx, BAUD, 0x5A)
    await ClockCycles(dut.clk, 40)
    assert await read(dut, UART_RX) == 0x15A
    assert await read(dut, UART_RX) == 0
