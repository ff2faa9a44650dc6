"""The receiver of the ATmega328P, by small programs on its hardware layer."""

import struct
from dataclasses import replace
from pathlib import Path

import pytest
from boards import Collector, own_main, stimulus, with_baud

from hostkit.emulation import avr_board
from hostkit.emulation.board import BoardRun, LinkInput

BYTE_US = 20
"""At 500000 baud."""
RING_BYTES = 127
PART_BYTES = 3
"""The part keeps two bytes and a third in its shift register."""

PROGRAM = """
#include <avr/interrupt.h>
#include "hk_hal.h"
static void wait_until(uint32_t time_us)
{
    while (hk_hal_time_us() < time_us) {
        hk_hal_watchdog_feed();
    }
}
int main(void)
{
    uint8_t byte;
    hk_hal_init();
    BEGIN;
    for (;;) {
        hk_hal_watchdog_feed();
        while (hk_hal_receive(&byte)) {
            EACH;
        }
        hk_hal_idle();
    }
}
"""
ECHO = "(void)hk_hal_transmit(&byte, 1U)"


def program(folder: Path, destination: Path, *, begin: str = "", each: str = ECHO) -> Path:
    used = "wait_until(0U)" if "wait_until" not in begin else ""
    text = PROGRAM.replace("BEGIN", f"{begin}; {used}").replace("EACH", each)
    avr_board.build(own_main(folder, destination, text))
    return destination


def heard(folder: Path, *pieces: tuple[float, bytes]) -> BoardRun:
    received = tuple(LinkInput(time_s=time_s, data=data) for time_s, data in pieces)
    return avr_board.run(folder, replace(stimulus(3), received=received))


def test_every_byte_is_echoed_in_order(avr_folder: Path, tmp_path: Path) -> None:
    folder = program(avr_folder, tmp_path / "code")
    data = bytes(range(256)) * 2
    assert heard(folder, (0.1, data), (0.3, b"later")).stream == data + b"later"


def test_bytes_come_at_their_time_and_at_the_baud_rate(avr_folder: Path, tmp_path: Path) -> None:
    stamp = """
    if (byte == 0xFFU) {
        const uint32_t now_us = hk_hal_time_us();
        (void)hk_hal_transmit((const uint8_t *)&now_us, 4U);
    }"""
    folder = program(avr_folder, tmp_path / "code", each=stamp)
    run = heard(folder, (0.25, b"\xff" + bytes(98) + b"\xff"), (0.75, b"\xff"))
    first, last, later = struct.unpack("<3I", run.stream)
    assert 250_000 - 200 < first < 250_000, "its clock starts within 0.2 ms"
    assert abs(last - first - 99 * BYTE_US) <= 10
    assert abs(later - first - 500_000) <= 10


def test_what_does_not_fit_the_ring_is_lost(avr_folder: Path, tmp_path: Path) -> None:
    folder = program(avr_folder, tmp_path / "code", begin="wait_until(500000U)")
    data = bytes(range(200))
    assert heard(folder, (0.1, data), (0.7, b"on")).stream == data[:RING_BYTES] + b"on"


def test_the_part_keeps_three_bytes_while_nobody_takes_them(
    avr_folder: Path, tmp_path: Path
) -> None:
    late = "cli(); wait_until(20000U); sei()"
    folder = program(avr_folder, tmp_path / "code", begin=late)
    assert heard(folder, (0.01, b"abcdef"), (0.3, b"on")).stream == b"abcdef"[:PART_BYTES] + b"on"


def test_sending_leaves_a_byte_alone_that_waits_to_be_taken(
    avr_folder: Path, tmp_path: Path
) -> None:
    late = "byte = 33U; cli(); wait_until(20000U);" + ECHO + "; sei()"
    folder = program(avr_folder, tmp_path / "code", begin=late)
    assert sorted(heard(folder, (0.01, b"a")).stream) == sorted(b"!a")


def test_bytes_before_the_receiver_is_on_are_lost(avr_folder: Path, tmp_path: Path) -> None:
    folder = program(avr_folder, tmp_path / "code", begin="(void)0")
    text = (folder / "main.c").read_text(encoding="ascii")
    late = text.replace("    hk_hal_init();", "    _delay_ms(20);\n    hk_hal_init();")
    (folder / "main.c").write_text("#include <util/delay.h>\n" + late, encoding="ascii")
    avr_board.build(folder)
    assert heard(folder, (0.01, b"abc"), (0.3, b"on")).stream == b"on"


def test_room_is_what_fits(avr_folder: Path, tmp_path: Path) -> None:
    tell = """
    uint8_t room[4];
    static const uint8_t zeros[255];
    cli();
    room[0] = hk_hal_transmit_room();
    room[1] = hk_hal_transmit(zeros, 10U) ? hk_hal_transmit_room() : 0U;
    room[2] = hk_hal_transmit(zeros, 246U) ? 0U : hk_hal_transmit_room();
    room[3] = hk_hal_transmit(zeros, 241U) ? hk_hal_transmit_room() : 0U;
    (void)hk_hal_transmit(room, 4U);
    sei()"""
    folder = program(avr_folder, tmp_path / "code", begin=tell)
    stream = heard(folder).stream
    assert stream == bytes(251) + bytes([255, 245, 245, 4])


def test_one_byte_at_a_time_leaves_nothing_behind(avr_folder: Path, tmp_path: Path) -> None:
    """The transmitter is switched on again just when it runs dry."""
    send = """
    uint16_t i;
    for (i = 0U; i < 600U; i++) {
        const uint8_t low = (uint8_t)i;
        uint8_t pause = (uint8_t)(i % 97U);
        hk_hal_watchdog_feed();
        while (!hk_hal_transmit(&low, 1U)) {
        }
        while (pause-- > 0U) {
            __asm__ volatile("nop");
        }
    }"""
    folder = program(avr_folder, tmp_path / "code", begin=send)
    assert heard(folder).stream == bytes(i % 256 for i in range(600))


def test_served_bytes_are_received(avr_folder: Path, tmp_path: Path) -> None:
    folder = program(avr_folder, tmp_path / "code", begin="byte = 33U; " + ECHO)
    collector = Collector(lambda data: len(data) >= 12)
    waiting = [b"over", b"", b"the", b"line"]

    def receive() -> bytes:
        return waiting.pop(0) if waiting and collector.data else b""

    avr_board.serve(folder, stimulus(3), collector.send, collector.stop, receive)
    assert collector.data == b"!overtheline"


@pytest.mark.parametrize("baud", [57600, 1_000_000])
def test_other_baud_rates_are_received(avr_folder: Path, tmp_path: Path, baud: int) -> None:
    folder = program(avr_folder, tmp_path / "code")
    with_baud(folder, baud)
    avr_board.build(folder)
    data = bytes(range(100))
    assert heard(folder, (0.1, data)).stream == data
