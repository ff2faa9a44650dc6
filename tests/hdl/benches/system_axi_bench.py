"""The whole system with a bus: settings changed while it runs, registers against the frames.

What came over the serial line is left in a file; the test holds it against the models.
"""

import json
import os
from pathlib import Path

import cocotb
from cocotb.clock import Clock
from cocotb.triggers import ClockCycles, RisingEdge, with_timeout
from uart_line import Listener, send

from hostkit.link.frames.decoder import Decoder

CHOSEN = json.loads(os.environ["SYSTEM_BENCH"])
PLACE = CHOSEN["addresses"]
ENABLE, CLEAR, COMMIT = 1, 2, 4
ANSWER_US = 100
SAMPLE_US = 4000


class Bus:
    """A master that reads and writes one word at a time."""

    def __init__(self, dut) -> None:
        self.dut = dut
        for name in ("awvalid", "wvalid", "arvalid"):
            getattr(dut, f"s_axi_{name}").value = 0

    async def write(self, name: str, value: int) -> None:
        dut = self.dut
        dut.s_axi_awaddr.value = PLACE[name]
        dut.s_axi_wdata.value = value & 0xFFFFFFFF
        dut.s_axi_awvalid.value = dut.s_axi_wvalid.value = 1
        await RisingEdge(dut.clk)
        dut.s_axi_awvalid.value = dut.s_axi_wvalid.value = 0
        while not dut.s_axi_bvalid.value:
            await RisingEdge(dut.clk)
        assert dut.s_axi_bresp.value == 0, f"{name} refused {value:#x}"
        await RisingEdge(dut.clk)

    async def read(self, name: str) -> int:
        dut = self.dut
        dut.s_axi_araddr.value = PLACE[name]
        dut.s_axi_arvalid.value = 1
        await RisingEdge(dut.clk)
        dut.s_axi_arvalid.value = 0
        while not dut.s_axi_rvalid.value:
            await RisingEdge(dut.clk)
        assert dut.s_axi_rresp.value == 0, f"{name} gave an error"
        value = dut.s_axi_rdata.value.to_unsigned()
        await RisingEdge(dut.clk)
        return value


class Frames:
    """The samples that have come over the line."""

    def __init__(self, dut, listener: Listener) -> None:
        self.dut, self.listener = dut, listener

    def samples(self) -> list:
        frames = Decoder().feed(bytes(self.listener.heard))
        return [frame.message for frame in frames if frame.name == "TILT_SAMPLE"]

    async def wait_for(self, count: int) -> None:
        while len(self.samples()) < count:
            await ClockCycles(self.dut.clk, 2000)


def signed(word: int) -> int:
    return word - (1 << 32) if word >> 31 else word


@cocotb.test()
async def settings_change_while_the_system_runs(dut) -> None:
    baud = CHOSEN["baud"]
    Clock(dut.clk, round(1e12 / CHOSEN["clock_hz"]), "ps").start()
    dut.uart_rx.value = 1
    dut.rst.value = 1
    bus = Bus(dut)
    await ClockCycles(dut.clk, 4)
    listener = Listener(dut.uart_tx, baud)
    cocotb.start_soon(listener.run())
    dut.rst.value = 0
    frames = Frames(dut, listener)

    assert await bus.read("IDENTITY") == 0x484B4954
    assert await bus.read("UART_RX") == 0
    await send(dut.uart_rx, baud, 0xA5)
    await ClockCycles(dut.clk, 40)
    assert await bus.read("UART_RX") == 0x1A5
    assert await bus.read("UART_RX") == 0

    await with_timeout(frames.wait_for(3), CHOSEN["start_us"], "us")
    for name, value in CHOSEN["settings"].items():
        await bus.write(name, value)
    await bus.write("CONTROL", ENABLE | COMMIT)
    begun = len(frames.samples())
    await with_timeout(frames.wait_for(begun + 4), 6 * SAMPLE_US, "us")

    # The registers show the sample whose frame has come last, or the one behind it.
    number = await bus.read("SAMPLE_NUMBER")
    roll, pitch = await bus.read("ANGLE_ROLL"), await bus.read("ANGLE_PITCH")
    await with_timeout(frames.wait_for(number + 1), 3 * SAMPLE_US, "us")
    shown = next(m for m in frames.samples() if m.sequence == number)
    assert (signed(roll), signed(pitch)) == (shown.roll, shown.pitch)

    await bus.write("CONTROL", ENABLE | CLEAR)
    begun = len(frames.samples())
    await with_timeout(frames.wait_for(begun + 3), 5 * SAMPLE_US, "us")
    Path(CHOSEN["heard"]).write_bytes(bytes(listener.heard))
