import shutil
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from boards import (
    BOOT,
    CRITICAL,
    PICO_TOOLS,
    Collector,
    assert_every_row_once,
    changed,
    copied,
    generated,
    hear,
    require_or_skip,
    stimulus,
    with_faults,
)
from designs import all_parameters

from hostkit.emulation import host_board, rp2040_board, tools
from hostkit.errors import EmulationError, ToolMissingError
from hostkit.filters.complementary import lower, run_integer

HAL, BUS, CLOCK, LINK = (f"hk_{name}_rp2040.c" for name in ("hal", "i2c", "clock", "link"))


def rebuilt(pico_folder: Path, folder: Path, file: str, old: str, new: str) -> Path:
    """Copy the code and what was built of it, make one change, and build again."""
    shutil.copytree(pico_folder, folder)
    changed(folder / file, old, new)
    rp2040_board.build(folder)
    return folder


# --- The run -------------------------------------------------------------------------------------


def test_every_row_arrives_once_with_the_counts_of_the_model(pico_folder: Path) -> None:
    feels = stimulus()
    progress: list[int] = []
    run = rp2040_board.run(pico_folder, feels, progress=progress.append)
    heard = hear(run)
    assert_every_row_once(heard, feels)
    assert run.faults == ()
    assert progress[-1] == len(feels)
    assert run.cycles_mean is not None
    assert run.cycles_max is not None
    assert 300 < run.cycles_mean <= run.cycles_max < 1500
    assert run.stack_bytes is not None
    assert 100 < run.stack_bytes < 1024
    steps = {b.time_usec - a.time_usec for a, b in pairwise(heard.samples)}
    assert steps <= {9999, 10000, 10001}


def test_the_same_angles_as_on_the_host(pico_folder: Path, host_folder: Path) -> None:
    feels = stimulus(300)
    answers = [
        [(s.sequence, s.roll, s.pitch, s.flags, s.digest) for s in hear(run).samples]
        for run in (rp2040_board.run(pico_folder, feels), host_board.run(host_folder, feels))
    ]
    assert answers[0] == answers[1]


def test_the_hidden_words_are_those_of_the_integer_model(tmp_path: Path) -> None:
    require_or_skip(*PICO_TOOLS)
    design = all_parameters()
    folder = generated("rp2040", tmp_path / "code", design)
    rp2040_board.build(folder)
    samples = hear(rp2040_board.run(folder, stimulus(300, design))).samples
    accel, gyro = (np.array([getattr(s, name) for s in samples]) for name in ("accel", "gyro"))
    wanted = run_integer(lower(design), accel, gyro)
    assert len(samples) == 300
    np.testing.assert_array_equal([[s.roll, s.pitch, *s.hidden] for s in samples], wanted)


def test_serve_streams_in_real_time(pico_folder: Path) -> None:
    collector = Collector(lambda data: len(hear(data).samples) > 50)
    rp2040_board.serve(pico_folder, stimulus(20), collector.send, collector.stop)
    samples = hear(collector.data).samples
    assert [s.sequence for s in samples] == list(range(len(samples)))
    assert samples[0].accel == samples[20].accel


# --- A sensor with faults ------------------------------------------------------------------------


def test_wrong_identity_is_refused(pico_folder: Path) -> None:
    run = rp2040_board.run(pico_folder, with_faults(stimulus(), who_am_i=0x12))
    heard = hear(run)
    assert heard.samples == []
    assert heard.states[0] == BOOT
    assert set(heard.states[1:]) == {CRITICAL}
    assert {t.text for t in heard.of("STATUSTEXT")} == {"MPU-6050 refused: WHO_AM_I is 0x12"}
    assert dict(run.faults)["stalled"] == 1


@pytest.mark.parametrize("from_row", [0, 100])
def test_nacks_are_survived(pico_folder: Path, from_row: int) -> None:
    feels = with_faults(stimulus(), nack=3, from_row=from_row)
    heard = hear(rp2040_board.run(pico_folder, feels))
    assert_every_row_once(heard, feels)
    assert heard.samples[-1].i2c_errors == 3


@pytest.mark.parametrize(
    ("clocks", "from_row", "errors"), [(6, 0, 0), (9, 0, 0), (9, 100, 1), (20, 0, 2)]
)
def test_a_stuck_data_line_is_freed(
    pico_folder: Path, clocks: int, from_row: int, errors: int
) -> None:
    feels = with_faults(stimulus(), hold_sda_clocks=clocks, from_row=from_row)
    heard = hear(rp2040_board.run(pico_folder, feels))
    assert_every_row_once(heard, feels)
    assert heard.samples[-1].i2c_errors <= errors


# --- Firmware with faults, each in something that only the emulated board can see ----------------


@pytest.mark.parametrize(
    ("file", "old", "new", "reason"),
    [
        (HAL, "hk_reset_release(HK_RESET_TIMER | HK_RESET_UART0 |",
         "hk_reset_release(HK_RESET_TIMER |",
         "uses UART0 while it is held in reset"),
        (CLOCK, "HK_REG(HK_CLK_PERI_CTRL) = HK_CLK_PERI_ENABLE;", "", "without clk_peri"),
        (BUS, "HK_REG(HK_I2C0_TAR) = address;\n    HK_REG(HK_I2C0_ENABLE) = 1U;",
         "HK_REG(HK_I2C0_ENABLE) = 1U;\n    HK_REG(HK_I2C0_TAR) = address;",
         "0x4 of I2C0 was set while it was on"),
        (LINK, " && (HK_REG(HK_UART0_FR) & HK_UART_TX_FULL) == 0U", "", "transmitter that is full"),
        ("hk_boot2_rp2040.S", "COMMAND,   0x03", "COMMAND,   0xEB", "0xf4 of the SSI wrong"),
        ("hk_boot2_rp2040.S", "VECTORS,   0x10000100", "VECTORS,   0x10000104", "reset vector"),
        ("hk_image.c", "crc = UINT32_MAX", "crc = 0U", "boot ROM refuses the image"),
    ],
    ids=["reset", "clk_peri", "target", "full", "command", "vectors", "checksum"],
)  # fmt: skip
def test_faulty_firmware_is_stopped(
    pico_folder: Path, tmp_path: Path, file: str, old: str, new: str, reason: str
) -> None:
    folder = rebuilt(pico_folder, tmp_path / "code", file, old, new)
    with pytest.raises(EmulationError, match=rf"board\.mjs failed .*{reason}"):
        rp2040_board.run(folder, stimulus(3))


