import os
import struct
import sys
from itertools import pairwise
from pathlib import Path

import pytest
from boards import (
    BOOT,
    CRITICAL,
    Collector,
    assert_every_row_once,
    changed,
    hear,
    stimulus,
    with_faults,
)
from stm32_machine import code, machine_of, program

from hostkit.emulation import stm32_board
from hostkit.emulation.board import PlannedFault
from hostkit.emulation.fault import KINDS
from hostkit.errors import BuildError, EmulationError, ToolMissingError

__all__ = ["code"]

FLASH_BYTES, RAM_BYTES, RAM_START = 64 * 1024, 20 * 1024, 0x20000000
HAL, I2C, LINK = (f"hk_{part}_stm32f103.c" for part in ("hal", "i2c", "link"))


def run_changed(code: Path, file: str, old: str, new: str, samples: int = 3):
    changed(code / file, old, new)
    stm32_board.build(code)
    return stm32_board.run(code, stimulus(samples))


def test_the_image_fits_and_begins_with_its_vectors(stm32_folder: Path) -> None:
    built = stm32_board.build(stm32_folder)
    image = built.artifact.read_bytes()
    assert (built.flash_bytes, (stm32_folder / "firmware.hex").is_file()) == (len(image), True)
    assert 4000 < len(image) < FLASH_BYTES / 2
    assert 300 < built.ram_bytes < RAM_BYTES / 4
    stack, *handlers = struct.unpack_from("<59I", image)
    assert stack == RAM_START + RAM_BYTES
    assert all(handler & 1 for handler in handlers)
    default = handlers[1]
    own = {number - 15 for number, handler in enumerate(handlers) if handler != default}
    assert own == {-15, 23, 28, 29, 37}  # reset, EXTI9_5, TIM2, TIM3, USART1


def test_every_row_arrives_once_with_the_counts_of_the_model(stm32_folder: Path) -> None:
    feels = stimulus(100)
    progress: list[int] = []
    run = stm32_board.run(stm32_folder, feels, progress=progress.append)
    assert_every_row_once(hear(run), feels)
    assert run.faults == ()
    assert progress[-1] == len(feels)
    assert run.cost_unit == "instructions"
    assert 100 < run.cycles_mean <= run.cycles_max < 5000
    assert run.cycles_max - run.cycles_mean < 5  # without those of interrupts
    assert 200 < run.stack_bytes < 2048
    steps = {b - a for a, b in pairwise(s.time_usec for s in hear(run).samples)}
    assert steps <= {9999, 10000, 10001}  # the interrupt takes the time


def test_wrong_identity_is_refused(stm32_folder: Path) -> None:
    run = stm32_board.run(stm32_folder, with_faults(stimulus(3), who_am_i=0x12))
    heard = hear(run)
    assert heard.samples == []
    assert heard.states[0] == BOOT
    assert set(heard.states[1:]) == {CRITICAL}
    assert {t.text for t in heard.of("STATUSTEXT")} == {"MPU-6050 refused: WHO_AM_I is 0x12"}
    assert dict(run.faults)["stalled"] == 1


def test_nacks_are_survived(stm32_folder: Path) -> None:
    feels = with_faults(stimulus(30), nack=3, from_row=15)
    heard = hear(stm32_board.run(stm32_folder, feels))
    assert_every_row_once(heard, feels)
    assert heard.samples[-1].i2c_errors == 3
    assert heard.samples[10].i2c_errors == 0


@pytest.mark.parametrize(("clocks", "from_row", "errors"), [(6, 0, 0), (9, 15, 1), (20, 0, 2)])
def test_a_stuck_data_line_is_freed(
    stm32_folder: Path, clocks: int, from_row: int, errors: int
) -> None:
    feels = with_faults(stimulus(30), hold_sda_clocks=clocks, from_row=from_row)
    heard = hear(stm32_board.run(stm32_folder, feels))
    assert_every_row_once(heard, feels)
    assert heard.samples[-1].i2c_errors <= errors
    assert from_row == 0 or heard.samples[-1].i2c_errors > 0


@pytest.mark.parametrize(
    ("name", "amount", "errors"),
    [
        ("clock-stretch", 300, 0),
        ("clock-stretch", 3000, 1),
        ("torn-burst", 6, 1),
        ("nack-data", 2, 1),
    ],
)
def test_faults_of_the_bus_are_survived(
    stm32_folder: Path, name: str, amount: int, errors: int
) -> None:
    kind = next(kind for kind in KINDS if kind.name == name)
    planned = (PlannedFault(code=kind.code, row=15, amount=amount),)
    feels = with_faults(stimulus(30), planned=planned)
    run = stm32_board.run(stm32_folder, feels)
    samples = hear(run).samples
    assert dict(run.faults)["struck"] == 1
    assert (samples[10].i2c_errors, samples[-1].i2c_errors > 0) == (0, errors > 0)
    assert len(samples) >= 28


