"""The whole board: core, memory, peripherals, the sensor on its pins, and the course of time."""

from unicorn import UC_HOOK_BLOCK, UC_HOOK_INTR, Uc, UcError
from unicorn import arm_const as arm

from hostkit.emulation.stm32.clocks import APB1ENR, APB2ENR, Clocks, FlashControl
from hostkit.emulation.stm32.core import FLASH_START, BlockLengths, Segments, load, stack_bytes
from hostkit.emulation.stm32.i2c import I2cMaster
from hostkit.emulation.stm32.nvic import THUMB, Nvic
from hostkit.emulation.stm32.pins import Lines, Port, Selector, Wires
from hostkit.emulation.stm32.timeline import NEVER, TICK_HZ, Device, Peripheral, Timeline
from hostkit.emulation.stm32.timer import Timer
from hostkit.emulation.stm32.usart import Transmitter
from hostkit.emulation.virtual_sensor import VirtualSensor
from hostkit.errors import EmulationError

PERIPHERALS_START, PERIPHERALS_BYTES = 0x40000000, 0x23000
CORE_START, CORE_BYTES = 0xE000E000, 0x1000
BLOCK_SHIFT = 10
EXCEPTION_RETURN = 8
ENDLESS = 0xFFFFFFFF
TX_PIN, MARK_PIN = 9, 8
EXTI9_5, TIM2, USART1 = 23, 28, 37
IT_STATE = 0x0600FC00


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
        self.time = Timeline()
        self._instructions = 0
        self._foreign_instructions = 0
        self._interrupted_at = 0
        self._begun_at: int | None = None
        self._sleeping = False
        self._until = self._wake = 0
        self._stopped = self._cleared = False
        self._returns_to: int | None = None
        self._begun = False
        self._uc = load(image)
        self._reset = self._uc.reg_read(arm.UC_ARM_REG_PC) & ~THUMB
        self._lengths = BlockLengths(image)
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
            self._uc, FLASH_START, {EXTI9_5: self._lines, TIM2: self._timer, USART1: self._usart}
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
        )
        self._places = {
            start - PERIPHERALS_START >> BLOCK_SHIFT: (peripheral, gate)
            for start, peripheral, gate in placed
        }
        uc = self._uc
        uc.mmio_map(PERIPHERALS_START, PERIPHERALS_BYTES, self._read, None, self._write, None)
        uc.mmio_map(CORE_START, CORE_BYTES, self._read_core, None, self._write_core, None)
        uc.hook_add(UC_HOOK_BLOCK, self._block)
        uc.hook_add(UC_HOOK_INTR, self._exception)
        uc.hook_add(UC_HOOK_BLOCK, self._began, None, self._reset, self._reset)

    # --- what the user sees ----------------------------------------------------------------------

    @property
    def finished(self) -> bool:
        """Whether the table has been played and read, and every byte is out."""
        return self._sleeping and self._usart.idle and self.sensor.exhausted

    @property
    def stack_bytes(self) -> int:
        """Bytes of stack used so far: all above the longest run of paint that is left."""
        return stack_bytes(self._uc)

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
        self._until = self.time.now + int(seconds * TICK_HZ)
        self._plan()
        while self.time.now < self._until and not self.finished:
            if self._sleeping:
                self._doze()
            else:
                self._run_instructions()

    # --- the course of time ----------------------------------------------------------------------

    def _plan(self) -> None:
        """Look at the requests, and at when the next thing happens."""
        self._nvic.update()
        self._wake = min(self._until, *(device.due for device in self._devices))

    def _let_happen(self) -> None:
        """Let happen what is due, the earliest first."""
        while True:
            device = min(self._devices, key=lambda d: d.due)
            if device.due > self.time.now:
                break
            device.happen()
        self._plan()

    def _doze(self) -> None:
        """Jump from event to event until an interrupt ends the sleep."""
        while not self._nvic.wakes:
            if min(device.due for device in self._devices) == NEVER:
                raise EmulationError("the firmware sleeps for ever")
            self.time.now = max(self.time.now, self._wake)
            self._let_happen()
            if self.time.now >= self._until or self.finished:
                return
        self._sleeping = False

    def _run_instructions(self) -> None:
        uc = self._uc
        if self._nvic.ready and (self._cleared or self._may_interrupt()):
            self._interrupted_at = self._instructions
            self._nvic.enter()
        self._stopped = self._cleared = False
        try:
            uc.emu_start(uc.reg_read(arm.UC_ARM_REG_PC) | THUMB, ENDLESS)
        except UcError as error:
            where = uc.reg_read(arm.UC_ARM_REG_PC)
            raise EmulationError(f"the firmware faults at {where:#010x}: {error}") from error
        if self._returns_to is not None:
            self._nvic.leave(self._returns_to)
            self._returns_to = None
            self._foreign_instructions += self._instructions - self._interrupted_at
        elif not self._stopped:
            self._sleeping = True

    def _may_interrupt(self) -> bool:
        """Tell whether nothing holds interrupts off; within an IT block they wait for its end."""
        held = self._uc.reg_read(arm.UC_ARM_REG_PRIMASK) & 1
        return not held and not self._uc.reg_read(arm.UC_ARM_REG_XPSR) & IT_STATE

    def _block(self, uc: Uc, address: int, size: int, _data: object) -> None:
        """Count the instructions of a block that begins, and stop before it if something waits."""
        count = self._lengths[address, size]
        self.time.now += count * self.time.ticks_per_instruction
        self._instructions += count
        if self.time.now < self._wake and not self._nvic.ready:
            return
        self._let_happen()
        self._cleared = self._nvic.ready and self._may_interrupt()
        if self._cleared or self.time.now >= self._until:
            self._instructions -= count  # it will be counted again, once it is carried out
            self._stopped = True
            uc.emu_stop()

    def _began(self, _uc: Uc, _address: int, _size: int, _data: object) -> None:
        if self._begun:
            raise EmulationError(f"the firmware jumped to its start after {self.time.now_s:.3f} s")
        self._begun = True

    def _exception(self, uc: Uc, number: int, _data: object) -> None:
        where = uc.reg_read(arm.UC_ARM_REG_PC)
        if number != EXCEPTION_RETURN:
            raise EmulationError(f"the firmware faults at {where:#010x}: exception {number}")
        self._returns_to = where
        self._stopped = True
        uc.emu_stop()

    # --- registers -------------------------------------------------------------------------------

    def _find(self, offset: int) -> Peripheral | None:
        """Return what answers at an offset; None for a peripheral that has no clock."""
        found = self._places.get(offset >> BLOCK_SHIFT)
        if found is None:
            raise EmulationError(
                f"the firmware uses {PERIPHERALS_START + offset:#010x}, which is not modelled"
            )
        peripheral, gate = found
        return peripheral if gate is None or self._clocks.clocked(*gate) else None

    def _read(self, _uc: Uc, offset: int, _size: int, _data: object) -> int:
        peripheral = self._find(offset)
        if peripheral is None:
            return 0
        if peripheral is self._i2c:
            if self._i2c.polled_in_vain():
                self._wait()
            value = self._i2c.read(offset & 0x3FF)
            self._plan()
            return value
        return peripheral.read(offset & 0x3FF)

    def _wait(self) -> None:
        """Let a program that polls in vain wait for the next event: the time passes, unspent."""
        self.time.now = max(self.time.now, min(d.due for d in self._devices))
        self._let_happen()

    def _write(self, _uc: Uc, offset: int, _size: int, value: int, _data: object) -> None:
        peripheral = self._find(offset)
        if peripheral is None:
            return
        peripheral.write(offset & 0x3FF, value)
        if peripheral is self._port_a:
            self._usart.wired = self._port_a.peripheral(TX_PIN)
            self._mark(bool(self._port_a.output >> MARK_PIN & 1))
        elif peripheral is self._port_b:
            self._wires.moved_by_program()
        self._plan()

    def _mark(self, begins: bool) -> None:
        own = self._instructions - self._foreign_instructions
        if begins and self._begun_at is None:
            self._begun_at = own
        elif not begins and self._begun_at is not None:
            self.segments.add(own - self._begun_at)
            self._begun_at = None

    def _read_core(self, _uc: Uc, offset: int, _size: int, _data: object) -> int:
        return self._nvic.read(offset)

    def _write_core(self, _uc: Uc, offset: int, _size: int, value: int, _data: object) -> None:
        self._nvic.write(offset, value)
        self._plan()
