"""What the registers do, asked through any bus, against the description they are made from."""

import os
import random
from typing import Protocol

import cocotb
import designs
from cocotb.clock import Clock
from cocotb.triggers import ClockCycles, ReadOnly, RisingEdge

from hostkit.filters import FILTERS
from hostkit.render.registers import Field, register_map

DESIGN = {
    "all": designs.all_parameters,
    "plain": designs.design,
    "pitch": lambda: designs.design(axes="pitch", tilt="arcsin"),
}[os.environ.get("DESIGN", "all")]()
SPEC = FILTERS["complementary"].lower(DESIGN)
MAP = register_map(DESIGN, SPEC)
PRESENT = [s for s in FILTERS[SPEC.filter].setting_words(DESIGN, SPEC) if s.raw is not None]
EVENTS = [field.element for field in MAP.register("EVENTS").fields]
BY_ADDRESS = {register.address: register for register in MAP.registers}
ENABLE, CLEAR, COMMIT, RESTORE = 1, 2, 4, 8
BUSY, RETUNED, STAGED, COMMITTING = 4, 8, 16, 32


class Bus(Protocol):
    """One access at a time; each also says whether it was answered without an error."""

    async def read(self, address: int) -> tuple[int, bool]: ...

    async def write(self, address: int, word: int, strobes: int = 15) -> bool: ...


def address(name: str) -> int:
    return MAP.register(name).address


def port(dut, element: str):
    """The port of an element; one has a name that SystemVerilog would not take."""
    return getattr(dut, {"sequence": "sample_sequence"}.get(element, element))


def inputs(dut) -> dict[str, int]:
    """Names and widths of what the core gives."""
    found = {}
    for register in MAP.registers:
        for field in register.fields:
            if field.source == "core" or field.access == "w1c":
                found[field.element] = len(port(dut, field.element))
    return found


def signed(value: int, bits: int) -> int:
    return (value ^ (1 << bits - 1)) - (1 << bits - 1)


def word_of(setting, raw: int) -> int:
    """A setting as a read shows it."""
    return signed(raw, setting.width) & 0xFFFFFFFF if setting.signed else raw


async def start(dut) -> None:
    Clock(dut.clk, 10, "ns").start()
    dut.rst.value = 1
    for name in inputs(dut):
        port(dut, name).value = 0
    for name in ("s_axi_awvalid", "s_axi_wvalid", "s_axi_arvalid", "wb_cyc", "wb_stb"):
        getattr(dut, name).value = 0
    await ClockCycles(dut.clk, 3)
    dut.rst.value = 0
    await RisingEdge(dut.clk)


def used(dut) -> tuple[int, ...]:
    """The settings that the core has, of those in the design."""
    return tuple(getattr(dut, f"settings_{s.name}").value.to_unsigned() for s in PRESENT)


OF_DESIGN = tuple(s.raw % 2**s.width for s in PRESENT)


async def written(bus: Bus, rng: random.Random) -> dict[str, int]:
    """Write every setting that the design has; return what."""
    raw = {s.name: rng.getrandbits(s.width) for s in PRESENT}
    for s in PRESENT:
        assert await bus.write(address(s.name.upper()), word_of(s, raw[s.name]))
    return raw


async def _read(bus: Bus, name: str) -> int:
    word, good = await bus.read(address(name))
    assert good
    return word


def _shown(field: Field, values: dict[str, int]) -> int:
    if not field.readable:
        return 0
    if field.source == "core":
        return values[field.element] >> field.element_low & 2**field.width - 1
    return field.reset


async def every_register_reads(dut, bus: Bus) -> None:
    rng = random.Random(1)
    values = {name: rng.getrandbits(bits) for name, bits in inputs(dut).items()}
    values |= dict.fromkeys(EVENTS, 0) | {"uart_valid": 1}
    for name, value in values.items():
        port(dut, name).value = value
    for register in MAP.registers:
        expected = sum(_shown(f, values) << f.low for f in register.fields)
        assert await _read(bus, register.name) == expected, register.name


async def what_cannot_be_is_an_error(dut, bus: Bus) -> None:
    before = used(dut)
    for place in range(0, 256, 4):
        register = BY_ADDRESS.get(place)
        word, good = await bus.read(place)
        assert good == (register is not None), hex(place)
        assert good or word == 0
        writable = register is not None and register.writable
        assert await bus.write(place, 1 if place == address("CONTROL") else 0) == writable, place
        if writable and not register.present:
            assert await bus.write(place, 0xFFFFFFFF) == writable
            assert await _read(bus, register.name) == 0
    assert used(dut) == before
    assert await bus.write(address("CONTROL"), ENABLE | RESTORE)