def test_serve_streams_in_real_time(stm32_folder: Path) -> None:
    collector = Collector(lambda data: len(hear(data).samples) > 30)
    stm32_board.serve(stm32_folder, stimulus(20), collector.send, collector.stop)
    samples = hear(collector.data).samples
    assert [s.sequence for s in samples] == list(range(len(samples)))
    assert samples[0].accel == samples[20].accel


# --- the I2C sequences, for every length ---------------------------------------------------------

READER = """
#include "hk_hal.h"
int main(void)
{
    static const uint8_t settings[5] = {0x19U, 0x5AU, 0x03U, 0x18U, 0x10U};
    static uint8_t bytes[17];
    uint8_t count;
    hk_hal_init();
    (void)hk_hal_i2c_write(0x68U, settings, sizeof settings);
    for (count = 1U; count <= 16U; count++) {
        const uint8_t first = (uint8_t)(0x1DU - count);
        bytes[0] = hk_hal_i2c_read(0x68U, first, &bytes[1], count) ? count : 0xFFU;
        while (!hk_hal_transmit(bytes, (uint8_t)(count + 1U))) {
        }
    }
    for (;;) {
        hk_hal_idle();
    }
}
"""
SETTINGS = bytes([*[0] * 12, 0x5A, 0x03, 0x18, 0x10])  # the registers up to 0x1C


def read_lengths(code: Path, work: Path) -> list[bytes]:
    program(code, READER)
    machine = machine_of(code, work)
    machine.sensor.set_self_test((0, 0, 0, 0))
    machine.run(0.05)
    said = bytes(machine.link)
    pieces = []
    for count in range(1, 17):
        pieces.append(said[: count + 1])
        said = said[count + 1 :]
    assert said == b""
    return pieces


def test_reads_of_every_length_are_right(code: Path, tmp_path: Path) -> None:
    pieces = read_lengths(code, tmp_path)
    assert pieces == [bytes([n]) + SETTINGS[-n:] for n in range(1, 17)]


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("I2C_CR1_PE | I2C_CR1_POS;\n", "I2C_CR1_PE | I2C_CR1_POS | I2C_CR1_ACK;\n"),
        ("I2C1_CR1 = I2C_CR1_PE; /*", "/*"),
    ],
)
def test_an_acknowledge_too_many_is_noticed(code: Path, tmp_path: Path, old: str, new: str) -> None:
    """With POS in a read of two bytes, without in longer ones."""
    changed(code / I2C, old, new)
    if "POS" not in old:
        changed(code / I2C, "I2C_CR1_STOP | position", "I2C_CR1_STOP | I2C_CR1_ACK | position")
    with pytest.raises(EmulationError, match="STOP after a byte that was acknowledged"):
        read_lengths(code, tmp_path)


def test_a_last_byte_read_late_is_spoilt(code: Path, tmp_path: Path) -> None:
    """As the errata sheet says of the last byte but one, if STOP has come before it is read."""
    changed(
        code / I2C,
        "STOP | position;\n",
        "STOP | position;\n    while ((I2C1_CR1 & I2C_CR1_STOP) != 0U) {\n    }\n",
    )
    pieces = read_lengths(code, tmp_path)
    assert pieces[0] == b"\x01\x10"
    assert [p[-2:] for p in pieces[1:]] == [b"\x18\x20"] * 15


def test_control_must_not_be_written_while_stop_is_under_way(code: Path, tmp_path: Path) -> None:
    changed(code / I2C, "    while ((I2C1_CR1 & (", "    while (false && (I2C1_CR1 & (")
    with pytest.raises(EmulationError, match="while START or STOP is under way"):
        read_lengths(code, tmp_path)


# --- what a real part would not forgive ----------------------------------------------------------


