"""The store of the ATmega328P on its EEPROM, by small programs on its hardware layer."""

import struct
from dataclasses import replace
from pathlib import Path

import pytest
from boards import own_main, stimulus

from hostkit.emulation import avr_board
from hostkit.emulation.board import BoardRun
from hostkit.errors import EmulationError

SLOT_BYTES = 128
EEPROM_BYTES = 1024
PATTERN = bytes((7 * i + 1) % 256 for i in range(SLOT_BYTES))
ERASED = b"\xff"

PROGRAM = """
#include <avr/io.h>
#include <util/delay.h>
#include "hk_hal.h"
static uint8_t bytes[HK_STORE_SLOT_BYTES];
static void wait(void)
{
    while (hk_hal_store_busy()) {
        hk_hal_watchdog_feed();
    }
}
static void replace(uint8_t slot, uint8_t count)
{
    uint8_t i;
    hk_hal_store_erase(slot);
    for (i = 0U; i < count; i++) {
        wait();
        hk_hal_store_put((uint8_t)(7U * i + 1U));
    }
    wait();
    hk_hal_store_finish();
}
static void show(uint8_t slot)
{
    hk_hal_store_read(slot, 0U, bytes, HK_STORE_SLOT_BYTES);
    (void)hk_hal_transmit(bytes, HK_STORE_SLOT_BYTES);
}
int main(void)
{
    hk_hal_init();
    WORK;
    for (;;) {
        hk_hal_watchdog_feed();
        hk_hal_idle();
    }
}
"""
UNLESS_BEGUN = """
    show(1U);
    _delay_ms(5);
    if (bytes[0] == 0xFFU) {
        replace(1U, 128U);
    }
    replace(0U, 0U)"""


def run(folder: Path, destination: Path, work: str, **store: bytes | int) -> BoardRun:
    uses = "" if all(f"{name}(" in work for name in ("replace", "show")) else UNUSED
    avr_board.build(own_main(folder, destination, PROGRAM.replace("WORK", work + uses)))
    return avr_board.run(destination, replace(stimulus(3), **store))


UNUSED = "; if (false) { replace(0U, 0U); show(0U); }"


@pytest.mark.parametrize("slot", [0, 1])
def test_a_slot_is_replaced_and_read_back(avr_folder: Path, tmp_path: Path, slot: int) -> None:
    found = run(avr_folder, tmp_path / "code", f"replace({slot}U, 128U); show({slot}U)")
    assert found.stream == PATTERN
    other = ERASED * SLOT_BYTES
    slots = (PATTERN + other) if slot == 0 else (other + PATTERN)
    assert found.store == slots + ERASED * (EEPROM_BYTES - len(slots))


@pytest.mark.parametrize("slot", [0, 1])
def test_what_was_there_before_is_read(avr_folder: Path, tmp_path: Path, slot: int) -> None:
    before = bytes(range(1, 201))
    found = run(avr_folder, tmp_path / "code", f"show({slot}U)", store=before)
    assert found.store == before + ERASED * (EEPROM_BYTES - len(before))
    assert found.stream == found.store[slot * SLOT_BYTES : (slot + 1) * SLOT_BYTES]


def test_bytes_behind_a_slot_go_nowhere(avr_folder: Path, tmp_path: Path) -> None:
    assert run(avr_folder, tmp_path / "code", "replace(0U, 130U)").store[SLOT_BYTES:] == (
        ERASED * (EEPROM_BYTES - SLOT_BYTES)
    )


def test_putting_a_byte_takes_no_time_and_the_store_is_busy_meanwhile(
    avr_folder: Path, tmp_path: Path
) -> None:
    """The first byte changes, the second does not."""
    work = """
    uint32_t times_us[4];
    hk_hal_store_erase(0U);
    times_us[0] = hk_hal_time_us();
    hk_hal_store_put(1U);
    times_us[1] = hk_hal_time_us();
    wait();
    times_us[2] = hk_hal_time_us();
    hk_hal_store_put(0xFFU);
    wait();
    times_us[3] = hk_hal_time_us();
    (void)hk_hal_transmit((const uint8_t *)times_us, sizeof times_us)"""
    found = run(avr_folder, tmp_path / "code", work)
    begun, put, written, skipped = struct.unpack("<4I", found.stream)
    assert put - begun < 20
    assert 3000 < written - put < 4000
    assert skipped - written < 40


def test_reading_waits_for_the_byte_that_is_written(avr_folder: Path, tmp_path: Path) -> None:
    work = "hk_hal_store_erase(0U); hk_hal_store_put(1U); show(0U)"
    found = run(avr_folder, tmp_path / "code", work)
    assert found.stream == b"\x01" + ERASED * (SLOT_BYTES - 1)


@pytest.mark.parametrize(("before", "resets"), [(PATTERN, 0), (PATTERN[:-1] + b"\0", 1)])
def test_only_bytes_that_change_are_written(
    avr_folder: Path, tmp_path: Path, before: bytes, resets: int
) -> None:
    """The supply fails within the first byte that is written."""
    found = run(avr_folder, tmp_path / "code", "replace(0U, 128U)", store=before, power_cut_after=0)
    assert dict(found.faults).get("resets", 0) == resets
    assert found.store[:SLOT_BYTES] == PATTERN


@pytest.mark.parametrize("after", [0, 1, 57, 127])
def test_a_power_cut_spoils_one_byte_and_no_other(
    avr_folder: Path, tmp_path: Path, after: int
) -> None:
    kept = bytes(range(100, 100 + SLOT_BYTES))
    found = run(avr_folder, tmp_path / "code", UNLESS_BEGUN, store=kept, power_cut_after=after)
    assert dict(found.faults)["resets"] == 1
    slots = found.store[:SLOT_BYTES], found.store[SLOT_BYTES : 2 * SLOT_BYTES]
    assert slots[0] == kept
    assert slots[1][:after] == PATTERN[:after]
    assert slots[1][after] != PATTERN[after]
    assert slots[1][after + 1 :] == ERASED * (SLOT_BYTES - after - 1)
    assert found.stream == ERASED * SLOT_BYTES + slots[1], "seen before and after the cut"


def test_no_byte_is_written_without_the_timed_sequence(avr_folder: Path, tmp_path: Path) -> None:
    """Else the emulator would take what the part does not."""
    slow = """
    EEARH = 0U;
    EEARL = 0U;
    EEDR = 0x12U;
    EECR |= _BV(EEMPE);
    _delay_us(1);
    EECR |= _BV(EEPE);
    show(0U)"""
    assert run(avr_folder, tmp_path / "code", slow).stream == ERASED * SLOT_BYTES


def test_reading_while_a_byte_is_written_is_noticed(avr_folder: Path, tmp_path: Path) -> None:
    hasty = "hk_hal_store_erase(0U); hk_hal_store_put(1U); EECR |= _BV(EERE)"
    with pytest.raises(EmulationError, match="reads the EEPROM while a byte is being written"):
        run(avr_folder, tmp_path / "code", hasty)
