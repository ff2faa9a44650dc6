"""The hardware layer of the RP2040 by small programs: receiver, watchdog, causes of a reset."""

import shutil
import struct
from dataclasses import replace
from pathlib import Path

import pytest
from boards import Collector, changed, stimulus

from hostkit.emulation import rp2040_board
from hostkit.emulation.board import BoardRun, LinkInput, Stimulus
from hostkit.errors import EmulationError

ECHO = """
#include "hk_hal.h"
int main(void)
{
    uint8_t byte;
    hk_hal_init();
    for (;;) {
        hk_hal_watchdog_feed();
        while (hk_hal_transmit_room() > 0U && hk_hal_receive(&byte)) {
            (void)hk_hal_transmit(&byte, 1U);
        }
        hk_hal_idle();
    }
}
"""

# Looks away for a while, then sends whatever it has.
LATE = """
#include "hk_hal.h"
#include "hk_rp2040.h"
int main(void)
{
    uint8_t byte;
    hk_hal_init();
    while (hk_hal_time_us() < 10000U) {
    }
    BEFORE
    while (hk_hal_time_us() < 60000U) {
        hk_hal_watchdog_feed();
    }
    AFTER
    for (;;) {
        hk_hal_watchdog_feed();
        while (hk_hal_transmit_room() > 0U && hk_hal_receive(&byte)) {
            (void)hk_hal_transmit(&byte, 1U);
        }
        hk_hal_idle();
    }
}
"""

# Sends the cause of its start and the time of its end.
TELLS = """
#include "hk_hal.h"
#include "hk_rp2040.h"
static uint8_t turns;
static void tell(uint8_t what)
{
    const uint32_t now_us = hk_hal_time_us();
    uint8_t bytes[5] = {what, (uint8_t)now_us, (uint8_t)(now_us >> 8), (uint8_t)(now_us >> 16), 0U};
    bytes[4] = turns;
    (void)hk_hal_transmit(bytes, sizeof bytes);
}
int main(void)
{
    hk_hal_init();
    tell((uint8_t)hk_hal_reset_cause());
    while (hk_hal_time_us() < 2500000U) {
        hk_hal_watchdog_feed();
        hk_hal_idle();
    }
    tell(0xEEU);
    while (hk_hal_time_us() < 2502000U) {
    }
    turns++;
    END
    for (;;) {
        hk_hal_idle();
    }
}
"""

# Sends what the RAM and the sensor's register 0x6B hold at each start, and changes both.
KEEPS = """
#include "hk_hal.h"
#include "hk_rp2040.h"
#define WORD HK_REG(0x20020000U)
int main(void)
{
    const uint8_t wake[] = {0x6BU, 0x00U};
    uint8_t byte;
    hk_hal_init();
    byte = (uint8_t)hk_hal_reset_cause();
    (void)hk_hal_transmit(&byte, 1U);
    byte = WORD == 0x12345678U;
    (void)hk_hal_transmit(&byte, 1U);
    while (!hk_hal_i2c_read(0x68U, 0x6BU, &byte, 1U)) {
    }
    (void)hk_hal_transmit(&byte, 1U);
    WORD = 0x12345678U;
    while (hk_hal_time_us() < 100000U) {
        hk_hal_idle();
    }
    (void)hk_hal_i2c_write(0x68U, wake, sizeof wake);
    hk_hal_store_erase(0U);
    for (;;) {
        hk_hal_idle();
    }
}
"""

POWER, PIN, BROWN_OUT, WATCHDOG, REQUEST = range(5)


def firmware(pico_folder: Path, folder: Path, source: str) -> Path:
    shutil.copytree(pico_folder, folder)
    (folder / "main.c").write_text(source, encoding="ascii")
    rp2040_board.build(folder)
    return folder


def hearing(*pieces: LinkInput) -> Stimulus:
    """The table is not played: the run ends when nobody has taken a row for a while."""
    return replace(stimulus(3), received=pieces)


def run(folder: Path, *pieces: LinkInput) -> BoardRun:
    return rp2040_board.run(folder, hearing(*pieces))


# --- Receiver ------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def echo(pico_folder: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return firmware(pico_folder, tmp_path_factory.mktemp("echo") / "code", ECHO)


def test_what_comes_in_arrives_in_order(echo: Path) -> None:
    long, short = bytes(range(256)) * 4, b"\x00\xff"
    heard = run(echo, LinkInput(time_s=0.1, data=long), LinkInput(time_s=1.0, data=short))
    assert heard.stream == long + short


@pytest.mark.parametrize("count", [1, 15, 16, 17, 33])
def test_a_few_bytes_do_not_stay_in_the_receiver(echo: Path, count: int) -> None:
    data = bytes(range(count))
    assert run(echo, LinkInput(time_s=0.1, data=data)).stream == data


@pytest.mark.parametrize(
    ("before", "after", "kept"),
    [("", "", 255), ('__asm__ volatile("cpsid i");', '__asm__ volatile("cpsie i");', 32)],
    ids=["ring", "receiver"],
)
def test_what_finds_no_room_is_lost(
    pico_folder: Path, tmp_path: Path, before: str, after: str, kept: int
) -> None:
    source = LATE.replace("BEFORE", before).replace("AFTER", after)
    data = bytes(i % 256 for i in range(300))  # 26 ms, within the 50 that it looks away
    heard = run(
        firmware(pico_folder, tmp_path / "code", source),
        LinkInput(time_s=0.02, data=data),
        LinkInput(time_s=0.5, data=b"on it goes"),
    )
    assert heard.stream == data[:kept] + b"on it goes"


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("HK_REG(HK_IO_CTRL(HK_PIN_RX)) = HK_IO_UART;", ""),
        ("HK_PAD_INPUT | ", ""),
        ("HK_REG(HK_UART0_IMSC) = HK_UART_RX_INTERRUPT;", ""),
    ],
    ids=["function", "input", "interrupt"],
)
def test_a_receiver_that_is_not_set_up_hears_nothing(
    echo: Path, tmp_path: Path, old: str, new: str
) -> None:
    folder = tmp_path / "code"
    shutil.copytree(echo, folder)
    changed(folder / "hk_link_rp2040.c", old, new)
    rp2040_board.build(folder)
    assert run(folder, LinkInput(time_s=0.1, data=b"hello")).stream == b""


