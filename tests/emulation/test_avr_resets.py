"""Why the ATmega328P starts, and its watchdog, by small programs on its hardware layer."""

from dataclasses import replace
from pathlib import Path

import pytest
from boards import (
    BOOT,
    changed,
    copied,
    expected_counts,
    hear,
    own_main,
    stimulus,
    with_baud,
)

from hostkit.emulation import avr_board
from hostkit.emulation.board import BoardRun

POWER, PIN, BROWN_OUT, WATCHDOG, REQUEST = range(5)
"""As hk_hal.h numbers the causes."""

PROGRAM = """
#include <avr/interrupt.h>
#include <avr/io.h>
#include <util/delay.h>
#include "hk_hal.h"
static uint8_t kept __attribute__((section(".noinit")));
BEFORE
int main(void)
{
    uint8_t cause;
    hk_hal_init();
    cause = (uint8_t)hk_hal_reset_cause();
    WORK
    for (;;) {
        hk_hal_watchdog_feed();
        hk_hal_idle();
    }
}
"""
SAY = "(void)hk_hal_transmit(&cause, 1U);"
HANG = "if (cause == HK_RESET_POWER) { for (;;) { } }"


def build(folder: Path, destination: Path, work: str, before: str = "") -> Path:
    text = PROGRAM.replace("WORK", "kept++; " + work).replace("BEFORE", before)
    avr_board.build(own_main(folder, destination, text))
    return destination


def run(folder: Path, destination: Path, work: str, before: str = "") -> BoardRun:
    return avr_board.run(build(folder, destination, work, before), stimulus(3))


def resets(found: BoardRun) -> int:
    return dict(found.faults).get("resets", 0)


@pytest.mark.parametrize("hang", [HANG, HANG.replace("for", "cli(); for")])
def test_a_firmware_that_hangs_is_reset_by_the_watchdog(
    avr_folder: Path, tmp_path: Path, hang: str
) -> None:
    found = run(avr_folder, tmp_path / "code", SAY + "_delay_ms(1);" + hang)
    assert found.stream == bytes([POWER, WATCHDOG])
    assert resets(found) == 1


def test_a_firmware_that_sleeps_without_interrupts_is_reset(
    avr_folder: Path, tmp_path: Path
) -> None:
    sleep = 'if (cause == HK_RESET_POWER) { cli(); SMCR = 1U; __asm__ volatile("sleep"); }'
    found = run(avr_folder, tmp_path / "code", SAY + "_delay_ms(1);" + sleep)
    assert found.stream == bytes([POWER, WATCHDOG])


def test_the_watchdog_bites_between_one_and_two_seconds(avr_folder: Path, tmp_path: Path) -> None:
    """A byte each 0.1 s, and one at the second start."""
    work = SAY + "while (cause == HK_RESET_POWER) { _delay_ms(100); " + SAY + "}"
    found = run(avr_folder, tmp_path / "code", work)
    assert found.stream[-1] == WATCHDOG
    assert found.stream[:-1] == bytes([POWER]) * (len(found.stream) - 1)
    assert 10 <= len(found.stream[1:-1]) < 20


def test_a_reboot_on_request_is_told_apart_and_sends_what_is_queued(
    avr_folder: Path, tmp_path: Path
) -> None:
    work = "static const uint8_t text[200]; if (cause == HK_RESET_POWER) {"
    work += "(void)hk_hal_transmit(text, 200U);" + SAY + "hk_hal_reboot(); }" + SAY
    folder = build(avr_folder, tmp_path / "code", work)
    with_baud(folder, 57600)  # 35 ms of bytes
    avr_board.build(folder)
    found = avr_board.run(folder, stimulus(3))
    assert found.stream == bytes(200) + bytes([POWER, REQUEST])
    assert resets(found) == 1


def test_a_hang_after_a_reboot_is_the_watchdogs(avr_folder: Path, tmp_path: Path) -> None:
    work = SAY + "_delay_ms(1); if (cause == HK_RESET_POWER) { hk_hal_reboot(); }"
    work += HANG.replace("POWER", "REQUEST")
    found = run(avr_folder, tmp_path / "code", work)
    assert found.stream == bytes([POWER, REQUEST, WATCHDOG])


