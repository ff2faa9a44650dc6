"""From a sample to the bytes at the other end of the line, under full load."""

import os
import random

import cocotb
from cocotb.clock import Clock
from cocotb.triggers import FallingEdge, RisingEdge
from cocotb.utils import get_sim_time
from mavlink_frames import frame_of_heartbeat, frame_of_sample, random_sample

DIGEST = bytes.fromhex(os.environ["DIGEST"])
CLOCK_NS = 10
SAMPLES = 4 if float(os.environ["RATIO"]) > 100 else 12


class Load:
    """Samples always waiting, a heartbeat with every fourth, and what must come of them."""

    def __init__(self, dut) -> None:
        self.dut = dut
        self.rng = random.Random(21)
        self.frames: list[bytes] = []
        self.began_ns: list[float] = []

    async def samples(self) -> None:
        for number in range(SAMPLES):
            sample = random_sample(self.rng)
            sample["restarted"] = 1  # all frames of one length
            for name, value in sample.items():
                getattr(self.dut, name).value = value
            self.dut.sample_valid.value = 1
            self.dut.heartbeat_valid.value = number % 4 == 3
            if number % 4 == 3:
                await self._until(self.dut.heartbeat_ready)
                self.frames.append(frame_of_heartbeat(4, len(self.frames)))
                self.dut.heartbeat_valid.value = 0
            await self._until(self.dut.sample_ready)
            self.began_ns.append(get_sim_time("ns"))
            self.frames.append(frame_of_sample(sample, (), DIGEST, len(self.frames)))
        self.dut.sample_valid.value = 0

    async def _until(self, ready) -> None:
        await RisingEdge(ready)
        await RisingEdge(self.dut.clk)


@cocotb.test()
async def frames_arrive_whole(dut) -> None:
    Clock(dut.clk, CLOCK_NS, "ns").start()
    load = Load(dut)
    dut.system_status.value = 4
    dut.sample_valid.value = 0
    dut.heartbeat_valid.value = 0
    dut.rst.value = 1
    for _ in range(3):
        await FallingEdge(dut.clk)
    dut.rst.value = 0
    received = bytearray()
    task = cocotb.start_soon(load.samples())
    while not task.done() or len(received) < sum(map(len, load.frames)):
        await RisingEdge(dut.out_valid)
        await FallingEdge(dut.clk)
        assert dut.framing_error.value == 0
        received.append(dut.out_data.value.to_unsigned())
    assert received == b"".join(load.frames)
    clocks = (load.began_ns[1] - load.began_ns[0]) / CLOCK_NS
    dut._log.info("a sample's frame of %d bytes: %.0f clocks", len(load.frames[1]), clocks)
    assert clocks <= float(os.environ["MOST_CLOCKS"])
