"""The I2C master of the STM32F1: data and shift register, flags, and how transfers end.

From RM0008 (26.3.3 and 26.6) and the errata sheet ES0340: what the program must do in time is
watched, and what it does wrongly has its consequence or is an error.
"""

from collections.abc import Callable

from hostkit.emulation.stm32.clocks import Clocks
from hostkit.emulation.stm32.pins import Wires
from hostkit.emulation.stm32.timeline import NEVER, TICK_HZ, Timeline, tick_at
from hostkit.emulation.virtual_sensor import VirtualSensor
from hostkit.errors import EmulationError

CR1, CR2, DR, SR1, SR2, CCR, TRISE = 0x00, 0x04, 0x10, 0x14, 0x18, 0x1C, 0x20
PE, START, STOP, ACK, POS, SWRST = 1, 1 << 8, 1 << 9, 1 << 10, 1 << 11, 1 << 15
SB, ADDR, BTF, RXNE, TXE, AF = 1, 1 << 1, 1 << 2, 1 << 6, 1 << 7, 1 << 10
ERRORS = 0xDF00
MSL, BUSY, TRA = 1, 2, 4
FAST, DUTY = 1 << 15, 1 << 14
FAST_LIMIT_HZ = 400_000
BYTE_BITS = 9
NOTHING = -1