async def settings_change_together(dut, bus: Bus) -> None:
    rng = random.Random(2)
    seen = set()

    async def watch() -> None:
        while True:
            await RisingEdge(dut.clk)
            await ReadOnly()
            seen.add(used(dut))

    watcher = cocotb.start_soon(watch())
    raw = await written(bus, rng)
    for s in PRESENT:
        assert await _read(bus, s.name.upper()) == word_of(s, raw[s.name])
    assert await _read(bus, "STATUS") & (RETUNED | STAGED) == STAGED
    dut.core_busy.value = 1
    assert await bus.write(address("CONTROL"), ENABLE | COMMIT)
    await ClockCycles(dut.clk, 20)
    assert await _read(bus, "STATUS") & COMMITTING
    first = PRESENT[0]
    assert not await bus.write(address(first.name.upper()), 0)
    assert await _read(bus, first.name.upper()) == word_of(first, raw[first.name])
    assert seen == {OF_DESIGN}
    dut.core_busy.value = 0
    await ClockCycles(dut.clk, 4)
    assert dut.retuned.value == 1
    assert await _read(bus, "STATUS") & (RETUNED | STAGED | COMMITTING) == RETUNED
    assert seen == {OF_DESIGN, tuple(raw.values())}
    assert await bus.write(address("CONTROL"), ENABLE | RESTORE | COMMIT)
    await ClockCycles(dut.clk, 4)
    watcher.cancel()
    assert await _read(bus, "STATUS") & (RETUNED | STAGED | COMMITTING) == 0
    assert used(dut) == OF_DESIGN
    assert len(seen) == 2


async def each_setting_alone_is_a_retuning(dut, bus: Bus) -> None:
    for i, s in enumerate(PRESENT):
        bit = (7 * i) % s.width
        assert await bus.write(address(s.name.upper()), word_of(s, OF_DESIGN[i] ^ 1 << bit))
        assert await bus.write(address("CONTROL"), ENABLE | COMMIT)
        await ClockCycles(dut.clk, 4)
        assert dut.retuned.value == 1, s.name
        assert [a != b for a, b in zip(used(dut), OF_DESIGN, strict=True)].index(True) == i
        assert await bus.write(address("CONTROL"), ENABLE | RESTORE | COMMIT)
        await ClockCycles(dut.clk, 4)
        assert dut.retuned.value == 0


async def bytes_are_written_alone(dut, bus: Bus) -> None:
    rng = random.Random(3)
    for s in PRESENT:
        word = await _read(bus, s.name.upper())
        for strobes in range(16):
            data = signed(rng.getrandbits(s.width), s.width) & 0xFFFFFFFF
            assert await bus.write(address(s.name.upper()), data, strobes)
            mask = sum(0xFF << 8 * i for i in range(4) if strobes >> i & 1)
            word = word_of(s, (word & ~mask | data & mask) & 2**s.width - 1)
            assert await _read(bus, s.name.upper()) == word, (s.name, strobes)


async def words_that_do_not_fit_are_refused(dut, bus: Bus) -> None:
    for word, fits in ((0x1FFFF, 1), (0x20000, 0), (0xFFFE0000, 1), (0xFFFDFFFF, 0), (1 << 31, 0)):
        assert await bus.write(address("BLEND"), 5)
        assert await bus.write(address("BLEND"), word) == bool(fits), hex(word)
        assert await _read(bus, "BLEND") == (word if fits else 5)


async def events_are_kept_until_cleared(dut, bus: Bus) -> None:
    everything = 2 ** len(EVENTS) - 1
    for i, event in enumerate(EVENTS):
        getattr(dut, event).value = 1
        await RisingEdge(dut.clk)
        getattr(dut, event).value = 0
        assert await _read(bus, "EVENTS") == 1 << i
        assert dut.interrupt.value == 0
        assert await bus.write(address("INTERRUPTS"), everything & ~(1 << i))
        assert dut.interrupt.value == 0
        assert await bus.write(address("INTERRUPTS"), 1 << i)
        await ClockCycles(dut.clk, 3)
        assert dut.interrupt.value == 1
        assert await bus.write(address("EVENTS"), everything & ~(1 << i))
        assert await bus.write(address("EVENTS"), everything, 0b1110)
        assert await _read(bus, "EVENTS") == 1 << i
        assert await bus.write(address("EVENTS"), 1 << i)
        assert await _read(bus, "EVENTS") == 0
        assert dut.interrupt.value == 0
    assert await bus.write(address("INTERRUPTS"), 0)


