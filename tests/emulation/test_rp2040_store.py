"""The flash of the RP2040: its two slots, what a change costs, and what ends a run."""

import shutil
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import pytest
from boards import (
    PICO_TOOLS,
    RESTARTED,
    changed,
    expected_counts,
    generated,
    hear,
    require_or_skip,
    stimulus,
)
from designs import design

from hostkit.emulation import rp2040_board
from hostkit.emulation.board import BoardRun
from hostkit.errors import EmulationError
from hostkit.records import FilterDesign

SECTOR = 4096
SLOT = 128
STORE = "hk_store_rp2040.c"

# Replaces a slot by 0x80, 0x81 ... unless it was there, and sends what both slots begin with.
WRITER = """
#include "hk_hal.h"
static void tell(uint8_t slot)
{
    uint8_t bytes[HK_STORE_SLOT_BYTES];
    hk_hal_store_read(slot, 0U, bytes, HK_STORE_SLOT_BYTES);
    (void)hk_hal_transmit(bytes, HK_STORE_SLOT_BYTES - 1U);
}
static void wait(uint32_t wait_us)
{
    const uint32_t since_us = hk_hal_time_us();
    while (hk_hal_time_us() - since_us < wait_us) {
        hk_hal_watchdog_feed();
    }
}
static void replace(uint8_t slot)
{
    uint8_t i;
    hk_hal_store_erase(slot);
    for (i = 0U; i < COUNT; i++) {
        hk_hal_store_put((uint8_t)(0x80U + i));
    }
    hk_hal_store_finish();
}
int main(void)
{
    uint8_t first;
    hk_hal_init();
    hk_hal_store_read(SLOT, 0U, &first, 1U);
    if (first != 0x80U) {
        replace(SLOT);
    }
    tell(0U);
    wait(20000U);
    tell(1U);
    for (;;) {
        hk_hal_watchdog_feed();
        hk_hal_idle();
    }
}
"""


