"""The whole board: core, memory, peripherals, the sensor on its pins, and the course of time."""

from hostkit.emulation.stm32.clocks import APB1ENR, APB2ENR, Clocks, FlashControl
from hostkit.emulation.stm32.core import FLASH_BYTES, Core, Outcome, Segments
from hostkit.emulation.stm32.i2c import I2cMaster
from hostkit.emulation.stm32.nvic import ControlBlock, Nvic
from hostkit.emulation.stm32.pins import Lines, Port, Selector, Wires
from hostkit.emulation.stm32.timeline import NEVER, TICK_HZ, Device, Peripheral
from hostkit.emulation.stm32.timer import Timer
from hostkit.emulation.stm32.usart import Transmitter
from hostkit.emulation.virtual_sensor import VirtualSensor
from hostkit.errors import EmulationError

PERIPHERALS_START, PERIPHERALS_BYTES = 0x40000000, 0x23000
CORE_START, CORE_BYTES = 0xE000E000, 0x1000
BLOCK_SHIFT = 10
TX_PIN, MARK_PIN = 9, 8
EXTI9_5, TIM2, USART1 = 23, 28, 37


class Machine:
    """An STM32F103C8 that runs an image with the virtual MPU-6050 on its pins.

    Parameters
    ----------
    image
        What is flashed.
    sensor
        The sensor on PB6, PB7 and PB8.
    receiver_baud
        Rate of what listens at PA9.
    crystal_starts
        Whether the crystal oscillates.

    Attributes
    ----------
    link
        Every byte that the link has sent and nobody has taken yet.
    segments
        Instructions between the marks, those of interrupts not counted.
    """

    def __init__(
        self,
        image: bytes,
        sensor: VirtualSensor,
        *,
        receiver_baud: int,
        crystal_starts: bool = True,
    ) -> None:
        self.link = bytearray()
        self.segments = Segments()
        self.sensor = sensor
        self._core = Core(
            image,
            flash_bytes=FLASH_BYTES,
            happen=self._let_happen,
            read=self._read,
            write=self._write,
        )
        self.time = self._core.state.time
        self.time.ticks_per_instruction = 1
        self._begun_at: int | None = None
        self._sleeping = False
        self._make_peripherals(receiver_baud, crystal_starts)
        self._wire()

    # --- construction ----------------------------------------------------------------------------

    def _make_peripherals(self, receiver_baud: int, crystal_starts: bool) -> None:
        time, sensor = self.time, self.sensor
        self._clocks = Clocks(time, crystal_starts=crystal_starts)
        self._timer = Timer(time, self._clocks)
        self._port_a, self._port_b, self._lines = Port(), Port(), Lines()
        self._wires = Wires(time, self._port_b, self._lines, sensor)
        self._i2c = I2cMaster(time, self._clocks, self._wires, sensor)
        self._usart = Transmitter(
            time, self._clocks, receiver_baud=receiver_baud, heard=self.link.append
        )
        self._devices: tuple[Device, ...] = (
            self._clocks,
            self._timer,
            self._wires,
            self._i2c,
            self._usart,
        )
        self._nvic = Nvic(
            self._core, {EXTI9_5: self._lines, TIM2: self._timer, USART1: self._usart}
        )

    def _wire(self) -> None:
        flash: Peripheral = FlashControl(self._clocks)
        placed: tuple[tuple[int, Peripheral, tuple[int, int] | None], ...] = (
            (0x40000000, self._timer, (APB1ENR, 0)),
            (0x40005400, self._i2c, (APB1ENR, 21)),
            (0x40010000, Selector(self._lines), (APB2ENR, 0)),
            (0x40010400, self._lines, None),
            (0x40010800, self._port_a, (APB2ENR, 2)),
            (0x40010C00, self._port_b, (APB2ENR, 3)),
            (0x40013800, self._usart, (APB2ENR, 14)),
            (0x40021000, self._clocks, None),
            (0x40022000, flash, None),
            (0xE000E000, self._nvic, None),
            (0xE000EC00, ControlBlock(self._core, self._reset_requested), None),
        )
        self._places = {
            start >> BLOCK_SHIFT: (peripheral, gate)
            for start, peripheral, gate in placed
        }
        self._core.map(PERIPHERALS_START, PERIPHERALS_BYTES)
        self._core.map(CORE_START, CORE_BYTES)

    # --- what the user sees ----------------------------------------------------------------------

    @property
    def finished(self) -> bool:
        """Whether the table has been played and read, and every byte is out."""
        return self._sleeping and self._usart.idle and self.sensor.exhausted

    @property
    def stack_bytes(self) -> int:
        """Bytes of stack used so far: all above the longest run of paint that is left."""
        return self._core.stack_bytes

    def sensor_moved(self) -> None:
        """Look at the sensor again after something was done to it from outside."""
        self._wires.happen()
        self._plan()

    def run(self, seconds: float) -> None:
        """Run for a span of simulated time, or until the machine has finished.

        Raises
        ------
        EmulationError
            If the firmware faults, sleeps for ever, or does what the model does not allow.
        """
        self.time.until = self.time.now + int(seconds * TICK_HZ)
        self._plan()
        while self.time.now < self.time.until and not self.finished:
            if self._sleeping:
                self._doze()
            else:
                self._run_instructions()

    # --- the course of time ----------------------------------------------------------------------

    def _plan(self) -> None:
        """Look at the requests, and at when the next thing happens."""
        self._nvic.update()
        wake = self.time.until
        for device in self._devices:
            if device.due < wake:
                wake = device.due
        self.time.wake = wake

    def _let_happen(self) -> None:
        """Let happen what is due, the earliest first."""
        now = self.time.now
        while True:
            device = min(self._devices, key=_due)
            if device.due > now:
                break
            device.happen()
        self._plan()

    def _doze(self) -> None:
        """Jump from event to event until an interrupt ends the sleep."""
        while not self._nvic.wakes:
            if min(device.due for device in self._devices) == NEVER:
                raise EmulationError("the firmware sleeps for ever")
            self.time.now = max(self.time.now, self.time.wake)
            self._let_happen()
            if self.time.now >= self.time.until or self.finished:
                return
        self._sleeping = False

    def _run_instructions(self) -> None:
        outcome = self._core.run()
        state = self._core.state
        if outcome is Outcome.SLEEPS:
            self._sleeping = True
        elif outcome is Outcome.FAULTS:
            raise EmulationError(
                f"the firmware faults at {state.fault_address:#010x}: exception {state.fault}"
            )
        elif outcome is Outcome.BEGINS_AGAIN:
            raise EmulationError(
                f"the firmware jumped to its start after {self.time.now_s:.3f} s"
            )
        elif outcome is Outcome.NO_CODE:
            raise EmulationError(
                f"the firmware runs at {state.fault_address:#010x}, where it has no code"
            )

    # --- registers -------------------------------------------------------------------------------

    def _find(self, address: int) -> Peripheral | None:
        """Return what answers at an address; None for a peripheral that has no clock."""
        found = self._places.get(address >> BLOCK_SHIFT)
        if found is None:
            raise EmulationError(f"the firmware uses {address:#010x}, which is not modelled")
        peripheral, gate = found
        return peripheral if gate is None or self._clocks.clocked(*gate) else None

    def _read(self, address: int, _size: int) -> int:
        peripheral = self._find(address)
        if peripheral is None:
            return 0
        if peripheral is self._i2c:
            if self._i2c.polled_in_vain():
                self._wait()
            value = self._i2c.read(address & 0x3FF)
            self._plan()
            return value
        return peripheral.read(address & 0x3FF)

    def _wait(self) -> None:
        """Let a program that polls in vain wait for the next event: the time passes, unspent."""
        self.time.now = max(self.time.now, min(d.due for d in self._devices))
        self._let_happen()

    def _write(self, address: int, _size: int, value: int) -> None:
        peripheral = self._find(address)
        if peripheral is None:
            return
        peripheral.write(address & 0x3FF, value)
        if peripheral is self._port_a:
            self._usart.wired = self._port_a.peripheral(TX_PIN)
            self._mark(bool(self._port_a.output >> MARK_PIN & 1))
        elif peripheral is self._port_b:
            self._wires.moved_by_program()
        self._plan()

    def _reset_requested(self) -> None:
        raise EmulationError("the firmware resets itself, as it does after a fault")

    def _mark(self, begins: bool) -> None:
        state = self._core.state
        own = state.instructions - state.foreign_instructions
        if begins and self._begun_at is None:
            self._begun_at = own
        elif not begins and self._begun_at is not None:
            self.segments.add(own - self._begun_at)
            self._begun_at = None


def _due(device: Device) -> int:
    return device.due
