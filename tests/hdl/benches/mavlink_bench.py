"""hk_mavlink_tx against what pymavlink packs of the same values."""

import os
import random

import cocotb
from cocotb.clock import Clock
from cocotb.triggers import FallingEdge, RisingEdge
from mavlink_frames import frame_of_heartbeat, frame_of_sample, random_sample

AXES = tuple(os.environ["HIDDEN_AXES"].split())
DIGEST = bytes.fromhex(os.environ["DIGEST"])
FRAMES = 40


class Sender:
    """The core, with what it has sent."""

    def __init__(self, dut, seed: int) -> None:
        self.dut = dut
        self.rng = random.Random(seed)
        self.sent = bytearray()
        self.readiness = 1.0

    async def start(self) -> None:
        Clock(self.dut.clk, 10, "ns").start()
        self.dut.byte_ready.value = 0
        self.dut.sample_valid.value = 0
        self.dut.heartbeat_valid.value = 0
        self.scramble()
        self.dut.system_status.value = 0
        await self.reset()
        cocotb.start_soon(self._take())

    async def reset(self) -> None:
        self.dut.rst.value = 1
        await FallingEdge(self.dut.clk)
        await FallingEdge(self.dut.clk)
        self.dut.rst.value = 0
        self.sent.clear()

    def scramble(self) -> None:
        """Nothing may be taken from inputs that are not valid."""
        self.put(random_sample(self.rng))

    def put(self, sample: dict[str, int]) -> None:
        for name, value in sample.items():
            getattr(self.dut, name).value = value

    async def _take(self) -> None:
        """Signals change on rising edges and are looked at on falling ones."""
        waiting = None
        while True:
            await FallingEdge(self.dut.clk)
            ready = self.rng.random() < self.readiness
            self.dut.byte_ready.value = ready
            if self.dut.byte_valid.value:
                byte = self.dut.byte_data.value.to_unsigned()
                assert waiting in (None, byte), "a byte must hold until it is taken"
                waiting = None if ready else byte
                if ready:
                    self.sent.append(byte)
            else:
                assert waiting is None, "valid must hold until the byte is taken"

    async def until_taken(self, ready) -> None:
        await FallingEdge(self.dut.clk)
        while not ready.value:
            await RisingEdge(ready)
            await FallingEdge(self.dut.clk)
        await RisingEdge(self.dut.clk)
        await FallingEdge(self.dut.clk)

    async def sample(self, sample: dict[str, int]) -> None:
        self.put(sample)
        self.dut.sample_valid.value = 1
        await self.until_taken(self.dut.sample_ready)
        self.dut.sample_valid.value = 0
        self.scramble()

    async def heartbeat(self, status: int) -> None:
        self.dut.system_status.value = status
        self.dut.heartbeat_valid.value = 1
        await self.until_taken(self.dut.heartbeat_ready)
        self.dut.heartbeat_valid.value = 0
        self.dut.system_status.value = self.rng.randrange(256)


@cocotb.test()
async def samples_are_packed_as_pymavlink_does(dut) -> None:
    sender = Sender(dut, 11)
    await sender.start()
    for number in range(FRAMES):
        sender.readiness = sender.rng.choice((1.0, 0.5, 0.05))
        sample = random_sample(sender.rng)
        await sender.sample(sample)
        assert sender.sent == frame_of_sample(sample, AXES, DIGEST, number)
        sender.sent.clear()


@cocotb.test()
async def zeros_at_the_end_are_not_sent(dut) -> None:
    sender = Sender(dut, 12)
    await sender.start()
    names = ("restarted", "saturated", "retuned", "bias_roll", "bias_pitch")
    number = 0
    for name in names:
        for value in (1, 0x100, 0x800000) if name.startswith("bias") else (1,):
            sample = random_sample(sender.rng) | dict.fromkeys(names, 0) | {name: value}
            await sender.sample(sample)
            assert sender.sent == frame_of_sample(sample, AXES, DIGEST, number), sample
            sender.sent.clear()
            number += 1
    nothing = dict.fromkeys(random_sample(sender.rng), 0)
    await sender.sample(nothing)
    assert sender.sent == frame_of_sample(nothing, AXES, DIGEST, number)


@cocotb.test(skip=bool(AXES))  # once is enough
async def the_sequence_wraps_over_both_kinds(dut) -> None:
    sender = Sender(dut, 13)
    await sender.start()
    for number in range(260):
        if number % 100 == 99:
            sample = random_sample(sender.rng)
            await sender.sample(sample)
            expected = frame_of_sample(sample, AXES, DIGEST, number % 256)
        else:
            status = sender.rng.randrange(256)
            await sender.heartbeat(status)
            expected = frame_of_heartbeat(status, number % 256)
        assert sender.sent == expected
        sender.sent.clear()


@cocotb.test(timeout_time=1, timeout_unit="ms")
async def neither_kind_starves(dut) -> None:
    sender = Sender(dut, 14)
    await sender.start()
    expected = b""
    sample = random_sample(sender.rng)
    sender.put(sample)
    dut.system_status.value = 4
    dut.sample_valid.value = 1
    dut.heartbeat_valid.value = 1
    for number in range(0, 10, 2):
        await sender.until_taken(dut.heartbeat_ready)
        await sender.until_taken(dut.sample_ready)
        expected += frame_of_heartbeat(4, number)
        expected += frame_of_sample(sample, AXES, DIGEST, number + 1)
    assert sender.sent == expected


@cocotb.test()
async def a_reset_drops_the_frame(dut) -> None:
    sender = Sender(dut, 15)
    await sender.start()
    for length in (0, 1, 7, 30, 50):
        sample = random_sample(sender.rng)
        sender.put(sample)
        dut.sample_valid.value = 1
        while len(sender.sent) < length:
            await FallingEdge(dut.clk)
        await sender.reset()
        await sender.sample(sample)
        assert sender.sent == frame_of_sample(sample, AXES, DIGEST, 0)
