"""The independent watchdog, which counts an oscillator of its own."""

from collections.abc import Callable

from hostkit.emulation.stm32.timeline import NEVER, TICK_HZ, Timeline
from hostkit.errors import EmulationError

KR, PR, RLR, SR = 0x00, 0x04, 0x08, 0x0C
START, UNLOCK, RELOAD = 0xCCCC, 0x5555, 0xAAAA
RELOAD_AFTER_RESET = 0xFFF
UPDATE_PERIODS = 5
PRESCALER_CHANGES, RELOAD_CHANGES = 1, 2


class Watchdog:
    """Prescaler, reload value and counter; what is written arrives some periods later.

    Parameters
    ----------
    oscillator_hz
        LSI: 30 to 60 kHz by the data sheet, 40 kHz typically.
    expire
        Called when nobody has fed it in time.

    Attributes
    ----------
    due
        When it expires, or when what was written arrives.
    """

    def __init__(self, time: Timeline, oscillator_hz: int, expire: Callable[[], None]) -> None:
        self._time = time
        self._period = TICK_HZ // oscillator_hz
        self._expire = expire
        self._open = False
        self._prescaler = self._wanted_prescaler = 0
        self._reload = self._wanted_reload = RELOAD_AFTER_RESET
        self._arrives = self._expires = NEVER
        self.due = NEVER

    def happen(self) -> None:
        """Expire, or take over what was written."""
        if self._expires <= self._arrives:
            self._expires = self.due = NEVER
            self._expire()
            return
        left = (self._expires - self._time.now) // self._step
        self._prescaler, self._reload = self._wanted_prescaler, self._wanted_reload
        self._arrives = NEVER
        self._expires = self._time.now + left * self._step
        self._plan()

    def read(self, offset: int) -> int:
        """Return a register."""
        if offset != SR:
            raise EmulationError(f"IWDG has no register at {offset:#x} to be read in the model")
        changes = PRESCALER_CHANGES * (self._prescaler != self._wanted_prescaler)
        return changes | RELOAD_CHANGES * (self._reload != self._wanted_reload)

    def write(self, offset: int, value: int) -> None:
        """Write a register."""
        if offset == KR:
            self._take_key(value)
        elif offset in (PR, RLR):
            self._set(offset, value)
        else:
            raise EmulationError(f"IWDG has no register at {offset:#x} to write in the model")
        self._plan()

    @property
    def _step(self) -> int:
        """Ticks of one count."""
        return self._period * (4 << min(self._prescaler, 6))

    def _plan(self) -> None:
        self.due = min(self._arrives, self._expires)

    def _take_key(self, value: int) -> None:
        self._open = value == UNLOCK
        if value == START or (value == RELOAD and self._expires != NEVER):
            self._expires = self._time.now + (self._reload + 1) * self._step

    def _set(self, offset: int, value: int) -> None:
        if not self._open:
            raise EmulationError("the watchdog's time is written before it is unlocked")
        if self._expires == NEVER:
            raise EmulationError("the watchdog's time is written before its oscillator runs")
        if offset == PR:
            self._wanted_prescaler = value & 7
        else:
            self._wanted_reload = value & 0xFFF
        self._arrives = self._time.now + UPDATE_PERIODS * self._period
