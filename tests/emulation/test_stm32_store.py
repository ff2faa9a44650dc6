"""The non-volatile store of the STM32F103, its flash controller, and a supply that fails."""

from pathlib import Path

import pytest
from boards import changed, stimulus
from stm32_machine import code, machine_of, program

from hostkit.emulation import stm32_board
from hostkit.errors import BuildError, EmulationError

__all__ = ["code"]

STORE = "hk_store_stm32f103.c"
PAGE = 1024
WRITTEN = bytes(range(1, 8))  # seven bytes: the last stands alone

# Replaces slot 1 at its first start, says how long that took, then what the slots hold.
WRITER = """
#include "hk_board_stm32f103.h"
#include "hk_hal.h"
static uint8_t said[32];
static void replace(uint8_t slot)
{
    uint8_t i;
    hk_hal_store_erase(slot);
    while (hk_hal_store_busy()) {
    }
    for (i = 1U; i <= 7U; i++) {
        hk_hal_store_put(i);
        while (hk_hal_store_busy()) {
        }
    }
    hk_hal_store_finish();
}
int main(void)
{
    uint32_t since, took;
    hk_hal_init();
    said[0] = (uint8_t)hk_hal_reset_cause();
    since = hk_hal_time_us();
    hk_hal_store_read(1U, 0U, &said[1], 1U);
    if (said[1] == 0xFFU) {
        replace(1U);
    }
    took = hk_hal_time_us() - since;
    said[1] = (uint8_t)(took >> 8);
    hk_hal_store_read(0U, 2U, &said[2], 2U);
    hk_hal_store_read(1U, 0U, &said[4], 9U);
    hk_hal_transmit(said, 13U);
    for (;;) {
        hk_hal_watchdog_feed();
        hk_hal_idle();
    }
}
"""


@pytest.fixture
def writer(code: Path) -> Path:
    program(code, WRITER)
    return code


def test_a_slot_is_replaced_and_the_other_stays(writer: Path, tmp_path: Path) -> None:
    machine = machine_of(writer, tmp_path, store=b"\x11\x22\x33\x44")
    machine.run(0.2)
    said = bytes(machine.link)
    assert said[2:] == b"\x33\x44" + WRITTEN + b"\xff\xff"
    assert 40_000 <= said[1] << 8 <= 41_000  # the clock has counted while the core stood still
    blank = b"\xff" * PAGE
    assert bytes(machine.store.data) == b"\x11\x22\x33\x44" + blank[4:] + WRITTEN + blank[7:]


def test_what_was_stored_is_there_at_the_next_run(writer: Path) -> None:
    feels = stimulus(3)
    first = stm32_board.run(writer, feels)
    assert first.store[PAGE : PAGE + 7] == WRITTEN
    again = stm32_board.run(writer, type(feels)(**fields(feels) | {"store": first.store}))
    assert again.store == first.store
    assert (again.stream[4:11], again.stream[1] << 8 < 300) == (WRITTEN, True)


def fields(feels) -> dict:
    return {name: getattr(feels, name) for name in type(feels).__slots__}


@pytest.mark.parametrize("cut_after", range(8))
def test_a_supply_that_fails_spoils_two_bytes_and_nothing_else(
    writer: Path, tmp_path: Path, cut_after: int
) -> None:
    machine = machine_of(writer, tmp_path, store=b"\x11\x22\x33\x44", power_cut_after=cut_after)
    machine.run(0.3)
    spoilt = cut_after // 2 * 2
    found, wanted = machine.store.data[PAGE:], WRITTEN + b"\xff"
    assert machine.store.data[:4] == b"\x11\x22\x33\x44"
    assert machine.resets == 1
    assert machine.link[0] == 0  # HK_RESET_POWER
    if cut_after < 2:  # the first byte is not 0xFF any more, so the second start leaves it
        assert machine.link[1] < 2
    assert found[:spoilt] == wanted[:spoilt]
    assert found[spoilt : spoilt + 2] != wanted[spoilt : spoilt + 2]
    assert set(found[spoilt + 2 :]) == {0xFF}


# Says how the sensor's power management stands; wakes it and loses its supply, the first time.
WAKER = """
#include "hk_hal.h"
static void say_power(void)
{
    uint8_t power = 0xEEU;
    (void)hk_hal_i2c_read(0x68U, 0x6BU, &power, 1U);
    hk_hal_transmit(&power, 1U);
}
int main(void)
{
    static const uint8_t awake[2] = {0x6BU, 0x01U};
    uint8_t first;
    hk_hal_init();
    while (hk_hal_time_us() < 30000U) {
    }
    say_power();
    hk_hal_store_read(1U, 0U, &first, 1U);
    if (first == 0xFFU) {
        (void)hk_hal_i2c_write(0x68U, awake, sizeof awake);
        say_power();
        while (hk_hal_time_us() < 40000U) {
        }
        hk_hal_store_erase(1U);
        hk_hal_store_put(0U);
        hk_hal_store_put(0U);
    }
    for (;;) {
        hk_hal_watchdog_feed();
        hk_hal_idle();
    }
}
"""


