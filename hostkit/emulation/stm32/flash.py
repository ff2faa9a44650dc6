"""The flash's controller and the two pages that hold the store, after PM0075."""

from collections.abc import Callable

from hostkit.emulation.stm32.clocks import Clocks
from hostkit.emulation.stm32.timeline import NEVER, TICK_HZ, BusError, Timeline
from hostkit.errors import EmulationError

PAGE_BYTES = 1024
STORE_BYTES = 2 * PAGE_BYTES
STORE_START = 0x08010000 - STORE_BYTES
ERASED = 0xFF
ACR, KEYR, SR, CR, AR = 0x00, 0x04, 0x0C, 0x10, 0x14
KEYS = (0x45670123, 0xCDEF89AB)
BSY, PGERR, WRPRTERR, EOP = 1, 1 << 2, 1 << 4, 1 << 5
PG, PER, STRT, LOCK = 1, 1 << 1, 1 << 6, 1 << 7
CR_MODELLED = PG | PER | STRT | LOCK
HALFWORD = 2
ERASE_TICKS = TICK_HZ * 40 // 1000
PROGRAM_TICKS = TICK_HZ * 70 // 1_000_000
"""The longest that the data sheet gives: t_ERASE and t_prog."""
SPOILT = 0xA5A5


class Store:
    """What the last two pages hold, and a supply that may fail while they are written.

    Attributes
    ----------
    data
        The content.
    """

    def __init__(self, initial: bytes, cut_after: int | None) -> None:
        self.data = bytearray(initial[:STORE_BYTES].ljust(STORE_BYTES, bytes([ERASED])))
        self._left = cut_after

    def erase(self, place: int) -> None:
        """Erase the page that a place is in."""
        start = place // PAGE_BYTES * PAGE_BYTES
        self.data[start : start + PAGE_BYTES] = bytes([ERASED]) * PAGE_BYTES

    def program(self, place: int, value: int) -> bool:
        """Write two bytes; return whether the supply fails, once, within them: both are spoilt."""
        if self._left is not None:
            self._left -= HALFWORD
        fails = self._left is not None and self._left < 0
        if fails:
            self._left = None
            value = value | SPOILT if value | SPOILT != value else value ^ 0x0101
        self.data[place : place + HALFWORD] = value.to_bytes(HALFWORD, "little")
        return fails


class Flash:
    """The flash's registers. The core stands still while the flash works.

    Parameters
    ----------
    power_fails
        Called when the supply fails while the store is written.

    Attributes
    ----------
    due
        When what is under way is done.
    """

    def __init__(
        self, time: Timeline, clocks: Clocks, store: Store, power_fails: Callable[[], None]
    ) -> None:
        self._time = time
        self._clocks = clocks
        self._store = store
        self._power_fails = power_fails
        self._acr = 0x30
        self._sr = self._ar = 0
        self._cr = LOCK
        self._keys_given = 0
        self._shut = False
        self.due = NEVER

    def happen(self) -> None:
        """End what is under way."""
        self._sr = self._sr & ~BSY | EOP
        self._cr &= ~STRT
        self.due = NEVER

    # --- registers -------------------------------------------------------------------------------

    def read(self, offset: int) -> int:
        """Return a register."""
        found = {ACR: self._acr, SR: self._sr, CR: self._cr}.get(offset)
        if found is None:
            raise EmulationError(f"FLASH has no register at {offset:#x} to be read in the model")
        return found

    def write(self, offset: int, value: int) -> None:
        """Write a register.

        Raises
        ------
        BusError
            If a key is wrong or comes out of turn: the controller stays locked until a reset.
        """
        if offset == ACR:
            self._acr = value & 0x3F
            self._clocks.set_wait_states(value)
        elif offset == KEYR:
            self._take_key(value)
        elif offset == SR:
            self._sr &= ~(value & (PGERR | WRPRTERR | EOP))
        elif offset == AR:
            self._require_idle("FLASH_AR")
            self._ar = value
        elif offset == CR:
            self._write_control(value)
        else:
            raise EmulationError(f"FLASH has no register at {offset:#x} to write in the model")

    def _take_key(self, value: int) -> None:
        if self._shut or not self._cr & LOCK or value != KEYS[self._keys_given]:
            self._shut = True
            self._cr = LOCK
            raise BusError("FLASH_KEYR gets a wrong key; the flash stays locked until a reset")
        self._keys_given = (self._keys_given + 1) % len(KEYS)
        if self._keys_given == 0:
            self._cr &= ~LOCK

    def _write_control(self, value: int) -> None:
        self._require_idle("FLASH_CR")
        if value & ~CR_MODELLED:
            raise EmulationError(f"FLASH_CR = {value:#x} asks for what is not in the model")
        if self._cr & LOCK:
            return  # not heard
        self._cr = value
        if value & LOCK:
            self._cr = LOCK
        elif value & STRT:
            self._erase()

    def _require_idle(self, name: str) -> None:
        if self._sr & BSY:
            raise EmulationError(f"{name} is written while the flash is busy")

    # --- erasing and programming -----------------------------------------------------------------

    def _erase(self) -> None:
        if self._cr & (PER | PG) != PER:
            raise EmulationError("FLASH_CR starts an erasure without PER, or with PG")
        place = self._ar - STORE_START
        if not 0 <= place < STORE_BYTES:
            raise EmulationError(f"the firmware erases the page at {self._ar:#010x}, its own code")
        self._store.erase(place)
        self._work(ERASE_TICKS)

    def _work(self, ticks: int) -> None:
        if not self._clocks.internal_is_on:
            raise EmulationError("the flash is written while the internal oscillator is off")
        self._sr |= BSY
        self.due = self._time.now + ticks
        self._time.stalled_until = self.due

    def read_store(self, place: int, size: int) -> int:
        """Return what the store holds; the core waits until the flash has ended its work."""
        return int.from_bytes(self._store.data[place : place + size], "little")

    def program(self, place: int, size: int, value: int) -> None:
        """Write to the store as the program does.

        Raises
        ------
        BusError
            If the flash is locked, PG is not set, or it is not two bytes at once.
        """
        self._require_idle("the store")
        if self._cr & LOCK or not self._cr & PG or self._cr & PER or size != HALFWORD:
            raise BusError(f"{size} bytes are written to flash with FLASH_CR = {self._cr:#x}")
        old = self.read_store(place, HALFWORD)
        if old != 0xFFFF and value != 0:
            self._sr |= PGERR
            return
        self._work(PROGRAM_TICKS)
        if self._store.program(place, value):
            self._power_fails()
