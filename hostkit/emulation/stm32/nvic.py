"""Interrupts: which are pending, and how the core enters and leaves them.

Unicorn runs instructions only; entry and return are done here as the ARMv7-M manual (DDI 0403)
describes them in B1.5.6 and B1.5.8, for one stack and one priority.
"""

import struct
from typing import Protocol

from unicorn import Uc
from unicorn import arm_const as arm

from hostkit.errors import EmulationError

ISER, ISER_END, AIRCR, CCR = 0x100, 0x108, 0xD0C, 0xD14
RESET_KEY, RESET_REQUEST = 0x05FA, 1 << 2
STKALIGN = 1 << 9
FIRST_INTERRUPT = 16
RETURN_TO_THREAD = 0xFFFFFFF9
FRAME_BYTES = 32
XPSR_ALIGNED = 1 << 9
THUMB = 1
FRAME = (
    arm.UC_ARM_REG_R0,
    arm.UC_ARM_REG_R1,
    arm.UC_ARM_REG_R2,
    arm.UC_ARM_REG_R3,
    arm.UC_ARM_REG_R12,
    arm.UC_ARM_REG_LR,
    arm.UC_ARM_REG_PC,
    arm.UC_ARM_REG_XPSR,
)


class Requester(Protocol):
    """A peripheral that can ask for an interrupt."""

    @property
    def request(self) -> bool:
        """Whether it asks."""


class Nvic:
    """Enabled, pending and active interrupts, and the registers of the core's control block.

    Attributes
    ----------
    ready
        Whether an interrupt is pending and enabled while none is active.
    """

    def __init__(self, uc: Uc, vectors: int, lines: dict[int, Requester]) -> None:
        self._uc = uc
        self._vectors = vectors
        self._lines = tuple(lines.items())
        self._enabled = 0
        self._pending = 0
        self._active: int | None = None
        self._ccr = 0
        self.ready = False

    @property
    def wakes(self) -> bool:
        """Whether an interrupt ends a sleep; PRIMASK does not prevent that."""
        return bool(self._pending & self._enabled)

    def update(self) -> None:
        """Look at the requests. One that has been seen stays pending until it is entered."""
        for number, requester in self._lines:
            if number != self._active and requester.request:
                self._pending |= 1 << number
        self.ready = self._active is None and bool(self._pending & self._enabled)

    def read(self, offset: int) -> int:
        """Return a register."""
        if ISER <= offset < ISER_END:
            return self._enabled >> 8 * (offset - ISER) & 0xFFFFFFFF
        if offset == CCR:
            return self._ccr
        raise EmulationError(f"the core has no register at {offset:#x} in the model")

    def write(self, offset: int, value: int) -> None:
        """Write a register."""
        if ISER <= offset < ISER_END:
            self._enabled |= value << 8 * (offset - ISER)
        elif offset == CCR:
            self._ccr = value
        elif offset == AIRCR and value >> 16 == RESET_KEY and value & RESET_REQUEST:
            raise EmulationError("the firmware resets itself, as it does after a fault")
        else:
            raise EmulationError(f"the core has no register at {offset:#x} in the model")

    def enter(self) -> None:
        """Enter the pending interrupt of the lowest number: push the frame, go to the handler."""
        waiting = self._pending & self._enabled
        number = (waiting & -waiting).bit_length() - 1
        self._pending &= ~(1 << number)
        self._active = number
        self.ready = False
        uc = self._uc
        values = list(uc.reg_read_batch(FRAME))
        stack = uc.reg_read(arm.UC_ARM_REG_SP)
        if self._ccr & STKALIGN and stack & 4:
            stack -= 4
            values[7] |= XPSR_ALIGNED
        stack -= FRAME_BYTES
        uc.mem_write(stack, struct.pack("<8I", *values))
        uc.reg_write(arm.UC_ARM_REG_SP, stack)
        uc.reg_write(arm.UC_ARM_REG_LR, RETURN_TO_THREAD)
        uc.reg_write(arm.UC_ARM_REG_IPSR, FIRST_INTERRUPT + number)
        uc.reg_write(arm.UC_ARM_REG_PC, self._handler(number))

    def leave(self, target: int) -> None:
        """Return from the handler: pop the frame.

        Raises
        ------
        EmulationError
            If the return value is not that of the thread on the main stack.
        """
        if target | THUMB != RETURN_TO_THREAD or self._active is None:
            raise EmulationError(f"an interrupt returns to {target:#x}, which is not modelled")
        uc = self._uc
        stack = uc.reg_read(arm.UC_ARM_REG_SP)
        values = struct.unpack("<8I", uc.mem_read(stack, FRAME_BYTES))
        stack += FRAME_BYTES + (4 if values[7] & XPSR_ALIGNED else 0)
        uc.reg_write(arm.UC_ARM_REG_XPSR, values[7] & ~XPSR_ALIGNED)
        for register, value in zip(FRAME[:6], values[:6], strict=True):
            uc.reg_write(register, value)
        uc.reg_write(arm.UC_ARM_REG_SP, stack)
        uc.reg_write(arm.UC_ARM_REG_PC, values[6] | THUMB)
        self._active = None
        self.update()

    def _handler(self, number: int) -> int:
        place = self._vectors + 4 * (FIRST_INTERRUPT + number)
        handler: int = struct.unpack("<I", self._uc.mem_read(place, 4))[0]
        return handler