@pytest.fixture(scope="module")
def writer(pico_folder: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Writes the whole of slot 1."""
    return firmware(pico_folder, tmp_path_factory.mktemp("writer") / "code")


def firmware(pico_folder: Path, folder: Path, *, slot: int = 1, count: int = SLOT) -> Path:
    shutil.copytree(pico_folder, folder)
    source = WRITER.replace("SLOT,", f"{slot}U,").replace("(SLOT)", f"({slot}U)")
    (folder / "main.c").write_text(source.replace("COUNT", f"{count}U"), encoding="ascii")
    rp2040_board.build(folder)
    return folder


def rebuilt(writer: Path, folder: Path, file: str, old: str, new: str) -> Path:
    shutil.copytree(writer, folder)
    changed(folder / file, old, new)
    rp2040_board.build(folder)
    return folder


def run(folder: Path, store: bytes = b"", power_cut_after: int | None = None) -> BoardRun:
    feels = replace(stimulus(3), store=store, power_cut_after=power_cut_after)
    return rp2040_board.run(folder, feels)


NEW = bytes(range(0x80, 0x80 + SLOT))
OLD = bytes(3 * i % 256 for i in range(SLOT))
BLANK = b"\xff" * SLOT


def test_a_slot_is_replaced_and_read_back(writer: Path) -> None:
    heard = run(writer)
    assert heard.store == b"\xff" * SECTOR + NEW.ljust(SECTOR, b"\xff")
    assert heard.stream == BLANK[:-1] + NEW[:-1]
    assert heard.faults == (("stalled", 1),)


def test_the_other_slot_is_left_alone(pico_folder: Path, tmp_path: Path) -> None:
    folder = firmware(pico_folder, tmp_path / "code", slot=0, count=5)
    before = OLD.ljust(SECTOR, b"\x11") + OLD.ljust(SECTOR, b"\x22")
    heard = run(folder, before)
    assert heard.store == NEW[:5].ljust(SECTOR, b"\xff") + before[SECTOR:]
    assert heard.stream == (NEW[:5] + BLANK)[: SLOT - 1] + OLD[:-1]


def test_what_was_stored_is_there_at_the_next_start(writer: Path) -> None:
    first = run(writer)
    again = run(writer, first.store, power_cut_after=0)  # no byte is written, so nothing fails
    assert again.stream == first.stream
    assert again.store == first.store
    assert "resets" not in dict(again.faults)


# --- The supply fails ----------------------------------------------------------------------------


@pytest.mark.parametrize("written", [0, 1, 2, 64, 127])
def test_a_supply_that_fails_spoils_one_slot_and_starts_the_board_over(
    writer: Path, written: int
) -> None:
    """The erase counts as the first byte. The last byte is 0xFF, which nobody has to write."""
    before = OLD.ljust(SECTOR, b"\x11") + OLD.ljust(SECTOR, b"\x22")
    heard = run(writer, before, written)
    assert dict(heard.faults)["resets"] == 1
    assert heard.store[:SECTOR] == before[:SECTOR]
    if written <= 1:  # the first byte is not there, so it was written anew
        assert heard.store[SECTOR:] == NEW.ljust(SECTOR, b"\xff")
        return
    kept, spoilt = heard.store[SECTOR : SECTOR + written - 1], heard.store[SECTOR + written - 1]
    assert kept == NEW[: written - 1]
    assert spoilt & NEW[written - 1] == NEW[written - 1]  # not all bits are cleared
    assert spoilt != NEW[written - 1]
    assert heard.store[SECTOR + written :] == b"\xff" * (SECTOR - written)


def test_a_supply_that_fails_in_an_erase_leaves_half_of_the_sector(
    writer: Path, tmp_path: Path
) -> None:
    folder = rebuilt(writer, tmp_path / "code", "main.c", "if (first != 0x80U)", "if (first == 3U)")
    heard = run(folder, b"\xff" * SECTOR + b"\x03" * SECTOR, 0)
    middle = SECTOR + SECTOR // 2
    assert set(heard.store[:middle]) == {0xFF}
    assert heard.store[middle] not in (0x03, 0xFF)
    assert set(heard.store[middle + 1 :]) == {0x03}


# --- What ends a run -----------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("file", "old", "new", "reason"),
    [
        (STORE, "    rom->connect();\n", "", "was not connected"),
        (STORE, "    rom->leave_reading();\n", "", "erases the flash while it is set up"),
        (STORE, "    rom->flush();\n", "", "cache was not flushed"),
        (STORE, "    read_again();\n", "    (void)read_again;\n", "flash cannot be read"),
        (STORE, 'section(".ram_code"), ', "", "flash cannot be read"),
        (STORE, "    mask = hk_interrupts_off();", "    mask = 0U;", "flash cannot be read"),
        (STORE, "rom->erase(offset,", "rom->erase(offset + 256U,", "must be multiples of 4096"),
        (STORE, "rom->erase(offset,", "rom->erase(0U * offset,", "erases 0x0 .*not in its store"),
        (STORE, "bytes, HK_PAGE_BYTES);", "bytes, 128U);", "programs 128 bytes .*of 256"),
        (STORE, "change(page);", "change((const uint8_t *)0x10000000U);", "flash cannot be read"),
        ("hk_boot2_rp2040.S", "    beq  start\n", "    b    start\n", "jumped to its start"),
    ],
    ids=["connect", "leave", "flush", "again", "in-flash", "interrupts", "sector", "code", "page",
         "source", "loader"],
)  # fmt: skip
def test_faulty_firmware_is_stopped(
    writer: Path, tmp_path: Path, file: str, old: str, new: str, reason: str
) -> None:
    folder = rebuilt(writer, tmp_path / "code", file, old, new)
    with pytest.raises(EmulationError, match=rf"board\.mjs failed .*{reason}"):
        run(folder)


def test_programming_without_an_erase_only_clears_bits(writer: Path, tmp_path: Path) -> None:
    folder = rebuilt(
        writer, tmp_path / "code", "main.c", "hk_hal_store_erase(slot);", "hk_hal_store_erase(0U);"
    )
    changed(folder / STORE, "change_flash(&rom, offset_of(slot_in_work), bytes);",
            "change_flash(&rom, offset_of(bytes == 0 ? 0U : 1U), bytes);")  # fmt: skip
    rp2040_board.build(folder)
    old = b"\x0f" * SLOT
    heard = run(folder, b"\xff" * SECTOR + old.ljust(SECTOR, b"\xff"))
    assert heard.store[SECTOR : SECTOR + SLOT] == bytes(
        a & b for a, b in zip(old, NEW, strict=True)
    )


# --- In the midst of sampling --------------------------------------------------------------------

SAVES = """
        if (!saved && hk_hal_time_us() > 800000U) {
            saved = true;
            hk_hal_store_erase(0U);
            hk_hal_store_put(0x42U);
            hk_hal_store_finish();
        }
"""


def saving(folder: Path, code: FilterDesign) -> Path:
    """The application, which changes the store once, 0.8 s after it has started."""
    generated("rp2040", folder, code)
    changed(folder / "main.c", "    for (;;) {\n", "    for (;;) {" + SAVES)
    changed(folder / "main.c", "    static hk_app_t app;\n",
            "    static hk_app_t app;\n    bool saved = false;\n")  # fmt: skip
    rp2040_board.build(folder)
    return folder


@pytest.mark.parametrize(
    ("rate_hz", "gap_rows", "restarts"), [(50.0, 3, 0), (100.0, 5, 1), (500.0, 24, 1)]
)
def test_a_change_of_the_store_costs_samples_and_no_more(
    tmp_path: Path, rate_hz: float, gap_rows: int, restarts: int
) -> None:
    require_or_skip(*PICO_TOOLS)
    code = design(rate_hz=rate_hz)
    feels = stimulus(round(2 * rate_hz), code)
    done = rp2040_board.run(saving(tmp_path / "code", code), feels)
    heard = hear(done)
    rows = {tuple(row): i for i, row in enumerate(expected_counts(feels, code).accel.tolist())}
    played = [rows[tuple(sample.accel)] for sample in heard.samples]
    assert done.store[:2] == b"\x42\xff"
    (gap,) = (b - a for a, b in pairwise(played) if b - a != 1)
    assert gap_rows - 1 <= gap <= gap_rows
    assert (played[0], played[-1]) == (0, len(feels) - 1)
    assert sum(sample.flags & RESTARTED for sample in heard.samples) == 1 + restarts
    assert [text.text for text in heard.of("STATUSTEXT")] == []
    assert "resets" not in dict(done.faults)


def test_the_application_starts_anew_after_the_supply_has_failed(tmp_path: Path) -> None:
    require_or_skip(*PICO_TOOLS)
    feels = replace(stimulus(300), power_cut_after=1)
    done = rp2040_board.run(saving(tmp_path / "code", design()), feels)
    sequences = [sample.sequence for sample in hear(done).samples]
    begins = [i for i, sequence in enumerate(sequences) if sequence == 0]
    assert dict(done.faults)["resets"] == 1
    assert len(begins) == 2
    assert sequences == [*range(begins[1]), *range(len(sequences) - begins[1])]
    assert begins[1] < 80 < len(sequences) - begins[1]
    assert done.store[:2] == b"\x42\xff"


LATE = """
    while (hk_hal_time_us() < 1480000U) {
        hk_hal_idle();
    }
"""


def test_a_change_begins_with_a_fed_watchdog(writer: Path, tmp_path: Path) -> None:
    begin = "    if (first != 0x80U) {"
    folder = rebuilt(writer, tmp_path / "code", "main.c", begin, LATE + begin)
    assert "resets" not in dict(run(folder).faults)
