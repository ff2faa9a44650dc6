"""Watchdog, reset cause, reboot and fault handler of the STM32F103."""

from pathlib import Path

import pytest
from boards import changed, stimulus
from stm32_machine import code, machine_of, program

from hostkit.emulation import stm32_board
from hostkit.errors import EmulationError

__all__ = ["code"]

RESET, HAL = "hk_reset_stm32f103.c", "hk_hal_stm32f103.c"
POWER, PIN, WATCHDOG, REQUEST = 0, 1, 3, 4

# Says why it started and how often it did, then goes on as told.
STARTS = """
#include "hk_board_stm32f103.h"
#include "hk_hal.h"
#include "hk_stm32f103.h"
__attribute__((section(".noinit"))) static volatile uint32_t starts;
int main(void)
{
    static volatile uint8_t zeroed;
    uint8_t said[3];
    hk_hal_init();
    starts = hk_hal_reset_cause() == HK_RESET_POWER ? 0U : starts + 1U;
    said[0] = (uint8_t)hk_hal_reset_cause();
    said[1] = (uint8_t)starts;
    said[2] = zeroed++;
    hk_hal_transmit(said, sizeof said);
    for (;;) {
        hk_hal_idle();
        THEN
    }
}
"""
FEED = "hk_hal_watchdog_feed();"
ONCE = "if (starts == 0U) { %s } hk_hal_watchdog_feed();"


def started(code: Path, then: str) -> None:
    program(code, STARTS.replace("THEN", then))


def expires_after_s(code: Path, work: Path, lsi_hz: int) -> float:
    """Return when a program that feeds the watchdog only once, at its start, is reset."""
    machine = machine_of(code, work, lsi_hz=lsi_hz)
    while machine.resets == 0 and machine.time.now_s < 5.0:
        machine.run(0.005)
    machine.run(0.01)
    assert bytes(machine.link) == bytes([POWER, 0, 0, WATCHDOG, 1, 0])
    return machine.time.now_s - 0.01


FED_ONCE = "static uint8_t turns; if (turns < 20U) { turns++; hk_hal_watchdog_feed(); }"


def test_the_watchdog_takes_one_to_two_seconds_with_every_oscillator(
    code: Path, tmp_path: Path
) -> None:
    started(code, FED_ONCE)
    fed_s = 0.085  # twenty times 4.1 ms
    times_s = [expires_after_s(code, tmp_path, hz) - fed_s for hz in (30_000, 40_000, 60_000)]
    assert times_s == pytest.approx([2.0, 1.5, 1.0], abs=0.02)


def test_who_feeds_the_watchdog_is_not_reset(code: Path, tmp_path: Path) -> None:
    started(code, FEED)
    machine = machine_of(code, tmp_path, lsi_hz=60_000)
    machine.run(5.0)
    assert machine.resets == 0
    assert bytes(machine.link) == bytes([POWER, 0, 0])


@pytest.mark.parametrize(
    ("then", "cause"),
    [
        ("hk_hal_reboot();", REQUEST),
        ("hk_board_restart();", WATCHDOG),  # as the handler of faults does
        ("NVIC_ISER0 = HK_BIT(30); *(volatile uint32_t *)0x60000000 = 1U;", WATCHDOG),
        ('__asm__ volatile("udf #0");', WATCHDOG),
        ("((void (*)(void))0x20000001)();", WATCHDOG),
    ],
)
def test_a_restart_keeps_the_memory_and_says_why(
    code: Path, tmp_path: Path, then: str, cause: int
) -> None:
    started(code, ONCE % then)
    machine = machine_of(code, tmp_path, handles_faults=True)
    machine.run(0.1)
    assert machine.resets == 1
    assert bytes(machine.link) == bytes([POWER, 0, 0, cause, 1, 0])


def test_what_is_queued_leaves_before_a_reboot(code: Path, tmp_path: Path) -> None:
    started(code, ONCE % "static uint8_t many[200]; hk_hal_transmit(many, 200U); hk_hal_reboot();")
    machine = machine_of(code, tmp_path)
    machine.run(0.1)
    assert machine.resets == 1
    assert bytes(machine.link) == bytes([POWER, 0, 0, *[0] * 200, REQUEST, 1, 0])


def test_a_link_that_does_not_move_does_not_hold_a_reboot_for_long(
    code: Path, tmp_path: Path
) -> None:
    begins = "USART1_CR1 = 0U; hk_hal_reboot();"
    started(code, ONCE % f"static uint8_t many[200]; hk_hal_transmit(many, 200U); {begins}")
    changed(code / "hk_link_stm32f103.c", "== sent.tail && (USART1_SR & USART_SR_TC) != 0U",
            "== sent.tail && (USART1_SR & USART_SR_TC) == 0U")  # fmt: skip
    stm32_board.build(code)
    machine = machine_of(code, tmp_path)
    while machine.resets == 0 and machine.time.now_s < 0.5:
        machine.run(0.001)
    assert 0.06 <= machine.time.now_s <= 0.08


@pytest.mark.parametrize("removed", [True, False])
def test_a_cause_is_told_once(code: Path, tmp_path: Path, removed: bool) -> None:
    """A flag that nobody removes would still tell of the watchdog after a reboot."""
    started(code, "if (starts == 1U) { hk_hal_reboot(); } if (starts > 0U) " + FEED)
    if not removed:
        changed(code / RESET, "    RCC_CSR |= RCC_CSR_RMVF;\n", "")
        stm32_board.build(code)
    machine = machine_of(code, tmp_path, lsi_hz=60_000)
    machine.run(1.5)
    causes = list(bytes(machine.link)[::3])
    assert causes == [POWER, WATCHDOG, REQUEST if removed else WATCHDOG]


def test_a_fault_ends_a_run_and_is_named(code: Path, tmp_path: Path) -> None:
    started(code, '__asm__ volatile("udf #0");')
    machine = machine_of(code, tmp_path)
    with pytest.raises(EmulationError, match=r"faults at 0x0800"):
        machine.run(0.1)


def test_resets_are_counted_in_a_run(code: Path) -> None:
    changed(code / RESET, "    IWDG_KR = IWDG_KR_RELOAD;\n", "")
    stm32_board.build(code)
    run = stm32_board.run(code, stimulus(400))
    assert dict(run.faults)["resets"] >= 1


def test_a_program_that_sleeps_for_ever_is_named(code: Path, tmp_path: Path) -> None:
    program(code, 'int main(void) { for (;;) { __asm__ volatile("wfi"); } }')
    machine = machine_of(code, tmp_path)
    with pytest.raises(EmulationError, match="sleeps for ever"):
        machine.run(0.1)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("    IWDG_KR = IWDG_KR_UNLOCK;\n", "", "before it is unlocked"),
        ("    IWDG_KR = IWDG_KR_START;\n", "", "before its oscillator runs"),
    ],
)
def test_a_watchdog_that_is_set_up_wrongly_is_named(
    code: Path, tmp_path: Path, old: str, new: str, message: str
) -> None:
    changed(code / RESET, old, new)
    stm32_board.build(code)
    machine = machine_of(code, tmp_path)
    with pytest.raises(EmulationError, match=message):
        machine.run(0.1)


def test_a_crystal_that_does_not_start_is_tried_again(stm32_folder: Path, tmp_path: Path) -> None:
    machine = machine_of(stm32_folder, tmp_path, crystal_starts=False, lsi_hz=60_000)
    while machine.resets < 1 and machine.time.now_s < 3.0:
        machine.run(0.01)
    assert 1.0 <= machine.time.now_s <= 1.02
    assert bytes(machine.link) == b""