@pytest.mark.parametrize(
    ("told", "cause"),
    [
        (0x01, POWER),
        (0x02, PIN),
        (0x04, BROWN_OUT),
        (0x05, POWER),
        (0x06, BROWN_OUT),
        (0x08, WATCHDOG),
        (0x0A, PIN),
        (0x00, POWER),
        (0x40, POWER),
    ],
)
def test_a_boot_loader_leaves_the_cause_in_r2(
    avr_folder: Path, tmp_path: Path, told: int, cause: int
) -> None:
    loader = """
    void loader(void) __attribute__((naked, used, section(".init1")));
    void loader(void)
    {
        MCUSR = 0U;
        __asm__ volatile("ldi r16, TOLD\\n\\tmov r2, r16" ::: "r16");
    }
    """.replace("TOLD", str(told))
    found = run(avr_folder, tmp_path / "code", SAY, loader)
    assert found.stream == bytes([cause])


def test_a_flag_that_is_written_is_not_set(avr_folder: Path, tmp_path: Path) -> None:
    write = """
    void flags(void) __attribute__((naked, used, section(".init1")));
    void flags(void)
    {
        MCUSR = 0xFFU;
    }
    """
    found = run(avr_folder, tmp_path / "code", SAY + "_delay_ms(1);" + HANG, write)
    assert found.stream == bytes([POWER, WATCHDOG])


def test_the_watchdog_runs_on_after_its_reset_until_it_is_stopped(
    avr_folder: Path, tmp_path: Path
) -> None:
    folder = build(avr_folder, tmp_path / "code", SAY + "_delay_ms(1);" + HANG)
    changed(folder / "hk_reset_atmega328p.c", "    MCUSR = 0U;\n    wdt_disable();\n", "")
    changed(folder / "main.c", "    hk_hal_init();", "    _delay_ms(30);\n    hk_hal_init();")
    avr_board.build(folder)
    found = avr_board.run(folder, stimulus(3))
    assert found.stream == bytes([POWER])
    assert resets(found) > 20


SENSOR = """
    uint8_t seen[3] = {cause, kept, 0U};
    static const uint8_t divider[2] = {0x19U, 7U};
    static const uint8_t awake[2] = {0x6BU, 1U};
    _delay_ms(50);
    (void)hk_hal_i2c_read(0x68U, 0x19U, &seen[2], 1U);
    (void)hk_hal_transmit(seen, 3U);
    (void)hk_hal_i2c_write(0x68U, awake, 2U);
    (void)hk_hal_i2c_write(0x68U, divider, 2U);
    _delay_ms(1);
"""


@pytest.mark.parametrize("cut", [False, True])
def test_memory_and_sensor_outlive_the_watchdog_but_not_the_supply(
    avr_folder: Path, tmp_path: Path, cut: bool
) -> None:
    """A power cut within the first byte of the store, or a hang."""
    fail = "hk_hal_store_read(0U, 0U, &cause, 1U); if (cause == 0xFFU) {"
    fail += "hk_hal_store_erase(0U); hk_hal_store_put(1U);"
    fail += "_delay_ms(10);" if cut else "for (;;) { }"
    folder = build(avr_folder, tmp_path / "code", SENSOR + fail + "}")
    found = avr_board.run(folder, replace(stimulus(3), power_cut_after=0 if cut else None))
    first, second = found.stream[:3], found.stream[3:]
    assert resets(found) == 1
    assert (first[0], first[2]) == (POWER, 0)
    if cut:
        assert (second[0], second[2]) == (POWER, 0)
        assert second[1] != (first[1] + 1) % 256
    else:
        assert tuple(second) == (WATCHDOG, (first[1] + 1) % 256, 7)


def test_the_application_goes_on_after_a_hang(avr_folder: Path, tmp_path: Path) -> None:
    folder = copied(avr_folder, tmp_path / "code")
    changed(
        folder / "main.c",
        "    for (;;) {\n",
        "    for (;;) {\n"
        "        while (hk_hal_reset_cause() == HK_RESET_POWER && hk_hal_time_us() > 1000000UL) {\n"
        "        }\n",
    )
    avr_board.build(folder)
    feels = stimulus(400)
    found = avr_board.run(folder, feels)
    heard = hear(found)
    assert resets(found) == 1
    assert heard.states.count(BOOT) == 2
    sequences = [s.sequence for s in heard.samples]
    again = sequences.index(0, 1)
    assert sequences == [*range(again), *range(len(sequences) - again)]
    assert len(sequences) - again > 50
    counts = expected_counts(feels)
    rows = {tuple(row): i for i, row in enumerate(counts.gyro.tolist())}
    played = [rows[tuple(s.gyro)] for s in heard.samples]
    assert played[:again] == list(range(again))
    assert played[again:] == list(range(played[again], len(feels)))
