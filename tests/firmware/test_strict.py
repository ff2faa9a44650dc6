import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest
from boards import generated, require_or_skip
from designs import all_parameters, design

from hostkit.emulation.make import make
from hostkit.records import FilterDesign

WARNINGS = (
    "-Wall",
    "-Wextra",
    "-Wpedantic",
    "-Wshadow",
    "-Wconversion",
    "-Wdouble-promotion",
    "-Werror",
)
BOARD_CODE = ("main.c", "hk_hal_host.c", "hk_host_link.c", "hk_host_store.c")


@pytest.mark.parametrize("compiler", ["gcc", "clang"])
@pytest.mark.parametrize("standard", ["c99", "gnu11"])
@pytest.mark.parametrize("axes", ["both", "roll", "pitch"])
@pytest.mark.parametrize("made", [design, all_parameters])
def test_compiles_without_a_warning(
    tmp_path: Path, compiler: str, standard: str, axes: str, made: Callable[..., FilterDesign]
) -> None:
    require_or_skip(compiler)
    folder = generated("host", tmp_path / "code", made(axes=axes))
    for source in sorted(folder.glob("*.c")):
        posix = ("-D_POSIX_C_SOURCE=200809L",) if source.name in BOARD_CODE else ()
        command = [
            compiler,
            f"-std={standard}",
            *WARNINGS,
            *posix,
            "-fsyntax-only",
            "-isystem",
            str(folder / "mavlink"),
            str(source),
        ]
        done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
        assert done.returncode == 0, done.stderr


@pytest.mark.parametrize(
    ("target", "tool"),
    [
        ("host", "gcc"),
        ("atmega328p", "avr-gcc"),
        ("rp2040", "arm-none-eabi-gcc"),
        ("stm32f103", "arm-none-eabi-gcc"),
    ],
)
@pytest.mark.parametrize("code", [design(), all_parameters()], ids=["eta", "all"])
def test_makefile_builds_without_a_warning(
    tmp_path: Path, target: str, tool: str, code: FilterDesign
) -> None:
    require_or_skip("make", tool)
    make(generated(target, tmp_path / "code", code), "WERROR=1")


@pytest.mark.parametrize("made", [design, all_parameters])
def test_the_filter_needs_no_arithmetic_of_64_bits(
    tmp_path: Path, made: Callable[..., FilterDesign]
) -> None:
    """The AVR's compiler calls a helper for each: none is asked for by the filter's objects."""
    require_or_skip("make", "avr-gcc")
    folder = generated("atmega328p", tmp_path / "code", made())
    make(folder)
    for name in ("hk_filter", "hk_arctan"):
        listed = subprocess.run(
            ["avr-nm", "-u", str(next(folder.rglob(f"{name}.o")))],
            capture_output=True,
            text=True,
            check=True,
            timeout=20,
        ).stdout.split()
        assert name == "hk_arctan" or any("hisi3" in symbol for symbol in listed)
        assert not [symbol for symbol in listed if "di3" in symbol or "di2" in symbol], name


def test_application_allocates_nothing_and_keeps_its_state_in_one_struct(tmp_path: Path) -> None:
    """The portable objects have no writable data and call no allocator."""
    require_or_skip("gcc")
    folder = generated("host", tmp_path / "code")
    for source in sorted(folder.glob("hk_*.c")):
        if source.name in BOARD_CODE:
            continue
        output = tmp_path / f"{source.stem}.o"
        subprocess.run(
            [
                "gcc",
                "-O2",
                "-c",
                "-isystem",
                str(folder / "mavlink"),
                "-o",
                str(output),
                str(source),
            ],
            check=True,
            timeout=60,
        )
        symbols = subprocess.run(
            ["nm", str(output)], capture_output=True, text=True, check=True, timeout=20
        ).stdout.splitlines()
        kinds = {line.split()[-1]: line.split()[-2] for line in symbols}
        assert not {name for name, kind in kinds.items() if kind in "bBdDC"}, source.name
        assert not {"malloc", "calloc", "realloc", "free"} & set(kinds), source.name
