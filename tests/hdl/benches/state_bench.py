"""hk_mavlink_tx of a filter that tells its state, against what pymavlink packs."""

import os

import cocotb
from cocotb.triggers import FallingEdge, RisingEdge
from mavlink_bench import DIGEST, Sender
from mavlink_frames import frame_of_heartbeat, frame_of_sample, frame_of_state, random_sample

WORDS = int(os.environ["WORDS"])
"""Words of the state."""


class StateSender(Sender):
    """The core beside a filter that shows a word two clocks after its index."""

    words: list[int]

    async def begin(self) -> None:
        self.words = [0] * 32
        self.dut.state_valid.value = 0
        self.dut.state_word.value = 0
        await self.start()
        cocotb.start_soon(self._show())

    async def _show(self) -> None:
        indices = [0, 0]
        while True:
            await RisingEdge(self.dut.clk)
            indices = [*indices[1:], self.dut.state_index.value]
            if indices[0] == 0 or indices[0].is_resolvable:
                self.dut.state_word.value = self.words[int(indices[0])]

    def fill(self) -> list[int]:
        """Choose words, often with zeros at the end; what is past the last must not matter."""
        used = self.rng.randrange(WORDS + 1)
        self.words = [self._word() if i < used else 0 for i in range(WORDS)]
        self.words += [self._word() for _ in range(WORDS, 32)]
        return self.words[:WORDS]

    def _word(self) -> int:
        return self.rng.choice((0, -1, -(2**31), 2**31 - 1, self.rng.randrange(-(2**31), 2**31)))


@cocotb.test()
async def a_state_follows_its_sample(dut) -> None:
    sender = StateSender(dut, 21)
    await sender.begin()
    number = 0
    for _ in range(30):
        sender.readiness = sender.rng.choice((1.0, 0.5, 0.05))
        sample, words = _sample(sender), sender.fill()
        told = sender.rng.random() < 0.7
        dut.state_valid.value = told
        await sender.sample(sample)
        expected = frame_of_sample(sample, (), DIGEST, number % 256)
        number += 1
        if told:
            expected += frame_of_state(sample["sequence"], words, number % 256)
            number += 1
        assert sender.sent == expected
        sender.sent.clear()


@cocotb.test()
async def a_zero_state_is_short(dut) -> None:
    sender = StateSender(dut, 22)
    await sender.begin()
    dut.state_valid.value = 1
    for number, sequence in enumerate((0, 1, 0x80000000)):
        sample = _sample(sender) | {"sequence": sequence}
        await sender.sample(sample)
        expected = frame_of_sample(sample, (), DIGEST, 2 * number)
        assert sender.sent == expected + frame_of_state(sequence, [0] * WORDS, 2 * number + 1)
        sender.sent.clear()


@cocotb.test()
async def it_is_told_that_a_state_was_sent(dut) -> None:
    sender = StateSender(dut, 23)
    await sender.begin()
    dut.state_valid.value = 1
    sample = _sample(sender)
    sender.put(sample)
    dut.sample_valid.value = 1
    await sender.until_taken(dut.state_ready)
    assert dut.sample_ready.value == 0
    dut.state_valid.value = 0
    dut.sample_valid.value = 0
    for _ in range(2000):
        await FallingEdge(dut.clk)
        assert dut.state_ready.value == 0


@cocotb.test()
async def no_heartbeat_comes_between(dut) -> None:
    sender = StateSender(dut, 24)
    await sender.begin()
    sample, words = _sample(sender), sender.fill()
    sender.put(sample)
    dut.system_status.value = 4
    dut.sample_valid.value = 1
    dut.heartbeat_valid.value = 1
    dut.state_valid.value = 1
    expected = b""
    for number in range(0, 9, 3):
        await sender.until_taken(dut.heartbeat_ready)
        await sender.until_taken(dut.sample_ready)
        expected += frame_of_heartbeat(4, number)
        expected += frame_of_sample(sample, (), DIGEST, number + 1)
        expected += frame_of_state(sample["sequence"], words, number + 2)
    assert sender.sent == expected


@cocotb.test()
async def a_reset_drops_the_state(dut) -> None:
    sender = StateSender(dut, 25)
    await sender.begin()
    dut.state_valid.value = 1
    for length in (60, 70):
        sample, words = _sample(sender), sender.fill()
        sender.put(sample)
        dut.sample_valid.value = 1
        while len(sender.sent) < length:
            await FallingEdge(dut.clk)
        await sender.reset()
        await sender.sample(sample)
        expected = frame_of_sample(sample, (), DIGEST, 0)
        assert sender.sent == expected + frame_of_state(sample["sequence"], words, 1)


def _sample(sender: StateSender) -> dict[str, int]:
    return random_sample(sender.rng)
