"""The image of the RP2040: what its boot ROM and its processor expect to find in the flash."""

import re
import struct
import subprocess
import zlib
from pathlib import Path

import pytest
from boards import PICO_TOOLS, changed, copied, generated, require_or_skip, stimulus
from designs import all_parameters, design

from hostkit.emulation import rp2040_board, tools
from hostkit.emulation.make import make
from hostkit.errors import BuildError
from hostkit.records import FilterDesign

FLASH_LIMIT, RAM_LIMIT = 26 * 1024, 2048
FLASH_START, STORE_START, RAM_START, RAM_END = 0x10000000, 0x101FE000, 0x20000000, 0x20042000


def test_image_is_small(pico_folder: Path) -> None:
    built = rp2040_board.build(pico_folder)
    assert built.artifact.name == "firmware.uf2"
    assert built.flash_bytes == (pico_folder / "firmware.bin").stat().st_size
    assert 4000 < built.flash_bytes < FLASH_LIMIT
    assert built.ram_bytes is not None
    assert 300 < built.ram_bytes < RAM_LIMIT


def test_uf2_holds_the_image_for_an_rp2040(pico_folder: Path) -> None:
    image = (pico_folder / "firmware.bin").read_bytes()
    file = (pico_folder / "firmware.uf2").read_bytes()
    blocks = [file[i : i + 512] for i in range(0, len(file), 512)]
    heads = [struct.unpack("<8I", block[:32]) for block in blocks]
    assert heads == [
        (0x0A324655, 0x9E5D5157, 0x2000, FLASH_START + 256 * i, 256, i, len(blocks), 0xE48BFF56)
        for i in range(-(-len(image) // 256))
    ]
    assert {block[-4:] for block in blocks} == {struct.pack("<I", 0x0AB16F30)}
    payload = b"".join(block[32 : 32 + 256] for block in blocks)
    assert payload == image.ljust(len(payload), b"\0")


def boot_rom_crc(loader: bytes) -> int:
    """CRC-32 that takes the highest bit first: zlib's, with all bits the other way round."""

    def mirrored(value: int, bits: int) -> int:
        return int(f"{value:0{bits}b}"[::-1], 2)

    reflected = zlib.crc32(bytes(mirrored(byte, 8) for byte in loader))
    return mirrored(reflected ^ 0xFFFFFFFF, 32)


def test_the_loader_has_the_checksum_of_the_boot_rom(pico_folder: Path) -> None:
    assert boot_rom_crc(b"123456789") == 0x0376E6E7  # the check value of CRC-32/MPEG-2
    image = (pico_folder / "firmware.bin").read_bytes()
    assert struct.unpack("<I", image[252:256]) == (boot_rom_crc(image[:252]),)


def printed(*command: str) -> str:
    done = subprocess.run(command, capture_output=True, text=True, check=True, timeout=20)
    return done.stdout


def symbols_of(folder: Path) -> dict[str, int]:
    lines = printed("arm-none-eabi-nm", str(folder / "firmware.elf")).splitlines()
    return {name: int(value, 16) for value, _, name in map(str.split, lines)}


def test_every_vector_points_into_the_code(pico_folder: Path) -> None:
    image = (pico_folder / "firmware.bin").read_bytes()
    stack, *vectors = struct.unpack("<43I", image[256 : 256 + 4 * (1 + 16 + 26)])[:42]
    assert stack == RAM_END
    assert all(FLASH_START + 256 < v < FLASH_START + len(image) and v & 1 for v in vectors)
    symbols = symbols_of(pico_folder)
    named = {0: "hk_reset", 15: "hk_irq_timer_0", 28: "hk_irq_io_bank0", 35: "hk_irq_uart0"}
    for i, vector in enumerate(vectors):
        assert vector - 1 == symbols[named.get(i, "hk_trap")], i


STORES = """
#include "hk_hal.h"
int main(void)
{
    hk_hal_init();
    hk_hal_store_erase(1U);
    hk_hal_store_put(1U);
    hk_hal_store_finish();
    for (;;) {
    }
}
"""


def code_in_ram(folder: Path) -> tuple[int, int, list[str]]:
    """Where it begins and ends, and its instructions: address, words and text of each."""
    symbols = symbols_of(folder)
    begin, end = symbols["hk_ram_code_start"], symbols["hk_data_end"]
    listed = printed(
        "arm-none-eabi-objdump", "-D", "-z", "-j", ".data", f"--start-address={begin:#x}",
        f"--stop-address={end:#x}", str(folder / "firmware.elf"),
    )  # fmt: skip
    return begin, end, [x.strip() for x in listed.splitlines() if re.match(r"\s*[0-9a-f]+:\t", x)]


def test_what_changes_the_flash_runs_in_ram_and_calls_nothing_in_the_flash(
    pico_folder: Path, tmp_path: Path
) -> None:
    folder = copied(pico_folder, tmp_path / "code")
    (folder / "main.c").write_text(STORES, encoding="ascii")
    rp2040_board.build(folder)
    begin, end, lines = code_in_ram(folder)
    assert RAM_START <= begin < end < RAM_END
    assert symbols_of(folder)["change_flash"] == begin
    assert len(lines) > 20
    assert sum("blx" in line for line in lines) == 6  # ROM functions and the loader, by pointer
    for line in lines:
        address, _, rest = line.partition(":\t")
        words, _, text = rest.partition("\t")
        jump = re.match(r"b\S*\s+([0-9a-f]{8})\b", text)
        assert jump is None or begin <= int(jump.group(1), 16) < end, line
        if len(words.strip()) == 8:  # a constant
            assert not FLASH_START <= int(words, 16) < STORE_START + 0x2000, line
        assert begin <= int(address, 16) < end


def test_an_image_leaves_the_store_alone(pico_folder: Path, tmp_path: Path) -> None:
    folder = copied(pico_folder, tmp_path / "code")
    assert symbols_of(pico_folder)["hk_store_start"] == STORE_START
    room = STORE_START - FLASH_START - (pico_folder / "firmware.bin").stat().st_size
    source = (folder / "main.c").read_text(encoding="ascii")
    source = source.replace(
        "    hk_hal_init();\n", "    hk_hal_init();\n    (void)*(const volatile char *)filler;\n"
    )
    filler = "static const char filler[{}] = {{1}};\nint main(void)\n"
    for count, fits in ((room - 64, True), (room + 64, False)):
        text = source.replace("int main(void)\n", filler.format(count))
        (folder / "main.c").write_text(text, encoding="ascii")
        if fits:
            assert rp2040_board.build(folder).flash_bytes == pytest.approx(
                STORE_START - FLASH_START, abs=128
            )
        else:
            with pytest.raises(BuildError, match=r"will not fit|overflowed"):
                rp2040_board.build(folder)


def test_the_board_layer_compiles_without_a_warning_of_clang(pico_folder: Path) -> None:
    require_or_skip("clang")
    for source in sorted(pico_folder.glob("hk_*_rp2040.c")):
        done = subprocess.run(
            ["clang", "--target=arm-none-eabi", "-mcpu=cortex-m0plus", "-std=c99", "-ffreestanding",
             "-DHK_CLOCK_HZ=125000000", "-Wall", "-Wextra", "-Wpedantic", "-Wshadow",
             "-Wconversion", "-Wdouble-promotion", "-Wstrict-prototypes", "-Wmissing-prototypes",
             "-Werror", "-fsyntax-only", str(source)],
            capture_output=True, text=True, timeout=60, check=False,
        )  # fmt: skip
        assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("code", [design(), all_parameters()], ids=["eta", "all"])
def test_image_builds_without_a_warning(tmp_path: Path, code: FilterDesign) -> None:
    require_or_skip(*PICO_TOOLS)
    make(generated("rp2040", tmp_path / "code", code), "WERROR=1")


def test_the_clock_of_the_target_is_checked_in_the_code(pico_folder: Path, tmp_path: Path) -> None:
    folder = copied(pico_folder, tmp_path / "code")
    changed(folder / "Makefile", "HZ=125000000", "HZ=133000000")
    with pytest.raises(BuildError, match="125 MHz"):
        rp2040_board.build(folder)


def test_code_that_was_not_built_cannot_run(pico_folder: Path, tmp_path: Path) -> None:
    with pytest.raises(BuildError, match="has not been built yet"):
        rp2040_board.run(copied(pico_folder, tmp_path / "code"), stimulus(3))


def test_the_emulator_is_asked_for_by_a_minimum_version_only() -> None:
    text = (tools.NODE_FOLDERS / "rp2040js" / "package.json").read_text(encoding="ascii")
    assert re.search(r'"rp2040js": ">=\d+\.\d+\.\d+"', text)
