"""USART 1, and who is at the other end of its wires."""

from collections import deque
from collections.abc import Callable

from hostkit.emulation.board import LinkInput
from hostkit.emulation.stm32.clocks import Clocks
from hostkit.emulation.stm32.timeline import NEVER, TICK_HZ, Timeline
from hostkit.errors import EmulationError

SR, DR, BRR, CR1 = 0x00, 0x04, 0x08, 0x0C
ORE, RXNE, TC, TXE = 1 << 3, 1 << 5, 1 << 6, 1 << 7
RE, TE, UE = 1 << 2, 1 << 3, 1 << 13
RX_INTERRUPT, TC_INTERRUPT, TXE_INTERRUPT = 1 << 5, 1 << 6, 1 << 7
BITS_PER_BYTE = 10
BAUD_TOLERANCE = 0.025


class Usart:
    """Data and shift registers; a byte takes ten bits of the rate that BRR makes.

    Parameters
    ----------
    peer_baud
        Rate of who is at the other end.
    heard
        Called with every byte that it hears.

    Attributes
    ----------
    wired
        Whether the TX pin belongs to the transmitter; otherwise what it sends is lost.
    listens
        Whether the RX pin is an input; otherwise what comes is lost.
    """

    def __init__(
        self, time: Timeline, clocks: Clocks, *, peer_baud: int, heard: Callable[[int], None]
    ) -> None:
        self._time = time
        self._clocks = clocks
        self._peer_baud = peer_baud
        self._heard = heard
        self._brr = 0
        self._cr1 = 0
        self._waiting: int | None = None
        self._shifting: int | None = None
        self._received = 0
        self._status_received = 0
        self._overrun_seen = False
        self.wired = False
        self.listens = True
        self.due = NEVER

    @property
    def idle(self) -> bool:
        """Whether everything is out and nothing is about to be sent."""
        return self._shifting is None and not self._cr1 & TXE_INTERRUPT

    @property
    def request(self) -> bool:
        """Whether the peripheral asks for its interrupt."""
        cr1 = self._cr1
        if not cr1 & UE:
            return False
        if cr1 & RX_INTERRUPT and self._status_received:
            return True
        enabled = cr1 & (TXE_INTERRUPT | TC_INTERRUPT)
        return bool(enabled and self._status() & enabled)

    def happen(self) -> None:
        """Finish a byte and begin the next."""
        if self._shifting is not None and self.wired:
            self._heard(self._shifting)
        self._shifting, self._waiting = self._waiting, None
        self._plan()

    def arrive(self, byte: int) -> None:
        """Take a byte that has come; while the one before has not been read it is lost."""
        if self._cr1 & (UE | RE) != UE | RE or not self.listens:
            return
        self._require_rate()
        if self._status_received & RXNE:
            self._status_received |= ORE
            return
        self._received = byte
        self._status_received |= RXNE

    def read(self, offset: int) -> int:
        """Return a register; reading DR after SR ends an overrun."""
        if offset == SR:
            self._overrun_seen = bool(self._status_received & ORE)
            return self._status()
        if offset == DR:
            self._status_received &= ~(RXNE | (ORE if self._overrun_seen else 0))
            self._overrun_seen = False
            return self._received
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
        sending = (TXE if self._waiting is None else 0) | (TC if self._shifting is None else 0)
        return sending | self._status_received

    def _take(self, byte: int) -> None:
        if self._cr1 & (UE | TE) != UE | TE:
            raise EmulationError("the firmware sends a byte while its transmitter is off")
        if self._shifting is None:
            self._shifting = byte
            self._plan()
        else:
            self._waiting = byte  # one that waited already is lost

    def _require_rate(self) -> None:
        baud = self._clocks.pclk2_hz / max(self._brr, 1)
        if abs(baud / self._peer_baud - 1.0) > BAUD_TOLERANCE:
            raise EmulationError(
                f"the link runs at {baud:.0f} bit/s, its receiver at {self._peer_baud}; "
                f"they may differ by {BAUD_TOLERANCE:.1%}"
            )

    def _plan(self) -> None:
        if self._shifting is None:
            self.due = NEVER
            return
        self._require_rate()
        bit = self._brr * TICK_HZ // self._clocks.pclk2_hz
        self.due = self._time.now + BITS_PER_BYTE * bit


class Sender:
    """Who talks into the link: one byte after the other, as fast as the rate allows.

    Parameters
    ----------
    pieces
        What it sends and when, in order of time.

    Attributes
    ----------
    arrive
        Called with every byte.
    due
        When the next byte has come.
    """

    def __init__(self, time: Timeline, baud: int, pieces: tuple[LinkInput, ...]) -> None:
        self._time = time
        self._byte_ticks = BITS_PER_BYTE * TICK_HZ // baud
        self._bytes: deque[tuple[int, int]] = deque()
        self._free = 0
        self.arrive: Callable[[int], None] = _lost
        self.due = NEVER
        for piece in pieces:
            self._send(round(piece.time_s * TICK_HZ), piece.data)

    def send(self, data: bytes) -> None:
        """Send bytes from now on, after what is still under way."""
        self._send(self._time.now, data)

    def happen(self) -> None:
        """Let a byte arrive."""
        _, byte = self._bytes.popleft()
        self._plan()
        self.arrive(byte)

    def _send(self, tick: int, data: bytes) -> None:
        for byte in data:
            self._free = max(self._free, tick) + self._byte_ticks
            self._bytes.append((self._free, byte))
        self._plan()

    def _plan(self) -> None:
        self.due = self._bytes[0][0] if self._bytes else NEVER


def _lost(_byte: int) -> None:
    """Nobody listens yet."""
