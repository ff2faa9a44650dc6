"""A timer of APB1 that counts upwards and tells when it wraps."""

from hostkit.emulation.stm32.clocks import Clocks
from hostkit.emulation.stm32.timeline import NEVER, TICK_HZ, Timeline
from hostkit.errors import EmulationError

CR1, DIER, SR, EGR, CNT, PSC, ARR = 0x00, 0x0C, 0x10, 0x14, 0x24, 0x28, 0x2C
ENABLED, UPDATE = 1, 1


class Timer:
    """Counter, prescaler, reload value and the update interrupt."""

    def __init__(self, time: Timeline, clocks: Clocks) -> None:
        self._time = time
        self._clocks = clocks
        self._registers = {CR1: 0, DIER: 0, SR: 0, PSC: 0, ARR: 0xFFFF}
        self._origin = 0
        self._step = 1
        self.due = NEVER

    @property
    def request(self) -> bool:
        """Whether the timer asks for its interrupt."""
        return bool(self._registers[SR] & self._registers[DIER] & UPDATE)

    def happen(self) -> None:
        """Wrap."""
        self._registers[SR] |= UPDATE
        self.due += self._period()

    def read(self, offset: int) -> int:
        """Return a register."""
        if offset == CNT:
            running = self._registers[CR1] & ENABLED
            steps = (self._time.now - self._origin) // self._step
            return steps % (self._registers[ARR] + 1) if running else 0
        return self._registers[self._known(offset)]

    def write(self, offset: int, value: int) -> None:
        """Write a register."""
        if offset == EGR:
            self._take_over()
        elif offset == SR:
            self._registers[SR] &= value
        else:
            self._registers[self._known(offset)] = value & 0xFFFF
            if offset == CR1:
                self._take_over(flag=0)

    def _known(self, offset: int) -> int:
        if offset not in self._registers:
            raise EmulationError(f"the timer has no register at {offset:#x} in the model")
        return offset

    def _period(self) -> int:
        return (self._registers[ARR] + 1) * self._step

    def _take_over(self, flag: int = UPDATE) -> None:
        """Start from 0; an update event also takes the prescaler over and raises the flag."""
        if flag:
            self._step = (self._registers[PSC] + 1) * TICK_HZ // self._clocks.timer1_hz
            self._registers[SR] |= UPDATE
        self._origin = self._time.now
        running = self._registers[CR1] & ENABLED
        self.due = self._time.now + self._period() if running else NEVER
