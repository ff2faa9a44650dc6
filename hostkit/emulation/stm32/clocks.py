"""Reset and clock control."""

from hostkit.emulation.stm32.timeline import NEVER, TICK_HZ, Timeline
from hostkit.errors import EmulationError

CR, CFGR, APB2ENR, APB1ENR, CSR = 0x00, 0x04, 0x18, 0x1C, 0x24
HSI_ON, HSE_ON, HSE_READY, PLL_ON, PLL_READY = 1, 1 << 16, 1 << 17, 1 << 24, 1 << 25
CR_AFTER_RESET = 0x83
REMOVE_FLAGS = 1 << 24
BY_PIN, BY_POWER, BY_REQUEST, BY_WATCHDOG = 1 << 26, 1 << 27, 1 << 28, 1 << 29
CR_SETTABLE = 0xF9 | HSE_ON | PLL_ON
CRYSTAL_HZ = 8_000_000
INTERNAL_HZ = 8_000_000
CRYSTAL_START_TICKS = TICK_HZ * 2 // 1000
PLL_LOCK_TICKS = TICK_HZ * 200 // 1_000_000
APB1_LIMIT_HZ = 36_000_000
HZ_PER_WAIT_STATE = 24_000_000
SW_INTERNAL, SW_CRYSTAL, SW_PLL = 0, 1, 2


class Clocks:
    """RCC: the clock of the core and of both buses, which peripherals have one, why it started.

    Attributes
    ----------
    crystal_starts
        Whether the crystal oscillates.
    reset_flags
        What the resets so far have left in RCC_CSR.
    hclk_hz, pclk1_hz, pclk2_hz
        Clock of the core and of the buses.
    """

    def __init__(self, time: Timeline, *, crystal_starts: bool, reset_flags: int) -> None:
        self._time = time
        self.reset_flags = reset_flags
        self.crystal_starts = crystal_starts
        self.due = NEVER
        self._cr = CR_AFTER_RESET
        self._cfgr = 0
        self._enabled = {APB2ENR: 0, APB1ENR: 0}
        self._wait_states = 0
        self.hclk_hz = self.pclk1_hz = self.pclk2_hz = INTERNAL_HZ
        self._derive()

    def happen(self) -> None:
        """Let crystal or PLL become ready."""
        self._cr |= HSE_READY if not self._cr & HSE_READY else PLL_READY
        self.due = NEVER
        self._start_what_is_on()

    def clocked(self, register: int, bit: int) -> bool:
        """Tell whether a peripheral has been given its clock."""
        return bool(self._enabled[register] >> bit & 1)

    @property
    def internal_is_on(self) -> bool:
        """Whether the internal oscillator runs, which the flash is programmed with."""
        return bool(self._cr & HSI_ON)

    @property
    def timer1_hz(self) -> int:
        """Clock of the timers of APB1: its own, or twice that where it is divided."""
        return self.pclk1_hz if self.pclk1_hz == self.hclk_hz else 2 * self.pclk1_hz

    def read(self, offset: int) -> int:
        """Return a register of RCC."""
        if offset == CR:
            return self._cr
        if offset == CFGR:
            return self._cfgr | (self._cfgr & 3) << 2  # the switch is done at once
        if offset == CSR:
            return self.reset_flags
        if offset in self._enabled:
            return self._enabled[offset]
        raise EmulationError(f"RCC has no register at {offset:#x} in the model")

    def write(self, offset: int, value: int) -> None:
        """Write a register of RCC."""
        if offset == CR:
            self._cr = self._cr & ~CR_SETTABLE | value & CR_SETTABLE
            self._start_what_is_on()
        elif offset == CFGR:
            self._cfgr = value & ~0xC
            self._derive()
        elif offset == CSR:
            self.reset_flags = 0 if value & REMOVE_FLAGS else self.reset_flags
        elif offset in self._enabled:
            self._enabled[offset] = value
        else:
            raise EmulationError(f"RCC has no register at {offset:#x} in the model")

    def set_wait_states(self, value: int) -> None:
        """Take over what the flash has been told."""
        self._wait_states = value & 7
        self._derive()

    def _start_what_is_on(self) -> None:
        if self.due != NEVER:
            return
        if self._cr & HSE_ON and not self._cr & HSE_READY:
            if self.crystal_starts:
                self.due = self._time.now + CRYSTAL_START_TICKS
        elif self._cr & PLL_ON and not self._cr & PLL_READY:
            self.due = self._time.now + PLL_LOCK_TICKS

    def _source_hz(self) -> int:
        switch = self._cfgr & 3
        if switch == SW_INTERNAL:
            return INTERNAL_HZ
        ready = HSE_READY if switch == SW_CRYSTAL else PLL_READY
        if not self._cr & ready:
            raise EmulationError("the firmware switches to a clock that is not ready")
        if switch == SW_CRYSTAL:
            return CRYSTAL_HZ
        source = CRYSTAL_HZ if self._cfgr >> 16 & 1 else INTERNAL_HZ // 2
        if self._cfgr >> 17 & 1:
            source //= 2
        return source * min((self._cfgr >> 18 & 0xF) + 2, 16)

    def _derive(self) -> None:
        self.hclk_hz = self._source_hz() // _divisor(self._cfgr >> 4 & 0xF, 8)
        self.pclk1_hz = self.hclk_hz // _divisor(self._cfgr >> 8 & 7, 4)
        self.pclk2_hz = self.hclk_hz // _divisor(self._cfgr >> 11 & 7, 4)
        if TICK_HZ % self.hclk_hz:
            raise EmulationError(f"a core clock of {self.hclk_hz} Hz does not divide {TICK_HZ} Hz")
        if self.pclk1_hz > APB1_LIMIT_HZ:
            raise EmulationError(f"APB1 runs at {self.pclk1_hz} Hz; it takes {APB1_LIMIT_HZ} Hz")
        limit_hz = (self._wait_states + 1) * HZ_PER_WAIT_STATE
        if self.hclk_hz > limit_hz:
            raise EmulationError(
                f"the core runs at {self.hclk_hz} Hz, the flash with {self._wait_states} wait "
                f"states at {limit_hz} Hz at most"
            )
        self._time.ticks_per_instruction = TICK_HZ // self.hclk_hz


def _divisor(field: int, divides_from: int) -> int:
    """Return what a prescaler's field stands for: 1 below `divides_from`, then 2, 4, 8, ..."""
    return 1 if field < divides_from else 2 << field - divides_from
