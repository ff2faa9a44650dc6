"""The core and its memory: loading an image, counting instructions, measuring the stack."""

import re
import struct
from dataclasses import dataclass

from unicorn import UC_ARCH_ARM, UC_MODE_MCLASS, UC_MODE_THUMB, UC_PROT_EXEC, UC_PROT_READ, Uc
from unicorn import arm_const as arm

from hostkit.errors import EmulationError

FLASH_START, FLASH_BYTES = 0x08000000, 64 * 1024
RAM_START, RAM_BYTES = 0x20000000, 20 * 1024
PAINT = 0xC5
VECTORS_BYTES = 8
ERASED = b"\xff"
LONG_INSTRUCTION = 0xE800
"""Halfwords from here on begin an instruction of 32 bits (DDI 0403, A5.1)."""


def load(image: bytes) -> Uc:
    """Return a Cortex-M3 that stands before its first instruction.

    Raises
    ------
    EmulationError
        If the image does not fit the flash.
    """
    if not VECTORS_BYTES <= len(image) <= FLASH_BYTES:
        raise EmulationError(
            f"the image has {len(image)} bytes; it must have {VECTORS_BYTES} to {FLASH_BYTES}"
        )
    uc = Uc(UC_ARCH_ARM, UC_MODE_THUMB | UC_MODE_MCLASS)
    uc.ctl_set_cpu_model(arm.UC_CPU_ARM_CORTEX_M3)
    uc.mem_map(FLASH_START, FLASH_BYTES, UC_PROT_READ | UC_PROT_EXEC)
    uc.mem_write(FLASH_START, image.ljust(FLASH_BYTES, ERASED))
    uc.mem_map(RAM_START, RAM_BYTES)
    uc.mem_write(RAM_START, bytes([PAINT]) * RAM_BYTES)
    stack, reset = struct.unpack_from("<2I", image)
    uc.reg_write(arm.UC_ARM_REG_SP, stack)
    uc.reg_write(arm.UC_ARM_REG_PC, reset)
    return uc


def stack_bytes(uc: Uc) -> int:
    """Return how much stack has been used: all above the longest run of paint that is left."""
    ram = bytes(uc.mem_read(RAM_START, RAM_BYTES))
    runs = re.finditer(rb"\x%02x+" % PAINT, ram)
    longest = max(runs, key=lambda run: run.end() - run.start(), default=None)
    return RAM_BYTES - (longest.end() if longest else 0)


class BlockLengths(dict[tuple[int, int], int]):
    """Number of instructions of a block of code, by address and size in bytes."""

    def __init__(self, image: bytes) -> None:
        super().__init__()
        self._image = image

    def __missing__(self, block: tuple[int, int]) -> int:
        """Count them, and remember."""
        address, size = block
        start = address - FLASH_START
        if not 0 <= start <= len(self._image) - size:
            raise EmulationError(f"the firmware runs at {address:#010x}, where it has no code")
        words = struct.unpack_from(f"<{size // 2}H", self._image, start)
        count = place = 0
        while place < len(words):
            place += 2 if words[place] >= LONG_INSTRUCTION else 1
            count += 1
        self[block] = count
        return count


@dataclass(slots=True)
class Segments:
    """Instructions between the marks: number of segments, sum and largest."""

    count: int = 0
    total: int = 0
    largest: int = 0

    def add(self, instructions: int) -> None:
        """Take note of one segment."""
        self.count += 1
        self.total += instructions
        self.largest = max(self.largest, instructions)

    @property
    def mean(self) -> float | None:
        """Mean length, or None if there was no segment."""
        return self.total / self.count if self.count else None
