"""The registers behind AXI4-Lite."""

import itertools
import logging
import random

import cocotb
import registers_checks as checks
from cocotb.triggers import ClockCycles, RisingEdge, gather
from cocotbext.axi import AxiLiteBus, AxiLiteMaster, AxiResp

SLOW = ("write_if.aw_channel", "write_if.w_channel", "write_if.b_channel")
SLOW += ("read_if.ar_channel", "read_if.r_channel")


class Axi:
    def __init__(self, dut) -> None:
        logging.getLogger("cocotb.hk_regs_bench").setLevel(logging.WARNING)
        self.master = AxiLiteMaster(AxiLiteBus.from_prefix(dut, "s_axi"), dut.clk)

    def stall(self, seed: int) -> None:
        rng = random.Random(seed)
        for name in SLOW:
            side, channel = name.split(".")
            pattern = [rng.random() < 0.5 for _ in range(97)]
            getattr(getattr(self.master, side), channel).set_pause_generator(
                itertools.cycle(pattern)
            )

    async def read(self, address: int) -> tuple[int, bool]:
        answer = await self.master.read(address, 4)
        return int.from_bytes(answer.data, "little"), _good(answer.resp)

    async def write(self, address: int, word: int, strobes: int = 15) -> bool:
        if strobes == 15:
            answer = await self.master.write(address, word.to_bytes(4, "little"))
            return _good(answer.resp)
        bus = self.master.write_if
        item = bus.aw_channel._transaction_obj()
        item.awaddr, item.awprot = address, 0
        data = bus.w_channel._transaction_obj()
        data.wdata, data.wstrb = word, strobes
        await bus.aw_channel.send(item)
        await bus.w_channel.send(data)
        return _good(AxiResp(int((await bus.b_channel.recv()).bresp)))


def _good(response: AxiResp) -> bool:
    assert response in (AxiResp.OKAY, AxiResp.SLVERR)
    return response == AxiResp.OKAY


async def _run(dut, check, stall_seed: int | None) -> None:
    await checks.start(dut)
    axi = Axi(dut)
    if stall_seed is not None:
        axi.stall(stall_seed)
    await check(dut, axi)


@cocotb.test()
@cocotb.parametrize(check=sorted(checks.CHECKS), stalls=[False, True])
async def registers(dut, check: str, stalls: bool) -> None:
    await _run(dut, checks.CHECKS[check], len(check) if stalls else None)


@cocotb.test()
async def reads_and_writes_at_once(dut) -> None:
    """Both sides at full speed and with stalls: neither starves, neither disturbs the other."""
    await checks.start(dut)
    axi = Axi(dut)
    rng = random.Random(5)
    counts = {"read": 0, "write": 0}
    last = 0

    async def write() -> None:
        nonlocal last
        for _ in range(60):
            last = rng.getrandbits(32)
            assert await axi.write(checks.address("TILT_OFFSET_PITCH"), last)
            counts["write"] += 1

    async def read() -> None:
        for i in range(60):
            register = checks.MAP.register("IDENTITY" if i % 3 else "DIGEST_LOW")
            assert await axi.read(register.address) == (register.reset, True)
            counts["read"] += 1

    async def both() -> None:
        await gather(write(), read())

    await both()
    axi.stall(6)
    await both()
    assert counts == {"read": 120, "write": 120}
    assert await axi.read(checks.address("TILT_OFFSET_PITCH")) == (last, True)


@cocotb.test()
async def address_and_data_come_in_any_order(dut) -> None:
    """By hand, as no master does it: data long before its address, and the other way round."""
    await checks.start(dut)
    dut.s_axi_bready.value = 0
    for first, second in (("w", "aw"), ("aw", "w")):
        dut.s_axi_awaddr.value = checks.address("GYRO_BIAS_PITCH")
        dut.s_axi_wdata.value = 0x12345678
        dut.s_axi_wstrb.value = 15
        for channel in (first, second):
            getattr(dut, f"s_axi_{channel}valid").value = 1
            await ClockCycles(dut.clk, 1)
            while not getattr(dut, f"s_axi_{channel}ready").value:
                await RisingEdge(dut.clk)
            getattr(dut, f"s_axi_{channel}valid").value = 0
            if channel == first:
                await ClockCycles(dut.clk, 7)
                assert dut.s_axi_bvalid.value == 0
        await ClockCycles(dut.clk, 5)
        for _ in range(6):
            assert dut.s_axi_bvalid.value == 1
            assert dut.s_axi_bresp.value == 0
            await RisingEdge(dut.clk)
        dut.s_axi_bready.value = 1
        await RisingEdge(dut.clk)
        dut.s_axi_bready.value = 0
        await ClockCycles(dut.clk, 2)
        assert dut.s_axi_bvalid.value == 0


@cocotb.test()
async def requests_are_kept_through_pressure(dut) -> None:
    """A read response that is not taken holds its data while writes go on."""
    await checks.start(dut)
    axi = Axi(dut)
    axi.master.read_if.r_channel.pause = True
    dut.angle_roll.value = 1234
    reading = cocotb.start_soon(axi.read(checks.address("ANGLE_ROLL")))
    await ClockCycles(dut.clk, 12)
    dut.angle_roll.value = 99
    for word in (1, 2, 3):
        assert await axi.write(checks.address("GYRO_BIAS_PITCH"), word)
    axi.master.read_if.r_channel.pause = False
    assert await reading == (1234, True)
