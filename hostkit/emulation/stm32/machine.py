"""The whole board: core, memory, peripherals, the sensor on its pins, and the course of time."""

from hostkit.emulation.board import LinkInput
from hostkit.emulation.stm32.clocks import (
    APB1ENR,
    APB2ENR,
    BY_PIN,
    BY_POWER,
    BY_REQUEST,
    BY_WATCHDOG,
    Clocks,
)
from hostkit.emulation.stm32.core import FLASH_BYTES, Core, Outcome, Segments
from hostkit.emulation.stm32.flash import STORE_BYTES, STORE_START, Flash, Store
from hostkit.emulation.stm32.i2c import I2cMaster
from hostkit.emulation.stm32.nvic import ControlBlock, Nvic
from hostkit.emulation.stm32.pins import Lines, Port, Selector, Wires
from hostkit.emulation.stm32.timeline import NEVER, TICK_HZ, BusFault, Device, Peripheral
from hostkit.emulation.stm32.timer import Timer
from hostkit.emulation.stm32.usart import Sender, Usart
from hostkit.emulation.stm32.watchdog import Watchdog
from hostkit.emulation.virtual_sensor import VirtualSensor
from hostkit.errors import EmulationError

PERIPHERALS_START, PERIPHERALS_BYTES = 0x40000000, 0x23000
CORE_START, CORE_BYTES = 0xE000E000, 0x1000
BLOCK_SHIFT = 10
OFFSET = 0x3FF
TX_PIN, RX_PIN, MARK_PIN = 9, 10, 8
EXTI9_5, TIM2, TIM3, USART1 = 23, 28, 29, 37
TYPICAL_LSI_HZ = 40_000
PATIENCE_TICKS = TICK_HZ // 100
"""For so long a program that does not sleep may go on after the end of the table."""
LONGEST_WAIT_TICKS = TICK_HZ // 10_000
"""A program that polls looks at the clock so often at least."""
POWER_UP_TICKS = TICK_HZ * 25 // 10_000
"""From the supply's return to the first instruction: t_RSTTEMPO of the data sheet."""
SENSOR, PWR_MGMT_1, DEVICE_RESET = 0x68, 0x6B, 0x80