async def what_happens_while_cleared_is_kept(dut, bus: Bus) -> None:
    outcomes = []
    for offset in (-1, 0, 1):
        dut.saturated.value = 1
        await RisingEdge(dut.clk)
        dut.saturated.value = 0

        async def pulse(clocks: int) -> None:
            """Make the event come so many clocks after the one of the write."""
            await RisingEdge(dut.write_request)
            if clocks < 0:
                return
            await ClockCycles(dut.clk, clocks)
            dut.saturated.value = 1
            await ClockCycles(dut.clk, 1)
            dut.saturated.value = 0

        pulsing = cocotb.start_soon(pulse(offset))
        assert await bus.write(address("EVENTS"), 4)
        await pulsing
        await ClockCycles(dut.clk, 2)
        outcomes.append(await _read(bus, "EVENTS"))
        assert await bus.write(address("EVENTS"), 127)
    assert outcomes == [0, 4, 4]


async def pulses_last_one_clock(dut, bus: Bus) -> None:
    highs = 0

    async def count() -> None:
        nonlocal highs
        while True:
            await RisingEdge(dut.clk)
            highs += int(dut.clear.value)

    counter = cocotb.start_soon(count())
    assert dut.enable.value == 1
    assert await bus.write(address("CONTROL"), CLEAR)
    await ClockCycles(dut.clk, 5)
    assert (highs, int(dut.enable.value)) == (1, 0)
    assert await _read(bus, "CONTROL") == 0
    assert await bus.write(address("CONTROL"), ENABLE | CLEAR, 0b1110)
    assert await bus.write(address("CONTROL"), ENABLE)
    await ClockCycles(dut.clk, 5)
    assert (highs, int(dut.enable.value)) == (1, 1)
    counter.cancel()


async def a_received_byte_is_taken_once(dut, bus: Bus) -> None:
    sent = [0x00, 0x5A, 0xFF, 0x31]
    waiting = list(sent)

    async def receiver() -> None:
        while True:
            dut.uart_valid.value = int(bool(waiting))
            dut.uart_data.value = waiting[0] if waiting else 0xEE
            await RisingEdge(dut.clk)
            if dut.uart_read.value == 1:
                waiting.pop(0)

    receiving = cocotb.start_soon(receiver())
    await ClockCycles(dut.clk, 2)
    await _read(bus, "STATUS")
    for byte in sent:
        assert await _read(bus, "UART_RX") == 0x100 | byte
    assert await _read(bus, "UART_RX") & 0x100 == 0
    assert not waiting
    receiving.cancel()
    dut.uart_valid.value = 0


async def the_time_is_of_one_moment(dut, bus: Bus) -> None:
    dut.time_us.value = 0x1_FFFF_FFFF
    assert await _read(bus, "TIME_LOW") == 0xFFFFFFFF
    dut.time_us.value = 0x2_0000_0000
    assert await _read(bus, "SAMPLE_NUMBER") == 0
    assert await _read(bus, "TIME_HIGH") == 1
    assert await _read(bus, "TIME_LOW") == 0
    assert await _read(bus, "TIME_HIGH") == 2


async def reset_brings_the_design_back(dut, bus: Bus) -> None:
    await written(bus, random.Random(4))
    assert await bus.write(address("CONTROL"), COMMIT)
    await ClockCycles(dut.clk, 4)
    assert used(dut) != OF_DESIGN
    dut.rst.value = 1
    await ClockCycles(dut.clk, 2)
    dut.rst.value = 0
    await ClockCycles(dut.clk, 2)
    assert used(dut) == OF_DESIGN
    assert (int(dut.enable.value), int(dut.retuned.value)) == (1, 0)
    for register in MAP.registers:
        if register.fields[0].source != "core":
            assert await _read(bus, register.name) == register.reset


CHECKS = {
    check.__name__: check
    for check in (
        every_register_reads,
        what_cannot_be_is_an_error,
        settings_change_together,
        each_setting_alone_is_a_retuning,
        bytes_are_written_alone,
        words_that_do_not_fit_are_refused,
        events_are_kept_until_cleared,
        what_happens_while_cleared_is_kept,
        pulses_last_one_clock,
        a_received_byte_is_taken_once,
        the_time_is_of_one_moment,
        reset_brings_the_design_back,
    )
}