def test_a_supply_that_fails_takes_the_sensor_with_it(code: Path, tmp_path: Path) -> None:
    program(code, WAKER)
    machine = machine_of(code, tmp_path, power_cut_after=0)
    machine.run(0.2)
    assert machine.resets == 1
    assert bytes(machine.link) == b"\x40\x01\x40"
    without = machine_of(code, tmp_path)
    without.run(0.2)
    assert (without.resets, bytes(without.link)) == (0, b"\x40\x01")


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("FLASH_KEYR = FLASH_KEY1;", "FLASH_KEYR = 1U;", "wrong key"),
        ("    FLASH_KEYR = FLASH_KEY1;\n", "", "wrong key"),
        ("if ((FLASH_CR & FLASH_CR_LOCK) != 0U) {", "for (;;) {", "wrong key"),
        ("    unlock();\n", "", "2 bytes are written to flash with FLASH_CR = 0x80"),
        ("    FLASH_CR = FLASH_CR_PG;\n", "", "2 bytes are written to flash with FLASH_CR = 0x2"),
        ("*(volatile uint16_t *)", "*(volatile uint8_t *)", "1 bytes are written to flash"),
        ("*(volatile uint16_t *)", "*(volatile uint32_t *)", "4 bytes are written to flash"),
        ("    FLASH_AR = writer.place;\n", "    FLASH_AR = 0x08000000U;\n", "its own code"),
        ("    FLASH_CR = FLASH_CR_PER;\n", "    FLASH_CR = FLASH_CR_PG | FLASH_CR_STRT;\n",
         "without PER"),
        ("    unlock();\n", "    unlock(); HK_MMIO(0x40021000) &= ~1U;\n", "oscillator is off"),
        ("FLASH_CR = FLASH_CR_PER | FLASH_CR_STRT;",
         "FLASH_CR = FLASH_CR_PER | FLASH_CR_STRT; FLASH_CR = FLASH_CR_PG;", "flash is busy"),
    ],
)  # fmt: skip
def test_what_the_flash_does_not_allow_is_named(
    writer: Path, tmp_path: Path, old: str, new: str, message: str
) -> None:
    changed(writer / STORE, old, new)
    program(writer, WRITER)
    machine = machine_of(writer, tmp_path)
    with pytest.raises(EmulationError, match=message):
        machine.run(0.3)


def test_what_is_not_erased_is_not_programmed(writer: Path, tmp_path: Path) -> None:
    changed(writer / STORE, "    FLASH_CR = FLASH_CR_PER | FLASH_CR_STRT;\n", "")
    program(writer, WRITER)
    before = b"\xff\x01\x02\x03\xff"
    machine = machine_of(writer, tmp_path, store=b"\xff" * PAGE + before)
    machine.run(0.3)
    # two of the half-words are blank
    assert bytes(machine.store.data[PAGE : PAGE + 8]) == b"\xff\x01\x02\x03\x05\x06\x07\xff"


def test_a_wrong_key_locks_the_flash_until_a_reset(writer: Path, tmp_path: Path) -> None:
    """The handler of faults restarts the board; then the flash takes its keys again."""
    from hostkit.emulation.stm32.flash import Flash, Store
    from hostkit.emulation.stm32.timeline import BusError

    machine = machine_of(writer, tmp_path)
    flash = Flash(machine.time, machine._own.clocks, Store(b"", None), lambda: None)
    with pytest.raises(BusError):
        flash.write(0x04, 0xCDEF89AB)
    for key in (0x45670123, 0xCDEF89AB):
        with pytest.raises(BusError):
            flash.write(0x04, key)
    assert flash.read(0x10) == 0x80
    changed(writer / STORE, "FLASH_KEYR = FLASH_KEY1;",
            "FLASH_KEYR = hk_hal_reset_cause() == HK_RESET_POWER ? 1U : FLASH_KEY1;")  # fmt: skip
    program(writer, WRITER)
    machine = machine_of(writer, tmp_path, handles_faults=True)
    machine.run(0.3)
    assert machine.resets == 1
    assert bytes(machine.link)[4:11] == WRITTEN


def test_an_image_that_reaches_the_store_is_refused(code: Path) -> None:
    own_bytes = stm32_board.build(code).flash_bytes or 0
    text = (code / "main.c").read_text(encoding="ascii")
    use = '    static hk_app_t app;\n    __asm__ volatile("" : : "r"(hk_big));\n'
    text = text.replace("    static hk_app_t app;\n", use)

    def build_with(total_bytes: int) -> None:
        big = f"static const unsigned char hk_big[{total_bytes - own_bytes}] = {{1}};\n"
        program(code, text.replace("int main", big + "int main"))

    build_with(61 * 1024)
    with pytest.raises(BuildError, match=r"FLASH.* overflowed|will not fit in region .FLASH"):
        build_with(63 * 1024)
