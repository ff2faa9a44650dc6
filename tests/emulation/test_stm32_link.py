"""What the link of the STM32F103 receives."""

import re
from pathlib import Path

import pytest
from boards import Collector, assert_every_row_once, changed, hear, stimulus
from stm32_machine import code, machine_of, program

from hostkit.emulation import stm32_board
from hostkit.emulation.board import LinkInput
from hostkit.errors import BuildError, EmulationError

__all__ = ["code"]

LINK, HAL = "hk_link_stm32f103.c", "hk_hal_stm32f103.c"

ECHO = """
#include "hk_board_stm32f103.h"
#include "hk_hal.h"
int main(void)
{
    uint8_t byte;
    uint32_t held, since;
    hk_hal_init();
    BEFORE
    for (;;) {
        hk_hal_watchdog_feed();
        while (hk_hal_transmit_room() > 0U && hk_hal_receive(&byte)) {
            (void)hk_hal_transmit(&byte, 1U);
        }
        hk_hal_idle();
    }
}
"""
HELD_20_MS = """
    since = hk_hal_time_us();
    held = hk_board_hold();
    while (hk_hal_time_us() - since < 20000U) {
    }
    hk_board_release(held);
"""
WAITS_20_MS = HELD_20_MS.replace("hk_board_hold()", "0U").replace("hk_board_release", "(void)")
UNUSED = "held = since = 0U; (void)held; (void)since;"
ALL = bytes(range(256))


def echoed(code: Path, work: Path, before: str, *pieces: LinkInput) -> bytes:
    program(code, ECHO.replace("BEFORE", before))
    machine = machine_of(code, work, received=pieces)
    machine.run(0.1)
    return bytes(machine.link)


def test_what_comes_is_received_in_order(code: Path, tmp_path: Path) -> None:
    pieces = [LinkInput(time_s=0.01 + 0.02 * k, data=ALL) for k in range(3)]
    assert echoed(code, tmp_path, UNUSED, *pieces) == 3 * ALL


def test_the_ring_holds_255_bytes_and_what_comes_then_is_lost(code: Path, tmp_path: Path) -> None:
    pieces = (LinkInput(time_s=0.005, data=ALL), LinkInput(time_s=0.03, data=b"more"))
    assert echoed(code, tmp_path, WAITS_20_MS, *pieces) == ALL[:255] + b"more"


def test_an_overrun_loses_bytes_and_nothing_else(code: Path, tmp_path: Path) -> None:
    pieces = (LinkInput(time_s=0.01, data=b"12345"), LinkInput(time_s=0.03, data=b"abc"))
    assert echoed(code, tmp_path, HELD_20_MS, *pieces) == b"1abc"


def test_an_overrun_that_is_not_cleared_starves_the_program(code: Path, tmp_path: Path) -> None:
    """The flag asks for the interrupt as long as it stands, and the watchdog ends that."""
    changed(
        code / LINK, "(uint8_t)USART1_DR;", "(uint8_t)(status & USART_SR_ORE ? 0U : USART1_DR);"
    )
    pieces = (LinkInput(time_s=0.01, data=b"12345"), LinkInput(time_s=0.03, data=b"abc"))
    assert echoed(code, tmp_path, HELD_20_MS, *pieces) == b""


@pytest.mark.parametrize(
    ("file", "old", "new"),
    [
        (LINK, " | USART_CR1_RE |", " |"),
        (LINK, " | USART_CR1_RXNEIE)", ")"),
        (HAL, "set_field(&GPIOA_CRH, HK_RX_PIN, GPIO_PULLED_INPUT)",
         "set_field(&GPIOA_CRH, HK_RX_PIN, GPIO_PERIPHERAL_PUSH_PULL)"),
    ],
)  # fmt: skip
def test_a_receiver_that_is_not_set_up_hears_nothing(
    code: Path, tmp_path: Path, file: str, old: str, new: str
) -> None:
    changed(code / file, old, new)
    assert echoed(code, tmp_path, UNUSED, LinkInput(time_s=0.02, data=b"abc")) == b""


def test_a_wrong_rate_is_named(code: Path, tmp_path: Path) -> None:
    changed(code / LINK, "USART1_BRR = HK_BRR", "USART1_BRR = HK_BRR - 8U")
    with pytest.raises(EmulationError, match=r"runs at 529412 bit/s, its receiver at 500000"):
        echoed(code, tmp_path, UNUSED, LinkInput(time_s=0.02, data=b"abc"))


def test_a_run_plays_what_the_link_receives(code: Path) -> None:
    program(code, ECHO.replace("BEFORE", UNUSED))
    feels = stimulus(3)
    slots = {name: getattr(feels, name) for name in type(feels).__slots__}
    slots["received"] = (LinkInput(time_s=0.5, data=b"hello"), LinkInput(time_s=0.6, data=b"!"))
    assert stm32_board.run(code, type(feels)(**slots)).stream == b"hello!"


def test_serve_receives_while_it_runs(code: Path) -> None:
    program(code, ECHO.replace("BEFORE", UNUSED))
    collector = Collector(lambda data: data == b"ping pong")
    words = iter([*[b""] * 20, b"ping", b"", b" pong"])
    stm32_board.serve(code, stimulus(3), collector.send, collector.stop, lambda: next(words, b""))
    assert collector.data == b"ping pong"


def test_the_rate_of_the_link_is_that_of_the_code(code: Path) -> None:
    header = code / "hk_design.h"
    text = header.read_text(encoding="ascii")
    slower = re.sub(r"(#define HK_LINK_BAUD +)500000", r"\g<1>115200", text)
    assert slower != text
    header.write_text(slower, "ascii")
    stm32_board.build(code)
    feels = stimulus(20)
    assert_every_row_once(hear(stm32_board.run(code, feels)), feels)
    header.write_text(text.replace("#define HK_LINK_BAUD", "#define HK_OTHER"), "ascii")
    with pytest.raises(BuildError, match="has no HK_LINK_BAUD"):
        stm32_board.run(code, feels)
