"""Cppcheck, with its MISRA add-on, over the C of every target.

The gate is a chosen part of MISRA C:2012, not all of it: the firmware does not claim MISRA.
"""

import re
import subprocess
from pathlib import Path

import pytest
from boards import changed, generated, program_or_skip
from designs import all_parameters

from hostkit.render import generate, write
from hostkit.render.options import FirmwareOptions
from hostkit.targets import TARGETS

FLOAT_FROM_FIFO = FirmwareOptions(arithmetic="float", acquisition="fifo", signing=True)

LEFT_OUT = {
    "2.2": "cppcheck takes a factor of -1 or 1 for an operation without effect",
    "2.3": "type names of assertions at compile time are not used again",
    "2.4": "as 2.3, of enumerations without a name",
    "2.5": "a header of registers lists more than one design uses",
    "2.7": "cppcheck does not look into assembly; -Wunused-parameter does",
    "5.7": "as 2.4",
    "5.9": "each module names its local helpers by itself",
    "7.2": "registers are written as they stand in the manuals",
    "8.6": "cppcheck looks at every main at once",
    "8.7": "board layers share functions that one configuration uses once",
    "8.9": "constant tables stand above the function, for the reader",
    "8.11": "symbols of the linker script have no size",
    "10.1": "the integer model shifts signed numbers arithmetically, which is asserted",
    "10.3": "as 10.4",
    "10.4": "cppcheck mixes up small unsigned types and their promotion",
    "10.6": "as 10.4",
    "10.7": "as 10.4",
    "10.8": "products are widened on purpose, and -Wconversion watches the rest",
    "9.2": "cppcheck asks a text for braces",
    "11.4": "addresses of registers are integers",
    "11.5": "as 11.4",
    "11.8": "cppcheck takes a pointer within a constant struct for a constant one",
    "11.9": "cppcheck takes 0 in a struct for a pointer",
    "12.1": "the usual precedence of C is assumed to be known",
    "13.3": "walks over bytes step their pointer where they use it",
    "14.1": "a float is halved and doubled without loss",
    "14.2": "loops of the start-up code go over addresses",
    "15.4": "as 15.5",
    "15.5": "refusals leave a function early",
    "15.7": "as 15.5",
    "16.4": "switches over an enumeration list it whole, and -Wswitch watches that",
    "17.8": "a parameter by value is a variable",
    "18.4": "walks over bytes",
    "18.8": "cppcheck takes an assertion of a size for an array of variable length",
    "20.10": "X macros make names",
    "20.5": "X macros are taken back",
    "20.7": "parameters of X macros are names",
    "21.15": "records are laid out byte by byte",
    "21.16": "a float is compared bit by bit on purpose",
}
"""Rules that do not gate, and why."""

OTHER_PROGRAMS = re.compile(
    r"^(main|hk_hal_host|hk_host_\w+|\w*_linux\w*|hk_image|hk_virtual_\w+)\.c$"
)
"""Programs of the host, which use the C library; and the virtual sensor, which is no firmware."""

FINDING = re.compile(r"^(?P<file>[^:]+):(?P<line>\d+): (?P<id>[\w.-]+): (?P<text>.*)$")
IGNORED = (
    *("toomanyconfigs", "missingIncludeSystem", "syntaxError"),
    *("variableScope", "comparePointers", "unusedStructMember"),
    *("CastIntegerToAddressAtReturn", "legacyUninitvar"),
)
"""Remarks on cppcheck itself, and on MAVLink's headers, of which it sees a part; and layers of
boards, which compare symbols, place vectors and call what a ROM holds by its address."""


def findings(folder: Path, *, only: re.Pattern[str] = re.compile("")) -> list[str]:
    """Return what gates, one line each; MAVLink's large headers are not looked at."""
    names = sorted(path.name for path in folder.glob("*.c") if only.search(path.name))
    sources = [name for name in names if not OTHER_PROGRAMS.match(name)]
    command = [
        "cppcheck",
        "--quiet",
        "--std=c99",
        "--enable=warning,style,performance,portability",
        "--addon=misra",
        "--suppress=missingIncludeSystem",
        "--template={file}:{line}: {id}: {message}",
        "--max-configs=2",
        "-j2",
        "-I.",
        *sources,
    ]
    done = subprocess.run(
        command, cwd=folder, capture_output=True, text=True, timeout=300, check=False
    )
    found = [match for line in done.stderr.splitlines() if (match := FINDING.match(line))]
    assert sources
    own = [match for match in found if not match["file"].startswith("mavlink/")]
    return sorted({match.group(0) for match in own if gates(match["id"])})


def gates(name: str) -> bool:
    return name not in IGNORED and name.removeprefix("misra-c2012-") not in LEFT_OUT


@pytest.mark.parametrize("options", [FirmwareOptions(), FLOAT_FROM_FIFO], ids=["fixed", "float"])
def test_cppcheck_finds_nothing_in_the_application(
    tmp_path: Path, options: FirmwareOptions
) -> None:
    program_or_skip("cppcheck")
    write(generate(all_parameters(), TARGETS["host"], options), tmp_path)
    assert findings(tmp_path) == []


@pytest.mark.parametrize("target", ["atmega328p", "rp2040", "stm32f103"])
def test_cppcheck_finds_nothing_in_a_board_layer(tmp_path: Path, target: str) -> None:
    program_or_skip("cppcheck")
    layer = re.compile(f"_{target}|hk_start")
    assert findings(generated(target, tmp_path / "code"), only=layer) == []


@pytest.mark.parametrize(
    ("new", "rule"),
    [
        ("if (load) { goto end; } end: filter->primed = 1U;", "misra-c2012-15.1"),
        ("hk_filter_update(filter, accel_count, gyro_count); filter->primed = 1U;", "17.2"),
        ("int32_t never[1]; filter->primed = (uint8_t)never[0];", "uninitvar"),
        ("filter->primed = (uint8_t)tilt[HK_ANGLES];", "arrayIndexOutOfBounds"),
    ],
)
def test_a_breach_is_found(tmp_path: Path, new: str, rule: str) -> None:
    program_or_skip("cppcheck")
    folder = generated("host", tmp_path / "code")
    changed(folder / "hk_filter.c", "filter->primed = 1U;", new)
    assert any(rule in line for line in findings(folder, only=re.compile("hk_filter.c")))