@pytest.mark.parametrize(
    ("file", "old", "new", "message"),
    [
        (HAL, "PREFETCH | FLASH_ACR_TWO_WAITS", "PREFETCH", r"72000000 Hz, .* 0 wait states"),
        (HAL, " | RCC_CFGR_PPRE1_BY_2", "", r"APB1 runs at 72000000 Hz"),
        (LINK, "USART1_BRR = HK_BRR", "USART1_BRR = HK_BRR + 8U", r"link runs at 473684 bit/s"),
        (I2C, "I2C1_CR2 = HK_PCLK1_HZ", "I2C1_CR2 = 2U * HK_PCLK1_HZ", r"I2C_CR2 says 8 MHz"),
        (I2C, "(3UL * HK_I2C_HZ)", "(4UL * HK_I2C_HZ)", r"SCL would run at 545455 Hz"),
        (HAL, "start_timers();\n", "*(uint32_t *)0x60000000 = 1U;\n", r"faults at 0x0800"),
        (HAL, "start_timers();\n", "HK_MMIO(0x40000800) = 1U;\n", r"0x40000800, which is not mod"),
        (HAL, "start_timers();\n", '__asm__ volatile("b hk_reset");\n', r"jumped to its start"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_named(code: Path, file: str, old: str, new: str, message: str) -> None:
    with pytest.raises(EmulationError, match=message):
        run_changed(code, file, old, new)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("set_field(&GPIOA_CRH, HK_TX_PIN", "set_field(&GPIOA_CRH, 10U"),
        ("NVIC_ISER1 = NVIC_USART1", "(void)NVIC_USART1"),
    ],
)
def test_a_link_that_is_not_connected_says_nothing(
    code: Path, tmp_path: Path, old: str, new: str
) -> None:
    changed(code / HAL, old, new)
    stm32_board.build(code)
    machine = machine_of(code, tmp_path)
    machine.run(0.05)
    assert bytes(machine.link) == b""


@pytest.mark.parametrize(
    ("file", "old", "new"),
    [
        (I2C, "i2c_pins(GPIO_PERIPHERAL_DRAIN)", "i2c_pins(GPIO_OPEN_DRAIN)"),
        (HAL, "RCC_APB1_TIM3 | RCC_APB1_I2C1", "RCC_APB1_TIM3"),
    ],
)
def test_a_bus_that_is_not_connected_is_a_fault(
    code: Path, tmp_path: Path, file: str, old: str, new: str
) -> None:
    changed(code / file, old, new)
    stm32_board.build(code)
    machine = machine_of(code, tmp_path)
    machine.run(0.15)
    heard = hear(bytes(machine.link))
    assert heard.states == [BOOT, CRITICAL]
    assert "I2C bus fault" in heard.of("STATUSTEXT")[0].text


def test_without_its_crystal_the_board_does_not_start(stm32_folder: Path, tmp_path: Path) -> None:
    machine = machine_of(stm32_folder, tmp_path, crystal_starts=False)
    machine.run(0.05)
    assert (bytes(machine.link), machine.time.now_s >= 0.05) == (b"", True)
    machine = machine_of(stm32_folder, tmp_path)
    machine.run(0.05)
    assert machine.link[0] == 0xFD  # the first heartbeat


HOLDER = """
#include "hk_board_stm32f103.h"
#include "hk_hal.h"
#include "hk_stm32f103.h"
int main(void)
{
    uint32_t begin, end, turns;
    uint8_t good = 1U, waited = 0U;
    hk_hal_init();
    for (turns = 0U; turns < 2U; turns++) {
        const uint32_t held = hk_board_hold();
        begin = hk_hal_time_us();
        do {
            end = hk_hal_time_us();
        } while (end - begin < 40000U);
        good &= end - begin < 40100U;
        waited |= (uint8_t)(TIM2_SR & TIM_SR_UIF);
        hk_board_release(held);
        good &= hk_hal_time_us() - end < 100U;
    }
    good &= waited;
    hk_hal_transmit(&good, 1U);
    for (;;) {
        hk_hal_idle();
    }
}
"""


def test_the_clock_goes_on_while_interrupts_are_held(code: Path, tmp_path: Path) -> None:
    program(code, HOLDER)
    machine = machine_of(code, tmp_path)
    machine.run(0.1)
    assert bytes(machine.link) == b"\x01"


MARKER = """
#include "hk_hal.h"
int main(void)
{
    static const uint8_t bytes[200];
    volatile uint32_t turns;
    hk_hal_init();
    (void)hk_hal_transmit(bytes, COUNT);
    hk_hal_mark_begin();
    for (turns = 0U; turns < 20000U; turns++) {
    }
    hk_hal_mark_end();
    for (;;) {
        hk_hal_idle();
    }
}
"""


def test_instructions_of_interrupts_are_not_counted(code: Path, tmp_path: Path) -> None:
    counts = []
    for sent in ("1U", "200U"):
        program(code, MARKER.replace("COUNT", sent))
        machine = machine_of(code, tmp_path)
        machine.run(0.02)
        counts.append(machine.segments.total)
    assert counts[0] > 20_000
    assert abs(counts[0] - counts[1]) < 10


# --- what is missing -----------------------------------------------------------------------------


def test_code_that_is_not_built_is_refused(code: Path) -> None:
    (code / "firmware.bin").unlink()
    with pytest.raises(BuildError, match="has not been built yet"):
        stm32_board.run(code, stimulus(3))


def test_missing_tools_are_named_with_their_remedy(
    stm32_folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in [name for name in sys.modules if name.startswith("hostkit.emulation.stm32.")]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, "unicorn", None)
    with pytest.raises(ToolMissingError, match=r"unicorn .*pip install 'hostkit\[stm32\]'"):
        stm32_board.run(stm32_folder, stimulus(3))
    monkeypatch.setenv("PATH", str(tmp_path))
    assert os.environ["PATH"] == str(tmp_path)
    with pytest.raises(ToolMissingError, match=r"make is not installed; .*apt-get install make"):
        stm32_board.build(stm32_folder)
