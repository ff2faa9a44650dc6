"""Ports A and B, the lines of EXTI, and what hangs on the pins."""

from hostkit.emulation.stm32.timeline import NEVER, Timeline, tick_at
from hostkit.emulation.virtual_sensor import VirtualSensor
from hostkit.errors import EmulationError

CRL, CRH, IDR, ODR, BSRR, BRR = 0x00, 0x04, 0x08, 0x0C, 0x10, 0x14
FLOATING = 0x44444444
SCL, SDA, INT = 6, 7, 8
AFIO_EXTICR3, PORT_B = 0x10, 1
IMR, RTSR, PR = 0x00, 0x08, 0x14
LINES_9_TO_5 = 0x3E0


class Port:
    """One port: configuration, output and input of sixteen pins."""

    def __init__(self) -> None:
        self._configuration = [FLOATING, FLOATING]
        self.output = 0
        self.driven_low = 0
        self.driven_high = 0

    def mode(self, pin: int) -> int:
        """Return the four bits that configure a pin: two of kind, two of speed (0 is input)."""
        return self._configuration[pin // 8] >> 4 * (pin % 8) & 0xF

    def peripheral(self, pin: int) -> bool:
        """Tell whether a peripheral drives the pin, push-pull or open drain."""
        return self.mode(pin) & 8 != 0 and self.mode(pin) & 3 != 0

    def pulls_low(self, pin: int) -> bool:
        """Tell whether the pin is an output of the program and at 0."""
        mode = self.mode(pin)
        return mode & 8 == 0 and mode & 3 != 0 and not self.output >> pin & 1

    def read(self, offset: int) -> int:
        """Return a register; an open pin reads as what its output register holds."""
        if offset in (CRL, CRH):
            return self._configuration[offset // 4]
        if offset == IDR:
            return (self.output | self.driven_high) & ~self.driven_low
        if offset == ODR:
            return self.output
        raise EmulationError(f"a port has no register at {offset:#x} to be read in the model")

    def write(self, offset: int, value: int) -> None:
        """Write a register."""
        if offset in (CRL, CRH):
            self._configuration[offset // 4] = value
        elif offset == BSRR:
            self.output = self.output & ~(value >> 16) | value & 0xFFFF
        elif offset == BRR:
            self.output &= ~value
        else:
            raise EmulationError(f"a port has no register at {offset:#x} to write in the model")


class Lines:
    """EXTI and the part of AFIO that selects the port of line 8."""

    def __init__(self) -> None:
        self.mask = 0
        self.rising = 0
        self.pending = 0
        self.port_of_line_8 = 0

    @property
    def request(self) -> bool:
        """Whether one of the lines 5 to 9 asks for their interrupt."""
        return bool(self.pending & self.mask & LINES_9_TO_5)

    def rise(self) -> None:
        """Let PB8 rise."""
        if self.port_of_line_8 == PORT_B:
            self.pending |= self.rising & 1 << INT

    def read(self, offset: int) -> int:
        """Return a register of EXTI."""
        found = {IMR: self.mask, RTSR: self.rising, PR: self.pending}.get(offset)
        if found is None:
            raise EmulationError(f"EXTI has no register at {offset:#x} in the model")
        return found

    def write(self, offset: int, value: int) -> None:
        """Write a register of EXTI; ones written to PR clear."""
        if offset == IMR:
            self.mask = value
        elif offset == RTSR:
            self.rising = value
        elif offset == PR:
            self.pending &= ~value
        else:
            raise EmulationError(f"EXTI has no register at {offset:#x} in the model")


class Selector:
    """AFIO."""

    def __init__(self, lines: Lines) -> None:
        self._lines = lines

    def read(self, offset: int) -> int:
        """Return a register."""
        return self._lines.port_of_line_8 if offset == AFIO_EXTICR3 else 0

    def write(self, offset: int, value: int) -> None:
        """Write a register; only the selection of the lines 8 to 11 is modelled."""
        if offset != AFIO_EXTICR3:
            raise EmulationError(f"AFIO has no register at {offset:#x} in the model")
        self._lines.port_of_line_8 = value & 0xF


class Wires:
    """The three wires of the sensor on port B: the sensor's time, its INT, and the bus by hand.

    Attributes
    ----------
    due
        When the sensor changes by itself.
    played_at
        When the table had been played and read for the first time.
    """

    def __init__(self, time: Timeline, port: Port, lines: Lines, sensor: VirtualSensor) -> None:
        self._time = time
        self._port = port
        self._lines = lines
        self._sensor = sensor
        self._levels = (True, True)
        self._int = False
        self.due = self.played_at = NEVER
        self.happen()

    @property
    def peripheral_has_bus(self) -> bool:
        """Whether both wires of the bus belong to the I2C peripheral."""
        return self._port.peripheral(SCL) and self._port.peripheral(SDA)

    @property
    def bus_free(self) -> bool:
        """Whether nobody pulls at the bus."""
        return not self._sensor.sda_low

    def happen(self) -> None:
        """Bring the sensor up to date, and its pins."""
        sensor, port = self._sensor, self._port
        sensor.advance(self._time.now_ns)
        level = sensor.int_pin
        if level and not self._int:
            self._lines.rise()
        self._int = level
        port.driven_high = 1 << INT if level else 0
        low = (1 << SDA) * (sensor.sda_low or port.pulls_low(SDA))
        port.driven_low = low | (1 << SCL) * port.pulls_low(SCL)
        self.due = tick_at(sensor.next_event_ns)
        if self.played_at == NEVER and sensor.exhausted:
            self.played_at = self._time.now

    def moved_by_program(self) -> None:
        """Let the sensor see what the program did with the bus: clocks, and STOP."""
        scl = not self._port.pulls_low(SCL)
        sda = not self._port.pulls_low(SDA)
        had_scl, had_sda = self._levels
        self._levels = (scl, sda)
        if self._levels == (had_scl, had_sda):
            return
        self._sensor.advance(self._time.now_ns)
        if scl and not had_scl:
            self._sensor.clock()
        elif scl and sda and not had_sda and not self._sensor.sda_low:
            self._sensor.stop()
        self.happen()
