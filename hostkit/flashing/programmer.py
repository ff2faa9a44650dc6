"""Programs that load firmware: for which target, with which command, and how to get them."""

import shutil
from dataclasses import dataclass
from typing import Literal

PortUse = Literal["serial", "drive", "optional", "none"]
PORT = "{port}"
"""Stands in a command for the port."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Programmer:
    """One way to load a target's image.

    Attributes
    ----------
    program
        What must be installed; empty for a way that needs nothing.
    command
        The command, run in the generated folder; ``{port}`` is the port. `port_option` stands
        after it if there is a port that need not be given.
    port_use
        Whether the port is a serial port that must be named, a mounted drive, one that may be
        named, or not used.
    image
        What is loaded; empty if the program builds it by itself.
    hint
        How to get the program.
    by_name_only
        Whether it is taken only if it is asked for: it fetches compilers of its own.
    """

    name: str
    target: str
    program: str
    command: tuple[str, ...]
    hint: str
    image: str = ""
    port_use: PortUse = "none"
    port_option: tuple[str, ...] = ()
    by_name_only: bool = False

    @property
    def installed(self) -> bool:
        """Whether the program is there; a way that needs none always is."""
        return not self.program or shutil.which(self.program) is not None

    def command_for(self, port: str | None) -> tuple[str, ...]:
        """Return the command with the port put in."""
        words = self.command if port is None else (*self.command, *self.port_option)
        return tuple(word.replace(PORT, port or "") for word in words)


def _pio(target: str) -> Programmer:
    return Programmer(
        name="pio",
        target=target,
        program="pio",
        command=("pio", "run", "-t", "upload"),
        hint="pip install platformio",
        port_use="optional",
        port_option=("--upload-port", PORT),
        by_name_only=True,
    )


def _openocd(target: str, interface: str, chip: str) -> Programmer:
    files = ("-f", f"interface/{interface}.cfg", "-f", f"target/{chip}.cfg")
    return Programmer(
        name="openocd",
        target=target,
        program="openocd",
        command=("openocd", *files, "-c", "program firmware.elf verify reset exit"),
        hint="sudo apt-get install openocd",
        image="firmware.elf",
    )


PROGRAMMERS = (
    Programmer(
        name="avrdude",
        target="atmega328p",
        program="avrdude",
        command=(
            *("avrdude", "-p", "atmega328p", "-c", "arduino", "-P", PORT, "-b", "{boot_baud}"),
            *("-D", "-U", "flash:w:firmware.hex:i"),
        ),
        hint="sudo apt-get install avrdude",
        image="firmware.hex",
        port_use="serial",
    ),
    _pio("atmega328p"),
    Programmer(
        name="picotool",
        target="rp2040",
        program="picotool",
        command=("picotool", "load", "-v", "-x", "firmware.uf2"),
        hint="build it from github.com/raspberrypi/picotool",
        image="firmware.uf2",
    ),
    Programmer(
        name="uf2",
        target="rp2040",
        program="",
        command=("cp", "firmware.uf2", PORT),
        hint="hold BOOTSEL while plugging the Pico in",
        image="firmware.uf2",
        port_use="drive",
    ),
    _openocd("rp2040", "cmsis-dap", "rp2040"),
    _pio("rp2040"),
    Programmer(
        name="st-flash",
        target="stm32f103",
        program="st-flash",
        command=("st-flash", "--reset", "write", "firmware.bin", "0x08000000"),
        hint="sudo apt-get install stlink-tools",
        image="firmware.bin",
    ),
    _openocd("stm32f103", "stlink", "stm32f1x"),
    _pio("stm32f103"),
)
"""Every way, for each target in the order in which they are tried."""
