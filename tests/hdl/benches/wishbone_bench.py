"""The registers behind Wishbone."""

import random

import cocotb
import registers_checks as checks
from cocotb.triggers import ClockCycles, ReadOnly, RisingEdge, Timer


class Wishbone:
    """A classic master; after a cycle it may go on with the next one at once."""

    def __init__(self, dut, rng: random.Random | None = None) -> None:
        self.dut = dut
        self.rng = rng
        self.clocks = self.cycles = 0
        dut.wb_cyc.value = dut.wb_stb.value = 0

    async def read(self, address: int) -> tuple[int, bool]:
        good = await self._cycle(address, 0, 0xDEADBEEF, 0)
        return self.word, good

    async def write(self, address: int, word: int, strobes: int = 15) -> bool:
        return await self._cycle(address, 1, word, strobes)

    async def _cycle(self, address: int, we: int, word: int, select: int) -> bool:
        dut = self.dut
        dut.wb_cyc.value = dut.wb_stb.value = 1
        dut.wb_we.value, dut.wb_adr.value = we, address
        dut.wb_dat_w.value, dut.wb_sel.value = word, select
        self.clocks = 0
        self.cycles += 1
        while True:
            await RisingEdge(dut.clk)
            self.clocks += 1
            assert self.clocks < 10
            ack, err = int(dut.wb_ack.value), int(dut.wb_err.value)
            assert not (ack and err)
            if ack or err:
                break
        self.word = dut.wb_dat_r.value.to_unsigned()
        await self._gap()
        return bool(ack)

    async def _release(self, cycles: int) -> None:
        """Take `stb` away before the next edge, unless another cycle has begun."""
        await Timer(1, "ns")
        if self.cycles == cycles:
            self.dut.wb_cyc.value = self.dut.wb_stb.value = 0

    async def _gap(self) -> None:
        if self.rng and self.rng.random() < 0.5:
            cocotb.start_soon(self._release(self.cycles))
            return
        self.dut.wb_stb.value = 0
        self.dut.wb_cyc.value = self.rng.getrandbits(1) if self.rng else 0
        await ReadOnly()
        assert not self.dut.wb_ack.value
        assert not self.dut.wb_err.value
        await ClockCycles(self.dut.clk, self.rng.randrange(1, 5) if self.rng else 1)


@cocotb.test()
@cocotb.parametrize(check=sorted(checks.CHECKS), gaps=[False, True])
async def registers(dut, check: str, gaps: bool) -> None:
    bus = Wishbone(dut, random.Random(len(check)) if gaps else None)
    await checks.start(dut)
    await checks.CHECKS[check](dut, bus)


@cocotb.test()
async def a_cycle_takes_its_clocks(dut) -> None:
    bus = Wishbone(dut)
    await checks.start(dut)
    assert await bus.write(checks.address("BLEND"), 1)
    assert bus.clocks == 2
    assert await bus.read(checks.address("BLEND")) == (1, True)
    assert bus.clocks == 3


@cocotb.test()
async def a_cycle_that_is_given_up_answers_no_other(dut) -> None:
    bus = Wishbone(dut)
    await checks.start(dut)
    for we in (0, 1):
        for clocks in (1, 2):
            dut.wb_cyc.value = dut.wb_stb.value = 1
            dut.wb_we.value, dut.wb_sel.value = we, 15
            dut.wb_adr.value = 0x3C
            await ClockCycles(dut.clk, clocks)
            dut.wb_cyc.value = dut.wb_stb.value = 0
            await RisingEdge(dut.clk)
            identity = checks.MAP.register("IDENTITY").reset
            assert await bus.read(checks.address("IDENTITY")) == (identity, True)