def test_without_the_time_out_a_few_bytes_would_stay(echo: Path, tmp_path: Path) -> None:
    folder = tmp_path / "code"
    shutil.copytree(echo, folder)
    changed(folder / "hk_rp2040.h", "(HK_BIT(4) | HK_BIT(6)) /*", "HK_BIT(4) /*")
    rp2040_board.build(folder)
    data = bytes(range(17))
    assert run(folder, LinkInput(time_s=0.1, data=data)).stream == data[:16]


def test_serve_hands_over_what_comes(echo: Path) -> None:
    """Question marks, until the first has come back: before, the receiver may not be set up."""
    collector = Collector(lambda data: data.endswith(b"again"))
    pieces = iter([b"once", b"", b" again"])

    def receive() -> bytes:
        return next(pieces, b"") if collector.data else b"?"

    rp2040_board.serve(echo, stimulus(3), collector.send, collector.stop, receive)
    assert collector.data.lstrip(b"?") == b"once again"


# --- Watchdog and resets -------------------------------------------------------------------------


def told(stream: bytes) -> list[tuple[int, float, int]]:
    """What it said, when by its own clock (s), and how often it had come to an end before."""
    pieces = [stream[i : i + 5] for i in range(0, len(stream), 5)]
    parts = [struct.unpack("<BHBB", piece) for piece in pieces if len(piece) == 5]
    return [(what, (low + (high << 16)) / 1e6, turns) for what, low, high, turns in parts]


@pytest.mark.parametrize(("end", "cause"), [("", WATCHDOG), ("hk_hal_reboot();", REQUEST)])
def test_a_reset_tells_its_cause(pico_folder: Path, tmp_path: Path, end: str, cause: int) -> None:
    """It is fed for longer than its limit; then it comes, or is called, at once."""
    heard = run(firmware(pico_folder, tmp_path / "code", TELLS.replace("END", end)))
    said = told(heard.stream)
    assert [what for what, _, _ in said[:3]] == [POWER, 0xEE, cause]
    assert all(time_s < 0.01 for what, time_s, _ in said if what != 0xEE)
    assert {turns for _, _, turns in said} == {0}
    resets = dict(heard.faults)["resets"]
    assert resets == 1 + (cause == REQUEST)  # of 5 s, each turn takes 2.5, or 4


def test_an_unexpected_exception_starts_the_board_over(pico_folder: Path, tmp_path: Path) -> None:
    trap = "void hk_trap(void);"
    source = TELLS.replace("int main(void)", f"{trap}\nint main(void)").replace("END", "hk_trap();")
    said = told(run(firmware(pico_folder, tmp_path / "code", source)).stream)
    assert [what for what, _, _ in said[:3]] == [POWER, 0xEE, WATCHDOG]


def test_application_that_hangs_is_started_over(pico_folder: Path, tmp_path: Path) -> None:
    folder = tmp_path / "code"
    shutil.copytree(pico_folder, folder)
    changed(folder / "hk_app.c", "    hk_hal_watchdog_feed();\n", "")
    rp2040_board.build(folder)
    heard = rp2040_board.run(folder, stimulus(400))
    assert dict(heard.faults)["resets"] == 3  # 1.5 s each, of which samples come in 1.25


def test_a_watchdog_that_would_reset_only_a_part_ends_the_run(
    pico_folder: Path, tmp_path: Path
) -> None:
    folder = firmware(pico_folder, tmp_path / "code", TELLS.replace("END", ""))
    changed(folder / "hk_watchdog_rp2040.c", "HK_REG(HK_PSM_WDSEL) = HK_PSM_BUT_CLOCKS;", "")
    rp2040_board.build(folder)
    with pytest.raises(EmulationError, match=r"resets only a part: WDSEL is 0x0"):
        run(folder)


@pytest.mark.parametrize(
    ("cut", "second"), [(None, (WATCHDOG, 1, 0x00)), (0, (POWER, 0, 0x40))], ids=["dog", "supply"]
)
def test_what_outlives_a_reset(
    pico_folder: Path, tmp_path: Path, cut: int | None, second: tuple[int, int, int]
) -> None:
    """The watchdog leaves RAM and sensor alone; where the supply fails, both start anew."""
    folder = firmware(pico_folder, tmp_path / "code", KEEPS)
    heard = rp2040_board.run(folder, replace(stimulus(3), power_cut_after=cut))
    assert tuple(heard.stream[:3]) == (POWER, 0, 0x40)
    assert tuple(heard.stream[3:6]) == second


def test_what_is_queued_leaves_before_a_restart(pico_folder: Path, tmp_path: Path) -> None:
    source = """
#include "hk_hal.h"
int main(void)
{
    uint8_t bytes[200] = {0U};
    hk_hal_init();
    if (hk_hal_reset_cause() == HK_RESET_POWER) {
        bytes[199] = 7U;
        (void)hk_hal_transmit(bytes, sizeof bytes);
        hk_hal_reboot();
    }
    for (;;) {
        hk_hal_watchdog_feed();
        hk_hal_idle();
    }
}
"""
    heard = run(firmware(pico_folder, tmp_path / "code", source))
    assert heard.stream == bytes(199) + b"\x07"
    assert dict(heard.faults)["resets"] == 1