class Machine:
    """An STM32F103C8 that runs an image with the virtual MPU-6050 on its pins.

    Parameters
    ----------
    image
        What is flashed.
    sensor
        The sensor on PB6, PB7 and PB8.
    peer_baud
        Rate of who is at PA9 and PA10.
    crystal_starts
        Whether the crystal oscillates.
    lsi_hz
        Rate of the watchdog's oscillator.
    store
        The first bytes of the store; the rest is erased.
    power_cut_after
        The supply fails within the byte after so many that are written to the store; None: never.
    received
        What the link receives and when.
    handles_faults
        Whether a fault goes to the program's handler instead of ending the run.

    Attributes
    ----------
    link
        Every byte that the link has sent and nobody has taken yet.
    segments
        Instructions between the marks, those of interrupts not counted.
    resets
        Resets since power-up.
    store
        The non-volatile store.
    """

    def __init__(
        self,
        image: bytes,
        sensor: VirtualSensor,
        *,
        peer_baud: int,
        crystal_starts: bool = True,
        lsi_hz: int = TYPICAL_LSI_HZ,
        store: bytes = b"",
        power_cut_after: int | None = None,
        received: tuple[LinkInput, ...] = (),
        handles_faults: bool = False,
    ) -> None:
        self.link = bytearray()
        self.segments = Segments()
        self.sensor = sensor
        self.store = Store(store, power_cut_after)
        self.resets = 0
        self._peer_baud, self._lsi_hz = peer_baud, lsi_hz
        self._crystal_starts = crystal_starts
        self._handles_faults = handles_faults
        self._core = Core(
            image,
            flash_bytes=FLASH_BYTES - STORE_BYTES,
            happen=self._let_happen,
            read=self._read,
            write=self._write,
        )
        self.time = self._core.state.time
        for start, size in (
            (PERIPHERALS_START, PERIPHERALS_BYTES),
            (CORE_START, CORE_BYTES),
            (STORE_START, STORE_BYTES),
        ):
            self._core.map(start, size)
        self._deepest_stack = 0
        self._played_at = NEVER
        self._reset_by: int | None = None
        self._sender = Sender(self.time, peer_baud, received)
        self._power_up(BY_POWER | BY_PIN)

    # --- construction and resets -----------------------------------------------------------------

    def _power_up(self, flags: int) -> None:
        """Stand before the first instruction, with all peripherals as after a reset."""
        self._begun_at: int | None = None
        self._sleeping = False
        self.time.ticks_per_instruction = 1
        self._core.reset()
        self._make_peripherals(flags)
        self._wire()

    def _make_peripherals(self, flags: int) -> None:
        time, sensor = self.time, self.sensor
        self._clocks = Clocks(time, crystal_starts=self._crystal_starts, reset_flags=flags)
        self._timer, self._ticker = Timer(time, self._clocks), Timer(time, self._clocks)
        self._port_a, self._port_b, self._lines = Port(), Port(), Lines()
        self._wires = Wires(time, self._port_b, self._lines, sensor)
        self._i2c = I2cMaster(time, self._clocks, self._wires, sensor)
        self._usart = Usart(time, self._clocks, peer_baud=self._peer_baud, heard=self.link.append)
        self._sender.arrive = self._usart.arrive
        self._flash = Flash(time, self._clocks, self.store, lambda: self._reset(BY_POWER))
        self._watchdog = Watchdog(time, self._lsi_hz, lambda: self._reset(BY_WATCHDOG))
        self._devices: tuple[Device, ...] = (
            *(self._clocks, self._timer, self._ticker, self._wires, self._i2c, self._usart),
            *(self._sender, self._flash, self._watchdog),
        )
        requesters = {EXTI9_5: self._lines, TIM2: self._timer, TIM3: self._ticker}
        self._nvic = Nvic(self._core, {**requesters, USART1: self._usart})

    def _wire(self) -> None:
        control = ControlBlock(self._core, lambda: self._reset(BY_REQUEST))
        placed: tuple[tuple[int, Peripheral, tuple[int, int] | None], ...] = (
            (0x40000000, self._timer, (APB1ENR, 0)),
            (0x40000400, self._ticker, (APB1ENR, 1)),
            (0x40003000, self._watchdog, None),
            (0x40005400, self._i2c, (APB1ENR, 21)),
            (0x40010000, Selector(self._lines), (APB2ENR, 0)),
            (0x40010400, self._lines, None),
            (0x40010800, self._port_a, (APB2ENR, 2)),
            (0x40010C00, self._port_b, (APB2ENR, 3)),
            (0x40013800, self._usart, (APB2ENR, 14)),
            (0x40021000, self._clocks, None),
            (0x40022000, self._flash, None),
            (0xE000E000, self._nvic, None),
            (0xE000EC00, control, None),
        )
        self._places = {
            start >> BLOCK_SHIFT: (peripheral, gate) for start, peripheral, gate in placed
        }

    def _reset(self, by: int) -> None:
        """Reset the board as soon as the instruction that is carried out has ended."""
        self._reset_by = by
        self._core.stop()

    def _start_over(self) -> None:
        by, self._reset_by = self._reset_by or BY_PIN, None
        self.resets += 1
        self._deepest_stack = self.stack_bytes
        flags = self._clocks.reset_flags | by | BY_PIN
        if by == BY_POWER:
            flags = BY_POWER | BY_PIN
            self._core.paint()
            self._power_sensor()
            self.time.now += POWER_UP_TICKS
        self.time.stalled_until = 0
        self._power_up(flags)
        self._plan()

    def _power_sensor(self) -> None:
        """Take the sensor's supply away and give it back: it is as after a reset on demand."""
        sensor = self.sensor
        sensor.advance(self.time.now_ns)
        sensor.stop()
        sensor.nack_next(0)
        sensor.hold_sda(0)
        sensor.start(SENSOR, read=False)
        sensor.write(PWR_MGMT_1)
        sensor.write(DEVICE_RESET)
        sensor.stop()

    # --- what the user sees ----------------------------------------------------------------------

    @property
    def finished(self) -> bool:
        """Whether the table has been played and read, and every byte is out."""
        if not self.sensor.exhausted:
            self._played_at = NEVER
            return False
        self._played_at = min(self._played_at, self.time.now)
        patience_over = self.time.now - self._played_at > PATIENCE_TICKS
        return (self._sleeping or patience_over) and self._usart.idle

    @property
    def stack_bytes(self) -> int:
        """Deepest stack so far."""
        return max(self._deepest_stack, self._core.stack_bytes)

    def receive(self, data: bytes) -> None:
        """Send bytes to the link from now on."""
        self._sender.send(data)
        self._plan()

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
            if self._reset_by is not None:
                self._start_over()
            elif self._sleeping:
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
        """Let happen what is due, the earliest first; what befell a stalled core, each in time."""
        time = self.time
        now = time.now
        stalled = self._flash.due <= now
        while self._reset_by is None:
            device = min(self._devices, key=_due)
            if device.due > now:
                break
            if stalled:
                time.now = device.due
            device.happen()
        time.now = now
        self._plan()

    def _doze(self) -> None:
        """Jump from event to event until an interrupt ends the sleep."""
        while not self._nvic.wakes:
            if min(device.due for device in self._devices) == NEVER:
                raise EmulationError("the firmware sleeps for ever")
            self.time.now = max(self.time.now, self.time.wake)
            self._let_happen()
            over = self.time.now >= self.time.until or self._reset_by is not None
            if over or self.finished:
                return
        self._sleeping = False

    def _run_instructions(self) -> None:
        try:
            outcome = self._core.run()
        except BusFault as fault:
            self._fault(str(fault))
            return
        state = self._core.state
        if outcome is Outcome.SLEEPS:
            self._sleeping = True
        elif outcome is Outcome.FAULTS:
            self._fault(self._core.message(state.fault))
        elif outcome is Outcome.EXCEPTS:
            self._fault(f"exception {state.fault}")
        elif outcome is Outcome.BEGINS_AGAIN:
            raise EmulationError(f"the firmware jumped to its start after {self.time.now_s:.3f} s")
        elif outcome is Outcome.NO_CODE:
            self._fault("it has no code there")

    def _fault(self, why: str) -> None:
        if not self._handles_faults:
            raise EmulationError(f"the firmware faults at {self._core.fault_address:#010x}: {why}")
        self._core.enter_fault()

    # --- registers -------------------------------------------------------------------------------

    def _find(self, address: int) -> Peripheral | None:
        """Return what answers at an address; None for a peripheral that has no clock."""
        found = self._places.get(address >> BLOCK_SHIFT)
        if found is None:
            raise EmulationError(f"the firmware uses {address:#010x}, which is not modelled")
        peripheral, gate = found
        return peripheral if gate is None or self._clocks.clocked(*gate) else None

    def _read(self, address: int, size: int) -> int:
        if address < PERIPHERALS_START:
            return self._flash.read_store(address - STORE_START, size)
        peripheral = self._find(address)
        if peripheral is None:
            return 0
        if peripheral is self._i2c and self._i2c.polled_in_vain():
            self._wait()
        value = peripheral.read(address & OFFSET)
        if peripheral is self._i2c or peripheral is self._usart:
            self._plan()
        return value

    def _wait(self) -> None:
        """Let a program that polls in vain wait for the next event: the time passes, unspent."""
        now = self.time.now
        next_due = min(d.due for d in self._devices)
        self.time.now = max(now, min(next_due, now + LONGEST_WAIT_TICKS))
        self._let_happen()

    def _write(self, address: int, size: int, value: int) -> None:
        if address < PERIPHERALS_START:
            self._flash.program(address - STORE_START, size, value)
            self._plan()
            return
        peripheral = self._find(address)
        if peripheral is None:
            return
        peripheral.write(address & OFFSET, value)
        if peripheral is self._port_a:
            self._usart.wired = self._port_a.peripheral(TX_PIN)
            self._usart.listens = not self._port_a.mode(RX_PIN) & 3
            self._mark(bool(self._port_a.output >> MARK_PIN & 1))
        elif peripheral is self._port_b:
            self._wires.moved_by_program()
        self._plan()

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
