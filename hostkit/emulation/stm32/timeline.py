"""Simulated time, and what a peripheral is."""

import ctypes
from typing import Protocol

from hostkit.emulation.virtual_sensor import NEVER as NEVER_NS
from hostkit.errors import EmulationError

TICK_HZ = 72_000_000
"""Time is counted in periods of the fastest clock."""
NS_PER_9_TICKS = 125
NEVER = 2**63
"""Tick of an event that does not come."""


class Timeline(ctypes.Structure):
    """The time, which the inner loop moves and the peripherals read; all in ticks.

    Attributes
    ----------
    now
        Time since the start.
    ticks_per_instruction
        What an instruction takes: one clock of the core.
    until
        How far to run.
    wake
        When something may happen.
    stalled_until
        No instruction can be fetched before.
    """

    now: int
    ticks_per_instruction: int
    until: int
    wake: int
    stalled_until: int
    _fields_ = [
        ("now", ctypes.c_uint64),
        ("ticks_per_instruction", ctypes.c_uint64),
        ("until", ctypes.c_uint64),
        ("wake", ctypes.c_uint64),
        ("stalled_until", ctypes.c_uint64),
    ]

    @property
    def now_ns(self) -> int:
        """Nanoseconds since the start, rounded down."""
        return self.now * NS_PER_9_TICKS // 9

    @property
    def now_s(self) -> float:
        """Seconds since the start."""
        return self.now / TICK_HZ


class BusError(EmulationError):
    """An access that the bus refuses; the core takes it for a fault of the program."""


def tick_at(time_ns: int) -> int:
    """Return the first tick that is not before a time of the virtual sensor."""
    return NEVER if time_ns == NEVER_NS else -(-time_ns * 9 // NS_PER_9_TICKS)


class Device(Protocol):
    """Something that changes by itself.

    Attributes
    ----------
    due
        Tick at which it does so next, or :data:`NEVER`.
    """

    due: int

    def happen(self) -> None:
        """Do what is due; the time is that of the timeline, at or shortly after `due`."""


class Peripheral(Protocol):
    """A block of registers, addressed by their offsets."""

    def read(self, offset: int) -> int:
        """Return a register, with the side effects of reading it."""

    def write(self, offset: int, value: int) -> None:
        """Write a register."""