def test_firmware_that_jumps_to_its_start_is_noticed(pico_folder: Path, tmp_path: Path) -> None:
    folder = tmp_path / "code"
    shutil.copytree(pico_folder, folder)
    changed(folder / "main.c", "    hk_app_init(&app);", "    hk_reset();")
    changed(folder / "main.c", "int main(void)\n", "void hk_reset(void);\nint main(void)\n")
    rp2040_board.build(folder)
    with pytest.raises(EmulationError, match=r"jumped to its start after 0\.0"):
        rp2040_board.run(folder, stimulus(3))


@pytest.mark.parametrize(
    ("file", "old", "new"),
    [
        (HAL, "HK_BIT(HK_IRQ_UART0);", "0U;"),
        (BUS, "take_pin(HK_PIN_SCL, HK_IO_I2C);", "take_pin(HK_PIN_SCL, HK_IO_SIO);"),
    ],
    ids=["interrupt", "pin"],
)
def test_firmware_that_gets_stuck_is_noticed(
    pico_folder: Path, tmp_path: Path, file: str, old: str, new: str
) -> None:
    folder = rebuilt(pico_folder, tmp_path / "code", file, old, new)
    assert dict(rp2040_board.run(folder, stimulus(3)).faults)["stalled"] == 1


def test_the_timer_counts_what_the_firmware_has_set(pico_folder: Path, tmp_path: Path) -> None:
    folder = rebuilt(pico_folder, tmp_path / "code", CLOCK, "HZ / HK_MHZ", "HZ / HK_MHZ / 2U")
    samples = hear(rp2040_board.run(folder, stimulus(10))).samples
    steps = [b.time_usec - a.time_usec for a, b in pairwise(samples)]
    assert 19900 < min(steps) <= max(steps) < 20500


def test_a_wrong_range_is_seen_in_the_counts(pico_folder: Path, tmp_path: Path) -> None:
    folder = rebuilt(
        pico_folder, tmp_path / "code", "hk_design.h", "X(0x1B, 0x08)", "X(0x1B, 0x10)"
    )
    feels = stimulus(30)
    with pytest.raises(AssertionError, match="Mismatched elements"):
        assert_every_row_once(hear(rp2040_board.run(folder, feels)), feels)


# --- Sleep ---------------------------------------------------------------------------------------

SLEEPER = """
#include "hk_hal.h"
#include "hk_rp2040.h"
#define PENDING ((HK_REG(HK_TIMER_INTR) & 1U) != 0U)
int main(void)
{
    volatile uint32_t i;
    uint32_t turn;
    hk_hal_init();
    for (turn = 0U; turn < 5U; turn++) {
        HK_REG(HK_TIMER_ALARM0) = hk_hal_time_us() + 20U;
        __asm__ volatile("cpsid i" : : : "memory");
        BEFORE
        hk_hal_mark_begin();
        __asm__ volatile("wfi" : : : "memory");
        for (i = 0U; !PENDING && i < 1000U; i++) {
        }
        hk_hal_mark_end();
        __asm__ volatile("cpsie i" : : : "memory");
    }
    for (;;) {
        __asm__ volatile("wfi" : : : "memory");
    }
}
"""


@pytest.mark.parametrize("before", ["", "while (!PENDING) { }"], ids=["later", "before"])
def test_masked_interrupts_end_a_sleep_and_wait(
    pico_folder: Path, tmp_path: Path, before: str
) -> None:
    """Else one that came before the sleep would be missed, or its handler run within it."""
    folder = tmp_path / "code"
    shutil.copytree(pico_folder, folder)
    (folder / "main.c").write_text(SLEEPER.replace("BEFORE", before), encoding="ascii")
    rp2040_board.build(folder)
    run = rp2040_board.run(folder, stimulus(3))
    assert run.cycles_max is not None
    assert run.cycles_max < 100


# --- Files and tools -----------------------------------------------------------------------------


@pytest.mark.parametrize(("at", "what"), [(0, "block 0 .*damaged at byte 0"), (40, "CRC")])
def test_a_damaged_image_is_noticed(pico_folder: Path, tmp_path: Path, at: int, what: str) -> None:
    folder = copied(pico_folder, tmp_path / "code")
    image = bytearray((pico_folder / "firmware.uf2").read_bytes())
    image[at] ^= 1
    (folder / "firmware.uf2").write_bytes(image)
    with pytest.raises(EmulationError, match=rf"board\.mjs failed .*{what}"):
        rp2040_board.run(folder, stimulus(3))


def test_missing_tools_are_named_with_their_remedy(
    pico_folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(tools, "NODE_FOLDERS", tmp_path)
    with pytest.raises(ToolMissingError, match=r"rp2040js is not installed; .*make setup"):
        rp2040_board.run(pico_folder, stimulus(3))
    for tool in ("make", "gcc"):
        (tmp_path / tool).symlink_to("/bin/true")
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(ToolMissingError, match=r"arm-none-eabi-gcc .*libnewlib-arm-none-eabi"):
        rp2040_board.build(pico_folder)
