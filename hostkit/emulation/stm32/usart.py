"""The transmitter of USART 1, and a receiver on its wire."""

from collections.abc import Callable

from hostkit.emulation.stm32.clocks import Clocks
from hostkit.emulation.stm32.timeline import NEVER, TICK_HZ, Timeline
from hostkit.errors import EmulationError

SR, DR, BRR, CR1 = 0x00, 0x04, 0x08, 0x0C
TC, TXE = 1 << 6, 1 << 7
TE, TC_INTERRUPT, TXE_INTERRUPT, UE = 1 << 3, 1 << 6, 1 << 7, 1 << 13
BITS_PER_BYTE = 10
BAUD_TOLERANCE = 0.025


class Transmitter:
    """Data and shift register; a byte takes ten bits of the rate that BRR makes.

    Attributes
    ----------
    wired
        Whether the pin belongs to the transmitter; otherwise what it sends is lost.
    """

    def __init__(
        self, time: Timeline, clocks: Clocks, *, receiver_baud: int, heard: Callable[[int], None]
    ) -> None:
        self._time = time
        self._clocks = clocks
        self._receiver_baud = receiver_baud
        self._heard = heard
        self._brr = 0
        self._cr1 = 0
        self._waiting: int | None = None
        self._shifting: int | None = None
        self.wired = False
        self.due = NEVER

    @property
    def idle(self) -> bool:
        """Whether everything is out and nothing is about to be sent."""
        return self._shifting is None and not self._cr1 & TXE_INTERRUPT

    @property
    def request(self) -> bool:
        """Whether the transmitter asks for its interrupt."""
        enabled = self._cr1 & (TXE_INTERRUPT | TC_INTERRUPT)
        return bool(enabled and self._cr1 & UE and self._status() & enabled)

    def happen(self) -> None:
        """Finish a byte and begin the next."""
        if self._shifting is not None and self.wired:
            self._heard(self._shifting)
        self._shifting, self._waiting = self._waiting, None
        self._plan()

    def read(self, offset: int) -> int:
        """Return a register."""
        if offset == SR:
            return self._status()
        if offset in (BRR, CR1):
            return self._brr if offset == BRR else self._cr1
        raise EmulationError(f"USART has no register at {offset:#x} in the model")

    def write(self, offset: int, value: int) -> None:
        """Write a register."""
        if offset == DR:
            self._take(value & 0xFF)
        elif offset == BRR:
            self._brr = value & 0xFFFF
        elif offset == CR1:
            self._cr1 = value
        else:
            raise EmulationError(f"USART has no register at {offset:#x} in the model")

    def _status(self) -> int:
        return (TXE if self._waiting is None else 0) | (TC if self._shifting is None else 0)

    def _take(self, byte: int) -> None:
        if self._cr1 & (UE | TE) != UE | TE:
            raise EmulationError("the firmware sends a byte while its transmitter is off")
        if self._shifting is None:
            self._shifting = byte
            self._plan()
        else:
            self._waiting = byte  # one that waited already is lost

    def _plan(self) -> None:
        if self._shifting is None:
            self.due = NEVER
            return
        baud = self._clocks.pclk2_hz / max(self._brr, 1)
        if abs(baud / self._receiver_baud - 1.0) > BAUD_TOLERANCE:
            raise EmulationError(
                f"the link runs at {baud:.0f} bit/s, its receiver at {self._receiver_baud}; "
                f"they may differ by {BAUD_TOLERANCE:.1%}"
            )
        bit = self._brr * TICK_HZ // self._clocks.pclk2_hz
        self.due = self._time.now + BITS_PER_BYTE * bit
