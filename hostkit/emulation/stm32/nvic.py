"""Interrupts: which are enabled and who asks for them, and the core's control block."""

from collections.abc import Callable
from typing import Protocol

from hostkit.emulation.stm32.core import Core
from hostkit.errors import EmulationError

ISER, ISER_END = 0x100, 0x108
AIRCR, CCR = 0x10C, 0x114
RESET_KEY, RESET_REQUEST = 0x05FA, 1 << 2


class Requester(Protocol):
    """A peripheral that can ask for an interrupt."""

    @property
    def request(self) -> bool:
        """Whether it asks."""


class Nvic:
    """The interrupt controller: enabled interrupts, and who asks for one."""

    def __init__(self, core: Core, lines: dict[int, Requester]) -> None:
        self._core = core
        self._interrupts = core.state.interrupts
        self._lines = tuple((1 << number, requester) for number, requester in lines.items())

    @property
    def wakes(self) -> bool:
        """Whether an interrupt ends a sleep; PRIMASK does not prevent that."""
        return bool(self._interrupts.pending & self._interrupts.enabled)

    def update(self) -> None:
        """Look at the requests. One that has been seen stays pending until it is entered."""
        requests = 0
        for bit, requester in self._lines:
            if requester.request:
                requests |= bit
        if requests != self._interrupts.requests:
            self._interrupts.requests = requests
            self._core.update()

    def read(self, offset: int) -> int:
        """Return a register."""
        if ISER <= offset < ISER_END:
            return self._interrupts.enabled >> 8 * (offset - ISER) & 0xFFFFFFFF
        raise EmulationError(f"the NVIC has no register at {offset:#x} in the model")

    def write(self, offset: int, value: int) -> None:
        """Write a register."""
        if not ISER <= offset < ISER_END:
            raise EmulationError(f"the NVIC has no register at {offset:#x} in the model")
        self._interrupts.enabled |= value << 8 * (offset - ISER)
        self._core.update()


class ControlBlock:
    """The core's control block: configuration, and the reset on request.

    Parameters
    ----------
    request_reset
        Called when the program asks for a reset.
    """

    def __init__(self, core: Core, request_reset: Callable[[], None]) -> None:
        self._interrupts = core.state.interrupts
        self._request_reset = request_reset

    def read(self, offset: int) -> int:
        """Return a register."""
        if offset == CCR:
            return self._interrupts.configuration
        raise EmulationError(f"the core has no register at {offset:#x} in the model")

    def write(self, offset: int, value: int) -> None:
        """Write a register."""
        if offset == CCR:
            self._interrupts.configuration = value
        elif offset == AIRCR and value >> 16 == RESET_KEY and value & RESET_REQUEST:
            self._request_reset()
        else:
            raise EmulationError(f"the core has no register at {offset:#x} in the model")