class I2cMaster:
    """One master that nobody competes with.

    Attributes
    ----------
    due
        When the transfer under way on the bus is done.
    """

    def __init__(self, time: Timeline, clocks: Clocks, wires: Wires, sensor: VirtualSensor) -> None:
        self._time = time
        self._clocks = clocks
        self._wires = wires
        self._sensor = sensor
        self._sr2 = 0
        self._reset()

    def _reset(self) -> None:
        self._cr1 = self._cr2 = self._ccr = 0
        self._trise = 2
        self._leave_bus()

    def _leave_bus(self) -> None:
        """Forget whatever is under way and let both wires go, as clearing PE does."""
        if self._sr2 & MSL:
            self._sensor.stop()
        self._cr1 &= ~(START | STOP)
        self._sr1 = self._sr2 = 0
        self._seen = NOTHING
        self._data = self._shift = self._moving = 0
        self._acknowledge_next = self._acknowledged = False
        self.due = NEVER
        self._then: Callable[[], None] | None = None

    def happen(self) -> None:
        """Finish what is under way on the bus."""
        then, self._then, self.due = self._then, None, NEVER
        if then is not None:
            self._sensor.advance(self._time.now_ns)
            then()
            self._wires.happen()

    def polled_in_vain(self) -> bool:
        """Tell whether SR1 has been read again without a change while something is under way."""
        return self._seen == self._sr1 and self.due != NEVER

    def read(self, offset: int) -> int:
        """Return a register; SR1, SR2 and DR move the transfer on."""
        if offset == SR1:
            self._seen = self._sr1
            return self._sr1
        if offset == SR2:
            return self._read_sr2()
        if offset == DR:
            return self._read_data()
        found = {CR1: self._cr1, CR2: self._cr2, CCR: self._ccr, TRISE: self._trise}.get(offset)
        if found is None:
            raise EmulationError(f"I2C has no register at {offset:#x} in the model")
        return found

    def write(self, offset: int, value: int) -> None:
        """Write a register."""
        if offset == CR1:
            self._write_control(value)
        elif offset == DR:
            self._write_data(value & 0xFF)
        elif offset == SR1:
            self._sr1 &= ~ERRORS | value
        elif offset in (CR2, CCR, TRISE):
            self._write_timing(offset, value)
        else:
            raise EmulationError(f"I2C has no register at {offset:#x} to write in the model")
        self._seen = NOTHING

    # --- control ---------------------------------------------------------------------------------

    def _write_timing(self, offset: int, value: int) -> None:
        if self._cr1 & PE:
            raise EmulationError("the timing of I2C is written while the peripheral is on")
        if offset == CR2:
            self._cr2 = value
        elif offset == CCR:
            self._ccr = value
        else:
            self._trise = value

    def _write_control(self, value: int) -> None:
        if value & SWRST:
            self._reset()
            self._cr1 = value
            return
        if not value & PE:
            self._cr1 = value
            self._leave_bus()
            return
        if self._cr1 & (START | STOP):
            raise EmulationError("I2C_CR1 is written while START or STOP is under way")
        if not self._cr1 & PE:
            self._check_timing()
        self._cr1 = value
        if value & (START | STOP) and self._then is None:
            self._begin_or_end()

    def _check_timing(self) -> None:
        pclk1_hz = self._clocks.pclk1_hz
        if self._cr2 & 0x3F != pclk1_hz // 1_000_000:
            raise EmulationError(
                f"I2C_CR2 says {self._cr2 & 0x3F} MHz, and APB1 runs at {pclk1_hz} Hz"
            )
        if pclk1_hz > self._periods() * FAST_LIMIT_HZ:
            raise EmulationError(
                f"SCL would run at {pclk1_hz / max(self._periods(), 1):.0f} Hz; the sensor takes "
                f"{FAST_LIMIT_HZ} Hz"
            )

    def _periods(self) -> int:
        """Return the periods of APB1 in one of SCL."""
        shares = 2 if not self._ccr & FAST else 25 if self._ccr & DUTY else 3
        return shares * (self._ccr & 0xFFF)

    def _after(self, bits: int, then: Callable[[], None]) -> None:
        ticks = bits * self._periods() * TICK_HZ // self._clocks.pclk1_hz
        if bits == BYTE_BITS:
            self._sensor.advance(self._time.now_ns)
            ticks += tick_at(self._sensor.stretch_ns)
        self.due = self._time.now + ticks
        self._then = then

    def _begin_or_end(self) -> None:
        """Send the START or STOP that is wanted, now that nothing moves on the bus."""
        if self._cr1 & STOP:
            if self._sr2 & MSL:
                self._require_released()
                self._after(1, self._stopped)
        elif self._sr2 & MSL or (self._wires.peripheral_has_bus and self._wires.bus_free):
            self._after(1, self._started)

    def _require_released(self) -> None:
        if not self._sr2 & TRA and self._acknowledged:
            raise EmulationError(
                "STOP after a byte that was acknowledged: the sensor may hold SDA low"
            )

    def _started(self) -> None:
        self._cr1 &= ~START
        self._sr1 = SB
        self._sr2 = MSL | BUSY

    def _stopped(self) -> None:
        self._sensor.stop()
        self._cr1 &= ~STOP
        if self._sr1 & BTF and not self._sr2 & TRA:
            self._shift = self._shift << 1 & 0xFF  # errata: it must have been read before
        self._sr1 &= ~(TXE | (BTF if self._sr2 & TRA else 0))
        self._sr2 = 0

    # --- address ---------------------------------------------------------------------------------

    def _addressed(self) -> None:
        read = bool(self._moving & 1)
        if not self._sensor.start(self._moving >> 1, read=read):
            self._sr1 |= AF
            self._end_if_wanted()
            return
        self._sr1 |= ADDR
        self._sr2 |= 0 if read else TRA

    def _read_sr2(self) -> int:
        """Return SR2; after SR1 that clears ADDR and lets the transfer go on."""
        if self._sr1 & ADDR and self._seen != NOTHING and self._seen & ADDR:
            self._sr1 &= ~ADDR
            if self._sr2 & TRA:
                self._sr1 |= TXE
            else:
                self._receive()
        self._seen = NOTHING
        return self._sr2

    def _end_if_wanted(self) -> None:
        if self._cr1 & (START | STOP):
            self._begin_or_end()

    # --- transmission ----------------------------------------------------------------------------

    def _write_data(self, byte: int) -> None:
        if self._sr1 & SB and self._seen != NOTHING and self._seen & SB:
            self._sr1 &= ~SB
            self._moving = byte
            self._after(BYTE_BITS, self._addressed)
        elif self._sr2 & TRA and self._sr1 & TXE:
            self._sr1 &= ~BTF
            if self._then is None and not self._sr1 & AF:
                self._moving = byte
                self._after(BYTE_BITS, self._sent)
            else:
                self._data = byte
                self._sr1 &= ~TXE
        else:
            raise EmulationError("I2C_DR is written while it waits for no byte")

    def _sent(self) -> None:
        if not self._sensor.write(self._moving):
            self._sr1 |= AF
        elif not self._sr1 & TXE:
            self._sr1 |= TXE
            self._moving = self._data
            self._after(BYTE_BITS, self._sent)
            return
        else:
            self._sr1 |= BTF
        self._end_if_wanted()

    # --- reception -------------------------------------------------------------------------------

    def _receive(self) -> None:
        self._acknowledge_next = bool(self._cr1 & ACK)
        self._after(BYTE_BITS, self._received)

    def _received(self) -> None:
        """Take a byte. With POS its acknowledge was settled when it began, else it is now."""
        byte = self._sensor.read()
        now = bool(self._cr1 & ACK)
        self._acknowledged = self._acknowledge_next if self._cr1 & POS else now
        if self._sr1 & RXNE:
            self._shift = byte
            self._sr1 |= BTF
        else:
            self._data = byte
            self._sr1 |= RXNE
        self._go_on()

    def _go_on(self) -> None:
        """Begin the next byte, unless the clock is stretched or the end is wanted or reached."""
        if self._cr1 & (START | STOP):
            self._begin_or_end()
        elif self._acknowledged and not self._sr1 & BTF:
            self._receive()

    def _read_data(self) -> int:
        data = self._data
        self._seen = NOTHING
        if self._sr1 & BTF and not self._sr2 & TRA:
            self._data = self._shift
            self._sr1 &= ~BTF
            if self._then is None and self._sr2 & MSL:
                self._go_on()
        else:
            self._sr1 &= ~RXNE
        return data
