"""What a target is: where its code comes from and what its link and clock can do."""

from dataclasses import dataclass
from typing import Literal

from hostkit.targets.board import Board
from hostkit.targets.clocking import ClockMaker
from hostkit.targets.uart import FixedRates, UartClock


@dataclass(frozen=True, slots=True, kw_only=True)
class Target:
    """A place where generated code runs.

    Attributes
    ----------
    kind
        ``mcu`` for C with a MAVLink telemetry link, ``fpga`` for VHDL.
    folders
        Template folders below ``firmware_templates`` or ``hdl_templates``, next to the folder of
        the filter, whose files make up the output.
    clock_hz
        Clock of the processor, or 0 where there is none to set; of an FPGA the one that it makes
        if no other is asked for.
    baud
        Rate of the telemetry link if no other is asked for, bit/s.
    uart
        How the port of that link makes a rate; None where nothing is divided.
    flash_bytes, loader_bytes
        What a linker may fill of a microcontroller's flash, and how much of that a boot loader
        takes; 0 where the firmware is a program like others.
    arduino
        Whether the Arduino IDE can build the code, so that it gets a sketch.
    boards
        For an FPGA: the boards that the top is made for; the first one's oscillator is assumed.
    clock_maker
        For an FPGA: how it makes its clock from the oscillator.
    family
        For an FPGA: name of its family in :mod:`hostkit.synthesis`.
    """

    name: str
    title: str
    kind: Literal["mcu", "fpga"]
    folders: tuple[str, ...]
    clock_hz: int = 0
    baud: int = 0
    uart: UartClock | FixedRates | None = None
    flash_bytes: int = 0
    loader_bytes: int = 0
    arduino: bool = False
    boards: tuple[Board, ...] = ()
    clock_maker: ClockMaker | None = None
    family: str = ""
